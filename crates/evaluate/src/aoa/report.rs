//! From records to curves and tables.

use super::cell::{AoaRecord, MethodRecord};
use super::score::{Operating, Score, one_threshold_db, point_at};
use super::stated::Stated;
use super::{AoaExperiment, CONDITIONS, Condition, SNRS_DB, TARGETS, figures};
use crate::EvaluateError;
use crate::entrants::Network;
use crate::experiment::brief;
use crate::statistics::Summary;
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
    /// Further snapshots a condition, on which the one threshold of each method was found.
    pub validation: u64,
    /// Seed.
    pub seed: u64,
    /// Methods, then each network plain and refined.
    pub methods: Vec<String>,
    /// The threshold of each method, the same in all conditions: where the mean over conditions of its F1 is largest on
    /// the snapshots for that, dB; `None` without predictions.
    pub thresholds_db: Vec<Option<f64>>,
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
    /// At the method's one threshold; `None` without predictions above it.
    pub at_one_threshold: Option<Operating>,
    /// Precision against recall.
    pub curve: Vec<Operating>,
    /// Separated targets: root mean square error and bound, deg, over those found; how many were, and of
    /// how many.
    pub separated: Separated,
    /// What became of the deviations stated; absent where none were.
    #[serde(skip_serializing_if = "Stated::is_empty")]
    pub stated: Stated,
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
        let mut sums: Vec<Vec<MethodRecord>> = vec![vec![]; 2 * CONDITIONS];
        for AoaRecord { condition, methods } in records {
            if let Some(sum) = sums.get_mut(condition) {
                MethodRecord::merge_all(sum, methods);
            }
        }
        let (scored, validation) = sums.split_at(CONDITIONS);
        let thresholds_db: Vec<Option<f64>> = (0..methods.len())
            .map(|k| {
                let of_method = validation.iter().filter_map(|sums| sums.get(k));
                let scores: Vec<Score> = of_method.map(|m| m.score.clone()).collect();
                one_threshold_db(&scores)
            })
            .collect();
        let results = |sums: &Vec<MethodRecord>| {
            let methods = sums.iter().zip(&thresholds_db);
            methods.map(|(m, threshold_db)| MethodResult::new(m, *threshold_db)).collect()
        };
        let conditions = conditions
            .iter()
            .zip(scored)
            .map(|(condition, sums)| ConditionResult {
                targets: condition.targets,
                snr_db: condition.snr_db,
                methods: results(sums),
            })
            .collect();
        Self {
            array: options.array.clone(),
            trials: options.trials,
            validation: options.validation,
            seed: options.seed,
            methods: methods.to_vec(),
            thresholds_db,
            networks: options.entrants.networks.clone(),
            conditions,
        }
    }

    /// Of a method its one threshold and means over conditions: the largest F1, F1 and strict F1 at that threshold.
    fn means(&self, method: usize) -> Vec<String> {
        let mean = |value: fn(&MethodResult) -> Option<f64>| {
            let of_method = self.conditions.iter().filter_map(|c| c.methods.get(method));
            let all: Vec<f64> = of_method.map(|m| value(m).unwrap_or(0.0)).collect();
            shown(Some(Summary::of(&all).mean), 4)
        };
        vec![
            shown(self.thresholds_db.get(method).copied().flatten(), 2),
            mean(|m| Some(m.best?.f1)),
            mean(|m| Some(m.at_one_threshold?.f1)),
            mean(|m| Some(m.at_one_threshold?.strict_f1)),
        ]
    }

    /// What became of the deviations that a method stated, over all conditions or those of one ratio.
    pub fn stated(&self, method: usize, snr_db: Option<f64>) -> Stated {
        let mut sum = Stated::default();
        for condition in &self.conditions {
            if snr_db.is_none_or(|snr_db| condition.snr_db == snr_db)
                && let Some(result) = condition.methods.get(method)
            {
                sum.merge(&result.stated);
            }
        }
        sum
    }

    /// The table of it; nothing where no method states deviations.
    fn stated_table(&self) -> String {
        let levels: Vec<Option<f64>> =
            std::iter::once(None).chain(DRAWN_DB.into_iter().map(Some)).collect();
        let heads: Vec<String> = ["azimuth", "power"]
            .iter()
            .flat_map(|what| {
                levels.iter().map(move |level| match level {
                    Some(snr_db) => format!("{what}, {snr_db} dB"),
                    None => format!("{what}, all"),
                })
            })
            .collect();
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        let rows: Vec<(&str, Vec<String>)> = self
            .methods
            .iter()
            .enumerate()
            .filter(|(k, _)| !self.stated(*k, None).is_empty())
            .map(|(k, name)| {
                let stated: Vec<Stated> =
                    levels.iter().map(|&level| self.stated(k, level)).collect();
                let shown: Vec<[String; 2]> = stated.iter().map(Stated::shown).collect();
                let of = |what: usize| shown.iter().map(move |both| both[what].clone());
                (name.as_str(), of(0).chain(of(1)).collect())
            })
            .collect();
        if rows.is_empty() {
            return String::new();
        }
        let title = "Right predictions within one / two of the deviations they state, %";
        format!("\n{title}\n\n{}", table("method", &heads, &rows))
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
        let mut text = format!(
            "Array {}, {} snapshots a condition; thresholds from {} others.\n",
            self.array, self.trials, self.validation
        );
        text += "\nOne threshold a method, dB, and the mean over all conditions of its F1\n\n";
        let rows: Vec<(&str, Vec<String>)> = self
            .methods
            .iter()
            .enumerate()
            .map(|(k, name)| (name.as_str(), self.means(k)))
            .collect();
        text += &table(
            "method",
            &["threshold", "largest F1", "F1 at the threshold", "strict F1 at the threshold"],
            &rows,
        );
        text += &self.stated_table();
        type Value = fn(&MethodResult) -> Option<f64>;
        let kinds: [(&str, usize, Value); 8] = [
            ("Largest F1", 4, |m| Some(m.best?.f1)),
            ("F1 at one threshold", 4, |m| Some(m.at_one_threshold?.f1)),
            ("Strict F1 at one threshold", 4, |m| Some(m.at_one_threshold?.strict_f1)),
            ("Precision at one threshold", 4, |m| Some(m.at_one_threshold?.precision)),
            ("Recall at one threshold", 4, |m| Some(m.at_one_threshold?.recall)),
            ("Mean error of angle at one threshold, deg", 4, |m| {
                Some(m.at_one_threshold?.angle_error_deg)
            }),
            ("Mean error of power at one threshold, dB", 2, |m| {
                Some(m.at_one_threshold?.power_error_db)
            }),
            ("Error over the Cramer-Rao bound, separated targets", 2, |m| {
                Some(m.separated.rmse_deg / m.separated.bound_deg)
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
                            shown(self.at(targets, snr_db, k).and_then(value), digits)
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
                        power_error_db,separated_rmse_deg,bound_deg,separated_found,separated_targets,\
                        one_threshold_db,one_precision,one_recall,one_f1,one_strict_f1,one_angle_error_deg,\
                        one_power_error_db\n"
            .to_owned();
        for condition in &self.conditions {
            let named = self.methods.iter().zip(&self.thresholds_db).zip(&condition.methods);
            let of = |point: Option<Operating>, value: fn(&Operating) -> f64| {
                point.as_ref().map_or(String::new(), |point| value(point).to_string())
            };
            for ((name, one_db), m) in named {
                let s = m.separated;
                let numbers = [
                    of(m.best, |p| p.threshold_db),
                    of(m.best, |p| p.precision),
                    of(m.best, |p| p.recall),
                    of(m.best, |p| p.f1),
                    m.strict_f1.to_string(),
                    of(m.best, |p| p.angle_error_deg),
                    of(m.best, |p| p.power_error_db),
                    s.rmse_deg.to_string(),
                    s.bound_deg.to_string(),
                    s.found.to_string(),
                    s.targets.to_string(),
                    one_db.map_or(String::new(), |db| db.to_string()),
                    of(m.at_one_threshold, |p| p.precision),
                    of(m.at_one_threshold, |p| p.recall),
                    of(m.at_one_threshold, |p| p.f1),
                    of(m.at_one_threshold, |p| p.strict_f1),
                    of(m.at_one_threshold, |p| p.angle_error_deg),
                    of(m.at_one_threshold, |p| p.power_error_db),
                ];
                let (targets, snr_db) = (condition.targets, condition.snr_db);
                text += &format!("\"{name}\",{targets},{snr_db},{}\n", numbers.join(","));
            }
        }
        text
    }

    /// Of the curves some, with fewer points; at the one threshold the scores.
    fn brief(&self) -> String {
        let mut all = json!(self);
        for (condition, result) in self.conditions.iter().zip(items(&mut all["conditions"])) {
            let drawn = DRAWN_DB.contains(&condition.snr_db);
            for (method, result) in condition.methods.iter().zip(items(&mut result["methods"])) {
                let points = if drawn { thinned(&method.curve) } else { vec![] };
                let point = |p: &Operating| json!({ "precision": p.precision, "recall": p.recall, "f1": p.f1 });
                result["curve"] = points.into_iter().map(point).collect();
                result["atOneThreshold"] = json!(method.at_one_threshold.as_ref().map(point));
            }
        }
        brief(all)
    }

    const FIGURES: &'static [&'static str] = &["precision-recall.svg", "scores.svg"];

    fn figures(&self) -> Result<Vec<String>, EvaluateError> {
        Ok(vec![figures::precision_recall(self)?, figures::scores(self)?])
    }
}

fn shown(value: Option<f64>, digits: usize) -> String {
    value.filter(|v| v.is_finite()).map_or_else(|| "-".into(), |v| format!("{v:.digits$}"))
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
    /// Adds another part of a condition, method by method; the first part is that of a condition not begun.
    pub(crate) fn merge_all(sums: &mut Vec<Self>, others: Vec<Self>) {
        if sums.is_empty() {
            *sums = others;
            return;
        }
        for (to, from) in sums.iter_mut().zip(&others) {
            to.merge(from);
        }
    }

    /// Adds another part of the condition.
    fn merge(&mut self, other: &Self) {
        self.score.merge(&other.score);
        self.separated.0 += other.separated.0;
        self.separated.1 += other.separated.1;
        self.separated.2 += other.separated.2;
        self.separated_targets += other.separated_targets;
        self.stated.merge(&other.stated);
    }
}

impl MethodResult {
    /// From the record of a method, and its one threshold.
    pub(crate) fn new(record: &MethodRecord, threshold_db: Option<f64>) -> Self {
        let curve = record.score.curve();
        let (errors, bounds, found) = record.separated;
        let rms = |sum: f64| if found > 0 { (sum / f64::from(found)).sqrt() } else { f64::NAN };
        Self {
            best: record.score.best(),
            at_one_threshold: threshold_db.and_then(|db| point_at(&curve, db)),
            strict_f1: curve.iter().map(|point| point.strict_f1).fold(0.0, f64::max),
            curve,
            separated: Separated {
                rmse_deg: rms(errors),
                bound_deg: rms(bounds),
                found,
                targets: record.separated_targets,
            },
            stated: record.stated,
        }
    }
}
