//! What errors of the array that no method knows of do to detection and angles: the scores of [`crate::aoa`] under
//! gain, phase, position and coupling errors of several strengths.
//!
//! Scenes are those of the `aoa` experiment, drawn from the same streams: without errors its scores are found again.

pub mod report;

pub use report::ImperfectionsReport;

use crate::aoa::{self, Condition, cell};
use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};

/// Numbers of targets.
pub const NUMBERS: [usize; 3] = [2, 5, 10];
/// Snapshots of one record.
const CHUNK: u64 = 250;

/// What is wrong with the array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Gain of each element, normal.
    Gain,
    /// Phase of each element, normal.
    Phase,
    /// Place of each element along the array, normal.
    Position,
    /// Coupling of elements, falling with the square of their distance.
    Coupling,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Gain, Self::Phase, Self::Position, Self::Coupling];

    /// Strengths, mildest first.
    pub fn strengths(self) -> &'static [f64] {
        match self {
            Self::Gain => &[0.5, 1.0, 2.0, 3.0, 4.5, 6.0],
            Self::Phase => &[2.0, 5.0, 10.0, 20.0, 30.0, 45.0],
            Self::Position => &[0.01, 0.02, 0.05, 0.1, 0.2, 0.3],
            Self::Coupling => &[-40.0, -30.0, -25.0, -20.0, -15.0, -10.0],
        }
    }

    /// What the strength is.
    pub fn label(self) -> &'static str {
        match self {
            Self::Gain => "deviation of gain / dB",
            Self::Phase => "deviation of phase / deg",
            Self::Position => "deviation of position / half wavelengths",
            Self::Coupling => "coupling at half a wavelength / dB",
        }
    }

    /// Errors of that strength.
    fn spread(self, strength: f64) -> ImperfectionSpread {
        let none = ImperfectionSpread::default();
        match self {
            Self::Gain => ImperfectionSpread { gain_db: strength, ..none },
            Self::Phase => ImperfectionSpread { phase_rad: strength.to_radians(), ..none },
            Self::Position => ImperfectionSpread { position: strength, ..none },
            Self::Coupling => ImperfectionSpread { coupling_db: Some(strength), ..none },
        }
    }
}

/// The array as it should be, or a kind of error of some strength.
pub type Setting = Option<(Kind, f64)>;

/// All settings, the array without errors first.
pub fn settings() -> Vec<Setting> {
    let of = |kind: Kind| kind.strengths().iter().map(move |&strength| Some((kind, strength)));
    std::iter::once(None).chain(Kind::ALL.into_iter().flat_map(of)).collect()
}

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ImperfectionsExperiment {
    /// Name of the array.
    pub array: String,
    /// Signal-to-noise ratio, dB, one of those of [`crate::aoa`].
    pub snr_db: f64,
    /// Snapshots a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Methods and networks, as in [`aoa::AoaExperiment`].
    #[serde(flatten)]
    pub entrants: Entrants,
}

impl ImperfectionsExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }
}

impl Experiment for ImperfectionsExperiment {
    const NAME: &'static str = "imperfections";
    const REVISION: u32 = 2;
    /// One a setting.
    type Plan = Vec<cell::Plan>;
    type Error = EvaluateError;
    type Record = cell::AoaRecord;
    type Report = ImperfectionsReport;

    fn plan(&self) -> Result<Self::Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e7)?;
        aoa::check_snr(self.snr_db)?;
        settings()
            .into_iter()
            .map(|setting| {
                cell::Plan::new(&aoa::AoaExperiment {
                    array: self.array.clone(),
                    trials: self.trials,
                    // Largest F1 only, which asks for no threshold.
                    validation: 1,
                    seed: self.seed,
                    entrants: self.entrants.clone(),
                    imperfections: setting
                        .map_or(ImperfectionSpread::default(), |(kind, s)| kind.spread(s)),
                    ..aoa::AoaExperiment::default()
                })
            })
            .collect()
    }

    fn methods(plan: &Self::Plan) -> Vec<String> {
        plan.first().map_or(vec![], cell::Plan::names)
    }

    by_entrants!();

    fn join(record: &mut cell::AoaRecord, other: cell::AoaRecord) {
        record.methods.extend(other.methods);
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(settings().len() * NUMBERS.len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    /// The condition of a record counts settings, then numbers of targets.
    fn scene(&self, plan: &Self::Plan, number: u64) -> Result<cell::AoaRecord, EvaluateError> {
        let (index, first, trials) = self.split().of(number);
        let condition = Condition::new(NUMBERS[index % NUMBERS.len()], self.snr_db);
        let there = aoa::AoaExperiment::default()
            .conditions()
            .iter()
            .position(|c| *c == condition)
            .unwrap_or(0);
        let record = plan[index / NUMBERS.len()].run(there, condition, [first, trials], None)?;
        Ok(cell::AoaRecord { condition: index, ..record })
    }

    fn report(
        &self,
        plan: &Self::Plan,
        records: impl Iterator<Item = cell::AoaRecord>,
    ) -> ImperfectionsReport {
        ImperfectionsReport::new(self, &Self::methods(plan), records)
    }
}
