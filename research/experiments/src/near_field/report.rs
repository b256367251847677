//! From records to tables and figures.

use super::trial::{DYNAMIC_RANGE_DB, NearFieldRecord, Plan};
use super::{NearFieldExperiment, POWERS_DB, RANGES};
use crate::deviation::Deviation;
use boresight_validate::plot::{Panel, Series, draw};
use boresight_validate::table::{Best, Cell, Table, Tables, short};
use serde::Serialize;

/// Error of azimuth within which a method counts as right, deg.
pub const RIGHT_DEG: f64 = 0.1;
/// Share of targets it must find for that.
pub const RIGHT_SHARE: f64 = 0.99;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct NearFieldReport {
    /// Array.
    pub array: String,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Snapshots a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Fraunhofer distance of the array, m.
    pub fraunhofer_m: f64,
    /// Methods.
    pub methods: Vec<String>,
    /// Results by number of targets, then range.
    pub conditions: Vec<ConditionResult>,
    /// For each number of targets the range, in Fraunhofer distances, from which on each method is right to
    /// [`RIGHT_DEG`]; none where it never is.
    pub right_from: Vec<Vec<Option<f64>>>,
}

/// Results for one number of targets at one range.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConditionResult {
    /// Targets.
    pub targets: usize,
    /// Range over the Fraunhofer distance; none for plane waves.
    pub range: Option<f64>,
    /// Methods.
    pub methods: Vec<MethodResult>,
}

/// A method in one condition.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Share of targets with an estimate within 0.5 deg, of as many of the strongest ones as there are targets.
    pub found: f64,
    /// Root mean square error of azimuth of these, deg.
    pub error_deg: f64,
    /// What their estimated power lacks of the true one in the mean, dB.
    pub power_loss_db: f64,
    /// Estimates a snapshot beside these.
    pub false_targets: f64,
}

impl MethodResult {
    fn new(sum: &Deviation) -> Self {
        Self {
            found: sum.share_found(),
            error_deg: sum.rms_error_deg(),
            power_loss_db: sum.power_loss_db(),
            false_targets: sum.false_rate(),
        }
    }

    fn is_right(&self) -> bool {
        self.found >= RIGHT_SHARE && self.error_deg <= RIGHT_DEG
    }
}

impl NearFieldReport {
    pub(super) fn new(
        options: &NearFieldExperiment,
        plan: &Plan,
        records: impl Iterator<Item = NearFieldRecord>,
    ) -> Self {
        let methods = plan.names();
        let none = vec![Deviation::default(); methods.len()];
        let mut sums = vec![none; POWERS_DB.len() * RANGES.len()];
        for record in records {
            let Some(sum) = sums.get_mut(record.condition) else { continue };
            sum.iter_mut().zip(&record.methods).for_each(|(to, from)| to.merge(from));
        }
        let all = POWERS_DB.iter().flat_map(|powers| RANGES.map(|range| (powers.len(), range)));
        let conditions: Vec<ConditionResult> = all
            .zip(&sums)
            .map(|((targets, range), sum)| ConditionResult {
                targets,
                range,
                methods: sum.iter().map(MethodResult::new).collect(),
            })
            .collect();
        let right_from = conditions.chunks_exact(RANGES.len()).map(|of_number| {
            (0..methods.len()).map(|method| right_from(of_number, method)).collect()
        });
        Self {
            array: options.array.clone(),
            snr_db: options.snr_db,
            trials: options.trials,
            seed: options.seed,
            fraunhofer_m: plan.fraunhofer_m,
            right_from: right_from.collect(),
            methods,
            conditions,
        }
    }

    /// Results for one number of targets, by range.
    fn of_number(&self, number: usize) -> &[ConditionResult] {
        self.conditions.chunks_exact(RANGES.len()).nth(number).unwrap_or_default()
    }
}

/// The least range tried from which on a method is right.
fn right_from(conditions: &[ConditionResult], method: usize) -> Option<f64> {
    let right = |c: &&ConditionResult| c.methods.get(method).is_some_and(MethodResult::is_right);
    conditions.iter().rev().take_while(right).last()?.range
}

