//! What stands along the road.

use super::motion::Path;
use super::scenario::Scenario;
use boresight_core::Random;
use std::collections::BTreeMap;

/// Side of a square of the index, m.
const CELL_M: f64 = 20.0;

/// The car touches nothing this close to the path of its rear axle, m.
const CLEARANCE_M: f64 = 1.9;

/// What a reflector belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    ParkedCar,
    Wall,
    Tree,
    Rail,
    /// Kerbs, grass, gravel.
    Ground,
    Pole,
}

/// Something that stands and reflects.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reflector {
    pub(crate) kind: Kind,
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    /// Height above the ground, m; only the profile "radarscenes" has heights.
    pub(crate) height_m: f64,
    /// Unit vector away from the road.
    pub(crate) outward: [f64; 2],
    /// Half of its extent: the echo comes from anywhere within.
    pub(crate) half_m: [f64; 2],
    /// Mean cross-section, dBsm.
    pub(crate) rcs_dbsm: f64,
    /// Whether it is flat along its extent, so that it fades away from its normal.
    pub(crate) flat: bool,
    /// What it does to echoes from behind it, dB.
    pub(crate) shadow_db: f64,
}

/// All that stands, by place.
#[derive(Debug, Default)]
pub(crate) struct World {
    cells: BTreeMap<(i32, i32), Vec<Reflector>>,
}

fn cell(x_m: f64, y_m: f64, side_m: f64) -> (i32, i32) {
    ((x_m / side_m).floor() as i32, (y_m / side_m).floor() as i32)
}

/// What a stretch of roadside holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    ParkedCars,
    Buildings,
    Trees,
    Rail,
    Fence,
    Open,
}

impl World {
    /// Lines both sides of a path.
    pub(crate) fn new(path: &Path, scenario: Scenario, random: &mut Random) -> Self {
        let mut free: BTreeMap<(i32, i32), Vec<[f64; 2]>> = BTreeMap::new();
        for p in path.points() {
            free.entry(cell(p.x_m, p.y_m, 2.0)).or_default().push([p.x_m, p.y_m]);
        }
        let mut builder = Builder { path, free, world: Self::default(), random };
        for left in [false, true] {
            let mut along = -60.0;
            while along < path.length_m() + 110.0 {
                let length = builder.random.uniform(15.0, 70.0);
                let kind = pick(scenario, builder.random);
                builder.line(scenario, kind, left, along, along + length);
                along += length;
            }
            builder.furniture(scenario, left);
        }
        builder.world
    }

    /// Adds a reflector.
    pub(crate) fn push(&mut self, reflector: Reflector) {
        let place = cell(reflector.x_m, reflector.y_m, CELL_M);
        self.cells.entry(place).or_default().push(reflector);
    }

    /// Takes everything, square by square.
    pub(crate) fn into_reflectors(self) -> impl Iterator<Item = Reflector> {
        self.cells.into_values().flatten()
    }

    /// Everything within `range_m` of a place, with squares around it.
    pub(crate) fn near(
        &self,
        x_m: f64,
        y_m: f64,
        range_m: f64,
    ) -> impl Iterator<Item = &Reflector> {
        let (x0, y0) = cell(x_m - range_m, y_m - range_m, CELL_M);
        let (x1, y1) = cell(x_m + range_m, y_m + range_m, CELL_M);
        (x0..=x1)
            .flat_map(move |x| self.cells.range((x, y0)..=(x, y1)))
            .flat_map(|(_, reflectors)| reflectors)
    }
}

/// The kind of roadside that comes next.
fn pick(scenario: Scenario, random: &mut Random) -> Side {
    use Side::{Buildings, Fence, Open, ParkedCars, Rail, Trees};
    let table: [(Side, f64); 6] = match scenario {
        Scenario::City | Scenario::StopAndGo | Scenario::DenseTraffic => [
            (ParkedCars, 0.35),
            (Buildings, 0.3),
            (Trees, 0.1),
            (Rail, 0.0),
            (Fence, 0.15),
            (Open, 0.1),
        ],
        Scenario::CountryRoad => [
            (ParkedCars, 0.0),
            (Buildings, 0.06),
            (Trees, 0.44),
            (Rail, 0.2),
            (Fence, 0.1),
            (Open, 0.2),
        ],
        Scenario::Motorway => [
            (ParkedCars, 0.0),
            (Buildings, 0.12),
            (Trees, 0.1),
            (Rail, 0.7),
            (Fence, 0.03),
            (Open, 0.05),
        ],
        Scenario::CarPark => [
            (ParkedCars, 0.75),
            (Buildings, 0.1),
            (Trees, 0.05),
            (Rail, 0.0),
            (Fence, 0.05),
            (Open, 0.05),
        ],
    };
    let mut draw = random.unit();
    for (kind, weight) in table {
        if draw < weight {
            return kind;
        }
        draw -= weight;
    }
    Open
}

