//! `boresight fleet plan`.

use super::{lines_of, log, threads};
use crate::arguments::FleetPlanArguments;
use crate::drive::drives_of_data_set;
use crate::error::CliError;
use crate::files::Files;
use crate::flags::{Flags, OnCommandLine};
use crate::output::remark;
use crate::run::Run;
use boresight_core::Progress;
use boresight_fleet::job::Settings;
use boresight_fleet::parallel;
use boresight_fleet::pattern::DEFAULT_PATTERN;
use boresight_fleet::plan::Distinct;
use boresight_fleet::schema::SCHEMA;
use boresight_fleet::{FleetError, Job, Pattern};
use boresight_formats::json;
use boresight_options::naming::javascript;
use boresight_pipeline::PipelineError;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};

/// A log as it is listed.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Listed {
    path: String,
    vehicle: Option<String>,
    drive: Option<String>,
    time_s: Option<f64>,
}

/// Where vehicles are from.
enum Vehicles {
    One(String),
    InPath(Pattern),
}

/// Plans the logs.
pub(super) fn run(arguments: &FleetPlanArguments, files: &Files) -> Result<String, CliError> {
    let vehicles = match arguments.vehicle.as_deref() {
        Some(name) if !name.contains(['{', '}']) => Vehicles::One(name.into()),
        pattern => Vehicles::InPath(Pattern::new(pattern.unwrap_or(DEFAULT_PATTERN))?),
    };
    let standard_output = || PathBuf::from("/dev/stdout");
    let out = arguments.out.clone().unwrap_or_else(standard_output);
    let out = files.destination(&out)?;
    let settings = settings(arguments);
    let mut listed: Vec<Listed> = arguments
        .logs
        .iter()
        .map(|path| Ok(Listed { path: text_of(path)?, ..Listed::default() }))
        .collect::<Result<_, CliError>>()?;
    if let Some(list) = &arguments.list {
        read_list(list, files, &mut listed)?;
    }
    let mut logs = vec![];
    for entry in listed {
        match drives_of_data_set(Path::new(&entry.path), files)? {
            Some(sequences) => {
                for path in sequences {
                    logs.push(Listed { path: text_of(&path)?, drive: None, ..entry.clone() });
                }
            }
            None => logs.push(entry),
        }
    }
    let run = Run::start("logs")?;
    let total = logs.len();
    let mut distinct = Distinct::default();
    let mut done = 0;
    parallel::each(
        &logs,
        threads(arguments.threads),
        |entry| job(entry, &vehicles, &settings),
        |job: Result<Job, CliError>| -> Result<(), CliError> {
            distinct.add(job?)?;
            done += 1;
            if run.report(Progress { done, total }).is_break() {
                return Err(PipelineError::Cancelled { done, total }.into());
            }
            Ok(())
        },
    )?;
    run.finish();
    let copies = distinct.copies();
    let jobs = distinct.into_jobs();
    if copies > 0 {
        let is = if copies == 1 { "log is a copy" } else { "logs are copies" };
        remark([format!("{copies} {is} of others and left out")]);
    }
    let named = out.named().to_owned();
    files.write_with(out, |file| {
        let mut file = std::io::BufWriter::with_capacity(1 << 18, file);
        for job in &jobs {
            let line = serde_json::to_string(job).map_err(std::io::Error::from);
            line.and_then(|line| writeln!(file, "{line}"))
                .map_err(|error| FleetError::file("write", &named, error))?;
        }
        file.flush().map_err(|error| FleetError::file("write", &named, error))?;
        Ok(())
    })?;
    let mut names: Vec<&str> = jobs.iter().map(|job| &*job.vehicle).collect();
    names.sort_unstable();
    names.dedup();
    let timed = jobs.iter().filter(|job| job.time_s.is_some()).count();
    Ok(format!(
        "{} logs of {} vehicles, {timed} of them with a time, {copies} copies left out\n",
        jobs.len(),
        names.len(),
    ))
}

fn settings(arguments: &FleetPlanArguments) -> Settings {
    Settings {
        format: arguments.format.clone(),
        sensor: arguments.sensor,
        joint: arguments.joint,
        calibration: given(&arguments.flags),
        signs: given(&arguments.signs),
        topics: given(&arguments.topics),
    }
}

/// The options that were given, by their names in JavaScript.
fn given<T: OnCommandLine>(flags: &Flags<T>) -> Map<String, Value> {
    let Value::Object(all) = json::result(&flags.options) else { return Map::new() };
    let names: Vec<String> = flags.all_given().iter().map(|name| javascript(name)).collect();
    all.into_iter().filter(|(name, _)| names.contains(name)).collect()
}

/// Paths stand in plans, which are text.
fn text_of(path: &Path) -> Result<String, CliError> {
    path.to_str().map(Into::into).ok_or_else(|| CliError::Option {
        option: "LOG",
        expected: "a path in UTF-8".into(),
        given: format!("{path:?}"),
    })
}

fn read_list(list: &Path, files: &Files, listed: &mut Vec<Listed>) -> Result<(), CliError> {
    for (at, line) in lines_of(list, files)?.lines().enumerate() {
        let line = line.map_err(|error| FleetError::file("read", list, error))?;
        let text = line.trim_end_matches('\r');
        if text.trim().is_empty() {
            continue;
        }
        listed.push(if text.trim_start().starts_with('{') {
            let line = at as u64 + 1;
            serde_json::from_str(text).map_err(|error| FleetError::Plan {
                path: list.into(),
                line,
                error,
            })?
        } else {
            Listed { path: text.into(), ..Listed::default() }
        });
    }
    Ok(())
}

fn job(entry: &Listed, vehicles: &Vehicles, settings: &Settings) -> Result<Job, CliError> {
    let path = Path::new(&entry.path);
    let named = match vehicles {
        // What the list says of a log needs no pattern.
        _ if entry.vehicle.is_some() => boresight_fleet::pattern::Named::default(),
        Vehicles::One(name) => {
            boresight_fleet::pattern::Named { vehicle: Some(name.clone()), ..Default::default() }
        }
        Vehicles::InPath(pattern) => {
            // A path that is relative may begin below the vehicle's folder.
            let whole =
                std::path::absolute(path).map_err(|error| FleetError::file("read", path, error))?;
            pattern.read(&whole.to_string_lossy().replace(std::path::MAIN_SEPARATOR, "/"))?
        }
    };
    let last = || path.file_name().map(|name| name.to_string_lossy().into_owned());
    let files = log::digests(path)?;
    Ok(Job {
        key: Job::key_of(&files, settings),
        path: entry.path.clone(),
        vehicle: entry.vehicle.clone().or(named.vehicle).unwrap_or_default(),
        drive: entry.drive.clone().or(named.drive).or_else(last).unwrap_or_default(),
        time_s: entry.time_s.or(named.time_s),
        files,
        settings: settings.clone(),
        schema: SCHEMA,
    })
}