/// Quantity of a method: label, which axes are logarithmic, better direction and value.
type Shown = (&'static str, [bool; 2], Best, fn(&MethodResult) -> f64);

const SHOWN: [Shown; 4] = [
    ("rms error of azimuth / deg", [true; 2], Best::None, |m| m.error_deg),
    ("share of targets found", [true, false], Best::Largest, |m| m.found),
    ("false targets a snapshot", [true, false], Best::Smallest, |m| m.false_targets),
    ("mean loss of estimated power / dB", [true, false], Best::None, |m| m.power_loss_db),
];

/// A number of targets in words.
fn counted(targets: usize) -> String {
    format!("{targets} target{}", if targets == 1 { "" } else { "s" })
}

impl boresight_validate::experiment::Report for NearFieldReport {
    fn tables(&self) -> Tables {
        let remark = format!(
            "Array {}, Fraunhofer distance {:.2} m, {} dB, {} snapshots a condition. Estimates count down to \
             {DYNAMIC_RANGE_DB} dB below the strongest.\n",
            self.array, self.fraunhofer_m, self.snr_db, self.trials
        );
        let range = |range: &Option<f64>| {
            Cell::text(
                range.map_or("-".into(), |r| format!("{r} ({})", short(r * self.fraunhofer_m))),
            )
        };
        let right_from = Table::new(
            format!(
                "Range in Fraunhofer distances (m) from which on the rms error is at most {RIGHT_DEG} deg and {:.0} % of \
                 targets are found.",
                100.0 * RIGHT_SHARE
            ),
            Best::None,
            "method",
            POWERS_DB.map(|powers| counted(powers.len())),
            self.methods.iter().enumerate().map(|(k, name)| {
                (name, self.right_from.iter().map(|of_number| range(&of_number[k])).collect())
            }),
        );
        let mut tables = vec![right_from];
        for (number, powers) in POWERS_DB.iter().enumerate() {
            let conditions = self.of_number(number);
            for (label, best, value) in SHOWN.map(|(label, _, best, value)| (label, best, value)) {
                tables.push(Table::new(
                    format!(
                        "{}: {label}, by range over the Fraunhofer distance.",
                        counted(powers.len())
                    ),
                    best,
                    "method",
                    conditions.iter().map(|c| c.range.map_or("plane".into(), |r| r.to_string())),
                    self.methods.iter().enumerate().map(|(k, name)| {
                        let cells = conditions.iter().map(|c| Cell::short(value(&c.methods[k])));
                        (name, cells.collect())
                    }),
                ));
            }
        }
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text =
            "targets,range,range_m,method,found,error_deg,power_loss_db,false_targets\n".to_owned();
        for c in &self.conditions {
            let range = c.range.map_or(f64::INFINITY, |range| range);
            for (name, m) in self.methods.iter().zip(&c.methods) {
                text += &format!(
                    "{},{range},{},\"{name}\",{},{},{},{}\n",
                    c.targets,
                    range * self.fraunhofer_m,
                    m.found,
                    m.error_deg,
                    m.power_loss_db,
                    m.false_targets
                );
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &["near-field.svg"];

    fn figures(&self) -> Vec<String> {
        let mut panels = vec![];
        for (label, logarithmic, _, value) in SHOWN {
            for (number, powers) in POWERS_DB.iter().enumerate() {
                let line = |(k, name): (usize, &String)| {
                    let point = |c: &ConditionResult| {
                        let y = value(&c.methods[k]);
                        let drawn = y.is_finite() && (y > 0.0 || !logarithmic[1]);
                        drawn.then_some((c.range?, y))
                    };
                    let points = self.of_number(number).iter().filter_map(point).collect();
                    let dashed = name.contains("refined");
                    Series { name: name.clone(), points, dashed, marked: true }
                };
                panels.push(Panel {
                    title: counted(powers.len()),
                    x: "range / Fraunhofer distance".into(),
                    y: label.into(),
                    logarithmic,
                    series: self.methods.iter().enumerate().map(line).collect(),
                    ..Panel::default()
                });
            }
        }
        vec![draw(&panels, 2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_is_right_from_where_it_never_is_wrong_again() {
        let result = |found, error_deg| MethodResult {
            found,
            error_deg,
            power_loss_db: 0.0,
            false_targets: 0.0,
        };
        let of = |results: [MethodResult; 4]| {
            let ranges = [Some(0.5), Some(1.0), Some(2.0), None];
            let conditions = ranges.into_iter().zip(results).map(|(range, result)| {
                ConditionResult { targets: 1, range, methods: vec![result] }
            });
            right_from(&conditions.collect::<Vec<_>>(), 0)
        };
        let (good, off, missed) = (result(1.0, 0.05), result(1.0, 0.2), result(0.9, 0.05));
        assert_eq!(of([good; 4]), Some(0.5));
        assert_eq!(of([good, off, good, good]), Some(2.0));
        assert_eq!(of([good, good, missed, good]), None);
        assert_eq!(of([good, good, good, result(f64::NAN, f64::NAN)]), None);
    }
}
