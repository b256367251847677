//! From records to tables.

use super::plan::Plan;
use super::tally::{CLOSE_DEG, DEVIATIONS_DEG, DoaRecord, Tally};
use super::{Axis, Condition, DoaExperiment, SNRS_DB, Setup, Targets, figures};
use crate::entrants::Network;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct DoaReport {
    /// The radar.
    pub setup: Setup,
    /// What changes between conditions.
    pub axis: Axis,
    /// Trials a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// What counts: rules, then networks.
    pub counters: Vec<String>,
    /// What estimates angles: methods, then networks.
    pub methods: Vec<String>,
    /// Which networks these are.
    pub networks: Vec<Network>,
    /// Bounds of the error of one target's angle by signal-to-noise ratio, deg: of the frame, and of MUSIC on the
    /// region.
    pub bounds_deg: Vec<[f64; 2]>,
    /// Results by condition.
    pub conditions: Vec<ConditionResult>,
}

/// What came of a condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConditionResult {
    /// What is in the scene.
    pub targets: Targets,
    /// Signal-to-noise ratio, dB; of the first of two targets.
    pub snr_db: f64,
    /// Power of the second of two targets over the first, dB.
    pub second_db: f64,
    /// Trials.
    pub trials: u32,
    /// Trials with a close pair.
    pub close: u32,
    /// Share of trials in which each of `counters` counted 0, 1, 2 and more targets.
    pub counted: Vec<[f64; 4]>,
    /// Methods in order, nothing of networks for another number of targets; none where there is no target.
    pub methods: Vec<Option<MethodResult>>,
}

/// What a method reached in a condition; shares are of all trials, those without as many angles as targets
/// included.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Share of trials with as many angles as targets.
    pub found: f64,
    /// Root mean square error over these, deg.
    pub rmse_deg: f64,
    /// The same of angles rounded to whole degrees, which all targets stand at.
    pub rounded_rmse_deg: f64,
    /// Share with every angle within 1 deg.
    pub success: f64,
    /// Share with every angle, rounded to a whole degree, within 0, 2 and 4 deg.
    pub within: [f64; 3],
    /// `success` of close pairs.
    pub close_success: f64,
    /// `within` of close pairs.
    pub close_within: [f64; 3],
}

