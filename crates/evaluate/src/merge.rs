//! Parts of a sweep, run anywhere, put together.

use crate::EvaluateError;
use crate::aoa;
use crate::calibration;
use crate::doa;
use crate::experiment::{Experiment, Report, setup};
use crate::imperfections;
use crate::resolution;
use crate::sweep::{self, Line, Part};
use boresight_core::CoreError;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What an experiment came to, as files.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Name of the experiment.
    pub name: &'static str,
    /// Tables, as Markdown.
    pub tables: String,
    /// All numbers, as JSON.
    pub json: String,
    /// All numbers, as comma-separated values.
    pub csv: String,
    /// Figures, as SVG, by name.
    pub figures: Vec<(&'static str, String)>,
}

impl Outcome {
    /// Of a report.
    ///
    /// # Errors
    /// [`EvaluateError::Figure`].
    pub fn new<E: Experiment>(report: &E::Report) -> Result<Self, EvaluateError> {
        Ok(Self {
            name: E::NAME,
            tables: report.tables(),
            json: report.json(),
            csv: report.csv(),
            figures: report.figures()?,
        })
    }
}

/// The records of one run, from several files.
struct Gathered {
    setup: Value,
    first: PathBuf,
    records: BTreeMap<u64, (Value, PathBuf)>,
}

/// Puts together the records in `sources`, files of records or folders of them, and writes them as those of one
/// run into `folder`. The outcome is the one of a run that was never split.
///
/// # Errors
/// [`EvaluateError::OtherRun`] where setups differ, or are not what this version would run;
/// [`EvaluateError::Conflict`] where two files hold different records of a scene; [`EvaluateError::Incomplete`]
/// where scenes are missing; [`CoreError::Empty`] where there are no records; those of the files.
pub fn merge(sources: &[PathBuf], folder: &Path) -> Result<Outcome, EvaluateError> {
    let gathered = gather(sources)?;
    let name = gathered.setup["experiment"].as_str().unwrap_or_default();
    match name {
        aoa::Options::NAME => merge_as::<aoa::Options>(gathered, folder),
        calibration::Options::NAME => merge_as::<calibration::Options>(gathered, folder),
        doa::Options::NAME => merge_as::<doa::Options>(gathered, folder),
        imperfections::Options::NAME => merge_as::<imperfections::Options>(gathered, folder),
        resolution::Options::NAME => merge_as::<resolution::Options>(gathered, folder),
        _ => Err(CoreError::Unknown {
            what: format!("experiment of {}", gathered.first.display()),
            expected: "aoa, calibration, doa, imperfections, resolution".into(),
            given: name.into(),
        }
        .into()),
    }
}

fn gather(sources: &[PathBuf]) -> Result<Gathered, EvaluateError> {
    let mut gathered: Option<Gathered> = None;
    for path in files(sources)? {
        let failed = |error| EvaluateError::File { action: "read", path: path.clone(), error };
        let text = std::fs::read_to_string(&path).map_err(failed)?;
        let mut lines = sweep::whole_lines(&text).lines().enumerate();
        let malformed =
            |line, error| EvaluateError::Record { path: path.clone(), line: line + 1, error };
        let Some((line, head)) = lines.next() else { continue };
        let mut head: Value = serde_json::from_str(head).map_err(|e| malformed(line, e))?;
        Part::take_from(&mut head);
        let all = gathered.get_or_insert_with(|| Gathered {
            setup: head.clone(),
            first: path.clone(),
            records: BTreeMap::new(),
        });
        if head != all.setup {
            return Err(EvaluateError::OtherRun {
                path,
                expected: all.setup.to_string(),
                given: head.to_string(),
            });
        }
        for (line, text) in lines {
            let found: Line<Value> = serde_json::from_str(text).map_err(|e| malformed(line, e))?;
            if let Some((record, other)) = all.records.get(&found.scene) {
                if *record != found.record {
                    return Err(EvaluateError::Conflict {
                        scene: found.scene,
                        path,
                        other: other.clone(),
                    });
                }
            } else {
                all.records.insert(found.scene, (found.record, path.clone()));
            }
        }
    }
    gathered.ok_or_else(|| {
        CoreError::Empty {
            what: "records".into(),
            expected: "files ending in .jsonl, or folders with such files".into(),
        }
        .into()
    })
}

/// The files named and those in the folders named, in order of their names.
fn files(sources: &[PathBuf]) -> Result<Vec<PathBuf>, EvaluateError> {
    let mut files = vec![];
    for source in sources {
        if !source.is_dir() {
            files.push(source.clone());
            continue;
        }
        let failed = |error| EvaluateError::File { action: "read", path: source.clone(), error };
        let mut within = vec![];
        for entry in std::fs::read_dir(source).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.extension().is_some_and(|ending| ending == "jsonl") {
                within.push(path);
            }
        }
        within.sort();
        files.append(&mut within);
    }
    Ok(files)
}

fn merge_as<E: Experiment>(gathered: Gathered, folder: &Path) -> Result<Outcome, EvaluateError> {
    let Gathered { setup: found, first, records } = gathered;
    let malformed = |error| EvaluateError::Record { path: first.clone(), line: 1, error };
    let options = E::deserialize(&found["options"]).map_err(malformed)?;
    let plan = options.plan()?;
    let expected = setup(&options, &plan);
    if found != expected {
        return Err(EvaluateError::OtherRun {
            path: first,
            expected: expected.to_string(),
            given: found.to_string(),
        });
    }
    let scenes = 0..options.scenes();
    let missing = scenes.clone().filter(|scene| !records.contains_key(scene));
    if let Some(first) = missing.clone().next() {
        let missing = missing.count();
        return Err(EvaluateError::Incomplete { missing, first, total: scenes.end });
    }
    let mut typed: BTreeMap<u64, E::Record> = BTreeMap::new();
    for (scene, (record, path)) in records {
        if scenes.contains(&scene) {
            let malformed = |error| EvaluateError::Scene { path, scene, error };
            typed.insert(scene, serde_json::from_value(record).map_err(malformed)?);
        }
    }
    sweep::write(&folder.join(Part::WHOLE.file_name(E::NAME)), &expected, &typed)?;
    Outcome::new::<E>(&options.report(&plan, typed.into_values()))
}
