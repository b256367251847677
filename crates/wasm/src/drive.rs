//! Drives, read from files and simulated, as flat typed arrays.

use crate::bytes::{Bytes, File};
use crate::carry;
use crate::error::Fallible;
use crate::read::Read;
use crate::report::reporter;
use boresight_core::Progress;
use boresight_core::Remark;
use boresight_core::drive::DriveLog;
use boresight_core::drive_columns::DriveColumns;
use boresight_formats::drive_log::{
    self, DriveFormat, DriveRead, DriveTopic, DropReason, McapDriveReader, MountingSource,
    ReadReport, TopicOptions,
};
use boresight_mounting::{CalibrationOptions, SignOptions, signs};
use boresight_options::{Described, Flat};
use boresight_simulate::drive::TruthColumns;
use boresight_simulate::{DriveOptions, Scenario, simulate_drive_reporting};
use js_sys::Function;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Scans between two reports.
const SCANS_A_REPORT: usize = 128;

/// How a drive is read.
#[derive(Debug, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ReadDriveOptions {
    /// The format of the files; found from their contents where none is named.
    format: Option<DriveFormat>,
    /// What the signs in them mean.
    signs: Flat<SignOptions>,
    /// Which topics of a recording are read.
    topics: Flat<TopicOptions>,
}

/// Reads a drive from named files.
#[wasm_bindgen(js_name = readDrive)]
pub fn read_drive(files: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let ReadDriveOptions { format, signs, topics } = carry::read_optional(options)?;
    let files = Vec::<File>::read(files, "files")?;
    let files = files.into_iter().map(|file| (file.name, file.bytes)).collect();
    record_of(drive_log::open_owned(files, format, &topics)?, *signs)
}

/// What JavaScript is given of a drive, once its signs are as they are meant.
fn record_of(mut read: DriveRead, signs: SignOptions) -> Fallible<JsValue> {
    let gap_s = CalibrationOptions::default().max_gap_s;
    read.report.remarks.extend(signs::apply(&mut read.log, signs, gap_s)?);
    Ok(carry::write(&DriveRecord::new(&read.log, read.format.name(), &read.report)))
}

/// Reads a drive from the bytes of an MCAP file as they come.
#[wasm_bindgen]
pub struct DriveStream {
    reader: McapDriveReader,
    signs: SignOptions,
}

#[wasm_bindgen]
impl DriveStream {
    /// A reader of the topics that the options name.
    #[wasm_bindgen(constructor)]
    pub fn new(options: &JsValue) -> Fallible<Self> {
        let ReadDriveOptions { format, signs, topics } = carry::read_optional(options)?;
        match format {
            None | Some(DriveFormat::Mcap) => {
                Ok(Self { reader: McapDriveReader::new(topics.0), signs: *signs })
            }
            Some(_) => Err(drive_log::no_drive_log(format, std::iter::empty()).into()),
        }
    }

    /// Takes the next bytes.
    pub fn push(&mut self, bytes: &JsValue) -> Fallible<()> {
        let Bytes(bytes) = Bytes::read(bytes, "bytes")?;
        Ok(self.reader.push(&bytes)?)
    }

    /// Ends a file; what comes next is the next part of the recording.
    #[wasm_bindgen(js_name = endFile)]
    pub fn end_file(&mut self) {
        self.reader.end_file();
    }

    /// The drive; what comes next is of another one.
    pub fn finish(&mut self) -> Fallible<JsValue> {
        record_of(self.reader.take().finish()?, self.signs)
    }
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
    let record = DriveRecord::new(&drive.log, "simulated", &counts);
    Ok(carry::write(&SimulatedDriveRecord { drive: record.into(), truth: drive.truth_columns() }))
}

/// A scenario that can be simulated.
#[derive(Described, Serialize)]
pub struct DriveScenarioInfo {
    /// Its name.
    name: Scenario,
    /// Name for people.
    title: &'static str,
}

/// The scenarios that can be simulated.
#[wasm_bindgen(js_name = driveScenarios)]
pub fn drive_scenarios() -> js_sys::Array {
    carry::write_all(Scenario::ALL.map(|name| DriveScenarioInfo { name, title: name.title() }))
}

/// A drive as read or simulated.
#[derive(Described, Serialize)]
#[option(name = "Drive")]
pub struct DriveRecord<'a> {
    /// The format it was read from, or `simulated`.
    #[option(typescript = "DriveFormat | 'simulated'")]
    format: &'static str,
    /// Radars, scans, detections and motion.
    columns: Flat<DriveColumns>,
    /// Where the radars' places are from, where the log has any.
    mountings: Option<MountingSource>,
    /// What the files held.
    counts: DriveCounts,
    /// Topics of a recording and what each is used for; none in other formats.
    topics: &'a [DriveTopic],
    /// When the drive begins by the clock of the recording, since 1970, where its times were shifted.
    start_s: Option<f64>,
    /// What else to know.
    warnings: &'a [Remark],
}

/// A simulated drive with the truth behind it; its poses are the true ones.
#[derive(Described, Serialize)]
#[option(name = "SimulatedDrive")]
pub struct SimulatedDriveRecord<'a> {
    /// What a log of the drive holds.
    drive: Flat<DriveRecord<'a>>,
    /// What really happened.
    truth: TruthColumns,
}

/// What the files of a drive held.
#[derive(Described, Serialize)]
pub struct DriveCounts {
    /// Detections in the files.
    detections: u64,
    /// Motion samples in the files.
    motion: u64,
    /// Detections kept although their range, cross-section, compensated rate or place is no number.
    incomplete_detections: u64,
    /// Motion samples kept although their speed or pose is no number.
    incomplete_motion: u64,
    /// Rows left out, by reason.
    #[option(typescript = "Partial<Record<DropReason, number>>")]
    dropped: BTreeMap<DropReason, u64>,
}

impl<'a> DriveRecord<'a> {
    fn new(log: &DriveLog, format: &'static str, report: &'a ReadReport) -> Self {
        Self {
            format,
            columns: DriveColumns::from(log).into(),
            mountings: report.mountings,
            counts: DriveCounts {
                detections: report.detections,
                motion: report.motion,
                incomplete_detections: report.incomplete,
                incomplete_motion: report.motion_incomplete,
                dropped: report.drops().collect(),
            },
            topics: &report.topics,
            start_s: report.start_s,
            warnings: &report.remarks,
        }
    }
}
