//! Conditions that are harder than those of the AAETR paper ([`crate::aoa`]): more noise, more targets, pairs of close
//! targets, short arrays, and arrays with errors.
//!
//! Scores are strict: of two predictions near one target, one is false. The paper's score would count one prediction
//! between two close targets as right for both.

pub mod conditions;
mod figures;
pub mod report;

pub use conditions::{Group, HardCondition};
pub use report::HardReport;

use crate::aoa::cell::{self, AoaRecord, MethodRecord};
use crate::aoa::score::Threshold;
use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_core::presets::preset;
use boresight_math::error::check_range;
use boresight_validate::experiment::{Experiment, Trials};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Snapshots of one record.
const CHUNK: u64 = 250;

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct HardExperiment {
    /// Snapshots a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Methods and networks, as in [`crate::aoa::AoaExperiment`]. The first one is compared with all others. A network
    /// for one array is run on that array alone.
    #[serde(flatten)]
    pub entrants: Entrants,
}

/// Methods that are run if none are named.
pub fn default_methods() -> Vec<String> {
    ["iaa", "plain-iaa", "plain-iaa-half-degree", "iaa+refined"].map(String::from).to_vec()
}

impl HardExperiment {
    fn split(&self) -> Trials {
        Trials::new(self.trials, CHUNK)
    }

    /// The methods and the networks that take an array.
    fn entrants_on(&self, array: &str) -> Entrants {
        let takes =
            |trained_on: Option<&str>| trained_on.is_none_or(|on| on == "any" || on == array);
        let networks = self.entrants.networks.iter().filter(|network| {
            let card = network.model.as_ref().and_then(|model| model.card());
            takes(card.and_then(|card| card.data.array.as_deref()))
        });
        Entrants::new(self.entrants.methods.clone(), networks.cloned().collect())
    }
}

/// What all snapshots share.
pub struct Plan {
    names: Vec<String>,
    /// Of each condition; `None` where nothing takes the array.
    conditions: Vec<Option<cell::Plan>>,
}

impl Experiment for HardExperiment {
    const NAME: &'static str = "hard";
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = AoaRecord;
    type Report = HardReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("trials", self.trials as f64, 1.0, 1e7)?;
        self.entrants.check()?;
        let conditions = conditions::all();
        let mut most: BTreeMap<&str, usize> = BTreeMap::new();
        for HardCondition { array, drawn, .. } in &conditions {
            let targets = most.entry(array).or_default();
            *targets = drawn.targets.max(*targets);
        }
        let mut arrays: BTreeMap<&str, cell::Plan> = BTreeMap::new();
        for (array, targets) in most {
            let entrants = self.entrants_on(array);
            if !entrants.methods.is_empty() || !entrants.networks.is_empty() {
                let plan = cell::Plan::of(preset(array)?, targets, self.seed, &entrants)?;
                arrays.insert(array, plan);
            }
        }
        let of = |condition: HardCondition| {
            let plan = arrays.get(condition.array)?.clone();
            let within_rad = condition.within_rad(plan.beam());
            Some(plan.within(within_rad).with_imperfections(condition.imperfections))
        };
        Ok(Plan {
            names: cell::names(&self.entrants)?,
            conditions: conditions.into_iter().map(of).collect(),
        })
    }

    fn methods(plan: &Plan) -> Vec<String> {
        plan.names.clone()
    }

    by_entrants!();

    fn join(record: &mut AoaRecord, other: AoaRecord) {
        record.methods.extend(other.methods);
    }

    fn scenes(&self) -> u64 {
        self.split().scenes(conditions::all().len())
    }

    fn repeats(&self) -> u64 {
        self.trials
    }

    fn scene(&self, plan: &Plan, number: u64) -> Result<AoaRecord, EvaluateError> {
        let (condition, first, trials) = self.split().of(number);
        let mut methods: Vec<MethodRecord> =
            plan.names.iter().map(|_| MethodRecord::new(Threshold::Power)).collect();
        if let Some(of_array) = &plan.conditions[condition] {
            let drawn = conditions::all()[condition].drawn;
            let record = of_array.run(condition, drawn, [first, trials], None)?;
            for (name, of_method) in of_array.names().iter().zip(record.methods) {
                if let Some(at) = plan.names.iter().position(|known| known == name) {
                    methods[at] = of_method;
                }
            }
        }
        Ok(AoaRecord { condition, methods })
    }

    fn report(&self, plan: &Plan, records: impl Iterator<Item = AoaRecord>) -> HardReport {
        HardReport::new(self, &plan.names, records)
    }
}
