//! The general tables of a drive: one of detections, one of the car's motion, both as CSV with a
//! header line, columns in any order and others beside them.
//!
//! Detections: `time_s`, `azimuth_rad` or `azimuth_deg`, `range_rate_mps`; optional `sensor`
//! (a number from 0 to 255; 1 without it), `range_m`, `rcs_dbsm`. Rows of the same time and sensor
//! are one scan; times of a sensor must not run backwards.
//!
//! Motion: `time_s`, `yaw_rate_radps` or `yaw_rate_degps`; optional `speed_mps`, and the pose as
//! `x_m`, `y_m`, `yaw_rad` together. Times must not run backwards.

use super::report::{DropReason, ReadReport};
use super::scans::Scans;
use super::text::{Rows, line};
use super::{motion, text};
use crate::error::FormatError;
use crate::tables::{Columns, field};
use boresight_core::drive::{DriveLog, MotionSample, Pose, Sensor};
use std::fmt::{Display, Formatter};
use std::io::Write;

const POSE_COLUMNS: [&str; 3] = ["x_m", "y_m", "yaw_rad"];

/// A column given in one of two units.
struct Angle {
    column: usize,
    name: &'static str,
    factor: f64,
}

impl Angle {
    fn find(columns: &Columns, radians: &'static str, degrees: &'static str) -> Option<Self> {
        let turn = 1.0_f64.to_radians();
        columns.find(radians).map(|column| Self { column, name: radians, factor: 1.0 }).or_else(
            || columns.find(degrees).map(|c| Self { column: c, name: degrees, factor: turn }),
        )
    }

    fn need(
        columns: &Columns,
        radians: &'static str,
        degrees: &'static str,
    ) -> Result<Self, FormatError> {
        Self::find(columns, radians, degrees).ok_or_else(|| FormatError::Table {
            line: 1,
            what: format!("column {radians} or {degrees}"),
            expected: "in the header line".into(),
            given: "none".into(),
        })
    }

    fn read(&self, row: &csv::StringRecord) -> Result<f64, FormatError> {
        Ok(self.factor * field::<f64>(row, self.column, self.name, "a number")?)
    }
}

/// A number that may be missing: NaN without the column or where the field is empty.
fn optional(row: &csv::StringRecord, at: Option<usize>, name: &str) -> Result<f64, FormatError> {
    match at {
        Some(at) if !row.get(at).unwrap_or_default().trim().is_empty() => {
            field(row, at, name, "a number")
        }
        _ => Ok(f64::NAN),
    }
}

/// Reads the table of detections, plain or packed with gzip; the log has no motion yet.
///
/// # Errors
/// [`FormatError::Table`] naming line and column, [`FormatError::TimeBackwards`],
/// [`FormatError::Compressed`].
pub fn read_detections(bytes: &[u8], report: &mut ReadReport) -> Result<DriveLog, FormatError> {
    let mut rows = Rows::open(bytes)?;
    let time_at = rows.columns.need("time_s")?;
    let azimuth_at = Angle::need(&rows.columns, "azimuth_rad", "azimuth_deg")?;
    let rate_at = rows.columns.need("range_rate_mps")?;
    let [sensor_at, range_at, rcs_at] =
        ["sensor", "range_m", "rcs_dbsm"].map(|name| rows.columns.find(name));
    let mut scans = Scans::default();
    while let Some(row) = rows.next()? {
        report.detections += 1;
        let time_s: f64 = field(row, time_at, "time_s", "a number")?;
        let azimuth = azimuth_at.read(row)?;
        let rate: f64 = field(row, rate_at, "range_rate_mps", "a number")?;
        let sensor =
            sensor_at.map_or(Ok(1), |at| field(row, at, "sensor", "an integer up to 255"))?;
        let range = optional(row, range_at, "range_m")?;
        let rcs = optional(row, rcs_at, "rcs_dbsm")?;
        text::turn(row, azimuth_at.column, azimuth_at.name, azimuth)?;
        if !time_s.is_finite() {
            report.drop(DropReason::NotFinite);
            continue;
        }
        let scan = scans.at(time_s, sensor, || format!("detections, line {}", line(row)))?;
        match motion::detection(azimuth, rate, range, rcs) {
            Some(detection) => scan.detections.push(detection),
            None => report.drop(DropReason::NotFinite),
        }
    }
    rows.not_empty()?;
    let sensors = scans.sensors().map(|id| Sensor { id, mounting: None }).collect();
    let mut scans = scans.into_vec();
    boresight_math::order::sort_ascending(&mut scans, |scan| scan.time_s);
    Ok(DriveLog { sensors, scans, motion: vec![] })
}

