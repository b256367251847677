//! What nuScenes and TruckScenes tell beside their clouds: where radars sit, and where the car was.
//!
//! `sample_data.json` leads from a cloud's name to its time, its pose and its place, `calibrated_sensor.json` and `sensor.json` to the places by
//! channel, `ego_pose.json` holds poses of the rear axle, and TruckScenes' `ego_motion_chassis.json` speed and yaw rate.

use super::poses::{self, TimedPose};
use super::rows::each_row;
use super::{Taken, base, view_of_delft};
use crate::drive_log::report::{DropReason, ReadReport};
use crate::error::FormatError;
use boresight_core::Remark;
use boresight_core::drive::{MotionSample, Mounting, Pose};
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Motion from this long before the first cloud to this long after the last is read, ns.
const AROUND_NS: i128 = 1_000_000_000;
const NS_PER_US: i128 = 1000;

type Source<'a> = Box<dyn std::io::Read + 'a>;

/// The tables beside clouds.
#[derive(Default)]
pub struct Tables<'a> {
    sensor: Option<Source<'a>>,
    calibrated_sensor: Option<Source<'a>>,
    sample_data: Option<Source<'a>>,
    ego_pose: Option<Source<'a>>,
    ego_motion_chassis: Option<Source<'a>>,
    /// Poses of View-of-Delft, a file a frame, by the frame's number.
    frames: Vec<(u64, Source<'a>)>,
}

impl<'a> Tables<'a> {
    /// Whether a file's name is that of a table, with or without folders before it.
    pub fn has(name: &str) -> bool {
        Tables::default().take(name, Box::new(std::io::empty()))
    }

    /// Takes a table by its name; false for a file that is none. It is not read yet.
    pub fn take(&mut self, name: &str, source: Source<'a>) -> bool {
        let place = match base(name) {
            "sensor.json" => &mut self.sensor,
            "calibrated_sensor.json" => &mut self.calibrated_sensor,
            "sample_data.json" => &mut self.sample_data,
            "ego_pose.json" => &mut self.ego_pose,
            "ego_motion_chassis.json" => &mut self.ego_motion_chassis,
            _ => {
                let frame = view_of_delft::frame_of(name, ".json");
                self.frames.extend(frame.map(|frame| (frame, source)));
                return frame.is_some();
            }
        };
        *place = Some(source);
        true
    }
}

#[derive(Deserialize)]
struct SensorRow {
    token: String,
    channel: String,
}

#[derive(Deserialize)]
struct CalibratedSensorRow {
    token: String,
    sensor_token: String,
    translation: [f64; 3],
    rotation: [f64; 4],
}

#[derive(Deserialize)]
struct SampleDataRow {
    ego_pose_token: String,
    calibrated_sensor_token: String,
    timestamp: i64,
    filename: String,
}

#[derive(Deserialize)]
struct EgoPoseRow {
    token: String,
    timestamp: i64,
    translation: [f64; 3],
    rotation: [f64; 4],
}

#[derive(Deserialize)]
struct ChassisRow {
    timestamp: i64,
    vx: f64,
    yaw_rate: f64,
}

/// Where a radar sits.
pub(super) struct Placed {
    pub(super) mounting: Mounting,
    /// Its z points down: what is to its left is to the car's right.
    pub(super) upside_down: bool,
}

/// Direction of the x axis, rad, and z of the z axis of a rotation given as a quaternion w, x, y, z; NaN for one of no length.
fn axes(quaternion: [f64; 4]) -> [f64; 2] {
    let length = quaternion.iter().map(|q| q * q).sum::<f64>().sqrt();
    let [w, x, y, z] = quaternion.map(|q| q / length);
    let ahead = [w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z)];
    [ahead[1].atan2(ahead[0]), w * w - x * x - y * y + z * z]
}

/// What the tables tell of a drive.
pub(super) struct Read {
    /// By channel.
    pub(super) mountings: BTreeMap<String, Placed>,
    chassis: Vec<(i128, f64, f64)>,
    poses: Vec<TimedPose>,
    /// Whether poses are the rear axle's.
    of_car: bool,
}

impl Read {
    /// Reads the tables, and gives clouds the times that `sample_data.json` has for them.
    pub(super) fn of(
        tables: Tables<'_>,
        scans: &mut BTreeMap<String, Taken>,
        log: Option<&str>,
        [first_ns, last_ns]: [i128; 2],
        report: &mut ReadReport,
    ) -> Result<Self, FormatError> {
        let around =
            |stamp_ns: i128| (first_ns - AROUND_NS..=last_ns + AROUND_NS).contains(&stamp_ns);
        let mut linked: Option<Linked> = None;
        if let Some(source) = tables.sample_data {
            linked = Some(Linked::read(source, scans, log, around)?);
        }
        let mountings =
            mountings(tables.sensor, tables.calibrated_sensor, linked.as_ref(), report)?;
        if let Some(linked) = &linked
            && linked.found < scans.len()
        {
            let lacking = scans.len() - linked.found;
            let message =
                format!("{lacking} of {} clouds are not in sample_data.json", scans.len());
            report.remarks.push(Remark::new("cloud-without-row", message));
        }
        let mut read = Self { mountings, chassis: vec![], poses: vec![], of_car: true };
        if let Some(source) = tables.ego_motion_chassis {
            each_row("ego_motion_chassis.json", source, |row: ChassisRow| {
                let stamp_ns = i128::from(row.timestamp) * NS_PER_US;
                if around(stamp_ns) {
                    read.chassis.push((stamp_ns, row.vx, row.yaw_rate));
                }
            })?;
        }
        if let Some(source) = tables.ego_pose {
            each_row("ego_pose.json", source, |row: EgoPoseRow| {
                let stamp_ns = i128::from(row.timestamp) * NS_PER_US;
                let wanted = linked.as_ref().is_none_or(|linked| linked.poses.contains(&row.token));
                if around(stamp_ns) && wanted {
                    let [x_m, y_m, _] = row.translation;
                    let pose = Pose { x_m, y_m, yaw_rad: axes(row.rotation)[0] };
                    read.poses.push(TimedPose { stamp_ns, pose });
                }
            })?;
        }
        if read.poses.is_empty() && !tables.frames.is_empty() {
            read.of_car = false;
            for (frame, source) in tables.frames {
                read.poses.push(view_of_delft::pose(frame, source)?);
            }
        }
        Ok(read)
    }

