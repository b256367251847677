//! From records to tables.

use super::trial::{Found, LowSnrRecord};
use super::{LowSnrExperiment, SNAPSHOTS, SNRS_DB, conditions};
use crate::entrants::Network;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct LowSnrReport {
    /// Array.
    pub array: String,
    /// Trials a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Methods, then networks.
    pub methods: Vec<String>,
    /// Which networks these are.
    pub networks: Vec<Network>,
    /// Results by number of snapshots and signal-to-noise ratio.
    pub conditions: Vec<ConditionResult>,
}

/// Results of one condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConditionResult {
    /// Snapshots.
    pub snapshots: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Methods in order.
    pub methods: Vec<MethodResult>,
}

/// A method in one condition.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Share of trials in which both sources were found.
    pub found: f64,
    /// Root mean square error of the azimuths of these, deg; none where there are none.
    pub rmse_deg: Option<f64>,
    /// The same over the Cramer-Rao bound.
    pub over_bound: Option<f64>,
}

impl MethodResult {
    fn new(sum: &Found) -> Self {
        let some = sum.found > 0;
        Self {
            found: f64::from(sum.found) / f64::from(sum.trials.max(1)),
            rmse_deg: some.then(|| (sum.error_deg2 / (2.0 * f64::from(sum.found))).sqrt()),
            over_bound: some.then(|| (sum.error_deg2 / sum.bound_deg2).sqrt()),
        }
    }
}

impl LowSnrReport {
    pub(super) fn new(
        options: &LowSnrExperiment,
        methods: &[String],
        records: impl Iterator<Item = LowSnrRecord>,
    ) -> Self {
        let conditions = conditions();
        let mut sums = vec![vec![Found::default(); methods.len()]; conditions.len()];
        for record in records {
            let Some(sums) = sums.get_mut(record.condition) else { continue };
            sums.iter_mut().zip(&record.methods).for_each(|(sum, found)| sum.merge(found));
        }
        let of = |(&(snapshots, snr_db), sums): (&(usize, f64), &Vec<Found>)| ConditionResult {
            snapshots,
            snr_db,
            methods: sums.iter().map(MethodResult::new).collect(),
        };
        Self {
            array: options.array.clone(),
            trials: options.trials,
            seed: options.seed,
            methods: methods.to_vec(),
            networks: options.entrants.networks.clone(),
            conditions: conditions.iter().zip(&sums).map(of).collect(),
        }
    }

    /// A table of one number of snapshots.
    fn table(
        &self,
        title: String,
        best: Best,
        snapshots: usize,
        shown: impl Fn(MethodResult) -> Option<Cell>,
    ) -> Table {
        let row = |(k, name)| {
            let of = self.conditions.iter().filter(|condition| condition.snapshots == snapshots);
            let cell = |c: &ConditionResult| c.methods.get(k).and_then(|&method| shown(method));
            (name, of.map(|c| cell(c).unwrap_or(Cell::text("-"))).collect())
        };
        let heads = SNRS_DB.map(|snr_db| format!("{snr_db} dB"));
        Table::new(title, best, "method", heads, self.methods.iter().enumerate().map(row))
    }
}

impl boresight_validate::experiment::Report for LowSnrReport {
    fn tables(&self) -> Tables {
        let remark = format!("Array {}, {} trials a condition.\n", self.array, self.trials);
        let found = SNAPSHOTS.map(|snapshots| {
            let title = format!("Both sources within 2 deg, %, {snapshots} snapshots");
            self.table(title, Best::Largest, snapshots, |m| Some(Cell::percent(m.found)))
        });
        let errors = SNAPSHOTS.map(|snapshots| {
            let title = format!(
                "Error over the Cramer-Rao bound where both were found, {snapshots} snapshots"
            );
            self.table(title, Best::None, snapshots, |m| m.over_bound.map(Cell::short))
        });
        Tables { remark, tables: found.into_iter().chain(errors).collect() }
    }

    fn csv(&self) -> String {
        let mut text = "snapshots,snr_db,method,found,rmse_deg,error_over_bound\n".to_owned();
        for condition in &self.conditions {
            for (name, m) in self.methods.iter().zip(&condition.methods) {
                let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
                let (snapshots, snr_db) = (condition.snapshots, condition.snr_db);
                let (rmse, over) = (number(m.rmse_deg), number(m.over_bound));
                text += &format!("{snapshots},{snr_db},\"{name}\",{},{rmse},{over}\n", m.found);
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &[];

    fn figures(&self) -> Vec<String> {
        vec![]
    }
}
