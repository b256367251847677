//! Kinds of roads, and routes over them: curvature, speed limits and stops along the way.

use boresight_core::{InputError, Random};
use boresight_options::{Described, Named};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Roads and traffic of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[option(name = "DriveScenario")]
pub enum Scenario {
    /// Streets with junctions, roundabouts, lights, parked cars, pedestrians.
    #[default]
    City,
    /// Curves between fields and woods, oncoming traffic.
    CountryRoad,
    /// Up to 130 km/h between guard rails.
    Motorway,
    /// Tight turns between parked cars, forward and in reverse.
    CarPark,
    /// A queue on a city road.
    StopAndGo,
    /// Vehicles on all sides at nearly the car's speed.
    DenseTraffic,
}

impl Scenario {
    /// All scenarios, in the order they are listed to users.
    pub const ALL: [Self; 6] = [
        Self::City,
        Self::CountryRoad,
        Self::Motorway,
        Self::CarPark,
        Self::StopAndGo,
        Self::DenseTraffic,
    ];

    /// The name used in options and on the command line.
    pub fn name(self) -> &'static str {
        Named::name(self)
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::City => "City",
            Self::CountryRoad => "Country road",
            Self::Motorway => "Motorway",
            Self::CarPark => "Car park",
            Self::StopAndGo => "Stop and go",
            Self::DenseTraffic => "Dense traffic",
        }
    }

    /// Finds a scenario by its [`Scenario::name`].
    ///
    /// # Errors
    /// [`InputError::Unknown`], listing the known names.
    pub fn from_name(name: &str) -> Result<Self, InputError> {
        Named::from_name("scenario", name)
    }

    /// Free speed from and to, m/s.
    fn speed_mps(self) -> [f64; 2] {
        match self {
            Self::City => [8.0, 14.5],
            Self::CountryRoad => [19.0, 28.0],
            Self::Motorway => [24.0, 36.1],
            Self::CarPark => [2.0, 4.1],
            Self::StopAndGo => [3.0, 13.0],
            Self::DenseTraffic => [7.0, 16.0],
        }
    }

    /// Lateral acceleration a driver accepts, m/s^2.
    pub(crate) fn lateral_mps2(self) -> f64 {
        match self {
            Self::CarPark => 1.5,
            Self::Motorway => 2.0,
            _ => 2.8,
        }
    }
}

/// How curvature runs over a piece of road.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// Rises to the curvature, holds it and falls, over the given share of the length each.
    Arc { curvature_per_m: f64, ramp: f64 },
    /// One period of a sine: a lane change.
    LaneChange { amplitude_per_m: f64 },
}

/// A piece of road.
#[derive(Debug, Clone, Copy)]
struct Piece {
    length_m: f64,
    shape: Shape,
    speed_mps: f64,
    reverse: bool,
    /// How long the car stands at the end of the piece, s.
    stop_s: Option<f64>,
}

/// Distance between the points of a route, m.
const STEP_M: f64 = 0.25;

/// A way to drive, by distance travelled.
#[derive(Debug, Clone)]
pub(crate) struct Route {
    /// Curvature of the path, to the left positive, 1/m; for each [`STEP_M`].
    curvature_per_m: Vec<f64>,
    /// Highest speed that still allows to brake for all that comes, m/s.
    speed_mps: Vec<f64>,
    reverse: Vec<bool>,
    /// Where and how long the car stops: m, s.
    pub(crate) stops: Vec<(f64, f64)>,
}

impl Route {
    /// A route that takes at least `duration_s`.
    pub(crate) fn new(scenario: Scenario, duration_s: f64, random: &mut Random) -> Self {
        let mut builder = Builder { scenario, pieces: Vec::new(), least_s: 0.0 };
        while builder.least_s < duration_s + 5.0 {
            builder.extend(random);
        }
        Self::from_pieces(&builder.pieces, scenario)
    }

    fn from_pieces(pieces: &[Piece], scenario: Scenario) -> Self {
        let mut route =
            Self { curvature_per_m: vec![], speed_mps: vec![], reverse: vec![], stops: vec![] };
        for piece in pieces {
            let count = (piece.length_m / STEP_M).ceil().max(1.0) as usize;
            for i in 0..count {
                let share = (i as f64 + 0.5) / count as f64;
                let curvature = piece.curvature(share);
                let grip = (scenario.lateral_mps2() / curvature.abs().max(1e-9)).sqrt();
                route.curvature_per_m.push(curvature);
                route.speed_mps.push(piece.speed_mps.min(grip));
                route.reverse.push(piece.reverse);
            }
            if let Some(stop_s) = piece.stop_s {
                route.stops.push(((route.speed_mps.len() - 1) as f64 * STEP_M, stop_s));
                if let Some(last) = route.speed_mps.last_mut() {
                    *last = 0.0;
                }
            }
        }
        let comfort_mps2 = if scenario == Scenario::CarPark { 1.0 } else { 1.9 };
        for i in (0..route.speed_mps.len().saturating_sub(1)).rev() {
            let next = route.speed_mps[i + 1];
            let braking = (next * next + 2.0 * comfort_mps2 * STEP_M).sqrt();
            route.speed_mps[i] = route.speed_mps[i].min(braking);
        }
        route
    }

