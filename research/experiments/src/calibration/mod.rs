//! Mounting angles on simulated drives: Tables II to IV and Figures 4 to 6 of Zhu et al., "Radar Mounting
//! Angle Estimation in Operational Driving Conditions".
//!
//! Scenes with even numbers are drives over all kinds of roads with up to 30 % moving detections, those with
//! odd numbers are dense traffic with 40 to 80 %. The first half has the clean profile of errors, the second half the same
//! drives with those of RadarScenes.

pub mod report;
pub mod scene;

pub use report::CalibrationReport;
pub use scene::SceneRecord;

use crate::error::EvaluateError;
use boresight_math::error::check_range;
use boresight_simulate::drive::DriveProfile;
use boresight_validate::candidates::CANDIDATES;
use boresight_validate::experiment::Experiment;
use serde::{Deserialize, Serialize};

/// Errors of radars and car in the halves of the scenes.
pub const PROFILES: [DriveProfile; 2] = [DriveProfile::Clean, DriveProfile::Radarscenes];

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct CalibrationExperiment {
    /// Drives of each kind and profile.
    pub scenes: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Length of a drive, s.
    pub duration_s: f64,
    /// Whether methods are kept from all that moves, by the truth: what it costs them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub standing: bool,
}

impl Experiment for CalibrationExperiment {
    const NAME: &'static str = "calibration";
    const REVISION: u32 = 3;
    type Plan = ();
    type Error = EvaluateError;
    type Record = SceneRecord;
    type Report = CalibrationReport;

    fn plan(&self) -> Result<(), EvaluateError> {
        check_range("scenes", self.scenes as f64, 1.0, 1e5)?;
        Ok(check_range("durationS", self.duration_s, 10.0, 3600.0)?)
    }

    fn methods((): &()) -> Vec<String> {
        CANDIDATES.iter().map(|candidate| candidate.name.into()).collect()
    }

    fn scenes(&self) -> u64 {
        2 * PROFILES.len() as u64 * self.scenes
    }

    fn scene(&self, (): &(), number: u64) -> Result<SceneRecord, EvaluateError> {
        scene::run(self, number)
    }

    fn report(&self, (): &(), records: impl Iterator<Item = SceneRecord>) -> CalibrationReport {
        CalibrationReport::new(self, records)
    }
}
