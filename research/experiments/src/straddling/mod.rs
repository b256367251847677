//! Straddling loss: what a target between the points of a grid costs methods that search one, and what finer grids
//! cost, beside methods that know no grid.
//!
//! Methods with a spectrum over the grid are run on every grid. Each answers twice: with the points of its grid, and
//! as it is, with its own interpolation between them. Methods without, and networks, are run once. The straddling
//! loss is what a beam loses that is steered to the estimate instead of the target.

pub mod cost;
mod figures;
pub mod report;
pub mod times;
pub mod trial;

pub use report::StraddlingReport;
pub use times::times;

use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};
use trial::{Plan, StraddlingRecord};

/// Numbers of points of the grids, uniform in sine of azimuth over `[-1, 1)`.
pub const GRIDS: [usize; 8] = [64, 128, 256, 512, 1024, 2048, 4096, 8192];
/// Snapshots of one record.
const CHUNK: u64 = 100;

/// What is in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Condition {
    /// Signal-to-noise ratio of a target of 0 dB, dB.
    pub snr_db: f64,
    /// Power of a second target, whose detection is scored, dB. Without one there is a single target of 0 dB.
    pub weak_db: Option<f64>,
}

/// A target at moderate and at high signal-to-noise ratio, and a weak one beside a strong one.
pub const CONDITIONS: [Condition; 3] = [
    Condition { snr_db: 10.0, weak_db: None },
    Condition { snr_db: 30.0, weak_db: None },
    Condition { snr_db: 30.0, weak_db: Some(-13.0) },
];

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StraddlingExperiment {
    /// Name of the array.
    pub array: String,
    /// Snapshots a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Methods and networks, as in [`crate::aoa::AoaExperiment`].
    #[serde(flatten)]
    pub entrants: Entrants,
}

/// Methods that are run if none are named.
pub fn default_methods() -> Vec<String> {
    ["bartlett", "capon", "iaa", "iaa+refined", "nomp"].map(String::from).to_vec()
}

impl StraddlingExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }
}

impl Experiment for StraddlingExperiment {
    const NAME: &'static str = "straddling";
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = StraddlingRecord;
    type Report = StraddlingReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e7)?;
        Plan::new(self)
    }

    fn methods(plan: &Plan) -> Vec<String> {
        plan.lines().iter().map(trial::Line::name).collect()
    }

    by_entrants!();

    fn join(record: &mut StraddlingRecord, other: StraddlingRecord) {
        record.variants.extend(other.variants);
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(CONDITIONS.len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    fn scene(&self, plan: &Plan, number: u64) -> Result<StraddlingRecord, EvaluateError> {
        let (condition, first, trials) = self.split().of(number);
        plan.run(condition, first, trials)
    }

    fn report(
        &self,
        plan: &Plan,
        records: impl Iterator<Item = StraddlingRecord>,
    ) -> StraddlingReport {
        StraddlingReport::new(self, plan, records)
    }
}
