//! What stands and drives on a street along the car's x axis: lanes at y = 0 and y = 3.2 m (the
//! oncoming one), cars parked on both sides, house fronts on the right, a guard rail on the left.

use super::{StreetKind, StreetOutline, StreetTarget};
use boresight_core::Random;

/// Stretch of street, m.
const STREET_M: [f64; 2] = [-45.0, 85.0];
/// Middles of the rows of parked cars, m.
const PARKED_Y_M: [f64; 2] = [-3.1, 6.3];
/// Where the row on the left ends and the guard rail begins, m.
const LEFT_ROW_END_M: f64 = 24.0;
const RAIL_Y_M: f64 = 5.6;
const WALL_Y_M: f64 = -7.0;
const ONCOMING_Y_M: f64 = 3.2;
/// Points lie this far outside the outline, so that it hides only those on its far side.
const SKIN_M: f64 = 0.03;

/// Things in the order they are placed.
#[derive(Default)]
struct Layout {
    targets: Vec<StreetTarget>,
    outlines: Vec<StreetOutline>,
}

pub(super) fn layout(random: &mut Random) -> (Vec<StreetTarget>, Vec<StreetOutline>) {
    let mut layout = Layout::default();
    layout.parked(PARKED_Y_M[0], STREET_M, random);
    layout.parked(PARKED_Y_M[1], [STREET_M[0], LEFT_ROW_END_M], random);
    layout.wall(random);
    layout.rail(random);
    for y in [-4.6, 8.2] {
        layout.poles(y, random);
    }
    layout.traffic(random);
    layout.people(random);
    (layout.targets, layout.outlines)
}

impl Layout {
    /// A row of parked cars with gaps, some wide enough for one more.
    fn parked(&mut self, y_m: f64, [from, to]: [f64; 2], random: &mut Random) {
        let mut x = from + random.uniform(0.0, 3.0);
        while x + 5.0 < to {
            let (length, width) = (random.uniform(3.9, 4.9), random.uniform(1.7, 1.9));
            let y = y_m + random.uniform(-0.15, 0.15);
            let turn = random.uniform(-0.03, 0.03);
            self.car(
                StreetKind::ParkedCar,
                [x + length / 2.0, y],
                [length, width],
                turn,
                0.0,
                random,
            );
            let gap = if random.unit() < 0.3 {
                random.uniform(3.0, 8.0)
            } else {
                random.uniform(0.8, 2.0)
            };
            x += length + gap;
        }
    }

    /// A car: corners and wheels scatter strongly, its sides in between weakly.
    fn car(
        &mut self,
        kind: StreetKind,
        [x, y]: [f64; 2],
        [length, width]: [f64; 2],
        yaw_rad: f64,
        speed_mps: f64,
        random: &mut Random,
    ) {
        let (sin, cos) = libm::sincos(yaw_rad);
        let place = |u: f64, v: f64| [x + u * cos - v * sin, y + u * sin + v * cos];
        let (a, b) = (length / 2.0, width / 2.0);
        let corners_m = vec![place(a, b), place(-a, b), place(-a, -b), place(a, -b)];
        let outline = self.outline(kind, corners_m);
        let (vx_mps, vy_mps) = (speed_mps * cos, speed_mps * sin);
        let mut point = |u: f64, v: f64, rcs_dbsm: f64| {
            let [x_m, y_m] = place(u, v);
            self.targets.push(StreetTarget { x_m, y_m, vx_mps, vy_mps, rcs_dbsm, kind, outline });
        };
        let (a, b) = (a + SKIN_M, b + SKIN_M);
        for side in [-1.0, 1.0] {
            for end in [-1.0, 1.0] {
                point(end * a, side * b, 3.0 + 3.0 * random.normal());
                point(end * 0.3 * length, side * b, -2.0 + 3.0 * random.normal());
            }
            for along in [-0.4, -0.15, 0.0, 0.15, 0.4] {
                let u = (along + random.uniform(-0.06, 0.06)) * length;
                point(u, side * b, -8.0 + 3.0 * random.normal());
            }
            // Bumper and number plate.
            let across = random.uniform(-0.3, 0.3) * width;
            point(side * a, across, 1.0 + 3.0 * random.normal());
        }
    }

