//! Other road users.

use super::motion::{Path, TrueMotion, motion_at};
use super::scenario::{Scenario, sign};
use boresight_core::Random;
use boresight_core::drive::Pose;
use std::f64::consts::{FRAC_PI_2, PI};

/// Numbers of the classes in `RadarScenes`.
pub(crate) const CAR: u8 = 0;
const TRUCK: u8 = 2;
const BICYCLE: u8 = 5;
const PEDESTRIAN: u8 = 7;

/// A road user at one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mover {
    pub(crate) track: u32,
    /// Class in the numbers of `RadarScenes`.
    pub(crate) class: u8,
    pub(crate) length_m: f64,
    pub(crate) width_m: f64,
    /// Centre and heading on the ground.
    pub(crate) pose: Pose,
    /// Speed along its heading, m/s.
    pub(crate) speed_mps: f64,
    course: Course,
    until_s: f64,
}

/// How a road user moves.
#[derive(Debug, Clone, Copy)]
enum Course {
    /// Drives what the car will drive `lead_s` later, `gap_m` ahead of it.
    Ahead { lead_s: f64, gap_m: f64 },
    /// In a lane of the car's road: a share of the car's speed `pace`, which wanders around
    /// `mean`.
    Alongside { along_m: f64, left_m: f64, pace: f64, mean: f64 },
    /// Along the road at its own speed, either way.
    Own { along_m: f64, left_m: f64, speed_mps: f64 },
    /// Straight on across the ground.
    Across { speed_mps: f64 },
}

/// How much traffic a scenario has.
#[derive(Debug, Clone, Copy)]
struct Profile {
    /// Vehicles ahead in the same lane.
    ahead: usize,
    /// Vehicles alongside, and lanes they take, m to the left.
    alongside: usize,
    lanes: [f64; 2],
    /// Spread of their paces.
    spread: f64,
    /// Oncoming vehicles a second, and their lane.
    oncoming: f64,
    oncoming_left_m: f64,
    oncoming_mps: f64,
    /// Crossing vehicles, pedestrians and cyclists a second.
    crossing: f64,
    walkers: f64,
}

impl Profile {
    fn new(scenario: Scenario, moving_share: Option<f64>) -> Self {
        let mut profile = match scenario {
            Scenario::City => Self::of(1, 1, [-3.5, 3.5], 0.15, 0.12, 3.4, 10.0, 0.04, 0.1),
            Scenario::CountryRoad => Self::of(1, 0, [3.5, 3.5], 0.1, 0.08, 3.5, 24.0, 0.0, 0.004),
            Scenario::Motorway => Self::of(1, 4, [-3.6, 3.6], 0.1, 0.3, 14.0, 33.0, 0.0, 0.0),
            Scenario::CarPark => Self::of(0, 0, [3.5, 3.5], 0.1, 0.02, 3.2, 3.0, 0.02, 0.06),
            Scenario::StopAndGo => Self::of(3, 3, [-3.5, 3.5], 0.12, 0.15, 6.8, 8.0, 0.02, 0.08),
            Scenario::DenseTraffic => {
                Self::of(3, 16, [-3.5, 3.5], 0.035, 0.3, 8.5, 12.0, 0.01, 0.05)
            }
        };
        if let Some(share) = moving_share {
            // What is too much is left out afterwards; what is too little cannot be made up.
            let wanted = (share / 0.8 * 26.0).ceil() as usize;
            profile.alongside = profile.alongside.max(wanted);
            profile.oncoming = profile.oncoming.max(0.3 * share);
            profile.ahead = profile.ahead.max((share * 4.0).ceil() as usize);
            profile.walkers = profile.walkers.max(0.3 * share);
            if share > 0.4 {
                profile.spread = profile.spread.min(0.06);
            }
        }
        profile
    }

    fn of(
        ahead: usize,
        alongside: usize,
        lanes: [f64; 2],
        spread: f64,
        oncoming: f64,
        oncoming_left_m: f64,
        oncoming_mps: f64,
        crossing: f64,
        walkers: f64,
    ) -> Self {
        Self {
            ahead,
            alongside,
            lanes,
            spread,
            oncoming,
            oncoming_left_m,
            oncoming_mps,
            crossing,
            walkers,
        }
    }
}

