//! The car's own speed as evidence, with its scale, which is estimated on the way.

use super::Reading;
use super::tracked::SpeedEvidence;
use serde::{Deserialize, Serialize};

/// Noise of a measured speed: a constant part, m/s, a share of the speed, and what a delay of 50 ms makes of an acceleration, s.
const SIGMA_MPS: f64 = 0.05;
const SIGMA_SHARE: f64 = 0.01;
const DELAY_S: f64 = 0.05;
/// Standard deviation of the scale before anything is known of it (tyres), and of what one block tells of it.
const SCALE_PRIOR: f64 = 0.01;
const SCALE_A_BLOCK: f64 = 0.01;
/// Speeds below this say nothing of a scale, m/s.
const LEAST_MPS: f64 = 3.0;
/// Readings further apart than this do not say how fast the car gets faster, s, and no car does by more than this, m/s^2.
const CHANGE_GAP_S: f64 = 0.5;
const MAX_ACCELERATION: f64 = 10.0;

/// Scale of the measured speed over the radar's, tempered: the frames of a block count as one observation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Speed {
    reading: Option<Reading>,
    blocks: f64,
    sum: f64,
    block_frames: f64,
    block_sum: f64,
}

impl Speed {
    /// The evidence in a reading of the car's speed at a time.
    pub(crate) fn evidence(&mut self, time_s: f64, measured_mps: f64) -> SpeedEvidence {
        let before = self.reading.replace(Reading { time_s, value: measured_mps });
        let acceleration = match before {
            Some(before) if time_s > before.time_s && time_s - before.time_s <= CHANGE_GAP_S => {
                ((measured_mps - before.value) / (time_s - before.time_s))
                    .abs()
                    .min(MAX_ACCELERATION)
            }
            _ => 0.0,
        };
        SpeedEvidence {
            mps: measured_mps / self.scale(),
            sigma_mps: SIGMA_MPS + SIGMA_SHARE * measured_mps.abs() + DELAY_S * acceleration,
        }
    }

    /// Starts a session on another clock.
    pub(crate) fn restart(&mut self) {
        self.end_block();
        self.reading = None;
    }

    /// Takes the speed that a frame was found to have.
    pub(crate) fn add(&mut self, found_mps: f64, evidence: &SpeedEvidence) {
        if found_mps.abs() >= LEAST_MPS {
            self.block_frames += 1.0;
            self.block_sum += evidence.mps * self.scale() / found_mps - 1.0;
        }
    }

    /// Ends a block.
    pub(crate) fn end_block(&mut self) {
        if self.block_frames > 0.0 {
            self.sum += self.block_sum / self.block_frames;
            self.blocks += 1.0;
        }
        (self.block_frames, self.block_sum) = (0.0, 0.0);
    }

    /// Adds what another drive tells of the scale.
    pub(crate) fn absorb(&mut self, other: &Self) {
        self.blocks += other.blocks;
        self.sum += other.sum;
    }

    /// Measured over true speed.
    pub(crate) fn scale(&self) -> f64 {
        let (data, prior) = (self.blocks / SCALE_A_BLOCK.powi(2), 1.0 / SCALE_PRIOR.powi(2));
        1.0 + self.sum / SCALE_A_BLOCK.powi(2) / (data + prior)
    }

    /// Its standard deviation.
    pub(crate) fn scale_sigma(&self) -> f64 {
        1.0 / (self.blocks / SCALE_A_BLOCK.powi(2) + 1.0 / SCALE_PRIOR.powi(2)).sqrt()
    }
}