    /// The car's motion: as the chassis measured it, otherwise by its poses.
    pub(super) fn motion(
        self,
        seconds: impl Fn(i128) -> f64 + Copy,
        report: &mut ReadReport,
    ) -> Vec<MotionSample> {
        if self.chassis.is_empty() {
            return poses::motion(self.poses, self.of_car, seconds, report);
        }
        let mut rows = self.chassis;
        report.motion += rows.len() as u64;
        boresight_math::order::sort_by(&mut rows, |a, b| a.0.cmp(&b.0));
        let mut samples: Vec<MotionSample> = vec![];
        for (stamp_ns, speed, yaw_rate_radps) in rows {
            let time_s = seconds(stamp_ns);
            if !(speed.is_finite() && yaw_rate_radps.is_finite()) {
                report.drop(DropReason::MotionNotFinite);
            } else if samples.last().is_some_and(|last| last.time_s == time_s) {
                report.drop(DropReason::MotionDuplicate);
            } else {
                samples.push(MotionSample {
                    time_s,
                    yaw_rate_radps,
                    speed_mps: Some(speed),
                    pose: None,
                });
            }
        }
        samples
    }
}

/// What `sample_data.json` leads to.
struct Linked {
    /// Clouds that it has.
    found: usize,
    poses: HashSet<String>,
    /// Channel by the token of its place.
    places: HashMap<String, String>,
}

impl Linked {
    fn read(
        source: Source<'_>,
        scans: &mut BTreeMap<String, Taken>,
        log: Option<&str>,
        around: impl Fn(i128) -> bool,
    ) -> Result<Self, FormatError> {
        let mut linked = Self { found: 0, poses: HashSet::new(), places: HashMap::new() };
        let mut met = HashSet::new();
        each_row("sample_data.json", source, |row: SampleDataRow| {
            let name = base(&row.filename);
            let stamp_ns = i128::from(row.timestamp) * NS_PER_US;
            if let Some(scan) = scans.get_mut(name) {
                linked.found += usize::from(met.insert(name.to_owned()));
                linked.places.insert(row.calibrated_sensor_token, scan.channel.clone());
                scan.stamp_ns = stamp_ns;
                linked.poses.insert(row.ego_pose_token);
            } else if around(stamp_ns) && log.is_none_or(|log| name.starts_with(log)) {
                // What cameras and other radars saw has poses, too.
                linked.poses.insert(row.ego_pose_token);
            }
        })?;
        Ok(linked)
    }
}

/// Places of radars by channel: those that the clouds' rows name, or without such rows those of a channel that has one place alone.
fn mountings(
    sensor: Option<Source<'_>>,
    calibrated_sensor: Option<Source<'_>>,
    linked: Option<&Linked>,
    report: &mut ReadReport,
) -> Result<BTreeMap<String, Placed>, FormatError> {
    let Some(source) = calibrated_sensor else { return Ok(BTreeMap::new()) };
    let mut channels = HashMap::new();
    if let Some(source) = sensor {
        each_row("sensor.json", source, |row: SensorRow| {
            channels.insert(row.token, row.channel);
        })?;
    }
    let mut placed: BTreeMap<String, Option<Placed>> = BTreeMap::new();
    each_row("calibrated_sensor.json", source, |row: CalibratedSensorRow| {
        let channel = match linked {
            Some(linked) => linked.places.get(&row.token),
            None => channels.get(&row.sensor_token),
        };
        let [yaw_rad, up] = axes(row.rotation);
        let [x_m, y_m, _] = row.translation;
        let Some(channel) = channel.filter(|_| (yaw_rad + up + x_m + y_m).is_finite()) else {
            return;
        };
        let here = Placed { mounting: Mounting { x_m, y_m, yaw_rad }, upside_down: up < 0.0 };
        placed
            .entry(channel.clone())
            .and_modify(|there| {
                if there.as_ref().is_none_or(|there| there.mounting != here.mounting) {
                    *there = None;
                }
            })
            .or_insert(Some(here));
    })?;
    let several = placed.values().filter(|place| place.is_none()).count();
    if several > 0 {
        let message = format!(
            "{several} radars have several places in calibrated_sensor.json, and none is taken"
        );
        report.remarks.push(Remark::new("several-places", message));
    }
    Ok(placed.into_iter().filter_map(|(channel, place)| Some((channel, place?))).collect())
}