/// All road users around the car, moved on from time to time.
#[derive(Debug)]
pub(crate) struct Traffic<'a> {
    path: &'a Path,
    motion: &'a [TrueMotion],
    profile: Profile,
    random: Random,
    time_s: f64,
    tracks: u32,
    pub(crate) movers: Vec<Mover>,
    crowded: bool,
}

/// Beyond this distance along the road nobody is simulated, m.
const HORIZON_M: f64 = 115.0;

impl<'a> Traffic<'a> {
    pub(crate) fn new(
        path: &'a Path,
        motion: &'a [TrueMotion],
        scenario: Scenario,
        moving_share: Option<f64>,
        random: Random,
    ) -> Self {
        let profile = Profile::new(scenario, moving_share);
        let crowded = profile.alongside > 6;
        let mut traffic =
            Self { path, motion, profile, random, time_s: 0.0, tracks: 0, movers: vec![], crowded };
        traffic.fill(true);
        traffic
    }

    /// Everyone at a time, which must not lie before the last.
    pub(crate) fn advance(&mut self, time_s: f64) {
        while self.time_s < time_s {
            let step = (time_s - self.time_s).min(0.05);
            self.step(step);
        }
    }

    fn step(&mut self, step_s: f64) {
        self.time_s += step_s;
        let car = motion_at(self.motion, self.time_s);
        let places: Vec<(f64, f64)> = self.movers.iter().filter_map(Mover::lane).collect();
        for i in 0..self.movers.len() {
            let mut mover = self.movers[i];
            self.shift(&mut mover, &car, &places, step_s);
            self.movers[i] = mover;
        }
        let now = self.time_s;
        self.movers.retain(|m| m.remains(&car, now));
        self.spawn(&car, step_s);
        self.fill(false);
    }

    fn shift(&mut self, mover: &mut Mover, car: &TrueMotion, places: &[(f64, f64)], step_s: f64) {
        let car_mps = car.speed_mps.abs();
        match &mut mover.course {
            Course::Ahead { lead_s, gap_m } => {
                let then = motion_at(self.motion, self.time_s + *lead_s);
                mover.speed_mps = then.speed_mps.abs();
                mover.pose = self.path.at(then.travelled_m + *gap_m, 0.0);
            }
            Course::Alongside { along_m, left_m, pace, mean } => {
                *pace += (*mean - *pace) * step_s / 8.0
                    + self.profile.spread * 0.25 * step_s.sqrt() * self.random.normal();
                let mut speed = car_mps * pace.max(0.0);
                // Nobody drives into the one ahead.
                let room = places
                    .iter()
                    .filter(|(a, l)| (l - *left_m).abs() < 1.0 && *a > *along_m + 0.01)
                    .fold(f64::INFINITY, |room, (a, _)| room.min(a - *along_m));
                if room < 7.5 {
                    speed *= 0.9;
                    *mean = (*mean * 0.98).max(0.7);
                }
                // Nor jumps to a speed.
                let most = 3.5 * step_s;
                mover.speed_mps += (speed - mover.speed_mps).clamp(-most, most);
                *along_m += mover.speed_mps * step_s;
                mover.pose = self.path.at(*along_m, *left_m);
            }
            Course::Own { along_m, left_m, speed_mps } => {
                *along_m += *speed_mps * step_s;
                mover.pose = self.path.at(*along_m, *left_m);
                if *speed_mps < 0.0 {
                    mover.pose.yaw_rad += PI;
                }
                mover.speed_mps = speed_mps.abs();
            }
            Course::Across { speed_mps } => {
                let (sin, cos) = libm::sincos(mover.pose.yaw_rad);
                mover.pose.x_m += *speed_mps * step_s * cos;
                mover.pose.y_m += *speed_mps * step_s * sin;
                mover.speed_mps = *speed_mps;
            }
        }
    }