impl DoaReport {
    pub(super) fn new(
        options: &DoaExperiment,
        plan: &Plan,
        records: impl Iterator<Item = DoaRecord>,
    ) -> Self {
        let empty =
            DoaRecord { condition: 0, trials: 0, close: 0, counted: vec![], methods: vec![] };
        let all = options.axis.conditions();
        let mut sums: Vec<DoaRecord> = all.iter().map(|_| empty.clone()).collect();
        for record in records {
            let Some(sum) = sums.get_mut(record.condition) else { continue };
            sum.trials += record.trials;
            sum.close += record.close;
            sum.counted.resize(record.counted.len(), [0; 4]);
            sum.methods.resize(record.methods.len(), None);
            for (to, from) in sum.counted.iter_mut().zip(&record.counted) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to += from;
                }
            }
            for (to, from) in sum.methods.iter_mut().zip(&record.methods) {
                if let Some(from) = from {
                    to.get_or_insert_default().add(from);
                }
            }
        }
        let conditions = all
            .iter()
            .zip(&sums)
            .map(|(&Condition { targets, snr_db, second_db }, sum)| ConditionResult {
                targets,
                snr_db,
                second_db,
                trials: sum.trials,
                close: sum.close,
                counted: sum.counted.iter().map(|c| c.map(|c| share(c, sum.trials))).collect(),
                methods: sum
                    .methods
                    .iter()
                    .map(|m| m.as_ref().map(|m| MethodResult::new(m, targets, sum)))
                    .collect(),
            })
            .collect();
        let none = [f64::NAN; 2];
        Self {
            setup: options.setup,
            axis: options.axis,
            trials: options.trials,
            seed: options.seed,
            counters: plan.counters(),
            methods: plan.names(),
            networks: options.entrants.networks.clone(),
            bounds_deg: SNRS_DB.map(|snr_db| plan.bounds_deg(snr_db).unwrap_or(none)).to_vec(),
            conditions,
        }
    }

    /// The result of a condition, by its value of what changes.
    pub fn at(&self, targets: Targets, value: f64) -> Option<&ConditionResult> {
        let value_of = |c: &ConditionResult| match self.axis {
            Axis::Snr => c.snr_db,
            Axis::PowerDifference => c.second_db,
        };
        self.conditions.iter().find(|c| c.targets == targets && value_of(c) == value)
    }

    /// Share of scenes, a third each of no, one and two targets, that one of `counters` counted rightly.
    pub fn counted_rightly(&self, counter: usize, two: Targets, snr_db: f64) -> f64 {
        let classes = [Targets::None, Targets::One, two];
        classes.map(|targets| self.counted_as_it_is(counter, targets, snr_db)).iter().sum::<f64>()
            / 3.0
    }

    /// Share of the scenes with such targets in which one of `counters` counted as many as there are.
    pub fn counted_as_it_is(&self, counter: usize, targets: Targets, snr_db: f64) -> f64 {
        let counted = self.at(targets, snr_db).and_then(|c| c.counted.get(counter));
        counted.map_or(f64::NAN, |counted| counted[targets.count()])
    }

    /// A table over the signal-to-noise ratio, of all `counters`.
    fn counting(&self, title: String, share: impl Fn(usize, f64) -> f64) -> Table {
        let cells = |k| SNRS_DB.map(|snr_db| Cell::percent(share(k, snr_db))).to_vec();
        let rows = self.counters.iter().enumerate().map(|(k, name)| (name, cells(k)));
        Table::new(title, Best::Largest, "rule", self.heads(), rows)
    }

    /// A table over what changes, of the methods that have been run on such targets.
    fn table(
        &self,
        title: String,
        best: Best,
        targets: Targets,
        value: fn(&MethodResult) -> f64,
        cell: fn(f64) -> Cell,
    ) -> Table {
        let rows = self.methods.iter().enumerate().map(|(k, name)| {
            (name, self.over(targets, k, value).map(|(_, v)| cell(v)).collect::<Vec<_>>())
        });
        let rows = rows.filter(|(_, cells)| !cells.is_empty());
        Table::new(title, best, "method", self.heads(), rows)
    }

    fn heads(&self) -> Vec<String> {
        self.axis.values().map(|value| format!("{value} dB")).to_vec()
    }

    /// A method's figure against what changes.
    pub(super) fn over(
        &self,
        targets: Targets,
        method: usize,
        value: fn(&MethodResult) -> f64,
    ) -> impl Iterator<Item = (f64, f64)> {
        self.axis.values().into_iter().filter_map(move |at| {
            Some((at, value(self.at(targets, at)?.methods.get(method)?.as_ref()?)))
        })
    }
}

fn share(count: u32, of: u32) -> f64 {
    f64::from(count) / f64::from(of)
}

impl MethodResult {
    fn new(tally: &Tally, targets: Targets, of: &DoaRecord) -> Self {
        let angles = targets.count() as f64 * f64::from(tally.found);
        Self {
            found: share(tally.found, of.trials),
            rmse_deg: (tally.squared_deg2 / angles).sqrt(),
            rounded_rmse_deg: (tally.rounded_deg2 / angles).sqrt(),
            success: share(tally.success, of.trials),
            within: tally.within.map(|count| share(count, of.trials)),
            close_success: share(tally.close_success, of.close),
            close_within: tally.close_within.map(|count| share(count, of.close)),
        }
    }
}

