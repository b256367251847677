//! Counting and angles of up to two targets in the region of interest of a data cube: Figures 6 to 9 of Sang et
//! al., "DoA Estimation for FMCW Radar by 3D-CNN" (2021), in simulation; theirs of Figure 9 is of field measurements.
//!
//! Every trial simulates the cube of one frame, takes its range spectrum with a rectangular window, centres the
//! region of 65 range bins and 4 chirps on the strongest bin, as detection would, and gives each method the
//! covariance of what passes a band-pass filter around that region (the paper's equation 7), from 260 vectors over
//! the 8 channels. Methods that take snapshots only get eight that have this covariance. The 3D-CNN gets the region
//! itself.

mod answers;
pub mod end_to_end;
pub mod figures;
mod flow;
pub mod plan;
mod region_methods;
pub mod report;
pub mod tally;
mod trial;

pub use end_to_end::EndToEnd;
pub use report::DoaReport;

use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_core::presets::preset;
use boresight_core::{Array, Waveform};
use boresight_math::error::check_range;
use boresight_simulate::{waveform_3dcnn_experiment, waveform_3dcnn_simulated};
use boresight_validate::experiment::{Answered, Experiment, Tell, Trials};
use plan::{COUNTERS, Plan};
use region_methods::RegionMethod;
use serde::{Deserialize, Serialize};
use tally::DoaRecord;

/// Signal-to-noise ratios, dB: power of one target over noise power, of one sample of one chirp at one element,
/// before any transform.
pub const SNRS_DB: [f64; 6] = [-10.0, -5.0, 0.0, 5.0, 10.0, 15.0];
/// Trials of one record: a tenth of all pairs of angles.
const CHUNK: u64 = 21;
/// Range bins and chirps of the region.
pub const REGION: [usize; 2] = [65, 4];

/// The radar and where its targets are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Setup {
    /// The paper's Table 3: range bins of 1 m, one transmitter, 8 receivers, targets at 70 to 90 m.
    Simulation,
    /// Its Table 4: range bins of 43 mm, 2 transmitters in turn, 4 receivers. Targets are at 9.7 to 10.3 m, where the
    /// paper's stood at 10 m and were shifted by up to 0.3 m for training.
    Experiment,
}

impl Setup {
    /// Waveform, array, nearest and farthest range.
    fn radar(self) -> Result<(Waveform, Array, [f64; 2]), EvaluateError> {
        Ok(match self {
            Self::Simulation => (waveform_3dcnn_simulated(), Array::ula(8)?, [70.0, 90.0]),
            Self::Experiment => (waveform_3dcnn_experiment(), preset("awr1642")?, [9.7, 10.3]),
        })
    }
}

/// What is in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Targets {
    /// Nothing.
    None,
    /// One target.
    One,
    /// Two, each at its own range.
    Apart,
    /// Two at one range: their echoes are coherent.
    Together,
    /// Two at one range, of which the second moves.
    Moving,
}

impl Targets {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::None, Self::One, Self::Apart, Self::Together, Self::Moving];

    /// How many.
    pub fn count(self) -> usize {
        match self {
            Self::None => 0,
            Self::One => 1,
            Self::Apart | Self::Together | Self::Moving => 2,
        }
    }
}

/// What changes from one condition to the next, for each kind of scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The signal-to-noise ratio; two targets have equal power.
    #[default]
    Snr,
    /// The power of the second target over the first, whose signal-to-noise ratio is the largest of [`SNRS_DB`].
    PowerDifference,
}

/// Powers of the second target over the first, dB.
pub const DIFFERENCES_DB: [f64; 6] = [0.0, -3.0, -6.0, -9.0, -12.0, -15.0];

/// A kind of scene with its powers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Condition {
    pub targets: Targets,
    pub snr_db: f64,
    pub second_db: f64,
}

impl Axis {
    /// Its values.
    pub fn values(self) -> [f64; 6] {
        match self {
            Self::Snr => SNRS_DB,
            Self::PowerDifference => DIFFERENCES_DB,
        }
    }

    /// Conditions in order.
    pub(crate) fn conditions(self) -> Vec<Condition> {
        let targets = Targets::ALL.into_iter();
        let targets = targets.filter(|targets| self == Self::Snr || targets.count() == 2);
        let of = |targets| {
            self.values().map(|value| match self {
                Self::Snr => Condition { targets, snr_db: value, second_db: 0.0 },
                Self::PowerDifference => {
                    let snr_db = SNRS_DB[SNRS_DB.len() - 1];
                    Condition { targets, snr_db, second_db: value }
                }
            })
        };
        targets.flat_map(of).collect()
    }

    /// Whether it has its usual value, which records and options do not mention.
    fn is_usual(&self) -> bool {
        *self == Self::Snr
    }
}

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct DoaExperiment {
    /// The radar.
    pub setup: Setup,
    /// What changes.
    #[serde(default, skip_serializing_if = "Axis::is_usual")]
    pub axis: Axis,
    /// Trials a condition. Angles go through all whole degrees within 10, or all pairs of them, in turn.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Rules that count and methods that estimate, by name, and networks that do either.
    #[serde(flatten)]
    pub entrants: Entrants,
    /// The whole flow, in place of regions that are told; then there are networks only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_to_end: Option<EndToEnd>,
}

/// Names of all rules that count, and of all methods that run on the radar's array.
///
/// # Errors
/// None with the arrays used.
pub fn default_methods(setup: Setup) -> Result<Vec<String>, EvaluateError> {
    let (_, array, _) = setup.radar()?;
    let counters = COUNTERS.iter().map(|counter| counter.0.to_owned());
    let methods = plan::candidates(&array, 1).into_iter().map(|candidate| candidate.name);
    let of_regions = RegionMethod::ALL.map(|method| method.name().to_owned());
    Ok(counters.chain(methods).chain(of_regions).collect())
}

impl DoaExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }
}

impl Experiment for DoaExperiment {
    const NAME: &'static str = "doa";
    const REVISION: u32 = 3;
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = DoaRecord;
    type Report = DoaReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e6)?;
        Plan::new(self)
    }

    fn methods(plan: &Plan) -> Vec<String> {
        [plan.counters(), plan.names()].concat()
    }

    by_entrants!();

    fn join(record: &mut DoaRecord, other: DoaRecord) {
        record.counted.extend(other.counted);
        record.methods.extend(other.methods);
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(self.axis.conditions().len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    fn scene(&self, plan: &Plan, number: u64) -> Result<DoaRecord, EvaluateError> {
        self.answered(plan, number, None)
    }

    fn report(&self, plan: &Plan, records: impl Iterator<Item = DoaRecord>) -> DoaReport {
        DoaReport::new(self, plan, records)
    }
}

impl Answered for DoaExperiment {
    fn answered(
        &self,
        plan: &Plan,
        number: u64,
        tell: Option<Tell>,
    ) -> Result<DoaRecord, EvaluateError> {
        let (condition, first, trials) = self.split().of(number);
        plan.run(condition, first, trials, tell)
    }
}
