//! `boresight calibrate`: the angle radars are mounted at, from a drive.

mod report;

use super::mcap::{self, Mcap};
use super::track::Track;
use crate::arguments::CalibrateArguments;
use crate::drive::open_path;
use crate::error::CliError;
use crate::files::Files;
use crate::output::remark;
use crate::run::Run;
use boresight_core::Progress;
use boresight_core::drive::{DriveLog, Sensor};
use boresight_formats::DriveFormat;
use boresight_live::foxglove::ResultTopics;
use boresight_mounting::network::MotionNetwork;
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, Car, FrameInput, Frames, NormalEquations, Outlook,
};
use boresight_pipeline::PipelineError;
use boresight_report::Recorder;
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Frames between two looks at progress and Ctrl-C.
const FRAMES_A_REPORT: usize = 64;

/// What is known of one radar.
struct Calibrated {
    sensor: u8,
    options: CalibrationOptions,
    estimate: AngleEstimate,
    track: Track,
    outlook: Option<Outlook>,
    recorder: Recorder,
    /// With the other radars of the log.
    joint: bool,
    equations: Option<NormalEquations>,
}

/// What is asked of a calibration beside the log.
pub(super) struct Asked<'a> {
    /// Options, with the place and the angle that the log states where they are not given.
    pub options: CalibrationOptions,
    /// Whether `x_m` and `y_m` are given.
    pub place_given: [bool; 2],
    /// Only this radar.
    pub sensor: Option<u8>,
    /// All radars of the log together.
    pub joint: bool,
    /// Where the motion is by one.
    pub network: &'a Arc<MotionNetwork>,
}

/// The angles, as text or JSON.
pub fn run(arguments: &CalibrateArguments, files: &Files) -> Result<String, CliError> {
    let format = arguments.format.as_deref().map(DriveFormat::from_name).transpose()?;
    let read = open_path(&arguments.log, format, files)?;
    remark(read.report.remarks.iter().map(|remark| remark.message.clone()));
    let log = &read.log;
    let shown = chosen(log, arguments.sensor)?;
    if arguments.trajectory.is_some() && shown.len() != 1 {
        return Err(CliError::Option {
            option: "--sensor",
            expected: format!("the radar of the trajectory: {}", ids(log)),
            given: "not given".into(),
        });
    }
    let trajectory =
        arguments.trajectory.as_deref().map(|path| files.destination(path)).transpose()?;
    let mcap = arguments.mcap.as_deref().map(|path| files.destination(path)).transpose()?;
    let report = arguments.report.as_deref().map(|path| files.destination(path)).transpose()?;
    let network = arguments.network.as_deref().map(|path| read_network(path, files)).transpose()?;
    let network = network.unwrap_or_else(boresight_validate::candidates::network);
    let run = Run::start("frames")?;
    let flags = &arguments.flags;
    let asked = Asked {
        options: flags.options,
        place_given: [flags.given("x_m"), flags.given("y_m")],
        sensor: arguments.sensor,
        joint: arguments.joint,
        network: &network,
    };
    let car = car(&asked, log)?;
    let look = |progress| run.report(progress);
    let mut results = match mcap {
        Some(destination) => {
            let mut topics = ResultTopics::new(log, &car)?;
            let channels = topics.channels().to_vec();
            mcap::write(files, destination, &channels, |file| {
                topics.begin(&read.report.remarks, &mut file.out);
                calibrated(car, log, &look, Some(Told { topics, file }))
            })?
        }
        None => calibrated(car, log, &look, None)?,
    };
    run.finish();
    results.retain(|result| shown.iter().any(|sensor| sensor.id == result.sensor));
    if let (Some(trajectory), [result]) = (trajectory, &results[..]) {
        let csv =
            result.track.csv(result.estimate.angle_rad, &result.options).ok_or_else(|| {
                CliError::Option {
                    option: "--trajectory",
                    expected: "a radar ahead of or behind the rear axle whose motion is known"
                        .into(),
                    given: format!("radar {}, x {} m", result.sensor, result.options.x_m),
                }
            })?;
        files.write(trajectory, csv.as_bytes())?;
    }
    if let Some(destination) = report {
        files.write(destination, report::page(&results, files)?.as_bytes())?;
    }
    Ok(if arguments.json {
        let mut objects: Vec<Value> = results.iter().map(report::json).collect();
        let result = if objects.len() == 1 { objects.remove(0) } else { Value::Array(objects) };
        format!("{result:#}\n")
    } else {
        results.iter().map(report::text).collect::<Vec<_>>().join("\n")
    })
}

pub(super) fn read_network(path: &Path, files: &Files) -> Result<Arc<MotionNetwork>, CliError> {
    let read = MotionNetwork::read(&files.read(path)?);
    read.map(Arc::new).map_err(|error| CliError::Network { path: path.into(), error })
}

pub(super) fn ids(log: &DriveLog) -> String {
    log.sensors.iter().map(|s| s.id.to_string()).collect::<Vec<_>>().join(", ")
}

/// The radar asked for, or all.
fn chosen(log: &DriveLog, sensor: Option<u8>) -> Result<Vec<&Sensor>, CliError> {
    let found: Vec<&Sensor> =
        log.sensors.iter().filter(|s| sensor.is_none_or(|id| id == s.id)).collect();
    if found.is_empty() {
        return Err(CliError::Option {
            option: "--sensor",
            expected: format!("a radar of the log: {}", ids(log)),
            given: sensor.map_or("a log without radars".into(), |id| id.to_string()),
        });
    }
    Ok(found)
}

