//! From records to curves and tables.

use super::cell::{AoaRecord, MethodRecord};
use super::score::Operating;
use super::{AoaExperiment, Condition, SNRS_DB, TARGETS, figures};
use crate::EvaluateError;
use crate::entrants::Network;
use crate::experiment::brief;
use crate::table::table;
use serde::Serialize;
use serde_json::{Value, json};

/// Signal-to-noise ratios of tables and drawn curves, dB.
const DRAWN_DB: [f64; 3] = [SNRS_DB[0], SNRS_DB[2], SNRS_DB[4]];

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct AoaReport {
    /// Array.
    pub array: String,
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
    /// Targets.
    pub targets: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Methods in order.
    pub methods: Vec<MethodResult>,
}

/// What a method reached in a condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Where F1 is largest; `None` without predictions.
    pub best: Option<Operating>,
    /// Largest strict F1.
    pub strict_f1: f64,
    /// Precision against recall.
    pub curve: Vec<Operating>,
    /// Separated targets: root mean square error and bound, deg, over those found; how many were, and of
    /// how many.
    pub separated: Separated,
}

/// Accuracy on targets that stand apart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Separated {
    /// Root mean square error, deg.
    pub rmse_deg: f64,
    /// Cramer-Rao bound, deg.
    pub bound_deg: f64,
    /// Found.
    pub found: u32,
    /// In all.
    pub targets: u32,
}

impl AoaReport {
    /// From the records.
    pub fn new(
        options: &AoaExperiment,
        methods: &[String],
        records: impl Iterator<Item = AoaRecord>,
    ) -> Self {
        let conditions = Condition::all();
        let mut sums: Vec<Vec<MethodRecord>> = vec![vec![]; conditions.len()];
        for AoaRecord { condition, methods } in records {
            let Some(sum) = sums.get_mut(condition) else { continue };
            if sum.is_empty() {
                *sum = methods;
                continue;
            }
            for (to, from) in sum.iter_mut().zip(&methods) {
                to.merge(from);
            }
        }
        Self {
            array: options.array.clone(),
            trials: options.trials,
            seed: options.seed,
            methods: methods.to_vec(),
            networks: options.entrants.networks.clone(),
            conditions: conditions
                .iter()
                .zip(&sums)
                .map(|(condition, sums)| ConditionResult {
                    targets: condition.targets,
                    snr_db: condition.snr_db,
                    methods: sums.iter().map(MethodResult::new).collect(),
                })
                .collect(),
        }
    }

    /// The result of a method in a condition.
    pub fn at(&self, targets: usize, snr_db: f64, method: usize) -> Option<&MethodResult> {
        self.conditions
            .iter()
            .find(|c| c.targets == targets && c.snr_db == snr_db)
            .and_then(|condition| condition.methods.get(method))
    }
}

impl crate::experiment::Report for AoaReport {
    fn tables(&self) -> String {
        let mut text = format!("Array {}, {} snapshots a condition.\n", self.array, self.trials);
        let none = f64::NAN;
        type Value = fn(&MethodResult) -> f64;
        let kinds: [(&str, usize, Value); 5] = [
            ("Largest F1", 4, |m| m.best.map_or(f64::NAN, |best| best.f1)),
            ("Largest F1 with one prediction a target", 4, |m| m.strict_f1),
            ("Mean error of angle at the largest F1, deg", 4, |m| {
                m.best.map_or(f64::NAN, |best| best.angle_error_deg)
            }),
            ("Mean error of power at the largest F1, dB", 2, |m| {
                m.best.map_or(f64::NAN, |best| best.power_error_db)
            }),
            ("Error over the Cramer-Rao bound, separated targets", 2, |m| {
                m.separated.rmse_deg / m.separated.bound_deg
            }),
        ];
        let heads: Vec<String> = TARGETS.iter().map(|n| format!("{n} targets")).collect();
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        for (title, digits, value) in kinds {
            for snr_db in DRAWN_DB {
                text += &format!("\n{title}, {snr_db} dB\n\n");
                let rows: Vec<(&str, Vec<String>)> = self
                    .methods
                    .iter()
                    .enumerate()
                    .map(|(k, name)| {
                        let cells = TARGETS.iter().map(|&targets| {
                            let value = self.at(targets, snr_db, k).map_or(none, value);
                            if value.is_finite() { format!("{value:.digits$}") } else { "-".into() }
                        });
                        (name.as_str(), cells.collect())
                    })
                    .collect();
                text += &table("method", &heads, &rows);
            }
        }
        text
    }

