//! `boresight fleet worker`: the process that calibrates the logs of one thread of `fleet run`.

use super::{log, memory};
use crate::arguments::{FleetWorkerArguments, LogPaths};
use crate::commands::calibrate::{Asked, results};
use crate::drive::open_path;
use crate::error::CliError;
use crate::files::Files;
use crate::flags::Flags;
use boresight_core::Diagnose;
use boresight_fleet::record::{Done, Failure, RadarRecord};
use boresight_fleet::store::line;
use boresight_fleet::worker::{ACCEPTED, READY, Workers};
use boresight_fleet::{FleetError, Job, Jobs, Record};
use boresight_formats::{DriveFormat, json};
use boresight_mounting::network::MotionNetwork;
use boresight_options::Described;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, mpsc};
use std::time::Duration;

/// Returns the workers of a run.
pub(super) fn workers(
    time_limit: Duration,
    memory_limit: Option<u64>,
) -> Result<Workers<impl Fn() -> Command>, CliError> {
    let program = this_program()?;
    let command = move || {
        let mut command = Command::new(&program);
        command.args(["fleet", "worker"]);
        if let Some(bytes) = memory_limit {
            command.args(["--memory-limit", &bytes.to_string()]);
        }
        command
    };
    Ok(Workers { command, time_limit })
}

/// The file of this program. On Linux by the name that still leads to it after an upgrade has replaced the file.
fn this_program() -> Result<PathBuf, CliError> {
    let itself = Path::new("/proc/self/exe");
    if cfg!(target_os = "linux") && itself.exists() {
        return Ok(itself.into());
    }
    std::env::current_exe().map_err(|error| CliError::File {
        action: "start",
        path: "boresight".into(),
        error,
    })
}

/// Calibrates logs until the standard input ends.
pub(super) fn run(arguments: &FleetWorkerArguments) -> Result<String, CliError> {
    if let Some(bytes) = arguments.memory_limit {
        memory::limit(bytes).map_err(|error| CliError::Option {
            option: "--memory-limit",
            expected: "a limit that the system accepts".into(),
            given: format!("{bytes} bytes: {error}"),
        })?;
    }
    let network = boresight_validate::candidates::network();
    let (sender, jobs) = mpsc::sync_channel(1);
    std::thread::spawn(move || {
        for job in Jobs::new(std::io::stdin().lock(), Path::new("the standard input")) {
            if sender.send(job).is_err() {
                return;
            }
        }
        // The run has ended, and with it the use of a log that is still being calibrated, perhaps forever.
        std::process::exit(0);
    });
    let mut out = std::io::stdout().lock();
    let mut print = |text: &str| {
        let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
        written.map_err(|error| FleetError::file("write", Path::new("the standard output"), error))
    };
    print(READY)?;
    for job in jobs {
        let job = job?;
        print(ACCEPTED)?;
        print(&line(&record(&job, &network))?)?;
    }
    Ok(String::new())
}

fn record(job: &Job, network: &Arc<MotionNetwork>) -> Record {
    match done(job, network) {
        Ok(done) => Record::success(job, done),
        Err(error) => {
            let details = error.details();
            Record::failure(
                job,
                Failure {
                    code: error.code().into(),
                    message: error.to_string(),
                    what: details.what,
                    expected: details.expected,
                    given: details.given,
                },
            )
        }
    }
}

fn done(job: &Job, network: &Arc<MotionNetwork>) -> Result<Done, CliError> {
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
    let radars = results(&asked, &read.log, &|_| ControlFlow::Continue(()))?;
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
