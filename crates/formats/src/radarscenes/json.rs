//! The JSON files of the data set: `scenes.json`, `sensors.json`, `sequences.json`.

use crate::error::FormatError;
use boresight_core::drive::{Mounting, Sensor};
use serde::de::DeserializeOwned;
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::BTreeMap;

fn parse<T: DeserializeOwned>(
    file: &'static str,
    expected: &'static str,
    bytes: &[u8],
) -> Result<T, FormatError> {
    serde_json::from_slice(bytes).map_err(|error| FormatError::Json {
        file,
        expected,
        given: error.to_string().chars().take(200).collect(),
    })
}

/// What is read of `scenes.json`.
#[derive(Deserialize)]
pub(super) struct Scenes {
    pub sequence_name: String,
    #[serde(default)]
    pub category: Option<String>,
    /// By time stamp, us.
    pub scenes: BTreeMap<i64, Scene>,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    pub sensor_id: u8,
    pub radar_indices: [u64; 2],
}

impl Scenes {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let expected = "sequence_name and scenes with sensor_id and radar_indices";
        parse("scenes.json", expected, bytes)
    }
}

/// Names of the sequences in `sequences.json`.
///
/// # Errors
/// [`FormatError::Json`].
pub fn sequence_names(bytes: &[u8]) -> Result<Vec<String>, FormatError> {
    #[derive(Deserialize)]
    struct Entry {}
    #[derive(Deserialize)]
    struct Sequences {
        sequences: BTreeMap<String, Entry>,
    }
    let read: Sequences = parse("sequences.json", "sequences by name", bytes)?;
    Ok(read.sequences.into_keys().collect())
}

/// Mountings by number in `sensors.json`: each `radar_N` of it, with `x`, `y` (m) and `yaw` (rad).
pub(super) fn mountings(bytes: &[u8]) -> Result<BTreeMap<u8, Mounting>, FormatError> {
    #[derive(Deserialize)]
    struct Entry {
        x: Option<f64>,
        y: Option<f64>,
        yaw: Option<f64>,
    }
    let expected = "radar_1 and so on, each with x, y and yaw";
    let read: BTreeMap<String, Entry> = parse("sensors.json", expected, bytes)?;
    let mut mountings = BTreeMap::new();
    for (name, entry) in &read {
        let Some(id) = name.strip_prefix("radar_").and_then(|id| id.parse().ok()) else { continue };
        let (Some(x_m), Some(y_m), Some(yaw_rad)) = (entry.x, entry.y, entry.yaw) else {
            return Err(FormatError::Json {
                file: "sensors.json",
                expected,
                given: format!("{name} without one of them"),
            });
        };
        mountings.insert(id, Mounting { x_m, y_m, yaw_rad });
    }
    Ok(mountings)
}

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
