//! What a set of data is to hold.

use crate::drive::Scenario;
use boresight_core::InputError;
use boresight_options::{Described, Naming, check};
use serde::{Deserialize, Serialize};

/// Successive frames of a window.
pub const WINDOW: usize = 8;

/// Most frames of a set of data.
pub const MAX_FRAMES: usize = 100_000_000;

/// What the errors of the radars of a set of data are like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DatasetNoise {
    /// Those of the drives' profile of that name.
    #[default]
    Radarscenes,
    /// A sparse radar of another kind, to test with: 30 detections within 45 deg at 15 Hz, azimuth errors
    /// of Laplace's distribution.
    Laplace,
}

/// A set of data to train and test networks with that estimate motion from one radar's scans.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct DatasetOptions {
    /// Everything random comes from it.
    pub seed: u64,
    /// Frames, in windows of 8 successive ones of a radar; as many more as fill the last window.
    #[option(default = 80_000, range = 8..=MAX_FRAMES)]
    pub frames: usize,
    /// The only kind of roads; all if absent.
    pub scenario: Option<Scenario>,
    /// A kind of roads that is left out, to test on it.
    pub scenario_left_out: Option<Scenario>,
    /// What the errors of the radars are like.
    pub dataset_noise: DatasetNoise,
}

impl DatasetOptions {
    /// Checks every number.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a number out of range, [`InputError::Incompatible`] where the only kind
    /// of roads is left out.
    pub fn check(&self) -> Result<(), InputError> {
        check(self, Naming::Rust)?;
        if self.scenarios().is_empty() {
            return Err(InputError::Incompatible {
                what: "scenario_left_out".into(),
                expected: "another kind of roads than the only one".into(),
                given: self.scenario_left_out.map_or("", Scenario::name).into(),
            });
        }
        Ok(())
    }

    /// The kinds of roads there are.
    pub(super) fn scenarios(&self) -> Vec<Scenario> {
        let chosen = |kind: &Scenario| {
            self.scenario.is_none_or(|only| only == *kind) && self.scenario_left_out != Some(*kind)
        };
        Scenario::ALL.into_iter().filter(chosen).collect()
    }
}
