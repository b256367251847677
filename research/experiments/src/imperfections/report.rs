//! From records to tables and figures.

use super::{ImperfectionsExperiment, Kind, NUMBERS, settings};
use crate::aoa::Score;
use crate::aoa::cell::AoaRecord;
use boresight_validate::plot::{Panel, Series, draw};
use boresight_validate::statistics::Summary;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// Share of its F1 without errors that a method must keep to survive.
pub const SURVIVES: f64 = 0.95;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ImperfectionsReport {
    /// Array.
    pub array: String,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Snapshots a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Methods.
    pub methods: Vec<String>,
    /// Results, the array without errors first.
    pub settings: Vec<SettingResult>,
    /// For each kind of error the greatest strength, interpolated, up to which each method keeps
    /// [`SURVIVES`] of its F1.
    pub tolerances: Vec<Tolerance>,
}

/// What each method reached under errors of one kind and strength.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SettingResult {
    /// Kind of error; nothing for the array without.
    pub kind: Option<Kind>,
    /// Strength, in the kind's unit.
    pub strength: Option<f64>,
    /// Methods.
    pub methods: Vec<MethodResult>,
}

/// A method under errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Largest F1 for each number of targets.
    pub f1_by_targets: Vec<f64>,
    /// Their mean.
    pub f1: f64,
    /// Mean over numbers of targets of the mean error of angle at the largest F1, deg.
    pub angle_error_deg: f64,
}

/// What methods bear of one kind of error.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Tolerance {
    /// Kind of error.
    pub kind: Kind,
    /// By method: the strength, and whether it is the greatest that was tried.
    pub methods: Vec<(f64, bool)>,
}

impl ImperfectionsReport {
    pub(super) fn new(
        options: &ImperfectionsExperiment,
        methods: &[String],
        records: impl Iterator<Item = AoaRecord>,
    ) -> Self {
        let all = settings();
        let mut sums: Vec<Vec<Score>> = vec![vec![]; all.len() * NUMBERS.len()];
        for AoaRecord { condition, methods } in records {
            let Some(sum) = sums.get_mut(condition) else { continue };
            if sum.is_empty() {
                *sum = methods.into_iter().map(|m| m.score).collect();
                continue;
            }
            sum.iter_mut().zip(&methods).for_each(|(to, from)| to.merge(&from.score));
        }
        let result = |sums: &[Vec<Score>], method: usize| {
            let best: Vec<_> = sums.iter().map(|scores| scores[method].best()).collect();
            let f1: Vec<f64> = best.iter().map(|b| b.map_or(0.0, |b| b.f1)).collect();
            let errors: Vec<f64> = best.iter().flatten().map(|b| b.angle_error_deg).collect();
            MethodResult {
                f1: Summary::of(&f1).mean,
                f1_by_targets: f1,
                angle_error_deg: Summary::of(&errors).mean,
            }
        };
        let settings: Vec<SettingResult> = all
            .iter()
            .zip(sums.chunks_exact(NUMBERS.len()))
            .map(|(setting, sums)| SettingResult {
                kind: setting.map(|(kind, _)| kind),
                strength: setting.map(|(_, strength)| strength),
                methods: (0..methods.len()).map(|method| result(sums, method)).collect(),
            })
            .collect();
        let mut report = Self {
            array: options.array.clone(),
            snr_db: options.snr_db,
            trials: options.trials,
            seed: options.seed,
            methods: methods.to_vec(),
            settings,
            tolerances: vec![],
        };
        report.tolerances = Kind::ALL
            .into_iter()
            .map(|kind| Tolerance {
                kind,
                methods: (0..methods.len()).map(|method| report.tolerance(kind, method)).collect(),
            })
            .collect();
        report
    }

    /// Without errors and then under those of a kind: strength, and what methods reached.
    fn of_kind(&self, kind: Kind) -> impl Iterator<Item = (Option<f64>, &[MethodResult])> {
        let without = self.settings.iter().take(1);
        let with = self.settings.iter().filter(move |s| s.kind == Some(kind));
        without.chain(with).map(|s| (s.strength, s.methods.as_slice()))
    }

    /// The strength at which the F1 of a method falls below [`SURVIVES`] of that without errors.
    fn tolerance(&self, kind: Kind, method: usize) -> (f64, bool) {
        let mut all = self.of_kind(kind).map(|(s, methods)| (s, methods[method].f1));
        let Some((_, without)) = all.next() else { return (f64::NAN, false) };
        let least = SURVIVES * without;
        let strengths = kind.strengths();
        // No coupling is minus infinity in dB, between which and the weakest nothing can be interpolated.
        let zero = if kind == Kind::Coupling { f64::NEG_INFINITY } else { 0.0 };
        let mut before = (zero, without);
        for (strength, f1) in all {
            let strength = strength.unwrap_or(zero);
            if f1 < least {
                let share = (before.1 - least) / (before.1 - f1);
                let at = before.0 + share * (strength - before.0);
                return (if at.is_finite() { at } else { before.0 }, false);
            }
            before = (strength, f1);
        }
        (strengths.last().copied().unwrap_or(zero), true)
    }
}