/// The options with the place and the angle that the log states, unless they are given.
pub(super) fn mounted(
    mut options: CalibrationOptions,
    sensor: &Sensor,
    [x_given, y_given]: [bool; 2],
) -> Result<CalibrationOptions, CliError> {
    match sensor.mounting {
        Some(mounting) => {
            if !x_given {
                options.x_m = mounting.x_m;
            }
            if !y_given {
                options.y_m = mounting.y_m;
            }
            options.nominal_rad = options.nominal_rad.or(Some(mounting.yaw_rad));
        }
        None if !x_given => {
            return Err(CliError::Option {
                option: "--x",
                expected:
                    "the radar's distance ahead of the rear axle, m: the log does not state it"
                        .into(),
                given: "not given".into(),
            });
        }
        None => {}
    }
    Ok(options)
}

/// Hands the frames of the radars that `wanted` picks to `add`, in order, until `look` breaks.
pub(super) fn feed<'a>(
    log: &'a DriveLog,
    options: &CalibrationOptions,
    look: &dyn Fn(Progress) -> ControlFlow<()>,
    wanted: impl Fn(u8) -> bool,
    mut add: impl FnMut(u8, FrameInput<'a>) -> Result<(), CliError>,
) -> Result<(), CliError> {
    let frames = Frames::of(log, wanted, options.max_gap_s);
    let total = frames.len();
    for (done, (sensor, frame)) in frames.enumerate() {
        if done % FRAMES_A_REPORT == 0 && look(Progress { done, total }).is_break() {
            return Err(PipelineError::Cancelled { done, total }.into());
        }
        add(sensor, frame)?;
    }
    Ok(())
}

/// The calibration of the radars asked for, or of all radars of the log together.
fn car(asked: &Asked, log: &DriveLog) -> Result<Car, CliError> {
    let one = |sensor: &Sensor| Ok((sensor.id, mounted(asked.options, sensor, asked.place_given)?));
    if asked.joint {
        return Ok(Car::together(log.sensors.iter().map(one).collect::<Result<_, CliError>>()?)?);
    }
    let radars =
        chosen(log, asked.sensor)?.into_iter().map(one).collect::<Result<_, CliError>>()?;
    Ok(Car::apart(radars, Some(asked.network))?)
}

/// The angles of the radars asked for, as `--json` has them but for the outlook, each with its number and what it says to other drives.
pub(super) fn results(
    asked: &Asked,
    log: &DriveLog,
    look: &dyn Fn(Progress) -> ControlFlow<()>,
) -> Result<Vec<(u8, Value, Option<NormalEquations>)>, CliError> {
    let shown: Vec<u8> = chosen(log, asked.sensor)?.iter().map(|sensor| sensor.id).collect();
    let results = calibrated(car(asked, log)?, log, look, None)?;
    let results = results.iter().filter(|result| shown.contains(&result.sensor));
    let told = |result: &Calibrated| {
        let mut told = report::json(result);
        if let Some(fields) = told.as_object_mut() {
            fields.remove("outlook");
        }
        (result.sensor, told, result.equations)
    };
    Ok(results.map(told).collect())
}

/// A pass over the log as messages, and where they go.
struct Told<'a, 'b, 'c> {
    topics: ResultTopics<'a>,
    file: &'b mut Mcap<'c>,
}

/// What a pass over the log tells of each radar of the calibration.
fn calibrated(
    mut car: Car,
    log: &DriveLog,
    look: &dyn Fn(Progress) -> ControlFlow<()>,
    mut told: Option<Told>,
) -> Result<Vec<Calibrated>, CliError> {
    let radars = car.radars().to_vec();
    let mut followed = vec![(Track::default(), Recorder::default()); radars.len()];
    let place = |sensor: u8| radars.iter().position(|(id, _)| *id == sensor);
    let mut scans = log.scans.iter().filter(|scan| place(scan.sensor).is_some());
    feed(
        log,
        &radars[0].1,
        look,
        |id| place(id).is_some(),
        |sensor, frame| {
            let outcome = car.add(sensor, frame)?;
            if let Some(at) = place(sensor) {
                let (track, recorder) = &mut followed[at];
                track.add(log, &radars[at].1, &outcome);
                if recorder.add(&frame, &outcome) {
                    recorder.look(frame.time_s, &car.estimate(sensor)?);
                }
            }
            if let (Some(Told { topics, file }), Some(scan)) = (&mut told, scans.next()) {
                topics.step(scan, outcome, &car, &mut file.out)?;
                file.write()?;
            }
            Ok(())
        },
    )?;
    if let Some(Told { topics, file }) = &mut told {
        topics.end(&car, &mut file.out)?;
    }
    let joint = car.is_joint();
    radars
        .into_iter()
        .zip(followed)
        .map(|((sensor, options), (track, recorder))| {
            let (estimate, outlook) = (car.estimate(sensor)?, car.outlook(sensor));
            let equations = car.normal_equations(sensor);
            Ok(Calibrated { sensor, options, estimate, track, outlook, recorder, joint, equations })
        })
        .collect()
}
