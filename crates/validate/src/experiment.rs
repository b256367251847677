//! What all experiments have in common: options that say everything, scenes by number, and results that are a
//! function of the scenes' records.

use crate::error::ValidateError;
use crate::outcome::Outcome;
use crate::sweep::{self, Sweep};
use crate::table::Tables;
use boresight_core::Progress;
use boresight_fleet::Part;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::mpsc;

/// The options of an experiment, which say all that its records depend on.
pub trait Experiment: Serialize + DeserializeOwned + Clone + PartialEq + Sync {
    /// Name on the command line and of its files.
    const NAME: &'static str;
    /// Counts the changes of what comes of a scene, so that records from before are not mixed with those from after.
    const REVISION: u32 = 0;
    /// What scenes share.
    type Plan: Sync;
    /// What can stop the experiment.
    type Error: From<ValidateError> + Debug + Send;
    /// What is kept of a scene.
    type Record: Serialize + DeserializeOwned + Clone + Send;
    /// What comes of the records.
    type Report: Report;

    /// Checks the options and prepares what scenes share.
    ///
    /// # Errors
    /// Options out of range.
    fn plan(&self) -> Result<Self::Plan, Self::Error>;

    /// Names of the methods compared.
    fn methods(plan: &Self::Plan) -> Vec<String>;

    /// The run split into legs, each with a file of records of its own: one that changes is run again, the others are not.
    fn legs(&self) -> Vec<Self> {
        vec![self.clone()]
    }

    /// What a leg adds to the name of its file of records.
    fn suffix(&self) -> String {
        String::new()
    }

    /// The run that has these legs; `None` where they are of different runs.
    fn whole(legs: &[Self]) -> Option<Self> {
        let (first, rest) = legs.split_first()?;
        rest.is_empty().then(|| first.clone())
    }

    /// Adds what another leg recorded in the same scene to a record.
    fn join(_record: &mut Self::Record, _other: Self::Record) {}

    /// Number of scenes.
    fn scenes(&self) -> u64;

    /// Independent trials of each condition, spread over consecutive scenes, from which standard errors are estimated; 0
    /// where tables state none.
    fn repeats(&self) -> u64 {
        0
    }

    /// Runs a scene; the record depends on the options and the number only.
    ///
    /// # Errors
    /// Those of the simulation and the methods.
    fn scene(&self, plan: &Self::Plan, number: u64) -> Result<Self::Record, Self::Error>;

    /// From the records of all scenes, in order.
    fn report(
        &self,
        plan: &Self::Plan,
        records: impl Iterator<Item = Self::Record>,
    ) -> Self::Report;
}

/// What is handed each answer: of one trial a JSON object, which the experiment describes.
pub type Tell<'a> = &'a mut dyn FnMut(Value);

/// An experiment that tells what was answered, so that its scores can be counted again by other means.
pub trait Answered: Experiment {
    /// Runs a scene like [`Experiment::scene`], and tells the truth and all answers of each of its trials.
    ///
    /// # Errors
    /// As [`Experiment::scene`].
    fn answered(
        &self,
        plan: &Self::Plan,
        number: u64,
        tell: Option<Tell>,
    ) -> Result<Self::Record, Self::Error>;
}

/// The result of an experiment.
pub trait Report: Serialize {
    /// Its tables.
    fn tables(&self) -> Tables;

    /// As comma-separated values with a line of heads.
    fn csv(&self) -> String;

    /// Names of the files of its figures.
    const FIGURES: &'static [&'static str];

    /// Figures as SVG, in the order of their names; the last ones may be lacking.
    fn figures(&self) -> Vec<String>;

    /// As indented JSON; what is no number is `null`.
    fn json(&self) -> String {
        format!("{:#}\n", json!(self))
    }

    /// The numbers that figures show in few bytes, for a page to load.
    fn brief(&self) -> String {
        brief(json!(self))
    }
}

/// JSON with a line a condition and numbers of five digits.
pub fn brief(mut all: Value) -> String {
    shorten(&mut all);
    let Some(fields) = all.as_object() else { return format!("{all}\n") };
    let lines = fields.iter().map(|(name, value)| match value.as_array() {
        Some(items) if items.iter().any(Value::is_object) => {
            let items: Vec<String> = items.iter().map(Value::to_string).collect();
            format!("\"{name}\":[\n{}\n]", items.join(",\n"))
        }
        _ => format!("\"{name}\":{value}"),
    });
    format!("{{\n{}\n}}\n", lines.collect::<Vec<_>>().join(",\n"))
}

