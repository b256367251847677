//! Drives for the tests: a car without side slip and the point clouds of one of its radars.
pub use crate::support::clean::without_real_errors;
use boresight_core::{Detection, Random};
use boresight_mounting::network::MotionNetwork;
use boresight_mounting::{CalibrationOptions, Calibrator, FrameInput, Method};
use std::sync::{Arc, LazyLock};

/// Both networks of motion.
pub fn network() -> Arc<MotionNetwork> {
    static NETWORK: LazyLock<Arc<MotionNetwork>> = LazyLock::new(|| {
        let bytes = include_bytes!("../../../../../tests/golden/motion/deepego-plus/weights.bin");
        Arc::new(MotionNetwork::read(bytes).unwrap())
    });
    NETWORK.clone()
}

#[derive(Debug, Clone, Copy)]
pub struct Drive {
    pub angle_rad: f64,
    pub x_m: f64,
    pub y_m: f64,
    pub scale: f64,
    pub bias_radps: f64,
    pub yaw_noise_radps: f64,
    pub range_rate_sigma_mps: f64,
    pub azimuth_sigma_rad: f64,
    pub moving: f64,
    pub detections: usize,
    pub frames: usize,
    /// Amplitude of the yaw rate's swing.
    pub turn_radps: f64,
    /// A constant part of the yaw rate.
    pub constant_turn_radps: f64,
    pub speed_mps: f64,
    /// Share by which the speed swings.
    pub speed_swing: f64,
    /// Standing frames at the beginning.
    pub standing: usize,
    pub seed: u64,
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            angle_rad: 25.0_f64.to_radians(),
            x_m: 3.86,
            y_m: 0.7,
            scale: 1.0,
            bias_radps: 0.0,
            yaw_noise_radps: 0.001,
            range_rate_sigma_mps: 0.1,
            azimuth_sigma_rad: 0.5_f64.to_radians(),
            moving: 0.2,
            detections: 60,
            frames: 600,
            turn_radps: 0.3,
            constant_turn_radps: 0.0,
            speed_mps: 10.0,
            speed_swing: 0.2,
            standing: 50,
            seed: 1,
        }
    }
}

pub fn detection(azimuth_rad: f32, range_rate_mps: f32) -> Detection {
    Detection { azimuth_rad, range_rate_mps, range_m: f32::NAN, rcs_dbsm: f32::NAN }
}

/// A point cloud of a radar that moves with `velocity`, over 120 deg.
pub fn cloud(random: &mut Random, velocity: [f64; 2], drive: &Drive) -> Vec<Detection> {
    let moving = (drive.moving * drive.detections as f64).round() as usize;
    (0..drive.detections)
        .map(|i| {
            let azimuth = random.uniform(-1.05, 1.05);
            let (sin, cos) = azimuth.sin_cos();
            let own = if i < moving { random.uniform(2.0, 20.0) } else { 0.0 };
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            Detection {
                azimuth_rad: (azimuth + drive.azimuth_sigma_rad * random.normal()) as f32,
                range_rate_mps: (-velocity[0] * cos - velocity[1] * sin
                    + sign * own
                    + drive.range_rate_sigma_mps * random.normal())
                    as f32,
                range_m: 20.0,
                rcs_dbsm: f32::NAN,
            }
        })
        .collect()
}

impl Drive {
    /// Runs frames at 13.5 Hz through a callback, with the radar's true velocity.
    pub fn run(&self, mut each: impl FnMut(FrameInput, [f64; 2])) {
        let mut random = Random::new(self.seed, 0);
        for i in 0..self.frames {
            let time = i as f64 / 13.5;
            let stands = i < self.standing;
            let speed = if stands {
                0.0
            } else {
                self.speed_mps * (1.0 + self.speed_swing * (0.1 * time).sin())
            };
            let rate = if stands {
                0.0
            } else {
                self.constant_turn_radps + self.turn_radps * (0.5 * time).sin()
            };
            let car = [speed - rate * self.y_m, rate * self.x_m];
            let (sin, cos) = self.angle_rad.sin_cos();
            let velocity = [cos * car[0] + sin * car[1], cos * car[1] - sin * car[0]];
            let cloud = cloud(&mut random, velocity, self);
            let measured =
                self.scale * rate + self.bias_radps + self.yaw_noise_radps * random.normal();
            let frame = FrameInput {
                time_s: time,
                detections: &cloud,
                yaw_rate_radps: Some(measured),
                speed_mps: Some(speed),
            };
            each(frame, velocity);
        }
    }

    pub fn options(&self, method: Method) -> CalibrationOptions {
        CalibrationOptions {
            method,
            x_m: self.x_m,
            y_m: self.y_m,
            ..without_real_errors(CalibrationOptions::default())
        }
    }

    /// A calibration that has seen the drive.
    pub fn calibrate(&self, options: CalibrationOptions) -> Calibrator {
        let mut calibrator = Calibrator::new(options).unwrap();
        self.run(|frame, _| {
            calibrator.add(frame).unwrap();
        });
        calibrator
    }
}

/// The methods that weigh all frames at once.
pub const BATCH: [Method; 4] =
    [Method::WeightedMean, Method::Kabsch, Method::LeastSquares, Method::OrthogonalDistance];
