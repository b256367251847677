//! The JSON files of the data set: `scenes.json`, `sensors.json`, `sequences.json`.

use boresight_core::drive::{Mounting, Sensor};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// `scenes.json` as it is written.
#[derive(Serialize)]
pub(super) struct ScenesFile {
    pub sequence_name: String,
    pub category: String,
    pub first_timestamp: i64,
    pub last_timestamp: i64,
    /// By time stamp, us, in order of time.
    #[serde(serialize_with = "in_order")]
    pub scenes: Vec<(i64, SceneEntry)>,
}

/// One scan of one radar.
#[derive(Serialize)]
pub(super) struct SceneEntry {
    pub sensor_id: u8,
    pub prev_timestamp: Option<i64>,
    pub next_timestamp: Option<i64>,
    pub prev_timestamp_same_sensor: Option<i64>,
    pub next_timestamp_same_sensor: Option<i64>,
    pub odometry_timestamp: i64,
    pub odometry_index: u64,
    pub image_name: String,
    /// First row in `radar_data` and the one after the last.
    pub radar_indices: [u64; 2],
}

fn in_order<S: Serializer>(scenes: &[(i64, SceneEntry)], out: S) -> Result<S::Ok, S::Error> {
    let mut map = out.serialize_map(Some(scenes.len()))?;
    for (stamp, scene) in scenes {
        map.serialize_entry(stamp, scene)?;
    }
    map.end()
}

/// A sequence of `sequences.json`.
#[derive(Serialize)]
pub(super) struct SequenceEntry {
    pub category: String,
    pub num_scenes: u64,
    /// s.
    pub duration: f64,
    pub sensors: Vec<String>,
}

/// `sequences.json` as it is written.
#[derive(Serialize)]
pub(super) struct SequencesFile {
    pub sequences: BTreeMap<String, SequenceEntry>,
}

impl ScenesFile {
    pub(super) fn text(&self) -> String {
        text(self)
    }
}

impl SequencesFile {
    pub(super) fn text(&self) -> String {
        text(self)
    }
}

fn text(value: &impl Serialize) -> String {
    // Strings, integers and finite numbers cannot fail.
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

/// The mounting of a radar in `sensors.json`.
#[derive(Serialize)]
struct SensorEntry {
    id: u8,
    x: f64,
    y: f64,
    yaw: f64,
}

/// `sensors.json` of the radars with a mounting.
pub(super) fn sensors_json(sensors: &[Sensor]) -> String {
    let entries: BTreeMap<String, SensorEntry> = sensors
        .iter()
        .filter_map(|sensor| {
            let Mounting { x_m, y_m, yaw_rad } = sensor.mounting?;
            let entry = SensorEntry { id: sensor.id, x: x_m, y: y_m, yaw: yaw_rad };
            Some((format!("radar_{}", sensor.id), entry))
        })
        .collect();
    text(&entries)
}
