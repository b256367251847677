//! The tables of PJLab-ADG/SensorsCalibration's drive with a Delphi (Aptiv) ESR front radar: the
//! radar's 64 tracks at 20 Hz, and the car's pose at 10 Hz.
//!
//! These are tracked objects. Status 0 is an empty track and 6 one coasted past its validity; a range
//! rate beyond 81 m/s is the radar's mark for none.
//!
//! The point whose pose is given lies about 1.0 m ahead of the axle that does not slip sideways:
//! its sideways speed is 1.04 m times the yaw rate. The pose is moved back to that axle. On straight
//! roads the car drives 1.32 deg to the left of the poses' heading, in positions and velocities alike;
//! the heading is turned to where the car drives.

use super::report::{DropReason, MountingSource, ReadReport};
use super::text::{Rows, line};
use super::{motion, text};
use crate::error::FormatError;
use crate::tables::field;
use boresight_core::drive::{Detection, DriveLog, MotionSample, Mounting, Pose, Scan, Sensor};
use std::collections::BTreeSet;

/// Number given to the radar.
pub const SENSOR: u8 = 1;
/// From the rear axle forward to the point whose pose is given, m.
pub const POSE_AHEAD_M: f64 = 1.0;
/// From the heading given to the direction the car drives in, rad (1.32 deg).
pub const HEADING_OFFSET_RAD: f64 = 0.023_038_346_126_325_15;
/// The radar's place, 2.4 m ahead of the point whose pose is given, and the straight-ahead direction
/// it nominally has.
pub const MOUNTING: Mounting = Mounting { x_m: POSE_AHEAD_M + 2.4, y_m: 0.0, yaw_rad: 0.0 };
/// Columns of the radar table that must be there; `track_id`, `status` and `range_m` are used too.
pub const RADAR_COLUMNS: [&str; 4] = ["frame", "t_s", "azimuth_rad", "range_rate_mps"];
/// Columns of the pose table that must be there.
pub const POSE_COLUMNS: [&str; 7] =
    ["t_s", "east_m", "north_m", "yaw_rad", "vx_lidar_mps", "vy_lidar_mps", "yaw_rate_radps"];

const INVALID_RATE_MPS: f64 = 81.0;

/// The rows of one frame while they are read.
struct Frame {
    number: u64,
    time_sum_s: f64,
    rows: u32,
    tracks: BTreeSet<u64>,
    detections: Vec<Detection>,
}

impl Frame {
    fn scan(self) -> Scan {
        let time_s = self.time_sum_s / f64::from(self.rows);
        Scan { time_s, sensor: SENSOR, detections: self.detections, labels: vec![] }
    }
}

/// Reads the radar table, plain or packed with gzip; the log has no motion yet.
///
/// Rows of one `frame` are a scan. Its time is the mean of its rows' times, which are those of the
/// bus messages: the radar reports its tracks over 16 ms of every 50.
///
/// # Errors
/// [`FormatError::Table`] naming line and column, [`FormatError::TimeBackwards`],
/// [`FormatError::Compressed`].
pub fn read_radar(bytes: &[u8], report: &mut ReadReport) -> Result<DriveLog, FormatError> {
    let mut rows = Rows::open(bytes)?;
    let mut places = [0; 4];
    for (place, name) in places.iter_mut().zip(RADAR_COLUMNS) {
        *place = rows.columns.need(name)?;
    }
    let [frame_at, time_at, azimuth_at, rate_at] = places;
    let [track_at, status_at, range_at] =
        ["track_id", "status", "range_m"].map(|name| rows.columns.find(name));
    let mut scans = vec![];
    let mut frame: Option<Frame> = None;
    let mut previous_s = f64::NEG_INFINITY;
    while let Some(row) = rows.next()? {
        report.detections += 1;
        let number: u64 = field(row, frame_at, "frame", "an integer of at least 0")?;
        let time_s: f64 = field(row, time_at, "t_s", "a number")?;
        let azimuth: f64 = field(row, azimuth_at, "azimuth_rad", "a number")?;
        let rate: f64 = field(row, rate_at, "range_rate_mps", "a number")?;
        let range = range_at.map_or(Ok(f64::NAN), |at| field(row, at, "range_m", "a number"))?;
        let integer = |at: Option<usize>, name| {
            at.map(|at| field::<u64>(row, at, name, "an integer of at least 0")).transpose()
        };
        let (track, status) = (integer(track_at, "track_id")?, integer(status_at, "status")?);
        text::turn(row, azimuth_at, "azimuth_rad", azimuth)?;
        if !time_s.is_finite() {
            report.drop(DropReason::NotFinite);
            continue;
        }
        if time_s < previous_s {
            return Err(FormatError::TimeBackwards {
                place: format!("radar, line {}", line(row)),
                previous: previous_s,
                given: time_s,
            });
        }
        previous_s = time_s;
        if frame.as_ref().is_none_or(|f| f.number != number) {
            scans.extend(frame.take().map(Frame::scan));
        }
        let frame = frame.get_or_insert_with(|| Frame {
            number,
            time_sum_s: 0.0,
            rows: 0,
            tracks: BTreeSet::new(),
            detections: vec![],
        });
        frame.time_sum_s += time_s;
        frame.rows += 1;
        let detection = motion::detection(azimuth, rate, range, f64::NAN);
        if rate.abs() > INVALID_RATE_MPS {
            report.drop(DropReason::InvalidMarker);
        } else if matches!(status, Some(0 | 6)) {
            report.drop(DropReason::Status);
        } else if track.is_some_and(|track| !frame.tracks.insert(track)) {
            report.drop(DropReason::Duplicate);
        } else if let Some(detection) = detection {
            frame.detections.push(detection);
        } else {
            report.drop(DropReason::NotFinite);
        }
    }
    scans.extend(frame.map(Frame::scan));
    rows.not_empty()?;
    report.mountings = Some(MountingSource::Format);
    let sensors = vec![Sensor { id: SENSOR, mounting: Some(MOUNTING) }];
    Ok(DriveLog { sensors, scans, motion: vec![] })
}

/// Reads the pose table, plain or packed with gzip.
///
/// The speed is the magnitude of the horizontal velocity, with the sign of its forward part.
///
/// # Errors
/// As [`read_radar`].
pub fn read_poses(bytes: &[u8], report: &mut ReadReport) -> Result<Vec<MotionSample>, FormatError> {
    let mut rows = Rows::open(bytes)?;
    let mut places = [0; 7];
    for (place, name) in places.iter_mut().zip(POSE_COLUMNS) {
        *place = rows.columns.need(name)?;
    }
    let mut samples = vec![];
    while let Some(row) = rows.next()? {
        let mut numbers = [0.0_f64; 7];
        for ((number, place), name) in numbers.iter_mut().zip(places).zip(POSE_COLUMNS) {
            *number = field(row, place, name, "a number")?;
        }
        let [time_s, east_m, north_m, heading_rad, vx_mps, vy_mps, yaw_rate_radps] = numbers;
        let yaw_rad = heading_rad + HEADING_OFFSET_RAD;
        let (sine, cosine) = yaw_rad.sin_cos();
        let x_m = east_m - POSE_AHEAD_M * cosine;
        let y_m = north_m - POSE_AHEAD_M * sine;
        let sample = MotionSample {
            time_s,
            yaw_rate_radps,
            speed_mps: Some(vx_mps.hypot(vy_mps).copysign(vx_mps)),
            pose: Some(Pose { x_m, y_m, yaw_rad }),
        };
        motion::push(&mut samples, report, sample, || format!("motion, line {}", line(row)))?;
    }
    rows.not_empty()?;
    Ok(samples)
}
