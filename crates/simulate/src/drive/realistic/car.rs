//! What a car and a drive are like: drawn once.

use super::model;
use crate::drive::options::DriveOptions;
use boresight_core::Random;
use boresight_options::Described;
use serde::Serialize;

/// How a car moves and measures, beside its yaw rate.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct CarErrors {
    /// Slip angle of the rear axle over lateral acceleration, outwards, rad/(m/s^2); outside Rust in
    /// degrees.
    pub slip_gradient_rad: f64,
    /// Direction of the rear axle's way straight ahead, to the left of the car's x.
    pub crab_rad: f64,
    /// By how much range rates lag their time stamp.
    pub delay_s: f64,
    /// Measured over true speed.
    pub speed_scale: f64,
    /// Standard deviation of a sample of speed.
    pub speed_sigma_mps: f64,
    /// Lag of the measured speed.
    pub speed_lag_s: f64,
    /// Lag of the measured yaw rate.
    pub yaw_rate_lag_s: f64,
}

impl CarErrors {
    /// A car without errors but those of the options.
    pub(crate) fn clean(options: &DriveOptions) -> Self {
        Self {
            slip_gradient_rad: options.slip_gradient_rad.unwrap_or(0.0),
            crab_rad: 0.0,
            delay_s: 0.5 * options.noise.coherent_interval_s,
            speed_scale: options.speed_scale.unwrap_or(1.0),
            speed_sigma_mps: options.speed_sigma_mps.unwrap_or(0.03),
            speed_lag_s: 0.0,
            yaw_rate_lag_s: 0.0,
        }
    }

    /// One as the profile has it: `car` draws what stays from drive to drive, `drive` the rest.
    pub(crate) fn drawn(options: &DriveOptions, car: &mut Random, drive: &mut Random) -> Self {
        let [mean, sigma] = model::SLIP_GRADIENT_RAD;
        let of_car = mean + sigma * car.normal();
        let slip_gradient = of_car * (1.0 + model::SLIP_SPREAD * drive.normal());
        let crab_rad = model::CRAB_SIGMA_RAD * drive.normal();
        let delay_s = drive.uniform(model::DELAY_S[0], model::DELAY_S[1]);
        let speed_scale = 1.0 + model::SPEED_SCALE_SIGMA * drive.normal();
        Self {
            slip_gradient_rad: options.slip_gradient_rad.unwrap_or(slip_gradient),
            crab_rad,
            delay_s,
            speed_scale: options.speed_scale.unwrap_or(speed_scale),
            speed_sigma_mps: options.speed_sigma_mps.unwrap_or(model::SPEED_SIGMA_MPS),
            speed_lag_s: model::SPEED_LAG_S,
            yaw_rate_lag_s: model::YAW_RATE_LAG_S,
        }
    }
}
