//! Sets of data for networks that estimate a radar's motion from its scans: windows of successive
//! frames from many short drives, with the motion behind each.
//!
//! Radars look in any direction. How much moves is set window by window, the same for all directions.
//! Some windows are queues, in which all road users have one speed, and one frame in twenty has nothing
//! that stands. [`mod@file`] has the format.

pub mod file;
mod options;
mod window;

#[cfg(test)]
mod tests;

pub use options::{DatasetNoise, DatasetOptions, MAX_FRAMES, WINDOW};
pub use window::{Condition, Frame, Window};

use super::{DriveOptions, DriveProfile, RadarNoise, Scenario, Variant, simulate};
use crate::error::SimulateError;
use boresight_core::Random;
use boresight_core::drive::Mounting;
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// Radars of a drive.
const RADARS: u8 = 4;

/// Length of a drive, s: from and to.
const DURATION_S: [f64; 2] = [12.0, 18.0];

/// Mean cycle of the noise "laplace" over that of drives: 15 Hz.
const LAPLACE_CYCLE_FACTOR: f64 = 1.0 / (15.0 * 0.074);

/// Windows of a set of data, drive by drive.
#[derive(Debug)]
pub struct Dataset {
    options: DatasetOptions,
    scenarios: Vec<Scenario>,
    drives: u64,
    state: window::Shares,
}

impl Dataset {
    /// Begins a set of data.
    ///
    /// # Errors
    /// [`SimulateError::Argument`] for options that [`DatasetOptions::check`] refuses.
    pub fn new(options: &DatasetOptions) -> Result<Self, SimulateError> {
        options.check()?;
        Ok(Self {
            options: options.clone(),
            scenarios: options.scenarios(),
            drives: 0,
            state: window::Shares::default(),
        })
    }

    /// The windows of the next drive; there is always another.
    ///
    /// # Errors
    /// Those of [`simulate_drive`](super::simulate_drive).
    pub fn next_drive(&mut self) -> Result<Vec<Window>, SimulateError> {
        let number = self.drives;
        self.drives += 1;
        let mut random = Random::new(self.options.seed, number);
        let kinds = self.scenarios.len() as u64;
        let scenario = self.scenarios[(number % kinds) as usize];
        let laplace = self.options.dataset_noise == DatasetNoise::Laplace;
        let options = DriveOptions {
            scenario,
            profile: if laplace { DriveProfile::Clean } else { DriveProfile::Radarscenes },
            seed: random.bits(),
            car: random.bits(),
            duration_s: random.uniform(DURATION_S[0], DURATION_S[1]),
            sensors: (0..RADARS).map(|id| (id, mounting(&mut random))).collect(),
            moving_share: Some(window::draw_share(&mut random).min(super::MAX_MOVING_SHARE)),
            noise: if laplace { window::LAPLACE_NOISE } else { RadarNoise::default() },
            ..DriveOptions::default()
        };
        let cycle_factor = if laplace { LAPLACE_CYCLE_FACTOR } else { 1.0 };
        let variant = Variant { trimmed: false, cycle_factor };
        let drive = simulate(&options, variant, |_, _| ControlFlow::Continue(()))?;
        let noise = self.options.dataset_noise;
        Ok(window::windows(&drive, number, scenario, noise, &mut self.state, &mut random))
    }
}

/// Anywhere on a car, in any direction.
fn mounting(random: &mut Random) -> Mounting {
    Mounting {
        x_m: random.uniform(-1.0, 4.0),
        y_m: random.uniform(-1.0, 1.0),
        yaw_rad: random.uniform(-PI, PI),
    }
}
