//! Two uncorrelated sources in many snapshots, each far below the noise: what methods on the covariance and networks on
//! it find, told that there are two.
//!
//! Papageorgiou, Sellathurai and Eldar (2021) ask so of their network. Sources are of equal power, anywhere within 60 deg
//! and at least half the main beam apart. A scene is found where both azimuths are within 2 deg.

pub mod report;
pub mod trial;

pub use report::LowSnrReport;

use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};
use trial::{LowSnrRecord, Plan};

/// Signal-to-noise ratios of each source at one element in one snapshot, dB.
pub const SNRS_DB: [f64; 7] = [-20.0, -15.0, -10.0, -5.0, 0.0, 5.0, 10.0];
/// Numbers of snapshots.
pub const SNAPSHOTS: [usize; 3] = [20, 200, 2000];
/// Trials of one record.
const CHUNK: u64 = 50;

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct LowSnrExperiment {
    /// Name of the array.
    pub array: String,
    /// Trials a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Methods that take a covariance, and networks that do.
    #[serde(flatten)]
    pub entrants: Entrants,
}

/// Methods that are run if none are named.
pub fn default_methods() -> Vec<String> {
    ["bartlett", "capon", "music", "root-music", "esprit", "maximum-likelihood"]
        .map(String::from)
        .to_vec()
}

/// Snapshots and signal-to-noise ratio of each condition.
fn conditions() -> Vec<(usize, f64)> {
    SNAPSHOTS.into_iter().flat_map(|n| SNRS_DB.map(|snr_db| (n, snr_db))).collect()
}

impl LowSnrExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }
}

impl Experiment for LowSnrExperiment {
    const NAME: &'static str = "low-snr";
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = LowSnrRecord;
    type Report = LowSnrReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e6)?;
        Plan::new(self)
    }

    fn methods(plan: &Plan) -> Vec<String> {
        plan.names()
    }

    by_entrants!();

    fn join(record: &mut LowSnrRecord, other: LowSnrRecord) {
        record.methods.extend(other.methods);
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(conditions().len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    fn scene(&self, plan: &Plan, number: u64) -> Result<LowSnrRecord, EvaluateError> {
        let (condition, first, trials) = self.split().of(number);
        plan.run(condition, first, trials)
    }

    fn report(&self, plan: &Plan, records: impl Iterator<Item = LowSnrRecord>) -> LowSnrReport {
        LowSnrReport::new(self, &plan.names(), records)
    }
}
