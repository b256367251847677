//! One radar frame: what goes in and what an estimator makes of it.

use boresight_core::Detection;
use boresight_options::{Described, columns};
use serde::Serialize;

/// One scan of the radar with the car's motion at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameInput<'a> {
    /// Time, s; must not run backwards from frame to frame of a session.
    pub time_s: f64,
    /// The point cloud, in the radar's frame.
    pub detections: &'a [Detection],
    /// Measured yaw rate at this time, rad/s; `None` where the log has none.
    pub yaw_rate_radps: Option<f64>,
    /// Measured forward speed of the rear axle at this time, m/s, negative in reverse. The full-velocity
    /// method needs it; to the tracked motion it tells the standing world from a queue of cars.
    pub speed_mps: Option<f64>,
}

impl FrameInput<'_> {
    /// What the frame says of the car.
    pub fn car(&self) -> CarMotion {
        CarMotion {
            time_s: self.time_s,
            yaw_rate_radps: self.yaw_rate_radps,
            speed_mps: self.speed_mps,
        }
    }
}

/// The car's measured motion at a time, as [`FrameInput`] has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarMotion {
    /// Time, s.
    pub time_s: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_radps: Option<f64>,
    /// Forward speed of the rear axle, m/s.
    pub speed_mps: Option<f64>,
}

/// The radar's own motion, from one frame.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
#[option(name = "RadarMotion")]
pub struct Motion {
    /// Velocity ahead and to the left in the radar's frame.
    #[option(typescript = "[x: number, y: number]")]
    pub velocity_mps: [f64; 2],
    /// Its covariance `[[xx, xy], [xy, yy]]`, m^2/s^2.
    #[option(typescript = "[[xx: number, xy: number], [xy: number, yy: number]]")]
    pub covariance: [[f64; 2]; 2],
    /// Detections taken as static.
    pub inliers: usize,
    /// Detections given that a sensor can have measured.
    pub detections: usize,
}

impl Motion {
    /// Speed and direction with their variances.
    pub(crate) fn polar(&self) -> Polar {
        let [vx, vy] = self.velocity_mps;
        let [[xx, xy], [_, yy]] = self.covariance;
        let squared = vx * vx + vy * vy;
        Polar {
            speed_mps: squared.sqrt(),
            speed_variance: (vx * vx * xx + 2.0 * vx * vy * xy + vy * vy * yy) / squared,
            direction_rad: vy.atan2(vx),
            direction_variance: (vy * vy * xx - 2.0 * vx * vy * xy + vx * vx * yy)
                / (squared * squared),
        }
    }

    /// Variance of the velocity, both components together, m^2/s^2.
    pub(crate) fn total_variance(&self) -> f64 {
        self.covariance[0][0] + self.covariance[1][1]
    }
}

/// A radar's motion as speed and direction in the radar's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Polar {
    pub(crate) speed_mps: f64,
    /// m^2/s^2.
    pub(crate) speed_variance: f64,
    pub(crate) direction_rad: f64,
    /// rad^2.
    pub(crate) direction_variance: f64,
}

/// What became of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[option(name = "FrameVerdict")]
pub enum Verdict {
    /// It went into the angle.
    Used,
    /// The car stood; it went into the bias of the yaw rate.
    Standing,
    /// The radar moved more slowly than the gate.
    Slow,
    /// The car turned faster than the gate.
    Turning,
    /// Too few detections or inliers for a motion, or too few frames yet for one that is smoothed over several.
    Sparse,
    /// What most detections agree on is not the car's own measured speed.
    OffSpeed,
    /// No yaw rate (or, for the full-velocity method, no speed) at this time.
    WithoutMotion,
}

/// What an estimator made of one frame.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct FrameOutcome {
    /// Time of what is told, the weights of detections aside: the frame's, or where motion is smoothed over several frames that
    /// of an earlier one.
    pub time_s: f64,
    /// What became of it.
    pub verdict: Verdict,
    /// The radar's motion, if one could be found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// The mounting angle this frame alone gives, if it gives one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_rad: Option<f64>,
    /// Its standard deviation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_sigma_rad: Option<f64>,
    /// Weight of the frame in the estimate, 1/rad^2; 0 if unused.
    pub weight: f64,
    /// For each detection the weight, 0 to 1, with which it was taken as static.
    #[serde(serialize_with = "columns::serialize")]
    pub weights: Vec<f32>,
}
