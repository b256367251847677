//! The car's motion from all of its radars, which need not scan together. DeepEgo+ fuses them by a network (Zhu et al.
//! 2025); the filter here, the vote and their numbers are ours.
//!
//! Each radar's motion of a frame is a measurement of the car's speed and yaw rate. What the radars tell together is where
//! DeepEgo begins with the next frame, so that a radar whose view is full of traffic is held by those that see the road.
//! A motion that the others contradict is left out, and where all that comes is contradicted the radars vote anew.

mod filter;

use crate::error::MountingError;
use crate::frame::{FrameInput, Motion};
use crate::intake::{Admission, Intake};
use crate::motion::weighed::{inliers, told};
use crate::network::{MotionNetwork, Near};
use crate::options::CalibrationOptions;
use crate::plane::{turned, turned_covariance};
use crate::radars;
use boresight_core::InputError;
use filter::{Filter, Seen, Told};
use std::sync::Arc;

/// Whitened squared distance from which a motion contradicts the others: one in 3,000 by chance.
const GATE: f64 = 16.0;
/// Without a motion that fits for so long the radars vote anew, s.
const LOST_S: f64 = 0.5;
/// Motions so old still vote, s.
const RECENT_S: f64 = 0.2;
/// Radars nearer to the rear axle do not tell a yaw rate, m.
const LEAST_LEVER_M: f64 = 0.5;

/// A radar and how it is mounted on the car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mounted {
    /// Its number in the log.
    pub sensor: u8,
    /// Boresight to the left of the car's axis, rad.
    pub angle_rad: f64,
    /// Ahead of the rear axle, m.
    pub x_m: f64,
    /// To the left of the car's axis, m.
    pub y_m: f64,
}

/// What a frame was to the fusion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It is part of the motion.
    Taken,
    /// It tells no motion: too few detections, or none that agree.
    Untold,
    /// Its motion contradicts that of the others.
    Contradicted,
}

/// The car's motion at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FusedMotion {
    /// Time, s.
    pub time_s: f64,
    /// Speed of the rear axle, forward, m/s.
    pub speed_mps: f64,
    /// Velocity of the rear axle to the left, by its slip, m/s.
    pub sideways_mps: f64,
    /// Yaw rate, to the left, rad/s.
    pub yaw_rate_radps: f64,
    /// Covariance of both.
    pub covariance: [[f64; 2]; 2],
    /// What the frame was.
    pub fate: Fate,
}

/// Frames of a radar by what they were.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FusionCounts {
    /// Part of the motion.
    pub taken: u64,
    /// Without a motion.
    pub untold: u64,
    /// Contradicted by the others.
    pub contradicted: u64,
}

/// The car's motion from all of its radars, frame by frame, in constant memory.
#[derive(Debug, Clone)]
pub struct Fusion {
    network: Arc<MotionNetwork>,
    /// Slip gradient of the rear axle, rad/(m/s^2).
    slip: f64,
    radars: Vec<Radar>,
    filter: Option<Filter>,
    /// When a motion fitted last.
    fitted_s: f64,
    last_s: Option<f64>,
    intake: Intake,
}

#[derive(Debug, Clone)]
struct Radar {
    mounted: Mounted,
    /// The last motion, in the car's frame, with its time.
    last: Option<(f64, Told)>,
    counts: FusionCounts,
}

impl Fusion {
    /// From the radars of a car, the slip gradient of its rear axle (rad/(m/s^2)) and a network of motion; of DeepEgo+ the
    /// network of single frames is used, since the filter smooths over all radars.
    ///
    /// # Errors
    /// [`InputError::Empty`] without radars, [`InputError::OutOfRange`] for a number given twice
    /// and for numbers that are not finite.
    pub fn new(
        radars: &[Mounted],
        slip_gradient_rad: f64,
        network: &Arc<MotionNetwork>,
    ) -> Result<Self, MountingError> {
        radars::check_numbers(radars.iter().map(|mounted| mounted.sensor))?;
        let numbers =
            radars.iter().flat_map(|mounted| [mounted.angle_rad, mounted.x_m, mounted.y_m]);
        let mut numbers = numbers.chain([slip_gradient_rad]);
        if let Some(given) = numbers.find(|number| !number.is_finite()) {
            let (what, expected) = ("mounting".into(), "finite numbers".into());
            return Err(InputError::OutOfRange { what, expected, given }.into());
        }
        let radar =
            |&mounted: &Mounted| Radar { mounted, last: None, counts: FusionCounts::default() };
        Ok(Self {
            network: network.clone(),
            slip: slip_gradient_rad,
            radars: radars.iter().map(radar).collect(),
            filter: None,
            fitted_s: f64::NEG_INFINITY,
            last_s: None,
            intake: Intake::default(),
        })
    }

