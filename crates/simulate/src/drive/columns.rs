//! The truth behind a drive as columns of numbers, which cost a program in another language little.

use super::{CarErrors, SimulatedDrive, YawRateErrors};
use boresight_core::drive::Mounting;
use boresight_options::{Described, Flat, columns};
use serde::Serialize;

/// What really happened in a simulated drive.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "DriveTruth")]
pub struct TruthColumns {
    /// The radars where they truly sit and look.
    pub sensors: Vec<TrueSensor>,
    /// Errors of the yaw-rate sensor.
    pub yaw_rate: YawRateErrors,
    /// How the car slips, and what its radars and its speed are late or off by.
    pub car: CarErrors,
    /// The car's motion at the times of the drive's.
    pub motion: TrueMotionColumns,
    /// For each detection, 1 where it comes from a moving road user.
    #[serde(serialize_with = "columns::serialize")]
    pub moving: Vec<u8>,
    /// For each detection, the number of the road user it comes from, or 0.
    #[serde(serialize_with = "columns::serialize")]
    pub track: Vec<u32>,
}

/// A radar where it truly sits and looks.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct TrueSensor {
    /// Its number in the drive.
    pub id: u8,
    /// Its place and direction.
    pub mounting: Flat<Mounting>,
    /// Root mean square of its azimuth bias within 55 deg.
    pub azimuth_bias_rms_rad: f64,
}

/// The car's true motion.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "TrueMotion")]
pub struct TrueMotionColumns {
    /// Yaw rate.
    #[serde(serialize_with = "columns::serialize")]
    pub yaw_rate_radps: Vec<f64>,
    /// Speed of the rear axle, negative in reverse.
    #[serde(serialize_with = "columns::serialize")]
    pub speed_mps: Vec<f64>,
}

impl SimulatedDrive {
    /// The truth as columns.
    #[must_use]
    pub fn truth_columns(&self) -> TruthColumns {
        let truth = &self.truth;
        TruthColumns {
            sensors: truth
                .sensors
                .iter()
                .zip(&truth.azimuth_bias_rms_rad)
                .map(|(&(id, mounting), &azimuth_bias_rms_rad)| TrueSensor {
                    id,
                    mounting: mounting.into(),
                    azimuth_bias_rms_rad,
                })
                .collect(),
            yaw_rate: truth.yaw_rate,
            car: truth.car,
            motion: TrueMotionColumns {
                yaw_rate_radps: truth.motion.iter().map(|motion| motion.yaw_rate_radps).collect(),
                speed_mps: truth.motion.iter().map(|motion| motion.speed_mps).collect(),
            },
            moving: self.moving.iter().flatten().map(|&moves| u8::from(moves)).collect(),
            track: self.tracks.iter().flatten().copied().collect(),
        }
    }
}