/// Rounds all numbers to five significant digits.
fn shorten(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(shorten),
        Value::Object(fields) => fields.values_mut().for_each(shorten),
        Value::Number(number) if number.is_f64() => {
            let short = number.as_f64().and_then(|x| format!("{x:.4e}").parse::<f64>().ok());
            *value = json!(short);
        }
        _ => {}
    }
}

/// Groups of scenes whose differences give the standard errors of tables.
const GROUPS: u64 = 16;

/// Trials of numbered conditions, a scene of a sweep holding some trials of one condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Trials {
    /// Trials a condition.
    pub each: u64,
    /// Most trials a scene.
    pub chunk: u64,
}

impl Trials {
    /// Scenes of at most `most` trials, and of fewer where there would not be one for each of the groups of which
    /// standard errors are estimated.
    pub fn new(each: u64, most: u64) -> Self {
        Self { each, chunk: each.div_ceil(GROUPS).clamp(1, most) }
    }

    /// Number of scenes of `conditions` conditions.
    pub fn scenes(self, conditions: usize) -> u64 {
        self.each.div_ceil(self.chunk) * conditions as u64
    }

    /// Condition, first trial and number of trials of a scene.
    pub fn of(self, scene: u64) -> (usize, u64, u64) {
        let scenes = self.each.div_ceil(self.chunk);
        let first = scene % scenes * self.chunk;
        ((scene / scenes) as usize, first, self.chunk.min(self.each - first))
    }
}

/// How to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct How<'a> {
    /// Threads, at least one.
    pub threads: usize,
    /// Where records are kept, from which a stopped run goes on.
    pub folder: Option<&'a Path>,
}