    /// Those who come by themselves.
    fn spawn(&mut self, car: &TrueMotion, step_s: f64) {
        let profile = self.profile;
        let random = &mut self.random;
        let mut chance = |rate: f64| random.unit() < rate * step_s;
        let (oncoming, crossing) = (chance(profile.oncoming), chance(profile.crossing));
        let walker = chance(profile.walkers);
        if oncoming {
            let speed_mps = -profile.oncoming_mps * self.random.uniform(0.7, 1.15);
            let left_m = profile.oncoming_left_m
                + if profile.oncoming_left_m > 10.0 {
                    3.6 * sign(&mut self.random).max(0.0)
                } else {
                    0.0
                };
            let along_m = car.travelled_m + HORIZON_M - 5.0;
            self.add(None, Course::Own { along_m, left_m, speed_mps });
        }
        if crossing {
            let ahead =
                if car.speed_mps.abs() < 0.5 { 14.0 } else { 25.0 + 3.0 * car.speed_mps.abs() };
            let at = car.travelled_m + ahead + 6.0 * self.random.unit();
            let side = sign(&mut self.random);
            let speed_mps = self.random.uniform(5.0, 12.0);
            let mut pose = self.path.at(at, side * 45.0);
            pose.yaw_rad -= side * FRAC_PI_2;
            self.add(Some(pose), Course::Across { speed_mps });
        }
        if walker {
            let at = car.travelled_m + self.random.uniform(15.0, 70.0);
            let side = sign(&mut self.random);
            let class = if self.random.unit() < 0.7 { PEDESTRIAN } else { BICYCLE };
            let speed = if class == PEDESTRIAN { 0.9 } else { 3.5 } * self.random.uniform(0.8, 1.7);
            let left_m = if side > 0.0 {
                self.random.uniform(6.0, 9.0)
            } else {
                -self.random.uniform(2.6, 6.0)
            };
            if class == PEDESTRIAN && self.random.unit() < 0.25 {
                let mut pose = self.path.at(at + 15.0, left_m);
                pose.yaw_rad -= side * FRAC_PI_2;
                self.add(Some(pose), Course::Across { speed_mps: speed });
            } else {
                let speed_mps = speed * sign(&mut self.random);
                self.add(None, Course::Own { along_m: at, left_m, speed_mps });
            }
            if let Some(last) = self.movers.last_mut() {
                last.class = class;
                (last.length_m, last.width_m) =
                    if class == PEDESTRIAN { (0.4, 0.5) } else { (1.7, 0.5) };
            }
        }
    }

    /// Keeps the numbers ahead and alongside.
    fn fill(&mut self, first: bool) {
        let car = motion_at(self.motion, self.time_s);
        let ahead = self.movers.iter().filter(|m| matches!(m.course, Course::Ahead { .. })).count();
        let beside =
            self.movers.iter().filter(|m| matches!(m.course, Course::Alongside { .. })).count();
        // A queue closes up at once, a free road stays free for a while.
        let soon = first || self.crowded || self.random.unit() < 0.004;
        if ahead < self.profile.ahead && soon {
            let lead_s = if first && ahead == 0 { 1.2 } else { self.random.uniform(0.9, 1.8) };
            let (lead_s, gap_m) = self
                .movers
                .iter()
                .filter_map(|m| match m.course {
                    Course::Ahead { lead_s, gap_m } => Some((lead_s, gap_m)),
                    _ => None,
                })
                .fold((lead_s, 9.5_f64), |(l, g), (lead, gap)| {
                    (l.max(lead + 0.9), g.max(gap + 7.5))
                });
            self.add(None, Course::Ahead { lead_s, gap_m });
        }
        if beside < self.profile.alongside && (soon || self.random.unit() < 0.02) {
            let lanes = self.profile.lanes;
            let mut left_m = lanes[usize::from(self.random.unit() < 0.5)];
            if self.crowded {
                left_m = match self.random.integer(0, 7) {
                    0 => 2.0 * lanes[1],
                    1 => 0.0,
                    _ => left_m,
                };
            }
            let reach = if self.crowded { 45.0 } else { HORIZON_M - 10.0 };
            let mean = 1.0 + self.profile.spread * self.random.normal();
            let mut along = match (first || self.crowded, mean > 1.0) {
                (true, _) => self.random.uniform(-0.6 * reach, reach),
                (false, true) => -reach,
                (false, false) => reach,
            };
            if left_m == 0.0 {
                along = -self.random.uniform(9.0, 40.0);
            }
            // Nobody appears beside the car once it is under way.
            if !first && self.crowded && along.abs() < 22.0 {
                along = if along < 0.0 { along - 22.0 } else { along + 22.0 };
            }
            let along_m = car.travelled_m + along;
            let near = |m: &Mover| {
                m.lane().is_some_and(|(a, l)| (l - left_m).abs() < 1.0 && (a - along_m).abs() < 8.0)
            };
            if !self.movers.iter().any(near) {
                self.add(None, Course::Alongside { along_m, left_m, pace: mean, mean });
                if let Some(last) = self.movers.last_mut() {
                    last.speed_mps = car.speed_mps.abs() * mean;
                }
            }
        }
    }