struct Builder<'a> {
    path: &'a Path,
    /// Points of the path, by 2 m squares.
    free: BTreeMap<(i32, i32), Vec<[f64; 2]>>,
    world: World,
    random: &'a mut Random,
}

impl Builder<'_> {
    /// Whether something may stand there without being driven over.
    fn allowed(&self, x_m: f64, y_m: f64) -> bool {
        let (cx, cy) = cell(x_m, y_m, 2.0);
        (cx - 1..=cx + 1).flat_map(|x| self.free.range((x, cy - 1)..=(x, cy + 1))).all(
            |(_, points)| {
                points.iter().all(|p| {
                    let (dx, dy) = (p[0] - x_m, p[1] - y_m);
                    dx * dx + dy * dy > CLEARANCE_M * CLEARANCE_M
                })
            },
        )
    }

    /// Puts a reflector beside the path, with its extent along it turned by `turned_rad`.
    fn put(&mut self, along_m: f64, left_m: f64, half_m: f64, turned_rad: f64, rest: Reflector) {
        // Inside of a tight curve the offset passes the curve's centre.
        if self.path.curvature(along_m) * left_m > 0.8 {
            return;
        }
        let p = self.path.at(along_m, left_m);
        if !self.allowed(p.x_m, p.y_m) {
            return;
        }
        let (sin, cos) = libm::sincos(p.yaw_rad + turned_rad);
        let half_m = [half_m * cos, half_m * sin];
        let (sin, cos) = libm::sincos(p.yaw_rad);
        let outward = [-sin * left_m.signum(), cos * left_m.signum()];
        self.world.push(Reflector { x_m: p.x_m, y_m: p.y_m, outward, half_m, ..rest });
    }

    fn line(&mut self, scenario: Scenario, kind: Side, left: bool, from_m: f64, to_m: f64) {
        let side = if left { 1.0 } else { -1.0 };
        // The left kerb lies beyond the oncoming lane, on motorways beyond a lane or two.
        let edge = match (scenario, left) {
            (Scenario::Motorway, true) => self.random.uniform(2.6, 6.5),
            (Scenario::Motorway, false) => self.random.uniform(4.0, 10.0),
            (Scenario::CarPark, _) => self.random.uniform(3.2, 4.5),
            (Scenario::DenseTraffic, true) => 12.5,
            (Scenario::DenseTraffic, false) => 6.0,
            (_, true) => self.random.uniform(5.6, 6.4),
            (_, false) => self.random.uniform(2.6, 3.4),
        };
        match kind {
            Side::ParkedCars => self.parked_cars(scenario, side, edge, from_m, to_m),
            Side::Buildings => {
                let offset = side * (edge + self.random.uniform(2.5, 9.0));
                let mut along = from_m;
                while along < to_m {
                    let rcs_dbsm = -9.0 + 6.0 * self.random.normal();
                    let wall = reflector(Kind::Wall, rcs_dbsm, true, 30.0);
                    let left = offset + 0.2 * self.random.normal();
                    self.put(along, left, 0.8, 0.0, wall);
                    along += 1.6;
                }
            }
            Side::Trees => {
                let offset = edge + self.random.uniform(0.8, 3.0);
                let mut along = from_m;
                while along < to_m {
                    let rcs_dbsm = -7.0 + 4.0 * self.random.normal();
                    let depth = 4.0 * self.random.unit();
                    self.put(
                        along,
                        side * (offset + depth),
                        0.3,
                        0.0,
                        reflector(Kind::Tree, rcs_dbsm, false, 3.0),
                    );
                    along += self.random.uniform(1.0, 6.0);
                }
            }
            Side::Rail => {
                let mut along = from_m;
                while along < to_m {
                    let rcs_dbsm = -9.0 + 3.0 * self.random.normal();
                    self.put(
                        along,
                        side * (edge + 0.5),
                        0.1,
                        0.0,
                        reflector(Kind::Rail, rcs_dbsm, false, 2.0),
                    );
                    self.put(
                        along + 1.0,
                        side * (edge + 0.5),
                        1.0,
                        0.0,
                        reflector(Kind::Rail, -12.0, true, 2.0),
                    );
                    along += 2.0;
                }
            }
            Side::Fence => {
                let mut along = from_m;
                while along < to_m {
                    let rcs_dbsm = -11.0 + 4.0 * self.random.normal();
                    self.put(
                        along,
                        side * (edge + 1.5),
                        0.4,
                        0.0,
                        reflector(Kind::Rail, rcs_dbsm, false, 1.0),
                    );
                    along += 1.5;
                }
            }
            Side::Open => {}
        }
        // Kerbs, grass, gravel and whatever lies about.
        let mut along = from_m;
        while along < to_m {
            let offset = side * (edge + 9.0 * self.random.unit());
            let rcs_dbsm = -13.0 + 5.0 * self.random.normal();
            self.put(along, offset, 0.1, 0.0, reflector(Kind::Ground, rcs_dbsm, false, 0.0));
            along += self.random.uniform(0.4, 2.0);
        }
    }

    /// Cars along the kerb, or side by side in a car park: corners and flanks.
    fn parked_cars(&mut self, scenario: Scenario, side: f64, edge: f64, from_m: f64, to_m: f64) {
        let across = scenario == Scenario::CarPark && self.random.unit() < 0.8;
        let mut along = from_m;
        while along < to_m {
            let (long, wide) = (self.random.uniform(3.8, 4.9), self.random.uniform(1.7, 1.9));
            let (ahead, aside) = if across { (wide, long) } else { (long, wide) };
            if self.random.unit() < 0.8 {
                let offset = side * (edge + 0.5 * aside + 0.15 * self.random.normal());
                let turned = if across { std::f64::consts::FRAC_PI_2 } else { 0.0 };
                for (da, dl) in [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)] {
                    let rcs_dbsm = -4.0 + 4.0 * self.random.normal();
                    let corner = reflector(Kind::ParkedCar, rcs_dbsm, false, 0.0);
                    self.put(along + da * ahead, offset + dl * aside, 0.25, turned, corner);
                }
                // Flank and end, which also throw the shadow.
                self.put(
                    along,
                    offset,
                    0.45 * long,
                    turned,
                    reflector(Kind::ParkedCar, 0.0, true, 12.0),
                );
                let end = reflector(Kind::ParkedCar, -3.0, true, 12.0);
                self.put(along, offset, 0.45 * wide, turned + std::f64::consts::FRAC_PI_2, end);
            }
            along += ahead
                + if across {
                    self.random.uniform(0.6, 1.0)
                } else {
                    self.random.uniform(0.8, 2.5)
                };
        }
    }

    /// Poles, lamps and signs.
    fn furniture(&mut self, scenario: Scenario, left: bool) {
        let (side, apart) = match scenario {
            Scenario::Motorway => (if left { 7.0 } else { -10.5 }, 50.0),
            Scenario::CountryRoad => (if left { 6.5 } else { -3.0 }, 25.0),
            Scenario::CarPark => (if left { 3.0 } else { -3.0 }, 20.0),
            Scenario::DenseTraffic => (if left { 13.0 } else { -6.5 }, 22.0),
            _ => (if left { 6.8 } else { -3.6 }, 22.0),
        };
        let mut along = -60.0;
        while along < self.path.length_m() + 110.0 {
            let rcs_dbsm = 1.0 + 4.0 * self.random.normal();
            let offset = side + 0.3 * self.random.normal();
            self.put(along, offset, 0.05, 0.0, reflector(Kind::Pole, rcs_dbsm, false, 1.0));
            along += apart * self.random.uniform(0.6, 1.4);
        }
    }
}

fn reflector(kind: Kind, rcs_dbsm: f64, flat: bool, shadow_db: f64) -> Reflector {
    Reflector {
        kind,
        x_m: 0.0,
        y_m: 0.0,
        height_m: 0.0,
        outward: [0.0; 2],
        half_m: [0.0; 2],
        rcs_dbsm,
        flat,
        shadow_db,
    }
}
