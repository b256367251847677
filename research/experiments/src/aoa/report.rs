//! From records to curves and tables.

use super::cell::{AoaRecord, MethodRecord};
use super::score::{Operating, Score, one_threshold_db, point_at};
use super::stated::Stated;
use super::{AoaExperiment, figures};
use crate::entrants::Network;
use boresight_validate::experiment::brief;
use boresight_validate::statistics::Summary;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;
use serde_json::{Value, json};

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
    /// Difference between the strongest and the weakest target, dB.
    pub spread_db: f64,
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
        let conditions = options.conditions();
        let mut sums: Vec<Vec<MethodRecord>> = vec![vec![]; 2 * conditions.len()];
        for AoaRecord { condition, methods } in records {
            if let Some(sum) = sums.get_mut(condition) {
                MethodRecord::merge_all(sum, methods);
            }
        }
        let (scored, validation) = sums.split_at(conditions.len());
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
            spread_db: options.spread_db,
            methods: methods.to_vec(),
            thresholds_db,
            networks: options.entrants.networks.clone(),
            conditions,
        }
    }

    /// Of a method its one threshold and means over conditions: the largest F1, F1 and strict F1 at that threshold.
    fn means(&self, method: usize) -> [f64; 4] {
        let mean = |value: fn(&MethodResult) -> Option<f64>| {
            let of_method = self.conditions.iter().filter_map(|c| c.methods.get(method));
            let all: Vec<f64> = of_method.map(|m| value(m).unwrap_or(0.0)).collect();
            Summary::of(&all).mean
        };
        [
            self.thresholds_db.get(method).copied().flatten().unwrap_or(f64::NAN),
            mean(|m| Some(m.best?.f1)),
            mean(|m| Some(m.at_one_threshold?.f1)),
            mean(|m| Some(m.at_one_threshold?.strict_f1)),
        ]
    }

    /// In how many conditions the largest F1 of a method is more than that of `iaa`; a dash where that was not run.
    fn ahead_of_iaa(&self, method: &str) -> String {
        let at = |wanted: &str| self.methods.iter().position(|name| name == wanted);
        let (Some(iaa), Some(method)) = (at("iaa"), at(method)) else { return "-".into() };
        let f1 = |c: &ConditionResult, k: usize| c.methods[k].best.map_or(0.0, |best| best.f1);
        let ahead = self.conditions.iter().filter(|c| f1(c, method) > f1(c, iaa)).count();
        format!("{ahead} of {}", self.conditions.len())
    }

    /// The table of it, with how far each method is behind the one of the largest mean.
    fn means_table(&self) -> Table {
        let means: Vec<[f64; 4]> = (0..self.methods.len()).map(|k| self.means(k)).collect();
        let most = means.iter().map(|[_, largest, ..]| *largest).fold(0.0, f64::max);
        let rows = self.methods.iter().zip(means).map(|(name, [threshold_db, f1, one, strict])| {
            let threshold = match threshold_db.is_finite() {
                true => format!("{threshold_db:.2}"),
                false => "-".into(),
            };
            let shares = [f1, most - f1, one, strict].map(|share| Cell::fixed(share, 4));
            let ahead = self.ahead_of_iaa(name);
            let cells =
                [Cell::text(threshold)].into_iter().chain(shares).chain([Cell::text(ahead)]);
            (name, cells.collect())
        });
        let title = "One threshold a method, dB, and the mean over all conditions of its F1";
        let heads = [
            "threshold",
            "largest F1",
            "behind",
            "F1 at the threshold",
            "strict F1 at the threshold",
            "conditions ahead of iaa",
        ];
        let table = Table::new(title, Best::None, "method", heads, rows);
        Table { errors_in_cells: true, ..table }
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
    fn stated_table(&self) -> Option<Table> {
        let levels: Vec<Option<f64>> =
            std::iter::once(None).chain(self.drawn_db().into_iter().map(Some)).collect();
        let heads = ["azimuth", "power"].iter().flat_map(|what| {
            levels.iter().map(move |level| match level {
                Some(snr_db) => format!("{what}, {snr_db} dB"),
                None => format!("{what}, all"),
            })
        });
        let rows: Vec<(&str, Vec<Cell>)> = self
            .methods
            .iter()
            .enumerate()
            .filter(|(k, _)| !self.stated(*k, None).is_empty())
            .map(|(k, name)| {
                let shown = levels.iter().map(|&level| self.stated(k, level).shown());
                let (azimuths, powers): (Vec<_>, Vec<_>) =
                    shown.map(|[azimuth, power]| (Cell::text(azimuth), Cell::text(power))).unzip();
                (name.as_str(), [azimuths, powers].concat())
            })
            .collect();
        let title = "Right predictions within one / two of the deviations they state, %";
        (!rows.is_empty()).then(|| Table::new(title, Best::None, "method", heads, rows))
    }

    /// Numbers of targets.
    pub fn targets(&self) -> Vec<usize> {
        let mut targets: Vec<usize> = self.conditions.iter().map(|c| c.targets).collect();
        targets.dedup();
        targets
    }

    /// Signal-to-noise ratios, dB.
    pub fn snrs_db(&self) -> Vec<f64> {
        let first = self.conditions.first().map(|c| c.targets);
        let of_first = self.conditions.iter().filter(|c| Some(c.targets) == first);
        of_first.map(|c| c.snr_db).collect()
    }

    /// Those of tables and curves: the first one, the one in the middle and the last one.
    fn drawn_db(&self) -> Vec<f64> {
        let all = self.snrs_db();
        let mut drawn: Vec<f64> = match all.len().checked_sub(1) {
            Some(last) => [0, last / 2, last].map(|at| all[at]).into(),
            None => vec![],
        };
        drawn.dedup();
        drawn
    }

    /// The result of a method in a condition.
    pub fn at(&self, targets: usize, snr_db: f64, method: usize) -> Option<&MethodResult> {
        self.conditions
            .iter()
            .find(|c| c.targets == targets && c.snr_db == snr_db)
            .and_then(|condition| condition.methods.get(method))
    }
}

