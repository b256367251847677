//! Detection and accuracy on several arrays, for methods and for networks that take any: the scores of [`crate::aoa`] on
//! single snapshots of known boards, an even line, a thinned one, elements scattered at random, and
//! transmitters whose virtual elements overlap.
//!
//! What is right is as many beams on each array: half a degree on `lrr48`, and as large a part of half the main beam on
//! others.

pub mod report;

pub use report::ArraysReport;

use crate::aoa::score::WITHIN_RAD;
use crate::aoa::{self, Condition, cell};
use crate::apart::half_beam;
use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_core::presets::preset;
use boresight_core::{Array, Random};
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};

/// Snapshots of one record.
const CHUNK: u64 = 250;
/// Places of the thinned line, and how many of them hold an element.
const THINNED: [usize; 2] = [48, 24];
/// Elements scattered at random, half a wavelength and up to a wavelength more apart.
const SCATTERED: usize = 20;

/// An array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tried {
    /// The sparse long-range array of the other experiments.
    Lrr48,
    /// Four chips in cascade: 86 elements in a row.
    Cascade86,
    /// A board of three transmitters, one of them elevated.
    Awr1843,
    /// 16 elements half a wavelength apart.
    Ula16,
    /// Half the elements of a line of 48, drawn once.
    Thinned24,
    /// Twenty elements at distances drawn once.
    Scattered20,
    /// Two transmitters by eight receivers whose virtual elements share four places.
    Overlap16,
    /// Six transmitters by eight receivers on 36 places.
    Overlap48,
}

impl Tried {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Lrr48,
        Self::Cascade86,
        Self::Thinned24,
        Self::Scattered20,
        Self::Ula16,
        Self::Awr1843,
        Self::Overlap16,
        Self::Overlap48,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lrr48 => "lrr48",
            Self::Cascade86 => "cascade86",
            Self::Awr1843 => "awr1843",
            Self::Ula16 => "ula16",
            Self::Thinned24 => "thinned24",
            Self::Scattered20 => "scattered20",
            Self::Overlap16 => "overlap16",
            Self::Overlap48 => "overlap48",
        }
    }

    /// Numbers of targets it is tried with.
    pub fn numbers(self) -> [usize; 2] {
        match self {
            Self::Lrr48 | Self::Cascade86 => [4, 10],
            Self::Thinned24 => [3, 6],
            Self::Scattered20 | Self::Ula16 => [2, 4],
            Self::Overlap16 => [2, 3],
            Self::Overlap48 => [3, 6],
            Self::Awr1843 => [1, 2],
        }
    }

    /// Its elements.
    ///
    /// # Errors
    /// None with those there are.
    pub fn array(self) -> Result<Array, EvaluateError> {
        // Which arrays these are is not of the seed.
        let random = &mut Random::new(0, 1);
        let at = |places: &[f64]| places.iter().map(|&y| [0.0, y, 0.0]).collect::<Vec<_>>();
        let row = |places: &[f64]| Array::new(&at(places));
        let eight: Vec<f64> = (0..8).map(f64::from).collect();
        Ok(match self {
            Self::Thinned24 => {
                let [places, elements] = THINNED;
                let mut left: Vec<f64> = (0..places).map(|place| place as f64).collect();
                while left.len() > elements {
                    left.swap_remove((random.uniform(0.0, left.len() as f64)) as usize);
                }
                row(&left)?
            }
            Self::Scattered20 => {
                let mut at = 0.0;
                let places: Vec<f64> = (0..SCATTERED)
                    .map(|_| {
                        at += random.uniform(1.0, 3.0);
                        at
                    })
                    .collect();
                row(&places)?
            }
            Self::Overlap16 => Array::mimo(&at(&[0.0, 4.0]), &at(&eight))?,
            Self::Overlap48 => Array::mimo(&at(&[0.0, 4.0, 8.0, 16.0, 24.0, 28.0]), &at(&eight))?,
            _ => preset(self.name())?,
        })
    }
}

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ArraysExperiment {
    /// Signal-to-noise ratio, dB, one of those of [`crate::aoa`].
    pub snr_db: f64,
    /// Snapshots a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Methods, as in [`crate::aoa::AoaExperiment`], and networks that take any array.
    #[serde(flatten)]
    pub entrants: Entrants,
}

/// Methods that are run if none are named.
pub fn default_methods() -> Vec<String> {
    ["bartlett", "plain-iaa", "iaa", "iaa+refined", "nomp"].map(String::from).to_vec()
}

/// Arrays with a number of targets.
fn conditions() -> Vec<(Tried, usize)> {
    let of = |tried: Tried| tried.numbers().map(|targets| (tried, targets));
    Tried::ALL.into_iter().flat_map(of).collect()
}

impl ArraysExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }
}

impl Experiment for ArraysExperiment {
    const NAME: &'static str = "arrays";
    const REVISION: u32 = 2;
    /// One an array.
    type Plan = Vec<cell::Plan>;
    type Error = EvaluateError;
    type Record = cell::AoaRecord;
    type Report = ArraysReport;

    fn plan(&self) -> Result<Self::Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e7)?;
        aoa::check_snr(self.snr_db)?;
        let usual = half_beam(&Tried::Lrr48.array()?);
        Tried::ALL
            .into_iter()
            .map(|tried| {
                let array = tried.array()?;
                let within_rad = WITHIN_RAD * half_beam(&array) / usual;
                let [_, most] = tried.numbers();
                Ok(cell::Plan::of(array, most, self.seed, &self.entrants)?.within(within_rad))
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
        self.split().scenes(conditions().len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    /// The condition of a record counts arrays, then numbers of targets.
    fn scene(&self, plan: &Self::Plan, number: u64) -> Result<cell::AoaRecord, EvaluateError> {
        let (index, first, trials) = self.split().of(number);
        let (_, targets) = conditions()[index];
        let condition = Condition::new(targets, self.snr_db);
        plan[index / 2].run(index, condition, [first, trials], None)
    }

    fn report(
        &self,
        plan: &Self::Plan,
        records: impl Iterator<Item = cell::AoaRecord>,
    ) -> ArraysReport {
        ArraysReport::new(self, &Self::methods(plan), records)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_what_their_names_say() {
        let elements = [48, 86, 24, 20, 16, 12, 16, 48];
        let places = [48, 86, 24, 20, 16, 12, 12, 36];
        for (tried, (elements, places)) in
            Tried::ALL.into_iter().zip(elements.into_iter().zip(places))
        {
            let array = tried.array().expect("an array");
            assert_eq!(array.len(), elements, "{tried:?}");
            assert_eq!(array.without_duplicates().len(), places, "{tried:?}");
            assert_eq!(array, tried.array().expect("the same"), "{tried:?}");
        }
    }
}