    /// House fronts: windows, pipes and corners every half a metre or so, with passages between.
    fn wall(&mut self, random: &mut Random) {
        let mut x = STREET_M[0];
        while x < STREET_M[1] {
            let end = (x + random.uniform(9.0, 18.0)).min(STREET_M[1]);
            let y = WALL_Y_M + random.uniform(-0.4, 0.4);
            let outline = self.outline(StreetKind::Wall, vec![[x, y], [end, y]]);
            let mut at = x + 0.2;
            while at < end {
                let rcs_dbsm = -6.0 + 4.0 * random.normal();
                self.standing([at, y + SKIN_M], rcs_dbsm, outline);
                at += random.uniform(0.3, 0.8);
            }
            x = end + random.uniform(1.5, 4.0);
        }
    }

    /// A guard rail: posts every two metres, and the joints of the rail.
    fn rail(&mut self, random: &mut Random) {
        let ends = [LEFT_ROW_END_M + 2.0, STREET_M[1]];
        let corners_m = ends.map(|x| [x, RAIL_Y_M]).to_vec();
        let outline = self.outline(StreetKind::GuardRail, corners_m);
        let mut x = ends[0];
        while x < ends[1] {
            self.standing([x, RAIL_Y_M], -1.0 + 2.0 * random.normal(), outline);
            let joint = x + 1.0 + random.uniform(-0.3, 0.3);
            self.standing([joint, RAIL_Y_M], -7.0 + 3.0 * random.normal(), outline);
            x += 2.0;
        }
    }

    fn poles(&mut self, y_m: f64, random: &mut Random) {
        let mut x = STREET_M[0] + random.uniform(0.0, 12.0);
        while x < STREET_M[1] {
            let place = [x, y_m + random.uniform(-0.2, 0.2)];
            let outline = self.outline(StreetKind::Pole, vec![place]);
            self.standing(place, 3.0 + 2.0 * random.normal(), outline);
            x += random.uniform(10.0, 18.0);
        }
    }

    /// Cars ahead, behind and oncoming.
    fn traffic(&mut self, random: &mut Random) {
        for (x, y, speed) in [
            (19.0, 0.0, 7.0),
            (37.0, 0.1, 6.0),
            (-16.0, 0.0, 5.5),
            (13.0, ONCOMING_Y_M, -5.0),
            (33.0, ONCOMING_Y_M, -5.5),
            (58.0, ONCOMING_Y_M, -6.0),
            (-9.0, ONCOMING_Y_M, -5.0),
        ] {
            let x = x + random.uniform(-3.0, 3.0);
            let speed_mps = speed + random.uniform(-0.4, 0.4);
            let size = [random.uniform(4.1, 4.9), random.uniform(1.75, 1.9)];
            // An oncoming car's front is turned towards -x; its outline is the same.
            self.car(StreetKind::Vehicle, [x, y], size, 0.0, speed_mps, random);
        }
    }

    /// People on the pavements and one who crosses.
    fn people(&mut self, random: &mut Random) {
        for (x, y, velocity) in [
            (11.0, -5.4, [1.3, 0.0]),
            (24.0, -5.0, [-1.2, 0.0]),
            (8.0, 8.0, [1.1, 0.2]),
            (27.0, 1.6, [0.0, -1.4]),
            (-6.0, -5.2, [1.4, 0.0]),
        ] {
            let place = [x + random.uniform(-2.0, 2.0), y + random.uniform(-0.2, 0.2)];
            let outline = self.outline(StreetKind::Pedestrian, vec![place]);
            let kind = StreetKind::Pedestrian;
            // Trunk, and legs that swing.
            for (rcs, swing) in [(-6.0, 0.0), (-11.0, 0.8), (-11.0, -0.8)] {
                let away = |random: &mut Random| random.uniform(-0.15, 0.15);
                let [vx_mps, vy_mps] = velocity.map(|v: f64| v * (1.0 + swing));
                let (x_m, y_m) = (place[0] + away(random), place[1] + away(random));
                let rcs_dbsm = rcs + 1.5 * random.normal();
                self.targets.push(StreetTarget {
                    x_m,
                    y_m,
                    vx_mps,
                    vy_mps,
                    rcs_dbsm,
                    kind,
                    outline,
                });
            }
        }
    }

    fn outline(&mut self, kind: StreetKind, corners_m: Vec<[f64; 2]>) -> usize {
        self.outlines.push(StreetOutline { kind, corners_m });
        self.outlines.len() - 1
    }

    fn standing(&mut self, [x_m, y_m]: [f64; 2], rcs_dbsm: f64, outline: usize) {
        let kind = self.outlines[outline].kind;
        self.targets.push(StreetTarget {
            x_m,
            y_m,
            vx_mps: 0.0,
            vy_mps: 0.0,
            rcs_dbsm,
            kind,
            outline,
        });
    }
}
