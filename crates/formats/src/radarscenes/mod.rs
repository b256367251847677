//! Sequences of the `RadarScenes` data set (Schumann et al. 2021): `radar_data.h5` with the compound
//! datasets `radar_data` and `odometry`, and the JSON files beside it.
//!
//! Read are, by name and in any width and byte order, `timestamp` (us), `sensor_id`, `range_sc` (m),
//! `azimuth_sc` (rad), `rcs` (dBsm), `vr` (m/s, positive when receding), `label_id`; and of the
//! odometry `timestamp`, `x_seq`, `y_seq` (m), `yaw_seq` (rad), `vx` (m/s), `yaw_rate` (rad/s).
//! Detections of one timestamp and sensor are a scan. Times of the log begin with the first of
//! either table. Chunked data in the layout that HDF5 2.0 brought in (version 5) is refused with an
//! error that names it.
//!
//! `scenes.json` adds the scans without detections and the sequence's name; `sensors.json` the
//! mountings, without which radars 1 to 4 get that of the data set's car.

mod compound;
mod json;
mod write;

pub use json::sequence_names;
pub use write::{Packing, SequenceFiles, write};

use crate::drive_log::scans::Scans;
use crate::drive_log::{self, DropReason, MountingSource, ReadReport};
use crate::error::FormatError;
use crate::hdf5::guard;
use boresight_core::Remark;
use boresight_core::drive::{
    DriveLog, MotionSample, Mounting, Pose, RADARSCENES_SENSORS, Scan, Sensor,
};
use compound::{Table, wrong};
use hdf5_pure::File;
use json::Scenes;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The files beside `radar_data.h5`; any may be missing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Companions<'a> {
    /// `scenes.json`.
    pub scenes: Option<&'a [u8]>,
    /// `sensors.json`.
    pub sensors: Option<&'a [u8]>,
}

/// Reads `radar_data.h5` from memory. The bytes are taken over; beside them there are the log and one
/// window of rows.
///
/// # Errors
/// [`FormatError::Hdf5`] naming dataset and field, [`FormatError::Json`] naming the file,
/// [`FormatError::TimeBackwards`].
pub fn read(
    radar_data: Vec<u8>,
    beside: Companions,
    report: &mut ReadReport,
) -> Result<DriveLog, FormatError> {
    from_file(&guard::from_bytes(radar_data).map_err(|error| not_hdf5(&error))?, beside, report)
}

/// Reads `radar_data.h5` from a file, piece by piece.
///
/// # Errors
/// As [`read`].
pub fn read_path(
    path: &Path,
    beside: Companions,
    report: &mut ReadReport,
) -> Result<DriveLog, FormatError> {
    let file = std::fs::File::open(path)
        .map_err(hdf5_pure::Error::Io)
        .and_then(guard::from_file)
        .map_err(|error| not_hdf5(&error))?;
    from_file(&file, beside, report)
}

fn not_hdf5(error: &hdf5_pure::Error) -> FormatError {
    wrong("radar_data.h5", "a whole HDF5 file", error)
}

fn from_file(
    file: &File,
    beside: Companions,
    report: &mut ReadReport,
) -> Result<DriveLog, FormatError> {
    let radar = Table::open(file, "radar_data")?;
    let odometry = Table::open(file, "odometry")?;
    let mut origin_us = i128::MAX;
    for table in [&radar, &odometry] {
        table.not_empty()?;
        let stamp = table.field("timestamp")?;
        origin_us = table.first()?.map_or(origin_us, |row| origin_us.min(stamp.integer(&row)));
    }
    let mountings = beside.sensors.map(json::mountings).transpose()?;
    let mut scans = scans(&radar, origin_us, report)?;
    if let Some(bytes) = beside.scenes {
        add_scenes(&Scenes::read(bytes)?, &mut scans, origin_us, report);
    }
    boresight_math::order::sort_ascending(&mut scans, |scan| scan.time_s);
    let ids: BTreeSet<u8> = scans.iter().map(|scan| scan.sensor).collect();
    let sensors = ids.into_iter().map(|id| sensor(id, mountings.as_ref())).collect::<Vec<_>>();
    report.mountings =
        sensors.iter().any(|sensor| sensor.mounting.is_some()).then_some(if mountings.is_some() {
            MountingSource::SensorsJson
        } else {
            MountingSource::Format
        });
    let motion = motion(&odometry, origin_us, report)?;
    Ok(DriveLog { sensors, scans, motion })
}

/// A radar with the mounting that `sensors.json` states, or without that file with that of the data
/// set's car.
fn sensor(id: u8, mountings: Option<&BTreeMap<u8, Mounting>>) -> Sensor {
    let mounting = match mountings {
        Some(mountings) => mountings.get(&id).copied(),
        None => RADARSCENES_SENSORS.iter().find(|s| s.0 == id).map(|s| s.1),
    };
    Sensor { id, mounting }
}