impl boresight_validate::experiment::Report for AoaReport {
    fn tables(&self) -> Tables {
        let remark = format!(
            "Array {}, powers within {} dB, {} snapshots a condition; thresholds from {} others.\n",
            self.array, self.spread_db, self.trials, self.validation
        );
        let mut tables = vec![self.means_table()];
        tables.extend(self.stated_table());
        type Value = fn(&MethodResult) -> Option<f64>;
        let kinds: [(&str, Best, usize, Value); 8] = [
            ("Largest F1", Best::Largest, 4, |m| Some(m.best?.f1)),
            ("F1 at one threshold", Best::Largest, 4, |m| Some(m.at_one_threshold?.f1)),
            ("Strict F1 at one threshold", Best::Largest, 4, |m| {
                Some(m.at_one_threshold?.strict_f1)
            }),
            ("Precision at one threshold", Best::None, 4, |m| Some(m.at_one_threshold?.precision)),
            ("Recall at one threshold", Best::None, 4, |m| Some(m.at_one_threshold?.recall)),
            ("Mean error of angle at one threshold, deg", Best::Smallest, 4, |m| {
                Some(m.at_one_threshold?.angle_error_deg)
            }),
            ("Mean error of power at one threshold, dB", Best::Smallest, 2, |m| {
                Some(m.at_one_threshold?.power_error_db)
            }),
            ("Error over the Cramer-Rao bound, separated targets", Best::None, 2, |m| {
                Some(m.separated.rmse_deg / m.separated.bound_deg)
            }),
        ];
        for (title, best, digits, value) in kinds {
            for snr_db in self.drawn_db() {
                tables.push(Table::new(
                    format!("{title}, {snr_db} dB"),
                    best,
                    "method",
                    self.targets().iter().map(|n| format!("{n} targets")),
                    self.methods.iter().enumerate().map(|(k, name)| {
                        let cells = self.targets().into_iter().map(|targets| {
                            let value = self.at(targets, snr_db, k).and_then(value);
                            Cell::fixed(value.unwrap_or(f64::NAN), digits)
                        });
                        (name, cells.collect())
                    }),
                ));
            }
        }
        Tables { remark, tables }
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
            let drawn = self.drawn_db().contains(&condition.snr_db);
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

    fn figures(&self) -> Vec<String> {
        vec![figures::precision_recall(self), figures::scores(self)]
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
