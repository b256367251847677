//! From records to tables.

use super::{ArraysExperiment, Tried, conditions};
use crate::aoa::cell::{AoaRecord, MethodRecord};
use crate::aoa::report::MethodResult;
use crate::aoa::stated::Stated;
use crate::entrants::Network;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ArraysReport {
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Snapshots a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Methods, then each network plain and refined.
    pub methods: Vec<String>,
    /// Which networks these are.
    pub networks: Vec<Network>,
    /// Results by array and number of targets.
    pub conditions: Vec<ArrayResult>,
}

/// An array with what each method reached.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ArrayResult {
    /// Which.
    pub array: Tried,
    /// Targets.
    pub targets: usize,
    /// Methods in order.
    pub methods: Vec<MethodResult>,
}

impl ArraysReport {
    pub(super) fn new(
        options: &ArraysExperiment,
        methods: &[String],
        records: impl Iterator<Item = AoaRecord>,
    ) -> Self {
        let conditions = conditions();
        let mut sums: Vec<Vec<MethodRecord>> = vec![vec![]; conditions.len()];
        for record in records {
            if let Some(sum) = sums.get_mut(record.condition) {
                MethodRecord::merge_all(sum, record.methods);
            }
        }
        let results = |sums: &Vec<MethodRecord>| {
            sums.iter().map(|record| MethodResult::new(record, None)).collect()
        };
        Self {
            snr_db: options.snr_db,
            trials: options.trials,
            seed: options.seed,
            methods: methods.to_vec(),
            networks: options.entrants.networks.clone(),
            conditions: conditions
                .iter()
                .zip(&sums)
                .map(|(&(array, targets), sums)| ArrayResult {
                    array,
                    targets,
                    methods: results(sums),
                })
                .collect(),
        }
    }

    /// What became of the deviations that a method stated on an array.
    pub fn stated(&self, method: usize, array: Tried) -> Stated {
        let mut sum = Stated::default();
        for condition in self.conditions.iter().filter(|condition| condition.array == array) {
            if let Some(result) = condition.methods.get(method) {
                sum.merge(&result.stated);
            }
        }
        sum
    }

    fn stated_tables(&self) -> Vec<Table> {
        let states = |method: usize| Tried::ALL.iter().any(|&a| !self.stated(method, a).is_empty());
        let named: Vec<(usize, &String)> =
            self.methods.iter().enumerate().filter(|(k, _)| states(*k)).collect();
        if named.is_empty() {
            return vec![];
        }
        let of = |(what, title): (usize, &str)| {
            Table::new(
                format!("Right {title} within one / two of the deviations stated, %"),
                Best::None,
                "method",
                Tried::ALL.map(Tried::name),
                named.iter().map(|(k, name)| {
                    let cell = |array| Cell::text(self.stated(*k, array).shown()[what].clone());
                    (name, Tried::ALL.map(cell).to_vec())
                }),
            )
        };
        ["azimuths", "powers"].into_iter().enumerate().map(of).collect()
    }
}

/// What tables and file have of a method: largest F1, and the root mean square error over the bound.
fn numbers(result: &MethodResult) -> [f64; 2] {
    let separated = result.separated;
    [result.best.map_or(0.0, |best| best.f1), separated.rmse_deg / separated.bound_deg]
}

impl boresight_validate::experiment::Report for ArraysReport {
    fn tables(&self) -> Tables {
        let remark = format!(
            "{} dB, {} snapshots a condition; right is 0.4 of half a beam.\n",
            self.snr_db, self.trials
        );
        let kinds = [
            ("Largest F1", Best::Largest, 3),
            ("Error over the Cramer-Rao bound, separated targets that were found", Best::None, 2),
        ];
        let of = |(what, (title, best, digits)): (usize, (&str, Best, usize))| {
            Table::new(
                format!("{title}, by array and number of targets"),
                best,
                "method",
                self.conditions.iter().map(|c| format!("{}, {}", c.array.name(), c.targets)),
                self.methods.iter().enumerate().map(|(k, name)| {
                    let cells = self.conditions.iter().map(|condition| {
                        let value = condition.methods.get(k).map(|m| numbers(m)[what]);
                        Cell::fixed(value.unwrap_or(f64::NAN), digits)
                    });
                    (name, cells.collect())
                }),
            )
        };
        let mut tables: Vec<Table> = kinds.into_iter().enumerate().map(of).collect();
        tables.extend(self.stated_tables());
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text = "array,targets,method,f1,error_over_bound,right,azimuth_one,azimuth_two,power_one,power_two\n".to_owned();
        for condition in &self.conditions {
            for (name, m) in self.methods.iter().zip(&condition.methods) {
                let (array, targets) = (condition.array.name(), condition.targets);
                let ([f1, over], s) = (numbers(m), m.stated);
                let [azimuth, power] =
                    [s.azimuth, s.power].map(|[one, two]| format!("{one},{two}"));
                text += &format!(
                    "{array},{targets},\"{name}\",{f1},{over},{},{azimuth},{power}\n",
                    s.predictions
                );
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &[];

    fn figures(&self) -> Vec<String> {
        vec![]
    }
}
