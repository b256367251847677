//! Ghosts: clusters of detections labelled static that move otherwise, and live for seconds.

use super::model;
use crate::drive::motion::TrueMotion;
use crate::drive::radar::{Radar, STATIC_CLASS};
use crate::drive::scenario::sign;
use crate::drive::traffic::Traffic;
use crate::drive::view::{Echo, RANGE_M, View};
use boresight_core::Random;
use std::f64::consts::PI;

/// What a ghost comes from.
#[derive(Debug, Clone, Copy)]
enum Course {
    /// Something that moves straight on: a mirror image, or a mover that nobody labelled.
    Body { x_m: f64, y_m: f64, velocity_mps: [f64; 2] },
    /// A wave that goes to and fro twice between the car and something in front: at twice the range
    /// and the range rate of that.
    DoubleBounce { x_m: f64, y_m: f64, velocity_mps: [f64; 2] },
    /// The own car: stays where it is, with hardly any range rate.
    OwnCar { range_m: f64, azimuth_rad: f64 },
}

#[derive(Debug, Clone, Copy)]
struct Ghost {
    course: Course,
    /// Mean detections a scan.
    detections: f64,
    since_s: f64,
    until_s: f64,
}

/// The ghosts one radar sees.
#[derive(Debug, Clone)]
pub(crate) struct Ghosts {
    ghosts: Vec<Ghost>,
    /// Mean detections of all ghosts a scan.
    wanted: f64,
    time_s: f64,
}

/// A detection of a ghost before errors of measurement.
pub(crate) struct GhostEcho {
    pub(crate) range_m: f64,
    pub(crate) azimuth_rad: f64,
    pub(crate) range_rate_mps: f64,
}

impl Ghosts {
    /// Ghosts that give `wanted` detections a scan on average.
    pub(crate) fn new(wanted: f64) -> Self {
        Self { ghosts: vec![], wanted, time_s: 0.0 }
    }

    /// Their detections a scan on average.
    pub(crate) fn wanted(&self) -> f64 {
        self.wanted
    }

    /// Moves on to a time, and gives what the radar then sees of them.
    pub(crate) fn advance(
        &mut self,
        radar: &Radar,
        view: &View,
        motion: &TrueMotion,
        traffic: &Traffic,
        time_s: f64,
        random: &mut Random,
    ) -> Vec<GhostEcho> {
        self.ghosts.retain(|ghost| time_s < ghost.until_s && ghost.seen(view, time_s));
        let [fewest, most] = model::GHOST_DETECTIONS;
        let [shortest, longest] = model::GHOST_LIFE_S;
        // What leaves the view is made up for, so that the mean is what is wanted: births at the rate
        // (1.5 wanted - present) / 1 s balance deaths after 2 s where present is wanted.
        let present: f64 = self.ghosts.iter().map(|ghost| ghost.detections).sum();
        let lacking = (1.5 * self.wanted - present).max(0.0);
        let interval_s = (time_s - self.time_s).clamp(0.0, 1.0);
        let born = poisson(lacking * interval_s * 2.0 / (fewest + most), random);
        self.time_s = time_s;
        for _ in 0..born {
            let mut course = birth(view, motion, traffic, random);
            for _ in 0..BIRTHS {
                if course.seen(view, 0.0) {
                    break;
                }
                course = birth(view, motion, traffic, random);
            }
            self.ghosts.push(Ghost {
                course,
                detections: random.uniform(fewest, most),
                since_s: time_s,
                until_s: time_s + random.uniform(shortest, longest),
            });
        }
        let mut echoes = vec![];
        for ghost in &self.ghosts {
            for _ in 0..poisson(ghost.detections, random) {
                echoes.extend(ghost.echo(radar, view, motion, time_s, random));
            }
        }
        echoes
    }
}

/// Ghosts drawn at most until one is in view.
const BIRTHS: usize = 8;

impl Course {
    /// Whether it is in view after an age.
    fn seen(&self, view: &View, age_s: f64) -> bool {
        match *self {
            Self::Body { x_m, y_m, velocity_mps: [vx, vy] } => {
                let (range_m, azimuth_rad) = view.polar(x_m + age_s * vx, y_m + age_s * vy);
                view.holds(range_m, azimuth_rad)
            }
            Self::DoubleBounce { x_m, y_m, .. } => {
                let (range_m, azimuth_rad) = view.polar(x_m, y_m);
                view.holds(2.0 * range_m, azimuth_rad)
            }
            Self::OwnCar { .. } => true,
        }
    }
}