    fn add(&mut self, pose: Option<Pose>, course: Course) {
        self.tracks += 1;
        let truck = self.random.unit() < 0.15;
        let (class, length_m, width_m) = if truck {
            (TRUCK, self.random.uniform(7.0, 12.0), 2.5)
        } else {
            (CAR, self.random.uniform(3.8, 5.0), self.random.uniform(1.7, 1.9))
        };
        // In queues nobody is longer than the gaps.
        let (class, length_m) = if self.crowded && truck { (CAR, 5.5) } else { (class, length_m) };
        let pose = pose.unwrap_or(match course {
            Course::Alongside { along_m, left_m, .. } | Course::Own { along_m, left_m, .. } => {
                self.path.at(along_m, left_m)
            }
            Course::Ahead { lead_s, gap_m } => {
                self.path.at(motion_at(self.motion, self.time_s + lead_s).travelled_m + gap_m, 0.0)
            }
            Course::Across { .. } => self.path.at(0.0, 0.0),
        });
        let until_s = self.time_s + self.random.uniform(15.0, 80.0);
        let track = self.tracks;
        let mover =
            Mover { track, class, length_m, width_m, pose, speed_mps: 0.0, course, until_s };
        self.movers.push(mover);
    }
}

impl Mover {
    /// Distance along and left of the path, of those who keep a lane of it.
    fn lane(&self) -> Option<(f64, f64)> {
        match self.course {
            Course::Alongside { along_m, left_m, .. } => Some((along_m, left_m)),
            _ => None,
        }
    }

    fn remains(&self, car: &TrueMotion, now_s: f64) -> bool {
        let (dx, dy) = (self.pose.x_m - car.pose.x_m, self.pose.y_m - car.pose.y_m);
        let distance = (dx * dx + dy * dy).sqrt();
        // Someone whose course cuts through the car is no longer there.
        let (sin, cos) = libm::sincos(car.pose.yaw_rad);
        let (forward, left) = (dx * cos + dy * sin, dy * cos - dx * sin);
        let reach = 0.5 * self.length_m;
        let inside = forward > -1.2 - reach
            && forward < 4.0 + reach
            && left.abs() < 1.0 + 0.5 * self.width_m;
        distance < HORIZON_M + 15.0
            && !inside
            && match self.course {
                Course::Ahead { .. } => now_s < self.until_s,
                Course::Alongside { along_m, .. } => (along_m - car.travelled_m).abs() < HORIZON_M,
                Course::Own { along_m, speed_mps, .. } => {
                    speed_mps > 0.0 || along_m > car.travelled_m - HORIZON_M
                }
                Course::Across { .. } => now_s < self.until_s,
            }
    }

    /// Corners, m, on the ground.
    pub(crate) fn corners(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = libm::sincos(self.pose.yaw_rad);
        [(0.5, 0.5), (0.5, -0.5), (-0.5, -0.5), (-0.5, 0.5)].map(|(a, b)| {
            let (along, left) = (a * self.length_m, b * self.width_m);
            [self.pose.x_m + along * cos - left * sin, self.pose.y_m + along * sin + left * cos]
        })
    }

    /// Velocity on the ground, m/s.
    pub(crate) fn velocity(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.pose.yaw_rad);
        [self.speed_mps * cos, self.speed_mps * sin]
    }

    /// Whether it walks or cycles.
    pub(crate) fn vulnerable(&self) -> bool {
        matches!(self.class, BICYCLE | PEDESTRIAN)
    }
}
