//! Mounting angles on simulated drives: Tables II to IV and Figures 5 and 6 of Zhu et al., "Radar Mounting
//! Angle Estimation in Operational Driving Conditions".
//!
//! Scenes with even numbers are drives over all kinds of roads with up to 30 % moving detections, those with
//! odd numbers are dense traffic with 40 to 80 %. The first half has the clean profile of errors, the second half the same
//! drives with those of RadarScenes.

pub mod drives;
pub mod drives_report;
pub mod figures;
pub mod report;
pub mod scene;

pub use drives::DrivesExperiment;
pub use drives_report::DrivesReport;
pub use report::CalibrationReport;
pub use scene::SceneRecord;

use crate::EvaluateError;
use crate::experiment::Experiment;
use boresight_calibrate::{CalibrationOptions, FrameInput, Method, MotionMethod};
use boresight_core::error::check_range;
use boresight_simulate::drive::DriveProfile;
use serde::{Deserialize, Serialize};

/// Driving times of Figure 6, s.
pub const DRIVING_TIMES_S: [f64; 8] = [2.0, 5.0, 10.0, 15.0, 25.0, 40.0, 60.0, 90.0];

/// A method of the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate {
    /// Name in records and tables.
    pub name: &'static str,
    /// How the angle is estimated.
    pub method: Method,
    /// How the radar's motion is.
    pub motion: MotionMethod,
    /// Whether it is told the car's speed.
    pub speed: bool,
    /// Whether all radars share scale, bias and slip.
    pub joint: bool,
    /// Whether Figure 6 shows it.
    pub convergence: bool,
}

impl Candidate {
    /// The options of a radar with this method.
    fn options(&self, radar: &CalibrationOptions) -> CalibrationOptions {
        CalibrationOptions { method: self.method, motion: Some(self.motion), ..*radar }
    }

    /// A frame as the method may see it.
    fn told<'a>(&self, frame: &FrameInput<'a>) -> FrameInput<'a> {
        FrameInput { speed_mps: frame.speed_mps.filter(|_| self.speed), ..*frame }
    }
}

const fn candidate(
    name: &'static str,
    method: Method,
    motion: MotionMethod,
    convergence: bool,
) -> Candidate {
    let speed = matches!(method, Method::Kabsch) || matches!(motion, MotionMethod::Tracked);
    Candidate { name, method, motion, speed, joint: false, convergence }
}

/// The methods compared: the two of Table II that have no network, the regressions on RANSAC's motion, ours, then the
/// formulations of Table IV on our motion.
pub const CANDIDATES: [Candidate; 11] = [
    candidate("weighted mean (Kellner et al.)", Method::WeightedMean, MotionMethod::Ransac, true),
    candidate("Kabsch (Bao et al.)", Method::Kabsch, MotionMethod::Ransac, true),
    candidate(
        "least squares on RANSAC",
        Method::LeastSquares,
        MotionMethod::WeightedLeastSquares,
        true,
    ),
    candidate(
        "orthogonal distance on RANSAC",
        Method::OrthogonalDistance,
        MotionMethod::OrthogonalDistance,
        false,
    ),
    Candidate {
        speed: false,
        ..candidate("recursive, without speed", Method::Recursive, MotionMethod::Tracked, true)
    },
    candidate("recursive", Method::Recursive, MotionMethod::Tracked, true),
    Candidate {
        joint: true,
        ..candidate("recursive, four radars", Method::Recursive, MotionMethod::Tracked, false)
    },
    candidate("least squares, tracked", Method::LeastSquares, MotionMethod::Tracked, false),
    candidate("Kabsch, tracked", Method::Kabsch, MotionMethod::Tracked, false),
    candidate("weighted mean, tracked", Method::WeightedMean, MotionMethod::Tracked, false),
    candidate(
        "orthogonal distance, tracked",
        Method::OrthogonalDistance,
        MotionMethod::Tracked,
        false,
    ),
];

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
}

impl Experiment for CalibrationExperiment {
    const NAME: &'static str = "calibration";
    const REVISION: u32 = 1;
    type Plan = ();
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