/// Runs all scenes.
///
/// # Errors
/// Options out of range; those of [`sweep::run`].
pub fn run<E: Experiment>(
    options: &E,
    how: How,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<E::Report, E::Error> {
    // Whether everything goes together, before anything is run.
    let plan = options.plan()?;
    let legs = records(options, how, Part::WHOLE, E::scene, progress)?;
    Ok(options.report(&plan, side_by_side::<E>(legs).into_values()))
}

/// Runs all scenes, and returns what it writes and prints.
///
/// # Errors
/// As [`run`].
pub fn run_outcome<E: Experiment>(
    options: &E,
    how: How,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Outcome, E::Error> {
    let plan = options.plan()?;
    let legs = records(options, how, Part::WHOLE, E::scene, progress)?;
    Ok(outcome(options, &plan, side_by_side::<E>(legs)))
}

/// What an experiment writes and prints of the records of all its scenes. Standard errors are from the results without
/// each of [`GROUPS`] groups of scenes.
pub(crate) fn outcome<E: Experiment>(options: &E, plan: &E::Plan, scenes: Records<E>) -> Outcome {
    let groups = if options.repeats() >= GROUPS { 0..GROUPS } else { 0..0 };
    let without = groups.map(|group| {
        let others = scenes.iter().filter(|(number, _)| *number % GROUPS != group);
        options.report(plan, others.map(|(_, record)| record.clone())).tables()
    });
    let without: Vec<Tables> = without.collect();
    Outcome::new::<E>(&options.report(plan, scenes.into_values()), &without)
}

/// Runs all scenes and hands `write` lines with every answer: what heads the records first, then an object a trial and
/// group of entrants, as [`Answered::answered`] tells them, in no order. Nothing is recorded, and no more held than the
/// lines of some scenes.
///
/// # Errors
/// As [`run`], and what `write` returns, which ends the run.
pub fn run_answered<E: Answered, X: From<E::Error>>(
    options: &E,
    threads: usize,
    mut write: impl FnMut(&str) -> Result<(), X>,
    mut progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Outcome, X> {
    let plan = options.plan()?;
    write(&format!("{}\n", setup(options, &plan)))?;
    let (sender, lines) = mpsc::channel();
    let scene = |leg: &E, plan: &E::Plan, number| {
        let mut text = String::new();
        let mut tell = |answer: Value| text += &format!("{answer}\n");
        let record = leg.answered(plan, number, Some(&mut tell))?;
        // Nobody listens where the run has ended.
        let _ = sender.send(text);
        Ok(record)
    };
    let mut written = Ok(());
    let mut go_on = |p: Progress| {
        written = lines.try_iter().try_for_each(|text: String| write(&text));
        if written.is_err() { ControlFlow::Break(()) } else { progress(p) }
    };
    let legs = records(options, How { threads, folder: None }, Part::WHOLE, scene, &mut go_on);
    written?;
    Ok(outcome(options, &plan, side_by_side::<E>(legs?)))
}

/// Whether a folder has records of an experiment's whole run, of any leg, from which it would go on.
pub fn is_recorded<E: Experiment>(options: &E, folder: &Path) -> bool {
    options.legs().iter().any(|leg| folder.join(file_name(leg, Part::WHOLE)).exists())
}

/// Runs one part of the scenes, whose records [`crate::merge`] puts together with the others', and returns
/// their number.
///
/// # Errors
/// As [`run`].
pub fn run_part<E: Experiment>(
    options: &E,
    how: How,
    part: Part,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<usize, E::Error> {
    options.plan()?;
    Ok(records(options, how, part, E::scene, progress)?.iter().map(BTreeMap::len).sum())
}

/// The records of a leg, or of a part of one.
pub(crate) type Records<E> = BTreeMap<u64, <E as Experiment>::Record>;

/// The records of each leg, by what runs a scene of it.
fn records<E: Experiment>(
    options: &E,
    how: How,
    part: Part,
    scene: impl Fn(&E, &E::Plan, u64) -> Result<E::Record, E::Error> + Sync,
    mut progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Vec<Records<E>>, E::Error> {
    let legs = options.legs();
    let count = legs.len();
    let mut all: Vec<Records<E>> = vec![];
    for leg in legs {
        let plan = leg.plan()?;
        let file = how.folder.map(|folder| folder.join(file_name(&leg, part)));
        let sweep = Sweep {
            setup: setup(&leg, &plan),
            scenes: 0..leg.scenes(),
            part,
            threads: how.threads,
            records: file.as_deref(),
        };
        let before: usize = all.iter().map(BTreeMap::len).sum();
        let of_all = |p: Progress| Progress { done: before + p.done, total: count * p.total };
        all.push(sweep::run(&sweep, |number| scene(&leg, &plan, number), |p| progress(of_all(p)))?);
    }
    Ok(all)
}

/// Puts the records of legs together, scene by scene.
pub(crate) fn side_by_side<E: Experiment>(legs: Vec<Records<E>>) -> Records<E> {
    let mut legs = legs.into_iter();
    let mut all = legs.next().unwrap_or_default();
    for leg in legs {
        for (scene, record) in leg {
            if let Some(beside) = all.get_mut(&scene) {
                E::join(beside, record);
            }
        }
    }
    all
}

/// Name of the file of a leg's records.
pub(crate) fn file_name<E: Experiment>(leg: &E, part: Part) -> String {
    part.file_name(&format!("{}{}", E::NAME, leg.suffix()))
}

/// What heads the records: experiment, version, methods and options.
pub(crate) fn setup<E: Experiment>(options: &E, plan: &E::Plan) -> Value {
    let mut head = json!({
        "experiment": E::NAME,
        "version": env!("CARGO_PKG_VERSION"),
        "methods": E::methods(plan),
        "options": options,
    });
    if let (1.., Some(head)) = (E::REVISION, head.as_object_mut()) {
        head.insert("revision".into(), E::REVISION.into());
    }
    head
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_brief_report_says_the_same_in_five_digits() {
        #[derive(Serialize)]
        struct Two {
            name: &'static str,
            numbers: [f64; 4],
            conditions: [Value; 2],
        }
        impl Report for Two {
            fn tables(&self) -> Tables {
                Tables::default()
            }
            fn csv(&self) -> String {
                String::new()
            }
            const FIGURES: &'static [&'static str] = &[];
            fn figures(&self) -> Vec<String> {
                vec![]
            }
        }
        let numbers = [1.0 / 3.0, 123_456.0, f64::NAN, 1e-9 / 3.0];
        let conditions = [json!({ "n": 2, "of": [0.1 + 0.2] }), json!(null)];
        let brief = Two { name: "a", numbers, conditions }.brief();
        let expected = json!({
            "name": "a",
            "numbers": [0.33333, 123_460.0, null, 3.3333e-10],
            "conditions": [{ "n": 2, "of": [0.3] }, null],
        });
        assert_eq!(serde_json::from_str::<Value>(&brief).unwrap(), expected);
        assert_eq!(brief.lines().count(), 8, "{brief}");
    }

    #[test]
    fn scenes_hold_every_trial_of_every_condition_once() {
        for (each, chunk) in [(1, 250), (250, 250), (251, 250), (1050, 21), (7, 3)] {
            let trials = Trials { each, chunk };
            let mut next = vec![0; 3];
            for scene in 0..trials.scenes(3) {
                let (condition, first, count) = trials.of(scene);
                assert_eq!(first, next[condition]);
                assert!((1..=chunk).contains(&count));
                next[condition] += count;
            }
            assert_eq!(next, [each; 3]);
        }
    }
}
