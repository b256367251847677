//! Frames of a car on a winding road, by the closed form alone.

pub mod clean;

use boresight_core::{Detection, Random};
pub use clean::without_real_errors;
use std::f64::consts::TAU;

pub struct Drive {
    pub seed: u64,
    pub angle_rad: f64,
    pub x_m: f64,
    pub y_m: f64,
    /// Mean speed; it swings by half of it, and the car stands for the first five seconds.
    pub speed_mps: f64,
    /// Amplitude of the yaw rate.
    pub yaw_rate_radps: f64,
    /// Speed and yaw rate do not change.
    pub constant: bool,
    pub scale: f64,
    pub bias_radps: f64,
    /// Multiple of 0.1 m/s, 0.5 deg and 0.1 deg/s.
    pub noise: f64,
    /// Share of detections with a range rate of their own.
    pub moving: f64,
    pub detections: usize,
    pub duration_s: f64,
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            seed: 1,
            angle_rad: 0.436,
            x_m: 3.86,
            y_m: 0.7,
            speed_mps: 10.0,
            yaw_rate_radps: 0.3,
            constant: false,
            scale: 1.0,
            bias_radps: 0.0,
            noise: 1.0,
            moving: 0.2,
            detections: 60,
            duration_s: 60.0,
        }
    }
}

pub struct Frame {
    pub time_s: f64,
    pub detections: Vec<Detection>,
    pub yaw_rate_radps: f64,
}

pub fn detection(azimuth_rad: f32, range_rate_mps: f32) -> Detection {
    Detection { azimuth_rad, range_rate_mps, range_m: f32::NAN, rcs_dbsm: f32::NAN }
}

impl Drive {
    pub fn frames(&self) -> impl Iterator<Item = Frame> + '_ {
        let mut random = Random::new(self.seed, 7);
        let count = (self.duration_s / 0.074) as usize;
        (0..count).map(move |index| {
            let time_s = 0.074 * index as f64;
            let (speed, rate) = if self.constant {
                (self.speed_mps, self.yaw_rate_radps)
            } else {
                let start = ((time_s - 5.0) / 5.0).clamp(0.0, 1.0);
                let swing = 1.0 + 0.5 * (TAU * time_s / 23.0).sin();
                let turn = (TAU * time_s / 17.0).sin() * if start > 0.0 { 1.0 } else { 0.0 };
                (self.speed_mps * start * swing, self.yaw_rate_radps * turn * start)
            };
            let along = speed - rate * self.y_m;
            let across = rate * self.x_m;
            let detections = (0..self.detections)
                .map(|_| {
                    let azimuth = random.uniform(-1.0, 1.0);
                    let direction = azimuth + self.angle_rad;
                    let moving = random.unit() < self.moving;
                    let own = if moving { random.uniform(-15.0, 15.0) } else { 0.0 };
                    let closing = along * direction.cos() + across * direction.sin() + own;
                    detection(
                        (azimuth + self.noise * 0.0087 * random.normal()) as f32,
                        (-closing + self.noise * 0.1 * random.normal()) as f32,
                    )
                })
                .collect();
            let noise = self.noise * 0.0017 * random.normal();
            Frame {
                time_s,
                detections,
                yaw_rate_radps: self.scale * rate + self.bias_radps + noise,
            }
        })
    }
}