impl boresight_validate::experiment::Report for ImperfectionsReport {
    fn tables(&self) -> Tables {
        let remark = format!(
            "Array {}, {} dB, {} snapshots a condition; means over {NUMBERS:?} targets.\n",
            self.array, self.snr_db, self.trials
        );
        let rows = self.methods.iter().enumerate().map(|(k, name)| {
            let mut cells = vec![Cell::fixed(self.settings[0].methods[k].f1, 3)];
            for tolerance in &self.tolerances {
                let (strength, all) = tolerance.methods[k];
                let digits = if tolerance.kind == Kind::Position { 3 } else { 1 };
                let shown = format!("{strength:.digits$}");
                cells.push(Cell::text(match (all, strength.is_finite()) {
                    (true, _) => format!("{shown} and more"),
                    (_, true) => shown,
                    _ => format!("less than {}", tolerance.kind.strengths()[0]),
                }));
            }
            (name, cells)
        });
        let greatest = Table::new(
            format!(
                "Greatest error with which a method keeps {:.0} % of the F1 it has without errors.",
                100.0 * SURVIVES
            ),
            Best::Largest,
            "method",
            ["F1 without errors"].into_iter().chain(Kind::ALL.map(Kind::label)),
            rows,
        );
        let mut tables = vec![greatest];
        type Value = fn(&MethodResult) -> f64;
        let kinds: [(&str, Best, Value); 2] = [
            ("Largest F1", Best::Largest, |m| m.f1),
            ("Mean error of angle at the largest F1, deg", Best::Smallest, |m| m.angle_error_deg),
        ];
        for (title, best, value) in kinds {
            for kind in Kind::ALL {
                let columns: Vec<_> = self.of_kind(kind).collect();
                tables.push(Table::new(
                    format!("{title}, by {}.", kind.label()),
                    best,
                    "method",
                    columns
                        .iter()
                        .map(|(strength, _)| strength.map_or("none".into(), |s| s.to_string())),
                    self.methods.iter().enumerate().map(|(k, name)| {
                        let cells = columns.iter().map(|(_, m)| Cell::fixed(value(&m[k]), 3));
                        (name, cells.collect())
                    }),
                ));
            }
        }
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let by: Vec<String> = NUMBERS.iter().map(|n| format!("f1_{n}_targets")).collect();
        let mut text = format!("error,strength,method,f1,angle_error_deg,{}\n", by.join(","));
        let named = std::iter::once("none".to_owned())
            .chain(super::settings().into_iter().flatten().map(|(kind, _)| format!("{kind:?}")));
        for (setting, error) in self.settings.iter().zip(named) {
            for (name, m) in self.methods.iter().zip(&setting.methods) {
                let strength = setting.strength.map_or(String::new(), |s| s.to_string());
                let by: Vec<String> = m.f1_by_targets.iter().map(f64::to_string).collect();
                text += &format!(
                    "{},{strength},\"{name}\",{},{},{}\n",
                    error.to_lowercase(),
                    m.f1,
                    m.angle_error_deg,
                    by.join(",")
                );
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &["imperfections.svg"];

    fn figures(&self) -> Vec<String> {
        type Value = fn(&MethodResult) -> f64;
        let rows: [(&str, Value); 2] =
            [("largest F1", |m| m.f1), ("mean error of angle / deg", |m| m.angle_error_deg)];
        let mut panels = vec![];
        for kinds in Kind::ALL.chunks(2) {
            for (label, value) in rows {
                for &kind in kinds {
                    panels.push(self.panel(kind, label, value));
                }
            }
        }
        vec![draw(&panels, 2)]
    }
}

impl ImperfectionsReport {
    fn panel(&self, kind: Kind, label: &str, value: fn(&MethodResult) -> f64) -> Panel {
        let line = |(k, name): (usize, &String)| Series {
            name: name.clone(),
            points: self
                .of_kind(kind)
                .filter_map(|(strength, methods)| {
                    // No coupling has no place on an axis in dB.
                    let zero = (kind != Kind::Coupling).then_some(0.0);
                    Some((strength.or(zero)?, value(&methods[k])))
                })
                .collect(),
            dashed: name.contains("refined"),
            marked: true,
        };
        Panel {
            x: kind.label().into(),
            y: label.into(),
            series: self.methods.iter().enumerate().map(line).collect(),
            ..Panel::default()
        }
    }
}
