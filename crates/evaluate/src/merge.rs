//! Parts of a sweep, run anywhere, put together.

use crate::EvaluateError;
use crate::aoa;
use crate::arrays;
use crate::calibration;
use crate::doa;
use crate::experiment::{
    Experiment, Records, file_name, legs, outcome, setup, side_by_side, whole,
};
use crate::images;
use crate::imperfections;
use crate::low_snr;
use crate::near_field;
use crate::outcome::Outcome;
use crate::resolution;
use crate::straddling;
use crate::sweep::{self, Line, Part};
use boresight_core::CoreError;
use boresight_core::lines::whole_lines;
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

/// The records of one run by some of its entrants, from several files.
struct Gathered {
    setup: Value,
    first: PathBuf,
    records: BTreeMap<u64, (Value, PathBuf)>,
}

/// Puts together the records in `sources`, files of records or folders of them. Records of methods and of networks in
/// the same scenes come side by side.
///
/// # Errors
/// [`EvaluateError::OtherRun`] where setups differ, or are not what this version would run;
/// [`EvaluateError::Conflict`] where two files hold different records of a scene; [`EvaluateError::Incomplete`]
/// where scenes are missing; [`CoreError::Empty`] where there are no records; those of the files.
pub fn merge(sources: &[PathBuf]) -> Result<Merged, EvaluateError> {
    let sources = files(sources)?;
    let gathered = gather(&sources)?;
    let first = &gathered[0];
    let name = first.setup["experiment"].as_str().unwrap_or_default();
    match name {
        aoa::AoaExperiment::NAME => merge_as::<aoa::AoaExperiment>(gathered, sources),
        arrays::ArraysExperiment::NAME => merge_as::<arrays::ArraysExperiment>(gathered, sources),
        calibration::DrivesExperiment::NAME => {
            merge_as::<calibration::DrivesExperiment>(gathered, sources)
        }
        calibration::CalibrationExperiment::NAME => {
            merge_as::<calibration::CalibrationExperiment>(gathered, sources)
        }
        doa::DoaExperiment::NAME => merge_as::<doa::DoaExperiment>(gathered, sources),
        images::ImagesExperiment::NAME => merge_as::<images::ImagesExperiment>(gathered, sources),
        imperfections::ImperfectionsExperiment::NAME => {
            merge_as::<imperfections::ImperfectionsExperiment>(gathered, sources)
        }
        low_snr::LowSnrExperiment::NAME => merge_as::<low_snr::LowSnrExperiment>(gathered, sources),
        resolution::ResolutionExperiment::NAME => {
            merge_as::<resolution::ResolutionExperiment>(gathered, sources)
        }
        near_field::NearFieldExperiment::NAME => {
            merge_as::<near_field::NearFieldExperiment>(gathered, sources)
        }
        straddling::StraddlingExperiment::NAME => {
            merge_as::<straddling::StraddlingExperiment>(gathered, sources)
        }
        _ => Err(CoreError::Unknown {
            what: format!("experiment of {}", first.first.display()),
            expected:
                "aoa, arrays, calibration, calibration-drives, doa, images, imperfections, low-snr, near-field, resolution, straddling"
                    .into(),
            given: name.into(),
        }
        .into()),
    }
}

/// At least one.
fn gather(sources: &[PathBuf]) -> Result<Vec<Gathered>, EvaluateError> {
    let mut gathered: Vec<Gathered> = vec![];
    for path in sources.iter().cloned() {
        let failed = |error| EvaluateError::File { action: "read", path: path.clone(), error };
        let text = std::fs::read_to_string(&path).map_err(failed)?;
        let mut lines = whole_lines(&text).lines().enumerate();
        let malformed =
            |line, error| EvaluateError::Record { path: path.clone(), line: line + 1, error };
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
    if gathered.is_empty() { Err(nothing()) } else { Ok(gathered) }
}

fn nothing() -> EvaluateError {
    let expected = "files ending in .jsonl, or folders with such files".into();
    CoreError::Empty { what: "records".into(), expected }.into()
}

fn other_run(path: &Path, expected: &Value, given: &Value) -> EvaluateError {
    let (expected, given) = (expected.to_string(), given.to_string());
    EvaluateError::OtherRun { path: path.to_owned(), expected, given }
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

fn merge_as<E: Experiment>(
    gathered: Vec<Gathered>,
    sources: Vec<PathBuf>,
) -> Result<Merged, EvaluateError> {
    let mut found = vec![];
    for Gathered { setup: head, first, .. } in &gathered {
        let malformed = |error| EvaluateError::Record { path: first.clone(), line: 1, error };
        let options = E::deserialize(&head["options"]).map_err(malformed)?;
        let expected = setup(&options, &options.plan()?);
        if *head != expected {
            return Err(other_run(first, &expected, head));
        }
        found.push(options);
        if whole(&found).is_none() {
            return Err(other_run(first, &gathered[0].setup, head));
        }
    }
    let Some(options) = whole(&found) else { return Err(nothing()) };
    let scenes = 0..options.scenes();
    // In the order of a run that was never split.
    let (mut typed, mut records): (Vec<Records<E>>, _) = (vec![], vec![]);
    let mut gathered: Vec<_> = found.into_iter().zip(gathered).collect();
    for leg in legs(&options) {
        let Some(at) = gathered.iter().position(|(options, _)| *options == leg) else { continue };
        let of_all = gathered.swap_remove(at).1.records;
        let missing = scenes.clone().filter(|scene| !of_all.contains_key(scene));
        if let Some(first) = missing.clone().next() {
            let missing = missing.count();
            return Err(EvaluateError::Incomplete { missing, first, total: scenes.end });
        }
        let mut of_leg = Records::<E>::new();
        for (scene, (record, path)) in of_all {
            if scenes.contains(&scene) {
                let malformed = |error| EvaluateError::Scene { path, scene, error };
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
    Ok(Merged { outcome: outcome(&options, &plan, side_by_side::<E>(typed))?, records, sources })
}