    fn index(&self, travelled_m: f64) -> usize {
        ((travelled_m.max(0.0) / STEP_M) as usize).min(self.speed_mps.len() - 1)
    }

    /// Curvature at a distance, interpolated, 1/m.
    pub(crate) fn curvature(&self, travelled_m: f64) -> f64 {
        let i = self.index(travelled_m);
        let next = (i + 1).min(self.curvature_per_m.len() - 1);
        let share = (travelled_m / STEP_M - i as f64).clamp(0.0, 1.0);
        self.curvature_per_m[i] * (1.0 - share) + self.curvature_per_m[next] * share
    }

    /// Allowed speed at a distance, m/s.
    pub(crate) fn speed(&self, travelled_m: f64) -> f64 {
        let i = self.index(travelled_m);
        let next = (i + 1).min(self.speed_mps.len() - 1);
        let share = (travelled_m / STEP_M - i as f64).clamp(0.0, 1.0);
        self.speed_mps[i] * (1.0 - share) + self.speed_mps[next] * share
    }

    /// 1 forward, -1 in reverse.
    pub(crate) fn direction(&self, travelled_m: f64) -> f64 {
        if self.reverse[self.index(travelled_m)] { -1.0 } else { 1.0 }
    }
}

impl Piece {
    fn curvature(&self, share: f64) -> f64 {
        match self.shape {
            Shape::Arc { curvature_per_m, ramp } => {
                let x = (share.min(1.0 - share) / ramp).min(1.0);
                curvature_per_m * x * x * (3.0 - 2.0 * x)
            }
            Shape::LaneChange { amplitude_per_m } => amplitude_per_m * libm::sin(TAU * share),
        }
    }
}

struct Builder {
    scenario: Scenario,
    pieces: Vec<Piece>,
    /// Time the pieces take at their speed limits, s.
    least_s: f64,
}

impl Builder {
    fn push(&mut self, length_m: f64, shape: Shape, speed_mps: f64) {
        self.least_s += length_m / speed_mps;
        self.pieces.push(Piece { length_m, shape, speed_mps, reverse: false, stop_s: None });
    }

    fn straight(&mut self, length_m: f64, speed_mps: f64, random: &mut Random) {
        // No lane is straight to better than this, and no driver keeps it so.
        let mut left = length_m;
        while left > 1.0 {
            let length = random.uniform(1.5, 4.0) * speed_mps;
            let length = length.min(left);
            let curvature = random.normal() * 0.04 / (speed_mps * speed_mps).max(9.0);
            self.push(length, Shape::Arc { curvature_per_m: curvature, ramp: 0.5 }, speed_mps);
            left -= length;
        }
    }

    /// Turns by an angle on a radius, with ramps of a quarter of the length.
    fn turn(&mut self, angle_rad: f64, radius_m: f64, speed_mps: f64) {
        let ramp = 0.25;
        // The integral of the ramps is half that of a full curve.
        let length = angle_rad.abs() * radius_m / (1.0 - ramp);
        let curvature_per_m = angle_rad.signum() / radius_m;
        self.push(length, Shape::Arc { curvature_per_m, ramp }, speed_mps);
    }

    fn lane_change(&mut self, speed_mps: f64, random: &mut Random) {
        let length_m = speed_mps.max(5.0) * random.uniform(3.0, 5.5);
        let offset_m = random.uniform(2.8, 3.7) * sign(random);
        let amplitude_per_m = offset_m * TAU / (length_m * length_m);
        self.push(length_m, Shape::LaneChange { amplitude_per_m }, speed_mps);
    }

    fn roundabout(&mut self, speed_mps: f64, random: &mut Random) {
        let radius = random.uniform(11.0, 20.0);
        let exit = FRAC_PI_2 * random.integer(1, 3) as f64;
        let (into, out) = (random.uniform(0.5, 0.8), random.uniform(0.5, 0.8));
        self.turn(-into, radius * 0.9, speed_mps);
        self.turn(exit - FRAC_PI_2 + into + out + random.uniform(-0.2, 0.2), radius, speed_mps);
        self.turn(-out, radius * 1.1, speed_mps);
    }

    fn stop(&mut self, time_s: f64) {
        if let Some(last) = self.pieces.last_mut() {
            last.stop_s = Some(time_s);
            self.least_s += time_s;
        }
    }

