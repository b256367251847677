//! From records to tables.

use super::cost::{Form, of_method};
use super::trial::{Plan, StraddlingRecord, VariantRecord};
use super::{CONDITIONS, Condition, GRIDS, StraddlingExperiment, figures};
use crate::apart::half_beam;
use boresight_aoa::Method;
use boresight_validate::table::{Best, Cell, Table, Tables, short};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct StraddlingReport {
    /// Array.
    pub array: String,
    /// Snapshots a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Numbers of points of the grids.
    pub grids: Vec<usize>,
    /// Width of the main beam on boresight between its first zeros over the step of each grid.
    pub points_a_beam: Vec<f64>,
    /// Operations of IAA in its dense form on each grid, by formula.
    pub iaa_dense_operations: Vec<f64>,
    /// Results by condition.
    pub conditions: Vec<ConditionResult>,
}

/// Results in one condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConditionResult {
    /// The condition.
    #[serde(flatten)]
    pub condition: Condition,
    /// Root mean square of the azimuth's standard deviation at the bound, deg.
    pub bound_deg: f64,
    /// Methods.
    pub methods: Vec<MethodResult>,
}

/// A method in one condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Name.
    pub name: String,
    /// One of each grid, or a single one of what knows no grid.
    pub results: Vec<GridResult>,
}

/// A method on one grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct GridResult {
    /// Points of the grid, if it has one.
    pub grid: Option<usize>,
    /// Share of targets found.
    pub found: f64,
    /// What a beam loses that is steered to the estimate instead of the target: in the mean, at most, dB.
    pub straddling_db: [f64; 2],
    /// What the estimated power lacks of the true one: in the mean, at most, dB.
    pub power_loss_db: [f64; 2],
    /// Error of azimuth: root mean square, largest, deg.
    pub error_deg: [f64; 2],
    /// Operations a snapshot, by formula.
    pub operations: Option<f64>,
}

impl GridResult {
    fn new(grid: Option<usize>, record: &VariantRecord) -> Self {
        let d = &record.deviation;
        Self {
            grid,
            found: d.share_found(),
            straddling_db: [d.beam_loss_db(), d.beam.largest_loss_db()],
            power_loss_db: [d.power_loss_db(), d.power.largest_loss_db()],
            error_deg: [d.rms_error_deg(), d.largest_error_deg],
            operations: record.operations,
        }
    }
}

impl StraddlingReport {
    pub(super) fn new(
        options: &StraddlingExperiment,
        plan: &Plan,
        records: impl Iterator<Item = StraddlingRecord>,
    ) -> Self {
        let mut sums: Vec<Option<StraddlingRecord>> = vec![None; CONDITIONS.len()];
        for record in records {
            match sums.get_mut(record.condition) {
                Some(Some(sum)) => {
                    sum.bound_deg2 += record.bound_deg2;
                    let variants = sum.variants.iter_mut().zip(&record.variants);
                    variants.for_each(|(to, from)| to.deviation.merge(&from.deviation));
                }
                Some(empty) => *empty = Some(record),
                None => {}
            }
        }
        let conditions = CONDITIONS.into_iter().zip(sums);
        let conditions = conditions.filter_map(|(condition, sum)| {
            let sum = sum?;
            let mut variants = sum.variants.iter();
            let methods = plan.lines().iter().map(|line| {
                let grids = line.grids().into_iter().zip(variants.by_ref());
                MethodResult {
                    name: line.name(),
                    results: grids.map(|(grid, record)| GridResult::new(grid, record)).collect(),
                }
            });
            let methods = methods.collect();
            let bound_deg = (sum.bound_deg2 / options.trials as f64).sqrt();
            Some(ConditionResult { condition, bound_deg, methods })
        });
        let beam = 2.0 * half_beam(&plan.array);
        let dense = |grid| of_method(Method::Iaa, Form::Dense, &plan.array, Some(grid));
        Self {
            array: options.array.clone(),
            trials: options.trials,
            seed: options.seed,
            grids: GRIDS.to_vec(),
            points_a_beam: GRIDS.map(|grid| beam * grid as f64 / 2.0).to_vec(),
            iaa_dense_operations: GRIDS.into_iter().filter_map(dense).collect(),
            conditions: conditions.collect(),
        }
    }

