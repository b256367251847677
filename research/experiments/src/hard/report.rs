//! From records to tables and figures.

use super::conditions::{self, Group};
use super::{HardExperiment, figures};
use crate::aoa::cell::{AoaRecord, MethodRecord};
use crate::aoa::report::MethodResult;
use crate::entrants::Network;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct HardReport {
    /// Snapshots a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Methods, then each network plain and refined.
    pub methods: Vec<String>,
    /// Which networks these are.
    pub networks: Vec<Network>,
    /// Results by condition.
    pub conditions: Vec<ConditionResult>,
}

/// A condition with what each method reached.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConditionResult {
    /// What is hard about it.
    pub group: Group,
    /// Name.
    pub name: String,
    /// Array.
    pub array: &'static str,
    /// Targets.
    pub targets: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Distance of the two targets of a pair, in halves of the main beam between its zeros.
    pub pair_beams: Option<f64>,
    /// Methods in order; `None` for a network that does not take the array.
    pub methods: Vec<Option<MethodResult>>,
}

impl ConditionResult {
    /// Largest strict F1 of a method.
    pub(super) fn strict_f1(&self, method: usize) -> Option<f64> {
        Some(self.methods.get(method)?.as_ref()?.strict_f1)
    }
}

impl HardReport {
    pub(super) fn new(
        options: &HardExperiment,
        methods: &[String],
        records: impl Iterator<Item = AoaRecord>,
    ) -> Self {
        let conditions = conditions::all();
        let mut sums: Vec<Vec<MethodRecord>> = vec![vec![]; conditions.len()];
        for record in records {
            if let Some(sum) = sums.get_mut(record.condition) {
                MethodRecord::merge_all(sum, record.methods);
            }
        }
        let results = |sums: &Vec<MethodRecord>| {
            let result = |record: &MethodRecord| {
                let result = MethodResult::new(record, None);
                result.best.is_some().then_some(result)
            };
            sums.iter().map(result).collect()
        };
        Self {
            trials: options.trials,
            seed: options.seed,
            methods: methods.to_vec(),
            networks: options.entrants.networks.clone(),
            conditions: conditions
                .into_iter()
                .zip(&sums)
                .map(|(condition, sums)| ConditionResult {
                    group: condition.group,
                    name: condition.name,
                    array: condition.array,
                    targets: condition.drawn.targets,
                    snr_db: condition.drawn.snr_db,
                    pair_beams: condition.drawn.pair_beams,
                    methods: results(sums),
                })
                .collect(),
        }
    }

    pub(super) fn of_group(&self, group: Group) -> impl Iterator<Item = &ConditionResult> {
        self.conditions.iter().filter(move |condition| condition.group == group)
    }

    /// How far the score of each method is from that of the first one, condition by condition.
    fn differences(&self) -> Table {
        let rows = self.conditions.iter().map(|condition| {
            let score = |method| condition.strict_f1(method).unwrap_or(f64::NAN);
            let least = Cell::fixed(score(0), 4);
            let others = (1..self.methods.len()).map(|k| difference(score(k) - score(0)));
            (&condition.name, [least].into_iter().chain(others).collect())
        });
        let first = self.methods.first().map_or("", String::as_str);
        let title = format!("Largest strict F1 of {first}, and differences of others from it");
        let table = Table::new(title, Best::None, "condition", &self.methods, rows);
        Table { errors_in_cells: true, ..table }
    }

    /// Means over the conditions of each group, nothing for a network that does not take all its arrays, and the number of
    /// conditions in which a method scores more than the first one.
    fn means(&self) -> Table {
        let rows = self.methods.iter().enumerate().map(|(k, name)| {
            let pairs =
                || self.conditions.iter().filter_map(|c| Some((c.strict_f1(0)?, c.strict_f1(k)?)));
            let ahead = pairs().filter(|(first, own)| own > first).count();
            let ahead = Cell::text(format!("{ahead} of {}", pairs().count()));
            let mean = |group| {
                let scores: Vec<f64> =
                    self.of_group(group).filter_map(|c| c.strict_f1(k)).collect();
                let complete = scores.len() == self.of_group(group).count();
                let mean = scores.iter().sum::<f64>() / scores.len() as f64;
                Cell::fixed(if complete { mean } else { f64::NAN }, 4)
            };
            (name, Group::ALL.map(mean).into_iter().chain([ahead]).collect())
        });
        let first = self.methods.first().map_or("", String::as_str);
        let heads = Group::ALL.map(|group| group.title().to_owned());
        let heads = heads.into_iter().chain([format!("conditions ahead of {first}")]);
        Table::new("Mean of the largest strict F1", Best::Largest, "method", heads, rows)
    }

    fn scores(&self, group: Group) -> Table {
        let rows = self.methods.iter().enumerate().map(|(k, name)| {
            let cell = |c: &ConditionResult| Cell::fixed(c.strict_f1(k).unwrap_or(f64::NAN), 3);
            (name, self.of_group(group).map(cell).collect())
        });
        let heads: Vec<&String> = self.of_group(group).map(|condition| &condition.name).collect();
        Table::new(
            format!("{}: largest strict F1", group.title()),
            Best::Largest,
            "method",
            heads,
            rows,
        )
    }
}

/// A difference with its sign; a dash where there is none.
fn difference(value: f64) -> Cell {
    if !value.is_finite() {
        return Cell::text("-");
    }
    Cell::shown(value, format!("{value:+.4}"))
}

impl boresight_validate::experiment::Report for HardReport {
    fn tables(&self) -> Tables {
        let remark = format!("{} snapshots a condition.\n", self.trials);
        let mut tables = vec![self.means(), self.differences()];
        tables.extend(Group::ALL.map(|group| self.scores(group)));
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text =
            "group,condition,array,targets,snr_db,method,f1,strict_f1,error_over_bound\n"
                .to_owned();
        for c in &self.conditions {
            for (name, result) in self.methods.iter().zip(&c.methods) {
                let Some(m) = result else { continue };
                let f1 = m.best.map_or(0.0, |best| best.f1);
                let over = m.separated.rmse_deg / m.separated.bound_deg;
                text += &format!(
                    "{},\"{}\",{},{},{},\"{name}\",{f1},{},{over}\n",
                    c.group.title().to_lowercase(),
                    c.name,
                    c.array,
                    c.targets,
                    c.snr_db,
                    m.strict_f1
                );
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &["hard.svg"];

    fn figures(&self) -> Vec<String> {
        vec![figures::hard(self)]
    }
}