    /// Takes a frame of a radar; the car's yaw rate and speed in it are not looked at. The motion at its time, `None` before
    /// any radar told one.
    ///
    /// # Errors
    /// [`MountingError::TimeBackwards`] for a frame older than the one before, of whichever radar, and
    /// [`InputError::OutOfRange`] for a radar that was not named. The frame is then not counted.
    pub fn add(
        &mut self,
        sensor: u8,
        frame: FrameInput<'_>,
    ) -> Result<Option<FusedMotion>, MountingError> {
        let at = radars::place(self.radars.iter().map(|radar| radar.mounted.sensor), sensor)?;
        if self.intake.admit(self.last_s, frame.time_s)? == Admission::NewSession {
            self.restart();
        }
        self.last_s = Some(frame.time_s);
        let screened = self.intake.screen(frame.detections);
        let frame = FrameInput { detections: &screened.detections, ..frame };
        if let Some(filter) = &mut self.filter {
            filter.advance(frame.time_s);
        }
        let near =
            self.filter.as_ref().map(|filter| self.radars[at].mounted.near(filter, self.slip));
        let alone = self.network.single().motion_near(frame.detections, near);
        let options = CalibrationOptions::default();
        let inliers = inliers(&alone.weights, &options);
        let (velocity, covariance) = (alone.velocity_mps, alone.covariance);
        let motion = told(velocity, covariance, inliers, frame.detections.len(), &options);
        let told = motion.map(|motion| self.radars[at].mounted.told(&motion));
        let fate = match told {
            None => Fate::Untold,
            Some(told) => self.take(at, frame.time_s, told),
        };
        let counts = &mut self.radars[at].counts;
        *match fate {
            Fate::Taken => &mut counts.taken,
            Fate::Untold => &mut counts.untold,
            Fate::Contradicted => &mut counts.contradicted,
        } += 1;
        Ok(self.filter.as_ref().map(|filter| FusedMotion {
            time_s: frame.time_s,
            speed_mps: filter.speed_mps(),
            sideways_mps: -self.slip * filter.speed_mps().powi(2) * filter.yaw_rate_radps(),
            yaw_rate_radps: filter.yaw_rate_radps(),
            covariance: filter.covariance(),
            fate,
        }))
    }

    /// Starts a session on a clock that need not continue the one before: the radars vote again.
    pub fn restart(&mut self) {
        self.intake.restart();
        (self.filter, self.last_s, self.fitted_s) = (None, None, f64::NEG_INFINITY);
        for radar in &mut self.radars {
            radar.last = None;
        }
    }

    /// What became of each radar's frames.
    pub fn counts(&self) -> impl Iterator<Item = (u8, FusionCounts)> {
        self.radars.iter().map(|radar| (radar.mounted.sensor, radar.counts))
    }

    fn take(&mut self, at: usize, time_s: f64, told: Told) -> Fate {
        self.radars[at].last = Some((time_s, told));
        if let Some(filter) = &mut self.filter {
            let seen = self.radars[at].mounted.seen(filter, self.slip);
            if filter.distance(at, &seen, told) < GATE {
                filter.take(at, &seen, told);
                self.fitted_s = time_s;
                return Fate::Taken;
            }
        }
        let recent: Vec<(usize, Told)> = self
            .radars
            .iter()
            .enumerate()
            .filter_map(|(at, radar)| {
                let (told_s, told) = radar.last?;
                (time_s - told_s <= RECENT_S).then_some((at, told))
            })
            .collect();
        let agreeing = self.filter.as_ref().map_or(0, |filter| {
            let fits = |&(at, told): &(usize, Told)| {
                let seen = self.radars[at].mounted.seen(filter, self.slip);
                filter.distance(at, &seen, told) < GATE
            };
            recent.iter().filter(|one| fits(one)).count()
        });
        let lost = time_s - self.fitted_s > LOST_S;
        match self.vote(time_s, &recent) {
            Some((filter, voters))
                if voters.contains(&at) && (lost || voters.len() > agreeing.max(1)) =>
            {
                self.filter = Some(filter);
                self.fitted_s = time_s;
                Fate::Taken
            }
            _ => Fate::Contradicted,
        }
    }