    fn extend(&mut self, random: &mut Random) {
        let [slow, fast] = self.scenario.speed_mps();
        let speed = random.uniform(slow, fast);
        let choice = random.unit();
        match self.scenario {
            Scenario::City => {
                self.straight(random.uniform(40.0, 160.0), speed, random);
                if random.unit() < 0.4 {
                    self.stop(random.uniform(4.0, 25.0));
                }
                match choice {
                    c if c < 0.4 => {
                        let left = sign(random);
                        let radius = random.uniform(7.0, 11.0) + if left > 0.0 { 3.0 } else { 0.0 };
                        self.turn(left * (FRAC_PI_2 + 0.12 * random.normal()), radius, speed);
                    }
                    c if c < 0.52 => self.roundabout(speed, random),
                    c if c < 0.7 => self.lane_change(speed, random),
                    _ => self.curve([40.0, 200.0], [0.2, 1.0], speed, random),
                }
            }
            Scenario::CountryRoad => {
                self.straight(random.uniform(80.0, 400.0), speed, random);
                match choice {
                    c if c < 0.06 => self.roundabout(speed, random),
                    c if c < 0.1 => {
                        self.stop(random.uniform(2.0, 8.0));
                        self.turn(sign(random) * FRAC_PI_2, random.uniform(10.0, 16.0), speed);
                    }
                    _ => {
                        self.curve([110.0, 600.0], [0.15, 1.2], speed, random);
                        if random.unit() < 0.6 {
                            self.curve([110.0, 600.0], [0.15, 1.2], speed, random);
                        }
                    }
                }
            }
            Scenario::Motorway => {
                self.straight(random.uniform(200.0, 900.0), speed, random);
                if choice < 0.55 {
                    self.lane_change(speed, random);
                } else if choice < 0.62 {
                    let radius = random.uniform(45.0, 90.0);
                    self.turn(sign(random) * random.uniform(1.2, 4.2), radius, speed);
                } else {
                    self.curve([700.0, 3000.0], [0.1, 0.5], speed, random);
                }
            }
            Scenario::CarPark => self.extend_car_park(speed, random),
            Scenario::StopAndGo => {
                let queue = choice < 0.75;
                let length = if queue { random.uniform(6.0, 45.0) } else { 90.0 };
                let pace = if queue { speed.min(1.5 + 0.25 * length) } else { speed };
                self.straight(length, pace, random);
                if queue {
                    self.stop(random.uniform(2.0, 14.0));
                }
                match random.unit() {
                    c if c < 0.12 => {
                        self.turn(sign(random) * FRAC_PI_2, random.uniform(8.0, 15.0), speed);
                    }
                    c if c < 0.3 => self.curve([40.0, 250.0], [0.15, 0.7], speed, random),
                    c if c < 0.4 => self.lane_change(speed, random),
                    _ => {}
                }
            }
            Scenario::DenseTraffic => {
                self.straight(random.uniform(40.0, 250.0), speed, random);
                if choice < 0.15 {
                    self.stop(random.uniform(3.0, 12.0));
                }
                match random.unit() {
                    c if c < 0.3 => self.lane_change(speed, random),
                    c if c < 0.42 => {
                        self.turn(sign(random) * FRAC_PI_2, random.uniform(10.0, 18.0), speed);
                    }
                    _ => self.curve([50.0, 400.0], [0.15, 0.8], speed, random),
                }
            }
        }
    }

    fn curve(
        &mut self,
        radius_m: [f64; 2],
        angle_rad: [f64; 2],
        speed_mps: f64,
        random: &mut Random,
    ) {
        // Uniform in curvature, so that gentle curves do not prevail.
        let curvature = random.uniform(1.0 / radius_m[1], 1.0 / radius_m[0]);
        let angle = random.uniform(angle_rad[0], angle_rad[1]) * sign(random);
        self.turn(angle, 1.0 / curvature, speed_mps);
    }

    fn extend_car_park(&mut self, speed_mps: f64, random: &mut Random) {
        self.straight(random.uniform(8.0, 35.0), speed_mps, random);
        let side = sign(random);
        if random.unit() < 0.35 {
            // Back into a space and come out of it again.
            self.stop(random.uniform(0.8, 2.0));
            let first = self.pieces.len();
            self.turn(side * FRAC_PI_2, random.uniform(5.2, 6.5), 1.8);
            self.straight(random.uniform(1.5, 3.5), 1.2, random);
            for piece in &mut self.pieces[first..] {
                piece.reverse = true;
            }
            self.stop(random.uniform(1.0, 12.0));
            self.turn(side * -random.uniform(1.2, FRAC_PI_2), random.uniform(5.5, 7.5), 2.4);
        } else {
            let angle = random.uniform(0.8, PI * 0.9);
            self.turn(side * angle, random.uniform(5.5, 9.0), speed_mps);
            if random.unit() < 0.25 {
                self.stop(random.uniform(1.0, 6.0));
            }
        }
    }
}

/// 1 or -1.
pub(crate) fn sign(random: &mut Random) -> f64 {
    if random.unit() < 0.5 { -1.0 } else { 1.0 }
}