/// Reads the table of the motion, plain or packed with gzip.
///
/// # Errors
/// As [`read_detections`].
pub fn read_motion(
    bytes: &[u8],
    report: &mut ReadReport,
) -> Result<Vec<MotionSample>, FormatError> {
    let mut rows = Rows::open(bytes)?;
    let time_at = rows.columns.need("time_s")?;
    let rate_at = Angle::need(&rows.columns, "yaw_rate_radps", "yaw_rate_degps")?;
    let speed_at = rows.columns.find("speed_mps");
    let pose_at = if POSE_COLUMNS.iter().any(|name| rows.columns.find(name).is_some()) {
        let mut places = [0; 3];
        for (place, name) in places.iter_mut().zip(POSE_COLUMNS) {
            *place = rows.columns.need(name)?;
        }
        Some(places)
    } else {
        None
    };
    let mut samples = vec![];
    while let Some(row) = rows.next()? {
        let time_s: f64 = field(row, time_at, "time_s", "a number")?;
        let yaw_rate_radps = rate_at.read(row)?;
        let speed = optional(row, speed_at, "speed_mps")?;
        let speed_mps = Some(speed).filter(|speed| speed.is_finite());
        let mut numbers = [f64::NAN; 3];
        for ((number, place), name) in
            numbers.iter_mut().zip(pose_at.into_iter().flatten()).zip(POSE_COLUMNS)
        {
            *number = optional(row, Some(place), name)?;
        }
        let [x_m, y_m, yaw_rad] = numbers;
        let pose = Some(Pose { x_m, y_m, yaw_rad })
            .filter(|_| numbers.iter().all(|number| number.is_finite()));
        let whole =
            speed_mps.is_some() == speed_at.is_some() && pose.is_some() == pose_at.is_some();
        let sample = MotionSample { time_s, yaw_rate_radps, speed_mps, pose };
        let count = samples.len();
        motion::push(&mut samples, report, sample, || format!("motion, line {}", line(row)))?;
        report.motion_incomplete += u64::from(!whole && samples.len() > count);
    }
    rows.not_empty()?;
    Ok(samples)
}

/// Writes the table of detections, so that [`read_detections`] gives the same scans; those without
/// detections have no rows.
///
/// # Errors
/// Those of `out`.
pub fn write_detections(log: &DriveLog, out: &mut impl Write) -> std::io::Result<()> {
    writeln!(out, "time_s,sensor,azimuth_rad,range_rate_mps,range_m,rcs_dbsm")?;
    for scan in &log.scans {
        for d in &scan.detections {
            write!(out, "{},{},{},{}", scan.time_s, scan.sensor, d.azimuth_rad, d.range_rate_mps)?;
            writeln!(out, ",{},{}", Given(d.range_m.into()), Given(d.rcs_dbsm.into()))?;
        }
    }
    Ok(())
}

/// Writes the table of the motion, so that [`read_motion`] gives the same samples.
///
/// # Errors
/// Those of `out`.
pub fn write_motion(log: &DriveLog, out: &mut impl Write) -> std::io::Result<()> {
    writeln!(out, "time_s,yaw_rate_radps,speed_mps,x_m,y_m,yaw_rad")?;
    for sample in &log.motion {
        let pose = sample.pose.map_or([f64::NAN; 3], |p| [p.x_m, p.y_m, p.yaw_rad]);
        let speed = Given(sample.speed_mps.unwrap_or(f64::NAN));
        let [x, y, yaw] = pose.map(Given);
        writeln!(out, "{},{},{speed},{x},{y},{yaw}", sample.time_s, sample.yaw_rate_radps)?;
    }
    Ok(())
}

/// A number, or nothing where there is none.
struct Given(f64);

impl Display for Given {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        if self.0.is_finite() { self.0.fmt(f) } else { Ok(()) }
    }
}
