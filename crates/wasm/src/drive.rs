//! Drives, read from files and simulated, as flat typed arrays.

use crate::bytes::Bytes;
use crate::carry;
use crate::error::Fallible;
use crate::read::{Fields, Read, choice};
use crate::report::reporter;
use crate::write::{Record, float32, float64, list, remarks};
use boresight_core::drive::{DriveLog, MotionSample, Mounting, Sensor};
use boresight_formats::drive_log::{self, DriveFormat, ReadReport};
use boresight_pipeline::Progress;
use boresight_simulate::drive::SimulatedDrive;
use boresight_simulate::{DriveOptions, Scenario, simulate_drive_reporting};
use js_sys::{Function, Uint8Array, Uint32Array};
use std::ops::ControlFlow;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Scans between two reports.
const SCANS_A_REPORT: usize = 128;

/// Reads a drive from named files.
#[wasm_bindgen(js_name = readDrive)]
pub fn read_drive(files: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::of_optional(options)?;
    let format = fields.optional("format")?;
    fields.finish()?;
    let files = Vec::<File>::read(files, "files")?;
    let files = files.into_iter().map(|file| (file.name, file.bytes)).collect();
    let read = drive_log::open_owned(files, format)?;
    Ok(drive_record(&read.log, read.format.name(), &read.report).into())
}

/// Simulates a drive.
#[wasm_bindgen(js_name = simulateDrive)]
pub fn simulate_drive(options: &JsValue, report: Option<Function>) -> Fallible<JsValue> {
    let options: DriveOptions = carry::read_optional(options)?;
    let mut report = reporter(report);
    let drive = simulate_drive_reporting(&options, |done, total| {
        if done % SCANS_A_REPORT == 0 {
            report(Progress { done, total })
        } else {
            ControlFlow::Continue(())
        }
    })?;
    let scans = &drive.log.scans;
    let _ = report(Progress { done: scans.len(), total: scans.len() });
    let mut counts = ReadReport::default();
    counts.detections = scans.iter().map(|scan| scan.detections.len() as u64).sum();
    counts.motion = drive.log.motion.len() as u64;
    let record = drive_record(&drive.log, "simulated", &counts);
    Ok(record.with("truth", truth_record(&drive)).into())
}

/// The scenarios that can be simulated.
#[wasm_bindgen(js_name = driveScenarios)]
pub fn drive_scenarios() -> js_sys::Array {
    list(Scenario::ALL.map(|s| Record::new().with("name", s.name()).with("title", s.title())))
}

struct File {
    name: String,
    bytes: Vec<u8>,
}

impl Read for File {
    const EXPECTED: &'static str = "{ name, bytes }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let name = fields.required("name")?;
        let Bytes(bytes) = fields.required("bytes")?;
        fields.finish()?;
        Ok(Self { name, bytes })
    }
}

impl Read for DriveFormat {
    const EXPECTED: &'static str = "the name of a format";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        choice(value, path, &Self::ALL.map(|format| (format.name(), format)))
    }
}

fn drive_record(log: &DriveLog, format: &str, report: &ReadReport) -> Record {
    let sensors = log.sensors.iter().map(|Sensor { id, mounting }| {
        let number = |of: fn(&Mounting) -> f64| {
            mounting.as_ref().map_or(JsValue::NULL, |mounting| of(mounting).into())
        };
        Record::new()
            .with("id", *id)
            .with("xM", number(|m| m.x_m))
            .with("yM", number(|m| m.y_m))
            .with("yawDeg", number(|m| m.yaw_rad.to_degrees()))
    });
    let mut dropped = Record::new();
    for (reason, count) in report.drops() {
        dropped = dropped.with(reason.code(), count as f64);
    }
    let counts = Record::new()
        .with("detections", report.detections as f64)
        .with("motion", report.motion as f64)
        .with("incompleteDetections", report.incomplete as f64)
        .with("incompleteMotion", report.motion_incomplete as f64)
        .with("dropped", dropped);
    Record::new()
        .with("format", format)
        .with("sensors", list(sensors))
        .with("mountings", report.mountings.map_or(JsValue::NULL, |from| from.name().into()))
        .with("scans", scans_record(log))
        .with("detections", detections_record(log))
        .with("motion", motion_record(&log.motion))
        .with("counts", counts)
        .with("warnings", remarks(&report.remarks))
}