/// A ghost around the radar.
fn birth(view: &View, motion: &TrueMotion, traffic: &Traffic, random: &mut Random) -> Course {
    let [own_car, mirror, bounce] = model::GHOST_KINDS;
    let draw = random.unit();
    let azimuth_rad = model::FIELD_OF_VIEW_RAD * random.uniform(-1.0, 1.0);
    if draw < own_car {
        return Course::OwnCar { range_m: random.uniform(0.6, 12.0), azimuth_rad };
    }
    let (sin, cos) = libm::sincos(azimuth_rad);
    let sight = [view.cos * cos - view.sin * sin, view.sin * cos + view.cos * sin];
    let (ahead_sin, ahead_cos) = libm::sincos(motion.pose.yaw_rad);
    if draw < own_car + mirror
        && let Some(mover) = pick(traffic, view, random)
    {
        // A rail or wall along the road, beside the car.
        let offset = sign(random) * random.uniform(3.0, 10.0);
        let [vx, vy] = mover.1;
        let left_of_wall = (mover.0[1] - motion.pose.y_m) * ahead_cos
            - (mover.0[0] - motion.pose.x_m) * ahead_sin
            - offset;
        let left_mps = vy * ahead_cos - vx * ahead_sin;
        return Course::Body {
            x_m: mover.0[0] + 2.0 * left_of_wall * ahead_sin,
            y_m: mover.0[1] - 2.0 * left_of_wall * ahead_cos,
            velocity_mps: [vx + 2.0 * left_mps * ahead_sin, vy - 2.0 * left_mps * ahead_cos],
        };
    }
    let range_m = random.uniform(8.0, 60.0);
    let place = |range_m: f64| [view.x_m + range_m * sight[0], view.y_m + range_m * sight[1]];
    if draw < own_car + mirror + bounce {
        let [x_m, y_m] = place(0.5 * range_m);
        return Course::DoubleBounce { x_m, y_m, velocity_mps: [0.0; 2] };
    }
    let [x_m, y_m] = place(range_m);
    let pace = random.uniform(0.2, 1.4) * (motion.speed_mps.abs() + 3.0);
    // Along the road either way, or across it.
    let heading = motion.pose.yaw_rad
        + match random.unit() {
            u if u < 0.45 => 0.0,
            u if u < 0.8 => PI,
            _ => 0.5 * PI * sign(random),
        }
        + 0.1 * random.normal();
    let (sin, cos) = libm::sincos(heading);
    Course::Body { x_m, y_m, velocity_mps: [pace * cos, pace * sin] }
}

/// Place and velocity of a road user near the radar.
fn pick(traffic: &Traffic, view: &View, random: &mut Random) -> Option<([f64; 2], [f64; 2])> {
    let near = |pose: &boresight_core::drive::Pose| {
        let (dx, dy) = (pose.x_m - view.x_m, pose.y_m - view.y_m);
        dx * dx + dy * dy < 60.0 * 60.0
    };
    let count = traffic.movers.iter().filter(|mover| near(&mover.pose)).count();
    let chosen = random.integer(0, count.max(1) as u64 - 1) as usize;
    let mover = traffic.movers.iter().filter(|mover| near(&mover.pose)).nth(chosen)?;
    Some(([mover.pose.x_m, mover.pose.y_m], mover.velocity()))
}

impl Ghost {
    fn seen(&self, view: &View, time_s: f64) -> bool {
        self.course.seen(view, time_s - self.since_s)
    }

    fn echo(
        &self,
        radar: &Radar,
        view: &View,
        motion: &TrueMotion,
        time_s: f64,
        random: &mut Random,
    ) -> Option<GhostEcho> {
        let age_s = time_s - self.since_s;
        let mut seen = |x_m: f64, y_m: f64, velocity_mps: [f64; 2], times: f64| {
            let (range_m, azimuth_rad) = view.polar(
                x_m + age_s * velocity_mps[0] + 0.7 * random.normal(),
                y_m + age_s * velocity_mps[1] + 0.7 * random.normal(),
            );
            let echo = Echo::new(range_m, azimuth_rad, velocity_mps, STATIC_CLASS);
            GhostEcho {
                range_m: times * range_m,
                azimuth_rad,
                range_rate_mps: times * radar.range_rate(&echo, view, motion),
            }
        };
        let echo = match self.course {
            Course::Body { x_m, y_m, velocity_mps } => seen(x_m, y_m, velocity_mps, 1.0),
            Course::DoubleBounce { x_m, y_m, velocity_mps } => seen(x_m, y_m, velocity_mps, 2.0),
            Course::OwnCar { range_m, azimuth_rad } => GhostEcho {
                range_m: range_m + 0.3 * random.normal(),
                azimuth_rad: azimuth_rad + 0.05 * random.normal(),
                range_rate_mps: 0.05 * random.normal(),
            },
        };
        let seen = (RANGE_M[0]..=RANGE_M[1]).contains(&echo.range_m)
            && view.holds(echo.range_m, echo.azimuth_rad);
        seen.then_some(echo)
    }
}

/// A Poisson number by Knuth's product of uniforms; at most 1000.
pub(crate) fn poisson(mean: f64, random: &mut Random) -> usize {
    let limit = libm::exp(-mean.min(100.0));
    let mut product = random.unit();
    let mut count = 0;
    while product > limit && count < 1000 {
        product *= random.unit();
        count += 1;
    }
    count
}
