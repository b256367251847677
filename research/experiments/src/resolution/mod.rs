//! When two targets of equal power are resolved: probability against separation and signal-to-noise ratio, of
//! every method that runs on the array, beside the statistical resolution limit.
//!
//! A scene is resolved by a method if, of its two strongest estimates, each is within half the separation of a
//! target of its own, in sine of azimuth. Methods are told that there are two targets. The middle of the two is
//! drawn within 15 deg of boresight, phases are random, new ones in every snapshot.

pub mod figures;
pub mod limit;
pub mod report;
pub mod trial;

pub use report::ResolutionReport;

use crate::error::EvaluateError;
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};
use trial::{Plan, ResolutionRecord};

/// Separations, widths of the beam at half power.
pub const SEPARATIONS: [f64; 12] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0];
/// Signal-to-noise ratios at one element in one snapshot, dB.
pub const SNRS_DB: [f64; 5] = [0.0, 10.0, 20.0, 30.0, 40.0];
/// Trials of one record.
const CHUNK: u64 = 100;

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ResolutionExperiment {
    /// Name of the array.
    pub array: String,
    /// Numbers of snapshots.
    pub snapshots: Vec<usize>,
    /// Trials a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
}

impl ResolutionExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }

    /// Numbers of conditions: snapshots, signal-to-noise ratios, separations.
    fn conditions(&self) -> impl Iterator<Item = Condition> {
        let snapshots = (0..self.snapshots.len())
            .flat_map(|snapshots| SNRS_DB.into_iter().map(move |snr_db| (snapshots, snr_db)));
        snapshots.flat_map(|(snapshots, snr_db)| {
            SEPARATIONS.map(|separation| Condition { snapshots, snr_db, separation })
        })
    }
}

/// What trials have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Index in [`ResolutionExperiment::snapshots`].
    pub snapshots: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Separation, beam widths.
    pub separation: f64,
}

impl Experiment for ResolutionExperiment {
    const NAME: &'static str = "resolution";
    const REVISION: u32 = 1;
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = ResolutionRecord;
    type Report = ResolutionReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e6)?;
        check_range("numbers of snapshots", self.snapshots.len() as f64, 1.0, 8.0)?;
        for &snapshots in &self.snapshots {
            check_range("snapshots", snapshots as f64, 1.0, 1024.0)?;
        }
        Plan::new(self)
    }

    fn methods(plan: &Plan) -> Vec<String> {
        plan.names()
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(self.conditions().count())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    fn scene(&self, plan: &Plan, number: u64) -> Result<ResolutionRecord, EvaluateError> {
        let (condition, first, trials) = self.split().of(number);
        plan.run(condition, first, trials)
    }

    fn report(
        &self,
        plan: &Plan,
        records: impl Iterator<Item = ResolutionRecord>,
    ) -> ResolutionReport {
        ResolutionReport::new(self, plan, records)
    }
}