fn scans_record(log: &DriveLog) -> Record {
    let times: Vec<f64> = log.scans.iter().map(|scan| scan.time_s).collect();
    let sensors: Vec<u8> = log.scans.iter().map(|scan| scan.sensor).collect();
    let mut offsets = Vec::with_capacity(log.scans.len() + 1);
    offsets.push(0);
    let mut count = 0;
    for scan in &log.scans {
        count += scan.detections.len() as u32;
        offsets.push(count);
    }
    Record::new()
        .with("timeS", float64(&times))
        .with("sensor", Uint8Array::new_from_slice(&sensors))
        .with("offsets", Uint32Array::new_from_slice(&offsets))
}

fn detections_record(log: &DriveLog) -> Record {
    let all = || log.scans.iter().flat_map(|scan| &scan.detections);
    let azimuth: Vec<f64> = all().map(|d| f64::from(d.azimuth_rad).to_degrees()).collect();
    let record = Record::new().with("azimuthDeg", float64(&azimuth));
    drop(azimuth);
    let rate: Vec<f32> = all().map(|d| d.range_rate_mps).collect();
    let record = record.with("rangeRateMps", float32(&rate));
    drop(rate);
    let range: Vec<f32> = all().map(|d| d.range_m).collect();
    let record = record.with("rangeM", float32(&range));
    drop(range);
    let rcs: Vec<f32> = all().map(|d| d.rcs_dbsm).collect();
    let record = record.with("rcsDbsm", float32(&rcs));
    drop(rcs);
    let labels: Vec<u8> = log.scans.iter().flat_map(|scan| scan.labels.iter().copied()).collect();
    let labelled = !labels.is_empty() && labels.len() == all().count();
    let labels = labelled.then(|| Uint8Array::new_from_slice(&labels));
    record.with("label", labels.map_or(JsValue::NULL, JsValue::from))
}

fn motion_record(motion: &[MotionSample]) -> Record {
    let column =
        |of: &dyn Fn(&MotionSample) -> f64| float64(&motion.iter().map(of).collect::<Vec<_>>());
    let posed = motion.iter().any(|sample| sample.pose.is_some());
    let pose = posed.then(|| {
        Record::new()
            .with("xM", column(&|s| s.pose.map_or(f64::NAN, |p| p.x_m)))
            .with("yM", column(&|s| s.pose.map_or(f64::NAN, |p| p.y_m)))
            .with("yawDeg", column(&|s| s.pose.map_or(f64::NAN, |p| p.yaw_rad.to_degrees())))
    });
    Record::new()
        .with("timeS", column(&|s| s.time_s))
        .with("yawRateDegps", column(&|s| s.yaw_rate_radps.to_degrees()))
        .with("speedMps", column(&|s| s.speed_mps.unwrap_or(f64::NAN)))
        .with("pose", pose.map_or(JsValue::NULL, JsValue::from))
}

fn truth_record(drive: &SimulatedDrive) -> Record {
    let truth = &drive.truth;
    let sensors = truth.sensors.iter().map(|(id, mounting)| {
        Record::new()
            .with("id", *id)
            .with("xM", mounting.x_m)
            .with("yM", mounting.y_m)
            .with("yawDeg", mounting.yaw_rad.to_degrees())
    });
    let yaw_rate = Record::new()
        .with("scale", truth.yaw_rate.scale)
        .with("biasDegps", truth.yaw_rate.bias_radps.to_degrees())
        .with("sigmaDegps", truth.yaw_rate.sigma_radps.to_degrees());
    let rates: Vec<f64> = truth.motion.iter().map(|m| m.yaw_rate_radps.to_degrees()).collect();
    let speeds: Vec<f64> = truth.motion.iter().map(|m| m.speed_mps).collect();
    let motion =
        Record::new().with("yawRateDegps", float64(&rates)).with("speedMps", float64(&speeds));
    let moving: Vec<u8> = drive.moving.iter().flatten().map(|&moves| u8::from(moves)).collect();
    let tracks: Vec<u32> = drive.tracks.iter().flatten().copied().collect();
    Record::new()
        .with("sensors", list(sensors))
        .with("yawRate", yaw_rate)
        .with("motion", motion)
        .with("moving", Uint8Array::new_from_slice(&moving))
        .with("track", Uint32Array::new_from_slice(&tracks))
}
