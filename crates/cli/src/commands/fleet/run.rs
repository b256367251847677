//! `boresight fleet run`.

use super::{lines_of, log, part, threads};
use crate::arguments::{FleetRunArguments, LogPaths, WhichPart};
use crate::commands::calibrate::{Asked, results};
use crate::drive::open_path;
use crate::error::CliError;
use crate::files::{Files, make_folder};
use crate::flags::Flags;
use crate::run::Run;
use boresight_calibrate::network::MotionNetwork;
use boresight_core::describe::Described;
use boresight_core::{Diagnose, Part};
use boresight_fleet::record::{Done, Failure, RadarRecord};
use boresight_fleet::run::{RunCounts, run as run_jobs};
use boresight_fleet::store::{self, Store, keys_of, line};
use boresight_fleet::{FleetError, Job, Jobs, Record};
use boresight_formats::{DriveFormat, json};
use boresight_pipeline::{PipelineError, Progress};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs a plan or a part of it.
pub(super) fn run(arguments: &FleetRunArguments, files: &Files) -> Result<String, CliError> {
    let part = match arguments.part {
        None => Part::WHOLE,
        Some(WhichPart::Given(part)) => part,
        Some(WhichPart::Auto) => part::of_variables(|name| std::env::var(name).ok())?,
    };
    let network = boresight_evaluate::calibration::network();
    let work = |job: &Job, stop: &AtomicBool| record(job, &network, stop);
    let run = Run::start("logs")?;
    let threads = threads(arguments.threads);
    let Some(folder) = &arguments.out else {
        let jobs = Jobs::new(lines_of(&arguments.plan, files)?, &arguments.plan);
        let jobs = of_part(jobs, part);
        let stdout = std::io::stdout();
        let printed = Path::new("the standard output");
        let keep = |record: &Record| {
            let line = line(record)?;
            let mut out = stdout.lock();
            out.write_all(line.as_bytes())
                .and_then(|()| out.flush())
                .map_err(|error| FleetError::file("write", printed, error))
        };
        let look = |counts: RunCounts| look(&run, counts.all() as usize, 0);
        run_jobs(jobs, threads, work, keep, look)?;
        run.finish();
        return Ok(String::new());
    };
    make_folder(folder)?;
    let path = folder.join(part.file_name(store::NAME));
    let mut store = Store::open(&path)?;
    // Records of other parts count too: who runs with another number of parts goes on with what is there.
    let there: HashSet<String> = keys_of(folder, arguments.retry)?;
    let plan = Jobs::new(lines_of(&arguments.plan, files)?, &arguments.plan);
    let mut jobs = vec![];
    let (mut found, mut planned) = (0_u64, HashSet::new());
    for job in of_part(plan, part) {
        let job = job?;
        if there.contains(&job.key) {
            found += 1;
        } else if planned.insert(job.key.clone()) {
            jobs.push(job);
        }
    }
    let total = jobs.len();
    let keep = |record: &Record| store.append(record);
    let look = |counts: RunCounts| look(&run, counts.all() as usize, total);
    let ended = run_jobs(jobs.into_iter().map(Ok), threads, work, keep, look);
    store.sync()?;
    run.finish();
    let counts = ended?;
    Ok(format!(
        "Part {part}: {} logs calibrated, {} failed, {found} had a record; {}\n",
        counts.done,
        counts.failed,
        path.display(),
    ))
}

/// The jobs of a part, by their place in the plan.
fn of_part<I: Iterator<Item = Result<Job, FleetError>>>(
    jobs: I,
    part: Part,
) -> impl Iterator<Item = Result<Job, FleetError>> {
    jobs.enumerate()
        .filter(move |(at, job)| job.is_err() || part.contains(*at as u64))
        .map(|(_, job)| job)
}

fn look(run: &Run, done: usize, total: usize) -> ControlFlow<()> {
    run.report(Progress { done, total: total.max(done) })
}

/// The record of a job; none where it was stopped.
fn record(job: &Job, network: &Arc<MotionNetwork>, stop: &AtomicBool) -> Option<Record> {
    match done(job, network, stop) {
        Ok(done) => Some(Record::success(job, done)),
        Err(CliError::Pipeline(PipelineError::Cancelled { .. })) => None,
        Err(error) => {
            let details = error.details();
            Some(Record::failure(
                job,
                Failure {
                    code: error.code().into(),
                    message: error.to_string(),
                    what: details.what,
                    expected: details.expected,
                    given: details.given,
                },
            ))
        }
    }
}

fn done(job: &Job, network: &Arc<MotionNetwork>, stop: &AtomicBool) -> Result<Done, CliError> {
    let path = Path::new(&job.path);
    let mut found = log::digests(path)?;
    let mut planned = job.files.clone();
    found.sort();
    planned.sort();
    if let Some(other) = planned.iter().find(|file| !found.contains(file)) {
        return Err(CliError::Changed {
            path: path.into(),
            expected: format!("{} of {} bytes, SHA-256 {}", other.name, other.bytes, other.sha256),
        });
    }
    if let Some(other) = found.iter().find(|file| !planned.contains(file)) {
        return Err(CliError::Changed {
            path: path.into(),
            expected: format!("no file {}", other.name),
        });
    }
    let settings = &job.settings;
    let log = LogPaths {
        paths: vec![path.into()],
        sequence: None,
        signs: Flags::of(options(&settings.signs, path)?),
        topics: Flags::of(options(&settings.topics, path)?),
    };
    let format = settings.format.as_deref().map(DriveFormat::from_name).transpose()?;
    let read = open_path(&log, format, &Files::new(false))?;
    let is_given = |name: &str| settings.calibration.contains_key(name);
    let asked = Asked {
        options: options(&settings.calibration, path)?,
        place_given: [is_given("xM"), is_given("yM")],
        sensor: settings.sensor,
        joint: settings.joint,
        network,
    };
    let stopped = |_| {
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let radars = results(&asked, &read.log, &stopped)?;
    let scans = &read.log.scans;
    let ends = scans.first().zip(scans.last());
    Ok(Done {
        format: read.format.name().into(),
        duration_s: ends.map_or(0.0, |(first, last)| last.time_s - first.time_s),
        remarks: read.report.remarks.iter().map(|remark| remark.message.to_string()).collect(),
        radars: radars
            .into_iter()
            .map(|(sensor, result, equations)| RadarRecord { sensor, result, equations })
            .collect(),
    })
}

/// Options as a plan has them.
fn options<T: DeserializeOwned + Described>(
    given: &Map<String, Value>,
    path: &Path,
) -> Result<T, CliError> {
    let text = Value::Object(given.clone()).to_string();
    json::read(text.as_bytes()).map_err(|error| CliError::Json {
        path: path.into(),
        expected: "options by their names in JavaScript",
        error,
    })
}