impl boresight_validate::experiment::Report for DoaReport {
    fn tables(&self) -> Tables {
        let remark = format!("{} trials a condition.\n", self.trials);
        let success = |two: Targets, title: String| {
            self.table(title, Best::Largest, two, |m| m.success, Cell::percent)
        };
        if self.axis == Axis::PowerDifference {
            let of = |(two, which)| {
                success(
                    two,
                    format!(
                        "Both angles of two targets {which} within 1 deg, %, by the second one's power over the first's, \
                         which is {} dB.",
                        SNRS_DB[SNRS_DB.len() - 1]
                    ),
                )
            };
            return Tables { remark, tables: PAIRS.map(of).to_vec() };
        }
        let mut tables = vec![];
        for (two, which) in PAIRS {
            let title = format!(
                "Scenes counted rightly, %, a third each of 0, 1 and 2 targets, the two {which} (Figure 6)."
            );
            tables.push(self.counting(title, |k, snr_db| self.counted_rightly(k, two, snr_db)));
        }
        for (targets, which) in CLASSES {
            let title = format!("Scenes with {which} counted rightly, %.");
            tables
                .push(self.counting(title, |k, snr_db| self.counted_as_it_is(k, targets, snr_db)));
        }
        let digits = |error| Cell::fixed(error, 4);
        let title = "Root mean square error of one target's angle, deg (Figure 7).";
        let mut errors =
            self.table(title.into(), Best::Smallest, Targets::One, |m| m.rmse_deg, digits);
        for (k, name) in BOUNDS.into_iter().enumerate() {
            let cells = self.bounds_deg.iter().map(|bounds| digits(bounds[k]).reference());
            errors.rows.push((name.into(), cells.collect()));
        }
        tables.push(errors);
        let title = "The same of angles rounded to whole degrees, which all targets stand at.";
        let value = |m: &MethodResult| m.rounded_rmse_deg;
        tables.push(self.table(title.into(), Best::Smallest, Targets::One, value, digits));
        for (two, which) in PAIRS {
            let title = format!("Both angles of two targets {which} within 1 deg, % (Figure 8).");
            tables.push(success(two, title));
        }
        for (two, which) in PAIRS {
            for snr_db in [SNRS_DB[2], SNRS_DB[5]] {
                let Some(condition) = self.at(two, snr_db) else { continue };
                let rows = self.methods.iter().zip(&condition.methods).filter_map(|(name, m)| {
                    let m = m.as_ref()?;
                    let shares = m.within.iter().chain(&m.close_within);
                    Some((name, shares.map(|&share| Cell::percent(share)).collect()))
                });
                tables.push(Table::new(
                    format!(
                        "Both angles of two targets {which}, rounded to whole degrees, within 0, 2 and 4 deg at {snr_db} dB, \
                         %, and the same of pairs closer than {CLOSE_DEG} deg (Figure 9)."
                    ),
                    Best::Largest,
                    "method",
                    ["", "close, "].iter().flat_map(|kind| {
                        DEVIATIONS_DEG.map(|deviation| format!("{kind}{deviation} deg"))
                    }),
                    rows,
                ));
            }
        }
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text = "targets,snr_db,second_db,method,trials,found,rmse_deg,rounded_rmse_deg,within_1_deg,rounded_0_deg,rounded_2_deg,\
                        rounded_4_deg,close,close_within_1_deg,close_rounded_0_deg,close_rounded_2_deg,\
                        close_rounded_4_deg,counted_0,counted_1,counted_2,counted_more\n"
            .to_owned();
        for c in &self.conditions {
            let targets = c.targets.name();
            let named = self.methods.iter().zip(&c.methods);
            for (name, m) in named.filter_map(|(name, m)| Some((name, m.as_ref()?))) {
                let ([a, b, d], [e, f, g]) = (m.within, m.close_within);
                text += &format!(
                    "{targets},{},{},\"{name}\",{},{},{},{},{},{a},{b},{d},{},{},{e},{f},{g},,,,\n",
                    c.snr_db,
                    c.second_db,
                    c.trials,
                    m.found,
                    m.rmse_deg,
                    m.rounded_rmse_deg,
                    m.success,
                    c.close,
                    m.close_success,
                );
            }
            for (name, [none, one, two, more]) in self.counters.iter().zip(&c.counted) {
                let (snr_db, second_db, trials) = (c.snr_db, c.second_db, c.trials);
                text += &format!(
                    "{targets},{snr_db},{second_db},\"{name}\",{trials},,,,,,,,,,,,,{none},{one},{two},{more}\n"
                );
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] =
        &["doa-success.svg", "doa-counting.svg", "doa-rmse.svg", "doa-deviation.svg"];

    fn figures(&self) -> Vec<String> {
        figures::all(self)
    }
}

impl Targets {
    fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::One => "one",
            Self::Apart => "apart",
            Self::Together => "together",
            Self::Moving => "moving",
        }
    }
}

/// The kinds of pairs, in words.
pub(super) const PAIRS: [(Targets, &str); 3] = [
    (Targets::Apart, "at ranges of their own"),
    (Targets::Together, "at one range"),
    (Targets::Moving, "at one range, one of them moving"),
];
/// What there is to count, in words.
const CLASSES: [(Targets, &str); 5] = [
    (Targets::None, "no target"),
    (Targets::One, "one target"),
    (Targets::Apart, "two targets at ranges of their own"),
    (Targets::Together, "two targets at one range"),
    (Targets::Moving, "two targets at one range, one of them moving"),
];
/// Names of the bounds.
pub(super) const BOUNDS: [&str; 2] = ["Cramer-Rao bound", "MUSIC in theory"];
