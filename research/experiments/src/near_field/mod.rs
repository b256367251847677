//! What spherical waves of near targets do to methods that take waves for plane: errors of angle and power, missed
//! and false targets against range, in Fraunhofer distances `2 D^2 / lambda` of the array's length `D`.
//!
//! Transmitters are around the origin and receivers, too, each row with its centre there, and angles are measured
//! from the origin. Were the rows elsewhere, near targets would be seen at other angles by the parallax alone. Scenes
//! of one number of targets are the same at all ranges: the same angles, phases and noise.

pub mod report;
pub mod trial;

pub use report::NearFieldReport;

use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};
use trial::{NearFieldRecord, Plan};

/// Ranges over the Fraunhofer distance; the last one stands for plane waves.
pub const RANGES: [Option<f64>; 11] = [
    Some(0.01),
    Some(0.02),
    Some(0.05),
    Some(0.1),
    Some(0.2),
    Some(0.5),
    Some(1.0),
    Some(2.0),
    Some(5.0),
    Some(10.0),
    None,
];
/// Powers of the targets of scenes with one and with two, dB.
pub const POWERS_DB: [&[f64]; 2] = [&[0.0], &[0.0, -6.0]];
/// Snapshots of one record.
const CHUNK: u64 = 100;

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct NearFieldExperiment {
    /// Name of the array.
    pub array: String,
    /// Signal-to-noise ratio of a target of 0 dB, dB.
    pub snr_db: f64,
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
    ["bartlett", "iaa", "iaa+refined", "nomp"].map(String::from).to_vec()
}

impl NearFieldExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }
}

impl Experiment for NearFieldExperiment {
    const NAME: &'static str = "near-field";
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = NearFieldRecord;
    type Report = NearFieldReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e7)?;
        check_range("snr_db", self.snr_db, -50.0, 100.0)?;
        Plan::new(self)
    }

    fn methods(plan: &Plan) -> Vec<String> {
        plan.names()
    }

    by_entrants!();

    fn join(record: &mut NearFieldRecord, other: NearFieldRecord) {
        record.methods.extend(other.methods);
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(POWERS_DB.len() * RANGES.len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    /// Conditions count numbers of targets, then ranges.
    fn scene(&self, plan: &Plan, number: u64) -> Result<NearFieldRecord, EvaluateError> {
        let (condition, first, trials) = self.split().of(number);
        plan.run(condition, first, trials)
    }

    fn report(
        &self,
        plan: &Plan,
        records: impl Iterator<Item = NearFieldRecord>,
    ) -> NearFieldReport {
        NearFieldReport::new(self, plan, records)
    }
}