    fn csv(&self) -> String {
        let mut text = "method,targets,snr_db,threshold_db,precision,recall,f1,strict_f1,angle_error_deg,\
                        power_error_db,separated_rmse_deg,bound_deg,separated_found,separated_targets\n"
            .to_owned();
        for condition in &self.conditions {
            for (name, m) in self.methods.iter().zip(&condition.methods) {
                let (b, s) = (m.best, m.separated);
                let of = |value: fn(&Operating) -> f64| {
                    b.as_ref().map_or(String::new(), |best| value(best).to_string())
                };
                text += &format!(
                    "\"{name}\",{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                    condition.targets,
                    condition.snr_db,
                    of(|b| b.threshold_db),
                    of(|b| b.precision),
                    of(|b| b.recall),
                    of(|b| b.f1),
                    m.strict_f1,
                    of(|b| b.angle_error_deg),
                    of(|b| b.power_error_db),
                    s.rmse_deg,
                    s.bound_deg,
                    s.found,
                    s.targets,
                );
            }
        }
        text
    }

    /// Of the curves some, with fewer points.
    fn brief(&self) -> String {
        let mut all = json!(self);
        for (condition, result) in self.conditions.iter().zip(items(&mut all["conditions"])) {
            let drawn = DRAWN_DB.contains(&condition.snr_db);
            for (method, result) in condition.methods.iter().zip(items(&mut result["methods"])) {
                let points = if drawn { thinned(&method.curve) } else { vec![] };
                let point = |p: &Operating| json!({ "precision": p.precision, "recall": p.recall, "f1": p.f1 });
                result["curve"] = points.into_iter().map(point).collect();
            }
        }
        brief(all)
    }

    const FIGURES: &'static [&'static str] = &["precision-recall.svg", "scores.svg"];

    fn figures(&self) -> Result<Vec<String>, EvaluateError> {
        Ok(vec![figures::precision_recall(self)?, figures::scores(self)?])
    }
}

fn items(value: &mut Value) -> impl Iterator<Item = &mut Value> {
    value.as_array_mut().into_iter().flatten()
}

/// Some points of a curve: both ends, that of the largest F1, and those two hundredths or more from the one before.
fn thinned(curve: &[Operating]) -> Vec<&Operating> {
    let best = curve.iter().map(|p| p.f1).fold(0.0, f64::max);
    let mut points: Vec<&Operating> = vec![];
    for (k, point) in curve.iter().enumerate() {
        let far = points.last().is_none_or(|last| {
            (last.precision - point.precision).hypot(last.recall - point.recall) >= 0.02
        });
        if far || k + 1 == curve.len() || point.f1 == best {
            points.push(point);
        }
    }
    points
}

impl MethodRecord {
    /// Adds another part of the condition.
    fn merge(&mut self, other: &Self) {
        self.score.merge(&other.score);
        self.separated.0 += other.separated.0;
        self.separated.1 += other.separated.1;
        self.separated.2 += other.separated.2;
        self.separated_targets += other.separated_targets;
    }
}

impl MethodResult {
    fn new(record: &MethodRecord) -> Self {
        let curve = record.score.curve();
        let (errors, bounds, found) = record.separated;
        let rms = |sum: f64| if found > 0 { (sum / f64::from(found)).sqrt() } else { f64::NAN };
        Self {
            best: record.score.best(),
            strict_f1: curve.iter().map(|point| point.strict_f1).fold(0.0, f64::max),
            curve,
            separated: Separated {
                rmse_deg: rms(errors),
                bound_deg: rms(bounds),
                found,
                targets: record.separated_targets,
            },
        }
    }
}
