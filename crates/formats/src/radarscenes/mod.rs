//! Sequences of the `RadarScenes` data set (Schumann et al. 2021): `radar_data.h5` with the compound
//! datasets `radar_data` and `odometry`.
//!
//! Read are, by name and in any width and byte order, `timestamp` (us), `sensor_id`, `range_sc` (m),
//! `azimuth_sc` (rad), `rcs` (dBsm), `vr` (m/s, positive when receding), `label_id`; and of the
//! odometry `timestamp`, `x_seq`, `y_seq` (m), `yaw_seq` (rad), `vx` (m/s), `yaw_rate` (rad/s).
//! Detections of one timestamp and sensor are a scan. Times of the log begin with the first of
//! either table. Radars 1 to 4 get the mounting of the data set's car. Chunked data in the layout that
//! HDF5 2.0 brought in (version 5) is refused with an error that names it.

mod compound;
mod json;
mod write;

pub use write::{Packing, STATIC_LABEL, SequenceFiles, write};

use crate::drive_log::{DropReason, ReadReport};
use crate::error::FormatError;
use boresight_core::drive::{
    Detection, DriveLog, MotionSample, Pose, RADARSCENES_SENSORS, Scan, Sensor,
};
use compound::{Table, wrong};
use hdf5_pure::File;
use std::collections::BTreeMap;
use std::path::Path;

/// Reads `radar_data.h5` from memory. The bytes are taken over; beside them there are the log and one
/// window of rows.
///
/// # Errors
/// [`FormatError::Hdf5`] naming dataset and field, [`FormatError::TimeBackwards`].
pub fn read(radar_data: Vec<u8>, report: &mut ReadReport) -> Result<DriveLog, FormatError> {
    from_file(&File::from_bytes(radar_data).map_err(|error| not_hdf5(&error))?, report)
}

/// Reads `radar_data.h5` from a file, piece by piece.
///
/// # Errors
/// As [`read`].
pub fn read_path(path: &Path, report: &mut ReadReport) -> Result<DriveLog, FormatError> {
    from_file(&File::open_streaming(path).map_err(|error| not_hdf5(&error))?, report)
}

fn not_hdf5(error: &hdf5_pure::Error) -> FormatError {
    wrong("radar_data.h5", "a whole HDF5 file", error)
}

fn from_file(file: &File, report: &mut ReadReport) -> Result<DriveLog, FormatError> {
    let radar = Table::open(file, "radar_data")?;
    let odometry = Table::open(file, "odometry")?;
    let mut origin_us = i128::MAX;
    for table in [&radar, &odometry] {
        let stamp = table.field("timestamp")?;
        origin_us = table.first()?.map_or(origin_us, |row| origin_us.min(stamp.integer(&row)));
    }
    let (sensors, scans) = scans(&radar, origin_us, report)?;
    let motion = motion(&odometry, origin_us, report)?;
    Ok(DriveLog { sensors, scans, motion })
}

fn seconds(stamp_us: i128, origin_us: i128) -> f64 {
    (stamp_us - origin_us) as f64 / 1e6
}

fn scans(
    table: &Table,
    origin_us: i128,
    report: &mut ReadReport,
) -> Result<(Vec<Sensor>, Vec<Scan>), FormatError> {
    let [stamp, sensor_id, label_id] =
        [table.field("timestamp")?, table.field("sensor_id")?, table.field("label_id")?];
    let [range, azimuth, rcs, rate] = [
        table.field("range_sc")?,
        table.field("azimuth_sc")?,
        table.field("rcs")?,
        table.field("vr")?,
    ];
    let mut scans: Vec<Scan> = vec![];
    // The latest scan of each sensor, by its place in `scans`.
    let mut latest: BTreeMap<u8, usize> = BTreeMap::new();
    table.for_each(|k, row| {
        report.detections += 1;
        let byte = |field: compound::Field, name: &str| {
            let given = field.integer(row);
            u8::try_from(given)
                .map_err(|_| wrong(format!("radar_data.{name}, row {k}"), "0 to 255", given))
        };
        let (sensor, label) = (byte(sensor_id, "sensor_id")?, byte(label_id, "label_id")?);
        let time_s = seconds(stamp.integer(row), origin_us);
        let previous = latest.get(&sensor).map(|&at| (at, scans[at].time_s));
        let at = match previous {
            Some((at, previous)) if time_s == previous => at,
            Some((_, previous)) if time_s < previous => {
                return Err(FormatError::TimeBackwards {
                    place: format!("radar_data, row {k}"),
                    previous,
                    given: time_s,
                });
            }
            _ => {
                scans.push(Scan { time_s, sensor, detections: vec![], labels: vec![] });
                latest.insert(sensor, scans.len() - 1);
                scans.len() - 1
            }
        };
        let numbers = [azimuth, rate, range, rcs].map(|field| field.number(row) as f32);
        if !numbers.iter().all(|number| number.is_finite()) {
            report.drop(DropReason::NotFinite);
            return Ok(());
        }
        let [azimuth_rad, range_rate_mps, range_m, rcs_dbsm] = numbers;
        let detection = Detection { azimuth_rad, range_rate_mps, range_m, rcs_dbsm };
        scans[at].detections.push(detection);
        scans[at].labels.push(label);
        Ok(())
    })?;
    scans.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    let mounting = |id| RADARSCENES_SENSORS.iter().find(|s| s.0 == id).map(|s| s.1);
    let sensors = latest.into_keys().map(|id| Sensor { id, mounting: mounting(id) }).collect();
    Ok((sensors, scans))
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
        let numbers = [x, y, yaw, speed, rate].map(|field| field.number(row));
        if !numbers.iter().all(|number| number.is_finite()) {
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
        let [x_m, y_m, yaw_rad, speed_mps, yaw_rate_radps] = numbers;
        let pose = Some(Pose { x_m, y_m, yaw_rad });
        samples.push(MotionSample { time_s, yaw_rate_radps, speed_mps: Some(speed_mps), pose });
        Ok(())
    })?;
    Ok(samples)
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod write_tests;
