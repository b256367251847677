//! Parts of a sweep, run anywhere, put together.

use crate::error::ValidateError;
use crate::experiment::{Experiment, Records, file_name, outcome, setup, side_by_side};
use crate::outcome::Outcome;
use crate::sweep::{self, Line};
use boresight_core::InputError;
use boresight_fleet::Part;
use boresight_fleet::lines::whole_lines;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What was run in parts, put together.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// What it came to: the outcome of a run that was never split.
    pub outcome: Outcome,
    /// Its records as those of one run, each file with its name.
    pub records: Vec<(String, String)>,
    /// The files that were read.
    pub sources: Vec<PathBuf>,
}

/// The records of one leg, from several files.
struct Gathered {
    setup: Value,
    first: PathBuf,
    records: BTreeMap<u64, (Value, PathBuf)>,
}

/// Records of one experiment from several files, before they are put together.
pub struct Parts {
    gathered: Vec<Gathered>,
    sources: Vec<PathBuf>,
}

impl Parts {
    /// Reads the records in `sources`, files of records or folders of them.
    ///
    /// # Errors
    /// [`ValidateError::OtherRun`] where experiments differ; [`ValidateError::Conflict`] where two files hold different
    /// records of a scene; [`InputError::Empty`] where there are no records; those of the files.
    pub fn read(sources: &[PathBuf]) -> Result<Self, ValidateError> {
        let sources = files(sources)?;
        Ok(Self { gathered: gather(&sources)?, sources })
    }

    /// Name of the experiment.
    pub fn experiment(&self) -> &str {
        self.gathered[0].setup["experiment"].as_str().unwrap_or_default()
    }

    /// A file of its records.
    pub fn first(&self) -> &Path {
        &self.gathered[0].first
    }

    /// Puts the records together as those of one run, those of several legs in the same scenes side by side.
    ///
    /// # Errors
    /// [`ValidateError::OtherRun`] for records of another experiment, and where setups differ or are not what this version would run;
    /// [`ValidateError::Incomplete`] where scenes are missing.
    pub fn put_together<E: Experiment>(self) -> Result<Merged, E::Error> {
        if self.experiment() != E::NAME {
            let (given, expected) = (self.experiment().into(), E::NAME.into());
            return Err(
                ValidateError::OtherRun { path: self.first().into(), expected, given }.into()
            );
        }
        let Self { gathered, sources } = self;
        let mut found = vec![];
        for Gathered { setup: head, first, .. } in &gathered {
            let malformed = |error| ValidateError::Record { path: first.clone(), line: 1, error };
            let options = E::deserialize(&head["options"]).map_err(malformed)?;
            let expected = setup(&options, &options.plan()?);
            if *head != expected {
                return Err(other_run(first, &expected, head).into());
            }
            found.push(options);
            if E::whole(&found).is_none() {
                return Err(other_run(first, &gathered[0].setup, head).into());
            }
        }
        let Some(options) = E::whole(&found) else { return Err(nothing().into()) };
        let scenes = 0..options.scenes();
        // In the order of a run that was never split.
        let (mut typed, mut records): (Vec<Records<E>>, _) = (vec![], vec![]);
        let mut gathered: Vec<_> = found.into_iter().zip(gathered).collect();
        for leg in options.legs() {
            let Some(at) = gathered.iter().position(|(options, _)| *options == leg) else {
                continue;
            };
            let of_all = gathered.swap_remove(at).1.records;
            let missing = scenes.clone().filter(|scene| !of_all.contains_key(scene));
            if let Some(first) = missing.clone().next() {
                let missing = missing.count();
                return Err(ValidateError::Incomplete { missing, first, total: scenes.end }.into());
            }
            let mut of_leg = Records::<E>::new();
            for (scene, (record, path)) in of_all {
                if scenes.contains(&scene) {
                    let malformed = |error| ValidateError::Scene { path, scene, error };
                    of_leg.insert(scene, serde_json::from_value(record).map_err(malformed)?);
                }
            }
            let setup = setup(&leg, &leg.plan()?);
            let name = file_name(&leg, Part::WHOLE);
            let text = sweep::text(Path::new(&name), &setup, &of_leg)?;
            records.push((name, text));
            typed.push(of_leg);
        }
        let plan = options.plan()?;
        Ok(Merged { outcome: outcome(&options, &plan, side_by_side::<E>(typed)), records, sources })
    }
}

/// At least one.
fn gather(sources: &[PathBuf]) -> Result<Vec<Gathered>, ValidateError> {
    let mut gathered: Vec<Gathered> = vec![];
    for path in sources.iter().cloned() {
        let failed = |error| ValidateError::File { action: "read", path: path.clone(), error };
        let text = std::fs::read_to_string(&path).map_err(failed)?;
        let mut lines = whole_lines(&text).lines().enumerate();
        let malformed =
            |line, error| ValidateError::Record { path: path.clone(), line: line + 1, error };
        let Some((line, head)) = lines.next() else { continue };
        let mut head: Value = serde_json::from_str(head).map_err(|e| malformed(line, e))?;
        sweep::without_part(&mut head);
        if let Some(other) = gathered.iter().find(|g| g.setup["experiment"] != head["experiment"]) {
            return Err(other_run(&path, &other.setup, &head));
        }
        let known = gathered.iter().position(|known| known.setup == head).unwrap_or_else(|| {
            let (setup, first) = (head, path.clone());
            gathered.push(Gathered { setup, first, records: BTreeMap::new() });
            gathered.len() - 1
        });
        let all = &mut gathered[known];
        for (line, text) in lines {
            let found: Line<Value> = serde_json::from_str(text).map_err(|e| malformed(line, e))?;
            if let Some((record, other)) = all.records.get(&found.scene) {
                if *record != found.record {
                    return Err(ValidateError::Conflict {
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
    if gathered.is_empty() { Err(nothing()) } else { Ok(gathered) }
}

fn nothing() -> ValidateError {
    let expected = "files ending in .jsonl, or folders with such files".into();
    InputError::Empty { what: "records".into(), expected }.into()
}

fn other_run(path: &Path, expected: &Value, given: &Value) -> ValidateError {
    let (expected, given) = (expected.to_string(), given.to_string());
    ValidateError::OtherRun { path: path.to_owned(), expected, given }
}

/// The files named and those in the folders named, in order of their names.
fn files(sources: &[PathBuf]) -> Result<Vec<PathBuf>, ValidateError> {
    let mut files = vec![];
    for source in sources {
        if !source.is_dir() {
            files.push(source.clone());
            continue;
        }
        let failed = |error| ValidateError::File { action: "read", path: source.clone(), error };
        let mut within = vec![];
        for entry in std::fs::read_dir(source).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            // A named pipe would block.
            if path.extension().is_some_and(|ending| ending == "jsonl") && path.is_file() {
                within.push(path);
            }
        }
        within.sort();
        files.append(&mut within);
    }
    Ok(files)
}
