//! A drive as columns of numbers, which cost a program in another language little.

use crate::drive::{Detection, DriveLog, MotionSample, Pose, Sensor};
use boresight_options::{Described, columns};
use serde::Serialize;

/// Radars, scans, detections and motion of a drive.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct DriveColumns {
    /// The radars, by ascending number.
    pub sensors: Vec<DriveSensor>,
    /// Radar scans in order of time.
    pub scans: DriveScans,
    /// An entry for each detection, those of a scan together.
    pub detections: DriveDetections,
    /// An entry for each sample of the car's motion, in order of time.
    pub motion: DriveMotion,
}

/// A radar of a drive: its place from the rear axle and nominal direction, null where the log does not say.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct DriveSensor {
    /// Its number in the log, 0 to 255.
    pub id: u8,
    /// Ahead of the rear axle.
    pub x_m: Option<f64>,
    /// Left of the centre line.
    pub y_m: Option<f64>,
    /// Nominal direction of boresight, counter-clockwise from the car's x.
    pub yaw_rad: Option<f64>,
}

/// Radar scans in order of time; the detections of scan `i` are those from the `i`-th offset to before the next.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct DriveScans {
    /// Time of each, on the clock of the log.
    #[serde(serialize_with = "columns::serialize")]
    pub time_s: Vec<f64>,
    /// Numbers of the radars.
    #[serde(serialize_with = "columns::serialize")]
    pub sensor: Vec<u8>,
    /// One more than there are scans.
    #[serde(serialize_with = "columns::serialize")]
    pub offsets: Vec<u32>,
}

/// Detections in the frames of their radars.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct DriveDetections {
    /// Azimuth, positive to the left.
    #[serde(serialize_with = "columns::serialize")]
    pub azimuth_rad: Vec<f64>,
    /// Range rate, positive when receding, not compensated for the car's motion.
    #[serde(serialize_with = "columns::serialize")]
    pub range_rate_mps: Vec<f32>,
    /// Range; NaN where there is none.
    #[serde(serialize_with = "columns::serialize")]
    pub range_m: Vec<f32>,
    /// Radar cross-section; NaN where there is none.
    #[serde(serialize_with = "columns::serialize")]
    pub rcs_dbsm: Vec<f32>,
    /// Classes in the numbers of RadarScenes (11 is static), where the log has them.
    #[serde(serialize_with = "columns::serialize_some")]
    pub label: Option<Vec<u8>>,
}

/// The car's motion as measured.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct DriveMotion {
    /// Time of each sample, on the clock of the log.
    #[serde(serialize_with = "columns::serialize")]
    pub time_s: Vec<f64>,
    /// Yaw rate.
    #[serde(serialize_with = "columns::serialize")]
    pub yaw_rate_radps: Vec<f64>,
    /// Speed of the rear axle, negative in reverse; NaN where there is none.
    #[serde(serialize_with = "columns::serialize")]
    pub speed_mps: Vec<f64>,
    /// Where the rear axle is, where the log says so.
    pub pose: Option<DrivePoses>,
}

/// Poses of the rear axle; NaN where one is not known.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct DrivePoses {
    /// East, or x of the log's global frame.
    #[serde(serialize_with = "columns::serialize")]
    pub x_m: Vec<f64>,
    /// North, or y of the log's global frame.
    #[serde(serialize_with = "columns::serialize")]
    pub y_m: Vec<f64>,
    /// Heading, counter-clockwise from x.
    #[serde(serialize_with = "columns::serialize")]
    pub yaw_rad: Vec<f64>,
}

impl From<&DriveLog> for DriveColumns {
    fn from(log: &DriveLog) -> Self {
        Self {
            sensors: log.sensors.iter().map(DriveSensor::from).collect(),
            scans: scans(log),
            detections: detections(log),
            motion: motion(&log.motion),
        }
    }
}

impl From<&Sensor> for DriveSensor {
    fn from(sensor: &Sensor) -> Self {
        let mounting = sensor.mounting;
        Self {
            id: sensor.id,
            x_m: mounting.map(|m| m.x_m),
            y_m: mounting.map(|m| m.y_m),
            yaw_rad: mounting.map(|m| m.yaw_rad),
        }
    }
}

impl DrivePoses {
    /// Columns of poses; NaN for those that are not known.
    pub fn of(poses: impl Iterator<Item = Option<Pose>> + Clone) -> Self {
        let column = |of: fn(Pose) -> f64| poses.clone().map(|p| p.map_or(f64::NAN, of)).collect();
        Self { x_m: column(|p| p.x_m), y_m: column(|p| p.y_m), yaw_rad: column(|p| p.yaw_rad) }
    }
}

fn scans(log: &DriveLog) -> DriveScans {
    let ends = log.scans.iter().scan(0, |end, scan| {
        *end += scan.detections.len() as u32;
        Some(*end)
    });
    DriveScans {
        time_s: log.scans.iter().map(|scan| scan.time_s).collect(),
        sensor: log.scans.iter().map(|scan| scan.sensor).collect(),
        offsets: std::iter::once(0).chain(ends).collect(),
    }
}

fn detections(log: &DriveLog) -> DriveDetections {
    let all = || log.scans.iter().flat_map(|scan| &scan.detections);
    let column = |of: fn(&Detection) -> f32| all().map(of).collect();
    let label: Vec<u8> = log.scans.iter().flat_map(|scan| scan.labels.iter().copied()).collect();
    let is_labelled = !label.is_empty() && label.len() == all().count();
    DriveDetections {
        azimuth_rad: all().map(|d| f64::from(d.azimuth_rad)).collect(),
        range_rate_mps: column(|d| d.range_rate_mps),
        range_m: column(|d| d.range_m),
        rcs_dbsm: column(|d| d.rcs_dbsm),
        label: is_labelled.then_some(label),
    }
}

fn motion(samples: &[MotionSample]) -> DriveMotion {
    let is_posed = samples.iter().any(|sample| sample.pose.is_some());
    DriveMotion {
        time_s: samples.iter().map(|s| s.time_s).collect(),
        yaw_rate_radps: samples.iter().map(|s| s.yaw_rate_radps).collect(),
        speed_mps: samples.iter().map(|s| s.speed_mps.unwrap_or(f64::NAN)).collect(),
        pose: is_posed.then(|| DrivePoses::of(samples.iter().map(|sample| sample.pose))),
    }
}
