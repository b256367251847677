//! What the car's own sensors report.

use super::motion::TrueMotion;
use super::options::DriveOptions;
use boresight_core::Random;
use boresight_core::describe::Described;
use boresight_core::drive::MotionSample;
use serde::Serialize;

/// Errors of a yaw-rate sensor.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct YawRateErrors {
    /// Measured over true yaw rate.
    pub scale: f64,
    /// Yaw rate measured at standstill.
    pub bias_radps: f64,
    /// Standard deviation of a sample's white noise.
    pub sigma_radps: f64,
}

impl YawRateErrors {
    /// Those of the options, or drawn.
    pub(crate) fn new(options: &DriveOptions, random: &mut Random) -> Self {
        let scale = random.uniform(0.98, 1.02);
        let bias = random.uniform(-0.2, 0.2).to_radians();
        let sigma = random.uniform(0.07, 0.13).to_radians();
        Self {
            scale: options.yaw_rate_scale.unwrap_or(scale),
            bias_radps: options.yaw_rate_bias_radps.unwrap_or(bias),
            sigma_radps: options.yaw_rate_sigma_radps.unwrap_or(sigma),
        }
    }
}

/// Yaw rate with scale, bias and white noise, speed with scale and white noise but zero at
/// standstill, and the true pose.
pub(crate) fn measure(
    truth: &[TrueMotion],
    errors: &YawRateErrors,
    options: &DriveOptions,
    random: &mut Random,
) -> Vec<MotionSample> {
    truth
        .iter()
        .map(|true_motion| {
            let yaw_rate_noise = errors.sigma_radps * random.normal();
            let speed_noise = options.speed_sigma_mps * random.normal();
            let speed = true_motion.speed_mps;
            MotionSample {
                time_s: true_motion.time_s,
                yaw_rate_radps: errors.scale * true_motion.yaw_rate_radps
                    + errors.bias_radps
                    + yaw_rate_noise,
                speed_mps: Some(if speed == 0.0 {
                    0.0
                } else {
                    options.speed_scale * speed + speed_noise
                }),
                pose: Some(true_motion.pose),
            }
        })
        .collect()
}
