//! What the car's own sensors report.

use super::motion::{MOTION_STEP_S, TrueMotion};
use super::options::DriveOptions;
use super::profile::YawRateSensor;
use super::realistic::{CarErrors, model};
use boresight_core::Random;
use boresight_core::drive::MotionSample;
use boresight_options::Described;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_pass_follows_a_ramp_its_time_constant_behind() {
        for lag_s in [0.05, 0.016] {
            let mut low_pass = LowPass::new(lag_s);
            let mut last = 0.0;
            for i in 0..400 {
                last = low_pass.next(MOTION_STEP_S * f64::from(i));
            }
            // Sampled, it lags by its share's own: `step (1 / share - 1)`, within a step of the constant.
            let behind = MOTION_STEP_S * 399.0 - last;
            assert!((behind - lag_s).abs() < 0.6 * MOTION_STEP_S, "{behind} {lag_s}");
        }
        let mut open = LowPass::new(0.0);
        assert_eq!([open.next(1.0), open.next(-3.0)], [1.0, -3.0]);
    }

    #[test]
    fn sensors_of_yaw_rate_are_what_they_are_called() {
        let drawn = |sensor, seed| {
            let options = DriveOptions { yaw_rate_sensor: sensor, ..DriveOptions::default() };
            YawRateErrors::new(&options, &mut Random::new(seed, 0))
        };
        let navigation = |seed| drawn(Some(YawRateSensor::Navigation), seed);
        let squares = |of: fn(YawRateErrors) -> f64| {
            ((0..1000).map(|seed| of(navigation(seed)).powi(2)).sum::<f64>() / 1000.0).sqrt()
        };
        // A deviation by 1000 values is good to 2.2 %.
        let scale = squares(|errors| errors.scale - 1.0) / model::NAVIGATION_SCALE_SIGMA;
        let bias = squares(|errors| errors.bias_radps) / model::NAVIGATION_BIAS_RADPS;
        assert!((scale - 1.0).abs() < 0.11 && (bias - 1.0).abs() < 0.11, "{scale} {bias}");
        assert_eq!(drawn(Some(YawRateSensor::Series), 3), drawn(None, 3));
    }

    #[test]
    fn the_bias_of_a_series_sensor_walks_by_a_fiftieth_of_a_degree_in_a_minute() {
        let motion = TrueMotion {
            time_s: 0.0,
            pose: boresight_core::Pose { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0 },
            speed_mps: 0.0,
            yaw_rate_radps: 0.0,
            acceleration_mps2: 0.0,
            slip_rad: 0.0,
            travelled_m: 0.0,
        };
        let standing = vec![motion; 6001];
        let walked = |sensor| {
            let options = DriveOptions { yaw_rate_sensor: sensor, ..DriveOptions::default() };
            let car = CarErrors::clean(&options);
            let errors = YawRateErrors { scale: 1.0, bias_radps: 0.0, sigma_radps: 0.0 };
            let squares = (0..400).map(|seed| {
                let random = &mut Random::new(seed, 0);
                let samples = measure(&standing, &errors, &car, &options, random);
                samples[6000].yaw_rate_radps.to_degrees().powi(2)
            });
            (squares.sum::<f64>() / 400.0).sqrt()
        };
        // A deviation by 400 values is good to 3.5 %.
        assert!((walked(Some(YawRateSensor::Series)) / 0.02 - 1.0).abs() < 0.18);
        assert_eq!(walked(None), 0.0);
    }
}
