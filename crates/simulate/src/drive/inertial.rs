//! What the car's own sensors report.

use super::motion::{MOTION_STEP_S, TrueMotion};
use super::options::DriveOptions;
use super::profile::YawRateSensor;
use super::realistic::{CarErrors, model};
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
        let (scale, bias, sigma) = match options.yaw_rate_sensor() {
            Some(YawRateSensor::Navigation) => (
                1.0 + model::NAVIGATION_SCALE_SIGMA * random.normal(),
                model::NAVIGATION_BIAS_RADPS * random.normal(),
                model::NAVIGATION_SIGMA_RADPS,
            ),
            Some(YawRateSensor::Series) | None => (scale, bias, sigma),
        };
        Self {
            scale: options.yaw_rate_scale.unwrap_or(scale),
            bias_radps: options.yaw_rate_bias_radps.unwrap_or(bias),
            sigma_radps: options.yaw_rate_sigma_radps.unwrap_or(sigma),
        }
    }
}

/// Yaw rate with scale, bias and white noise, speed with scale and white noise but zero at
/// standstill, and the true pose. Both lag behind the truth by what `car` says; the bias of a series
/// sensor that was asked for walks.
pub(crate) fn measure(
    truth: &[TrueMotion],
    errors: &YawRateErrors,
    car: &CarErrors,
    options: &DriveOptions,
    random: &mut Random,
) -> Vec<MotionSample> {
    let walk = match options.yaw_rate_sensor() {
        Some(YawRateSensor::Series) => model::SERIES_WALK * MOTION_STEP_S.sqrt(),
        _ => 0.0,
    };
    let mut bias = errors.bias_radps;
    let mut yaw_rate = LowPass::new(car.yaw_rate_lag_s);
    let mut lagging_speed = LowPass::new(car.speed_lag_s);
    truth
        .iter()
        .map(|true_motion| {
            let yaw_rate_noise = errors.sigma_radps * random.normal();
            let speed_noise = car.speed_sigma_mps * random.normal();
            let yaw_rate = yaw_rate.next(true_motion.yaw_rate_radps);
            let speed = lagging_speed.next(true_motion.speed_mps);
            if walk > 0.0 {
                bias += walk * random.normal();
            }
            MotionSample {
                time_s: true_motion.time_s,
                yaw_rate_radps: errors.scale * yaw_rate + bias + yaw_rate_noise,
                speed_mps: Some(if true_motion.speed_mps == 0.0 {
                    0.0
                } else {
                    car.speed_scale * speed + speed_noise
                }),
                pose: Some(true_motion.pose),
            }
        })
        .collect()
}

/// A low-pass of first order over samples of the car's motion; without a time constant it passes
/// everything as it is.
struct LowPass {
    share: f64,
    state: Option<f64>,
}

impl LowPass {
    fn new(lag_s: f64) -> Self {
        let share = if lag_s > 0.0 { 1.0 - libm::exp(-MOTION_STEP_S / lag_s) } else { 1.0 };
        Self { share, state: None }
    }

    fn next(&mut self, value: f64) -> f64 {
        let next = match self.state {
            Some(state) if self.share < 1.0 => state + self.share * (value - state),
            _ => value,
        };
        self.state = Some(next);
        next
    }
}
