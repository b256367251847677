//! Detection and accuracy on random scenes of a single snapshot: Figures 4 and 5 of the AAETR paper
//! (Zhu, Chen and Yang 2024).

pub mod cell;
pub mod figures;
pub(crate) mod finder;
pub(crate) mod plain_iaa;
pub mod report;
pub mod score;
pub mod stated;
pub mod times;

pub use report::AoaReport;
pub use score::Score;
pub use times::times;

use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::{Array, InputError};
use boresight_math::error::check_range;
use boresight_validate::experiment::{Answered, Experiment, Tell, Trials};
use serde::{Deserialize, Serialize};

/// Numbers of targets of the paper's conditions.
pub const TARGETS: [usize; 9] = [2, 3, 4, 5, 6, 7, 8, 9, 10];
/// Signal-to-noise ratios of the paper's conditions, dB.
pub const SNRS_DB: [f64; 5] = [15.0, 20.0, 25.0, 30.0, 35.0];
/// Difference between the strongest and the weakest target in the paper, dB.
pub const SPREAD_DB: f64 = 13.0;
/// Most targets of a scene.
const MOST_TARGETS: f64 = 64.0;
/// Most snapshots of one record.
const CHUNK: u64 = 250;

/// Checks that a signal-to-noise ratio is one of [`SNRS_DB`].
pub(crate) fn check_snr(snr_db: f64) -> Result<(), InputError> {
    if SNRS_DB.contains(&snr_db) {
        return Ok(());
    }
    Err(InputError::OutOfRange {
        what: "snrDb".into(),
        expected: SNRS_DB.map(|snr_db| snr_db.to_string()).join(", "),
        given: snr_db,
    })
}

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct AoaExperiment {
    /// Name of the array.
    pub array: String,
    /// Snapshots a condition.
    pub trials: u64,
    /// Further snapshots a condition, drawn from streams of their own, on which the one threshold of each entrant is
    /// found; they are not scored.
    pub validation: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Numbers of targets; a condition is one of them at one signal-to-noise ratio.
    pub targets: Vec<usize>,
    /// Signal-to-noise ratios, dB: the power of a target of 0 dB at one element over that of the noise there.
    pub snrs_db: Vec<f64>,
    /// Powers are uniform from 0 dB down to this much, dB.
    pub spread_db: f64,
    /// Errors of the array that no method knows of.
    pub imperfections: ImperfectionSpread,
    /// Methods by name, `plain-iaa` for IAA on whole degrees, `plain-iaa-half-degree` on half ones, `iaa` with `+hard` or `+soft` for its thresholding, any with
    /// `+refined` for sources refined on the snapshot, and networks, which are run plain and refined. Methods that need
    /// the number of sources are given it.
    #[serde(flatten)]
    pub entrants: Entrants,
}

/// Methods that are run if none are named: those quick enough for many snapshots.
pub fn default_methods(array: &Array) -> Vec<String> {
    let mut names = vec!["bartlett", "capon", "iaa", "iaa+hard", "iaa+soft", "iaa+refined", "nomp"];
    if array.is_uniform() {
        names.push("single-snapshot-music");
    }
    names.into_iter().map(String::from).collect()
}

/// The paper's conditions without entrants.
impl Default for AoaExperiment {
    fn default() -> Self {
        Self {
            array: "lrr48".into(),
            trials: 4000,
            validation: 200,
            seed: 0,
            targets: TARGETS.to_vec(),
            snrs_db: SNRS_DB.to_vec(),
            spread_db: SPREAD_DB,
            imperfections: ImperfectionSpread::default(),
            entrants: Entrants::default(),
        }
    }
}

/// How scenes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Targets.
    pub targets: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Distance of the second target from the first in sine, in halves of the main beam between its zeros. If `None`,
    /// it is as random as the others.
    pub pair_beams: Option<f64>,
}

impl Condition {
    /// All targets at random.
    pub const fn new(targets: usize, snr_db: f64) -> Self {
        Self { targets, snr_db, pair_beams: None }
    }
}

impl Experiment for AoaExperiment {
    const NAME: &'static str = "aoa";
    const REVISION: u32 = 3;
    type Plan = cell::Plan;
    type Error = EvaluateError;
    type Record = cell::AoaRecord;
    type Report = AoaReport;

    fn plan(&self) -> Result<cell::Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e7)?;
        check_range("validation", self.validation as f64, 1.0, 1e7)?;
        if self.targets.is_empty() || self.snrs_db.is_empty() {
            return Err(InputError::Empty {
                what: "conditions".into(),
                expected: "at least one number of targets and one signal-to-noise ratio".into(),
            }
            .into());
        }
        for &targets in &self.targets {
            check_range("targets", targets as f64, 1.0, MOST_TARGETS)?;
        }
        for &snr_db in &self.snrs_db {
            check_range("snrsDb", snr_db, -60.0, 100.0)?;
        }
        check_range("spreadDb", self.spread_db, 0.0, 100.0)?;
        cell::Plan::new(self)
    }

    fn methods(plan: &cell::Plan) -> Vec<String> {
        plan.names()
    }

    by_entrants!();

    fn join(record: &mut cell::AoaRecord, other: cell::AoaRecord) {
        record.methods.extend(other.methods);
    }

    /// Those that are scored, then those for the threshold.
    fn scenes(&self) -> u64 {
        let [scored, validation] = self.splits();
        let conditions = self.conditions().len();
        scored.scenes(conditions) + validation.scenes(conditions)
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    fn scene(&self, plan: &cell::Plan, number: u64) -> Result<cell::AoaRecord, EvaluateError> {
        self.answered(plan, number, None)
    }

    fn report(
        &self,
        plan: &cell::Plan,
        records: impl Iterator<Item = cell::AoaRecord>,
    ) -> AoaReport {
        AoaReport::new(self, &plan.names(), records)
    }
}

impl Answered for AoaExperiment {
    fn answered(
        &self,
        plan: &cell::Plan,
        number: u64,
        tell: Option<Tell>,
    ) -> Result<cell::AoaRecord, EvaluateError> {
        let [scored, validation] = self.splits();
        let conditions = self.conditions();
        let (index, first, trials) = match number.checked_sub(scored.scenes(conditions.len())) {
            None => scored.of(number),
            Some(number) => {
                let (condition, first, trials) = validation.of(number);
                (conditions.len() + condition, first, trials)
            }
        };
        plan.run(index, conditions[index % conditions.len()], [first, trials], tell)
    }
}

impl AoaExperiment {
    /// All conditions. A record's condition counts those of scored snapshots, then those of snapshots for the threshold.
    pub fn conditions(&self) -> Vec<Condition> {
        let of = |&targets: &usize| {
            self.snrs_db.iter().map(move |&snr_db| Condition::new(targets, snr_db))
        };
        self.targets.iter().flat_map(of).collect()
    }

    /// Of scored snapshots, and of those for the threshold.
    fn splits(&self) -> [Trials; 2] {
        [self.trials, self.validation].map(|each| Trials::new(each, CHUNK))
    }
}