    /// The motion that most radars agree on, of those that each of them tells, and who they are.
    fn vote(&self, time_s: f64, recent: &[(usize, Told)]) -> Option<(Filter, Vec<usize>)> {
        let mut best: Option<(Filter, Vec<usize>)> = None;
        for &(candidate, told) in recent {
            let Some((speed, yaw)) = self.radars[candidate].mounted.motion_of(told, self.slip)
            else {
                continue;
            };
            let mut filter = Filter::new(self.radars.len(), time_s, speed, yaw);
            let mut voters = vec![];
            let others = recent.iter().filter(|(at, _)| *at != candidate);
            for &(at, told) in std::iter::once(&(candidate, told)).chain(others) {
                let seen = self.radars[at].mounted.seen(&filter, self.slip);
                if filter.distance(at, &seen, told) < GATE {
                    filter.take(at, &seen, told);
                    voters.push(at);
                }
            }
            let doubt = |filter: &Filter| filter.covariance()[0][0];
            let better = best.as_ref().is_none_or(|(other, supporters)| {
                voters.len() > supporters.len()
                    || (voters.len() == supporters.len() && doubt(&filter) < doubt(other))
            });
            if better {
                best = Some((filter, voters));
            }
        }
        best
    }
}

impl Mounted {
    /// The radar's velocity in the car's frame with a motion of the car, and how it changes with it.
    fn seen(&self, filter: &Filter, slip: f64) -> Seen {
        let (speed, yaw) = (filter.speed_mps(), filter.yaw_rate_radps());
        let lever = self.lever(speed, slip);
        Seen {
            velocity: [speed - yaw * self.y_m, yaw * lever],
            by_motion: [[1.0, -self.y_m], [-2.0 * slip * speed * yaw, lever]],
        }
    }

    /// How far the radar is ahead of what does not move sideways when the car turns, m.
    fn lever(&self, speed: f64, slip: f64) -> f64 {
        self.x_m - slip * speed * speed
    }

    /// The radar's motion in the car's frame.
    fn told(&self, motion: &Motion) -> Told {
        let (sin, cos) = self.angle_rad.sin_cos();
        let [[xx, xy], [_, yy]] = motion.covariance;
        let [xx, xy, yy] = turned_covariance([xx, xy, yy], [cos, -sin]);
        Told {
            velocity: turned(motion.velocity_mps, [cos, -sin]),
            covariance: [[xx, xy], [xy, yy]],
        }
    }

    /// Speed and yaw rate that a radar's motion alone tells; `None` where the radar is too near to the axle.
    fn motion_of(&self, told: Told, slip: f64) -> Option<(f64, f64)> {
        let [ux, uy] = told.velocity;
        // Slip moves the lever by little: the speed along will do.
        let lever = self.lever(ux, slip);
        (lever.abs() >= LEAST_LEVER_M).then(|| {
            let yaw = uy / lever;
            (ux + yaw * self.y_m, yaw)
        })
    }

    /// Where the radar's motion is expected, in its own frame.
    fn near(&self, filter: &Filter, slip: f64) -> Near {
        let Seen { velocity, by_motion } = self.seen(filter, slip);
        let (sin, cos) = self.angle_rad.sin_cos();
        let p = filter.covariance();
        let variance: f64 = by_motion
            .iter()
            .map(|[a, b]| a * a * p[0][0] + 2.0 * a * b * p[0][1] + b * b * p[1][1])
            .sum();
        Near { velocity_mps: turned(velocity, [cos, sin]), sigma_mps: variance.sqrt() }
    }
}
