//! What all experiments have in common: options that say everything, scenes by number, and results that are a
//! function of the scenes' records.

use crate::EvaluateError;
use crate::sweep::{self, Part, Sweep};
use boresight_pipeline::Progress;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

/// The options of an experiment, which say all that its records depend on.
pub trait Experiment: Serialize + DeserializeOwned + Sync {
    /// Name on the command line and of its files.
    const NAME: &'static str;
    /// What scenes share.
    type Plan: Sync;
    /// What is kept of a scene.
    type Record: Serialize + DeserializeOwned + Send;
    /// What comes of the records.
    type Report: Report;

    /// Checks the options and prepares what scenes share.
    ///
    /// # Errors
    /// Options out of range.
    fn plan(&self) -> Result<Self::Plan, EvaluateError>;

    /// Names of the methods compared.
    fn methods(plan: &Self::Plan) -> Vec<String>;

    /// Number of scenes.
    fn scenes(&self) -> u64;

    /// Runs a scene; the record depends on the options and the number only.
    ///
    /// # Errors
    /// Those of the simulation and the methods.
    fn scene(&self, plan: &Self::Plan, number: u64) -> Result<Self::Record, EvaluateError>;

    /// From the records of all scenes, in order.
    fn report(
        &self,
        plan: &Self::Plan,
        records: impl Iterator<Item = Self::Record>,
    ) -> Self::Report;
}

/// The result of an experiment.
pub trait Report: Serialize {
    /// As Markdown.
    fn tables(&self) -> String;

    /// As comma-separated values with a line of heads.
    fn csv(&self) -> String;

    /// Figures as SVG, each with its name.
    ///
    /// # Errors
    /// [`EvaluateError::Figure`].
    fn figures(&self) -> Result<Vec<(&'static str, String)>, EvaluateError>;

    /// As indented JSON; what is no number is `null`.
    fn json(&self) -> String {
        format!("{:#}\n", json!(self))
    }
}

/// Trials of numbered conditions, a scene of a sweep holding some trials of one condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Trials {
    /// Trials a condition.
    pub each: u64,
    /// Most trials a scene.
    pub chunk: u64,
}

impl Trials {
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
) -> Result<E::Report, EvaluateError> {
    let plan = options.plan()?;
    let done = records(options, &plan, how, Part::WHOLE, progress)?;
    Ok(options.report(&plan, done.into_values()))
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
) -> Result<usize, EvaluateError> {
    Ok(records(options, &options.plan()?, how, part, progress)?.len())
}

fn records<E: Experiment>(
    options: &E,
    plan: &E::Plan,
    how: How,
    part: Part,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<BTreeMap<u64, E::Record>, EvaluateError> {
    let file = how.folder.map(|folder| folder.join(part.file_name(E::NAME)));
    let sweep = Sweep {
        setup: setup(options, plan),
        scenes: 0..options.scenes(),
        part,
        threads: how.threads,
        records: file.as_deref(),
    };
    sweep::run(&sweep, |number| options.scene(plan, number), progress)
}

/// What heads the records: experiment, version, methods and options.
pub(crate) fn setup<E: Experiment>(options: &E, plan: &E::Plan) -> Value {
    json!({
        "experiment": E::NAME,
        "version": env!("CARGO_PKG_VERSION"),
        "methods": E::methods(plan),
        "options": options,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