/// Adds the scans of `scenes.json` that have no rows, and says where the two do not go together.
fn add_scenes(scenes: &Scenes, scans: &mut Vec<Scan>, origin_us: i128, report: &mut ReadReport) {
    let cut = |text: &str| text.chars().take(60).collect::<String>();
    report.sequence = Some((cut(&scenes.sequence_name), scenes.category.as_deref().map(cut)));
    let mut with_rows: BTreeSet<(u64, u8)> =
        scans.iter().map(|scan| (scan.time_s.to_bits(), scan.sensor)).collect();
    let mut lost = 0_u64;
    for (stamp, scene) in &scenes.scenes {
        let time_s = seconds(i128::from(*stamp), origin_us);
        if with_rows.remove(&(time_s.to_bits(), scene.sensor_id)) {
            continue;
        }
        let [start, end] = scene.radar_indices;
        lost += u64::from(start < end);
        scans.push(Scan { time_s, sensor: scene.sensor_id, detections: vec![], labels: vec![] });
    }
    let unnamed = with_rows.len();
    for (count, what) in [
        (lost, "scans of scenes.json have detections that radar_data.h5 lacks"),
        (unnamed as u64, "scans of radar_data.h5 are not in scenes.json"),
    ] {
        if count > 0 {
            report.remarks.push(Remark::new("scenes-mismatch", format!("{count} {what}")));
        }
    }
}

fn seconds(stamp_us: i128, origin_us: i128) -> f64 {
    (stamp_us - origin_us) as f64 / 1e6
}

fn scans(
    table: &Table,
    origin_us: i128,
    report: &mut ReadReport,
) -> Result<Vec<Scan>, FormatError> {
    let [stamp, sensor_id, label_id] =
        [table.field("timestamp")?, table.field("sensor_id")?, table.field("label_id")?];
    let [range, azimuth, rcs, rate] = [
        table.field("range_sc")?,
        table.field("azimuth_sc")?,
        table.field("rcs")?,
        table.field("vr")?,
    ];
    // Not needed; a row that lacks them is only counted.
    let beside = ["vr_compensated", "x_seq", "y_seq"]
        .into_iter()
        .filter(|name| table.has(name))
        .map(|name| table.field(name))
        .collect::<Result<Vec<_>, _>>()?;
    let mut scans = Scans::default();
    table.for_each(|k, row| {
        report.detections += 1;
        let byte = |field: compound::Field, name: &str| {
            let given = field.integer(row);
            u8::try_from(given)
                .map_err(|_| wrong(format!("radar_data.{name}, row {k}"), "0 to 255", given))
        };
        let (sensor, label) = (byte(sensor_id, "sensor_id")?, byte(label_id, "label_id")?);
        let time_s = seconds(stamp.integer(row), origin_us);
        let scan = scans.at(time_s, sensor, || format!("radar_data, row {k}"))?;
        let [azimuth, rate, range, rcs] = [azimuth, rate, range, rcs].map(|f| f.number(row));
        let Some(detection) = drive_log::motion::detection(azimuth, rate, range, rcs) else {
            report.drop(DropReason::NotFinite);
            return Ok(());
        };
        let whole = detection.range_m.is_finite()
            && detection.rcs_dbsm.is_finite()
            && beside.iter().all(|field| field.number(row).is_finite());
        report.incomplete += u64::from(!whole);
        scan.detections.push(detection);
        scan.labels.push(label);
        Ok(())
    })?;
    Ok(scans.into_vec())
}

fn motion(
    table: &Table,
    origin_us: i128,
    report: &mut ReadReport,
) -> Result<Vec<MotionSample>, FormatError> {
    let stamp = table.field("timestamp")?;
    let [x, y, yaw, speed, rate] = [
        table.field("x_seq")?,
        table.field("y_seq")?,
        table.field("yaw_seq")?,
        table.field("vx")?,
        table.field("yaw_rate")?,
    ];
    let mut samples: Vec<MotionSample> = vec![];
    table.for_each(|k, row| {
        report.motion += 1;
        let time_s = seconds(stamp.integer(row), origin_us);
        let [x_m, y_m, yaw_rad, speed, yaw_rate_radps] =
            [x, y, yaw, speed, rate].map(|field| field.number(row));
        if !yaw_rate_radps.is_finite() {
            report.drop(DropReason::MotionNotFinite);
            return Ok(());
        }
        match samples.last().map(|sample| sample.time_s) {
            Some(previous) if time_s < previous => {
                return Err(FormatError::TimeBackwards {
                    place: format!("odometry, row {k}"),
                    previous,
                    given: time_s,
                });
            }
            Some(previous) if time_s == previous => {
                report.drop(DropReason::MotionDuplicate);
                return Ok(());
            }
            _ => {}
        }
        let pose = Some(Pose { x_m, y_m, yaw_rad })
            .filter(|_| [x_m, y_m, yaw_rad].iter().all(|number| number.is_finite()));
        let speed_mps = Some(speed).filter(|speed| speed.is_finite());
        report.motion_incomplete += u64::from(pose.is_none() || speed_mps.is_none());
        samples.push(MotionSample { time_s, yaw_rate_radps, speed_mps, pose });
        Ok(())
    })?;
    Ok(samples)
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod write_tests;