    /// A table of one number of each method on each grid.
    fn table(
        &self,
        title: String,
        best: Best,
        condition: &ConditionResult,
        value: impl Fn(&GridResult) -> Cell,
    ) -> Table {
        let row = |method: &MethodResult| {
            let of = |grid: Option<usize>| {
                let found = method.results.iter().find(|result| result.grid == grid);
                found.map_or(Cell::text(""), &value)
            };
            [None].into_iter().chain(GRIDS.map(Some)).map(of).collect()
        };
        Table::new(
            title,
            best,
            "points of the grid",
            ["any".to_owned()].into_iter().chain(GRIDS.map(|grid| grid.to_string())),
            condition.methods.iter().map(|m| (&m.name, row(m))),
        )
    }
}

impl boresight_validate::experiment::Report for StraddlingReport {
    fn tables(&self) -> Tables {
        let per: Vec<String> = self.points_a_beam.iter().map(|x| format!("{x:.1}")).collect();
        let remark = format!(
            "Array {}, {} snapshots a condition. Without a grid: under \"any\".\n\nPoints of the grids on the main beam, \
             between its first zeros: {}.\n",
            self.array,
            self.trials,
            per.join(", ")
        );
        let both = |[mean, most]: [f64; 2]| {
            Cell::shown(mean, format!("{} ({})", short(mean), short(most)))
        };
        let mut tables = vec![];
        for condition in &self.conditions {
            let Condition { snr_db, weak_db } = condition.condition;
            if let Some(weak_db) = weak_db {
                let title = format!(
                    "Share of targets of {weak_db} dB found beside one of 0 dB, at {snr_db} dB."
                );
                let found = |r: &GridResult| Cell::fixed(r.found, 3);
                tables.push(self.table(title, Best::Largest, condition, found));
                continue;
            }
            let title =
                format!("Straddling loss, dB, in the mean (at most), one target at {snr_db} dB.");
            tables.push(self.table(title, Best::None, condition, |r| both(r.straddling_db)));
            let title = format!(
                "Loss of the estimated power, dB, in the mean (at most), one target at {snr_db} dB."
            );
            tables.push(self.table(title, Best::None, condition, |r| both(r.power_loss_db)));
            let title = format!(
                "Error of azimuth, deg, root mean square (largest), one target at {snr_db} dB; at the bound {}.",
                short(condition.bound_deg)
            );
            tables.push(self.table(title, Best::Smallest, condition, |r| both(r.error_deg)));
        }
        if let Some(first) = self.conditions.first() {
            let millions = |x: f64| Cell::text(short(1e-6 * x));
            let title = "Operations a snapshot by formula, millions.".to_owned();
            let mut table = self.table(title, Best::None, first, |r| {
                r.operations.map_or(Cell::text("-"), millions)
            });
            let dense = self.iaa_dense_operations.iter().map(|&x| millions(x));
            let cells = [Cell::text("")].into_iter().chain(dense).collect();
            table.rows.push(("iaa, dense form".into(), cells));
            tables.push(table);
        }
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text = "snr_db,weak_db,method,grid,found,straddling_db,largest_straddling_db,\
                        power_loss_db,largest_power_loss_db,error_deg,largest_error_deg,operations\n"
            .to_owned();
        for c in &self.conditions {
            let Condition { snr_db, weak_db } = c.condition;
            let weak = weak_db.map_or(String::new(), |db| db.to_string());
            for m in &c.methods {
                for r in &m.results {
                    let grid = r.grid.map_or(String::new(), |grid| grid.to_string());
                    let operations = r.operations.map_or(String::new(), |x| x.to_string());
                    let [loss, worst] = r.straddling_db;
                    let [power, worst_power] = r.power_loss_db;
                    let [error, largest] = r.error_deg;
                    text += &format!(
                        "{snr_db},{weak},\"{}\",{grid},{},{loss},{worst},{power},{worst_power},{error},{largest},{operations}\n",
                        m.name, r.found
                    );
                }
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &["straddling.svg"];

    fn figures(&self) -> Vec<String> {
        vec![figures::straddling(self)]
    }
}
