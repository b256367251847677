//! A line of a plan: one drive log, and how it is calibrated.

use crate::schema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};

/// A drive log to calibrate. Each line of a plan is one, as JSON, and says all there is to say, so that plans may be cut, shuffled and
/// put together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Job {
    /// Digest of all that the record depends on but names and places: the log's bytes and the settings ([`Job::key_of`]).
    pub key: String,
    /// Where the log is: a file or a folder.
    pub path: String,
    /// The vehicle, by any name.
    pub vehicle: String,
    /// The drive, by any name; drives without a time are in the order of these names.
    pub drive: String,
    /// When the drive began, s since 1970 (UTC), where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// The files of the log, by name.
    pub files: Vec<LogFile>,
    /// How it is read and calibrated.
    #[serde(default)]
    pub settings: Settings,
    /// Version of the format of the line; 1 where it is absent.
    #[serde(default = "schema::first")]
    pub schema: u32,
}

/// First part of every digest, so that a key is that of no other data. It was the version of Boresight once; keys must not change with that,
/// so that plans survive an upgrade.
const KEY: &str = "0.1.0";

/// A file of a log.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct LogFile {
    /// Its name within the log's folder, with slashes.
    pub name: String,
    /// Its size, bytes.
    pub bytes: u64,
    /// Digest of its bytes by SHA-256, in hexadecimal digits.
    pub sha256: String,
}

/// How a log is read and calibrated. Options are those given, by their names in JavaScript and in its units; others have their defaults.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Settings {
    /// Format of the log, where it is not to be found from the files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<String>,
    /// Only this radar of the log.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<u8>,
    /// All radars of the log together.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub joint: bool,
    /// Options of the calibration.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub calibration: Map<String, Value>,
    /// What the signs of the log mean.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub signs: Map<String, Value>,
    /// Which topics are read.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub topics: Map<String, Value>,
}

impl Job {
    /// The key of a log's files and settings: 32 hexadecimal digits. Copies of a log have the same key, whatever they are
    /// called.
    #[must_use]
    pub fn key_of(files: &[LogFile], settings: &Settings) -> String {
        let mut files: Vec<&LogFile> = files.iter().collect();
        files.sort();
        // Maps of JSON are sorted by name, and numbers are written in one way.
        let whole = (KEY, files, settings);
        let text = serde_json::to_string(&whole).unwrap_or_default();
        let digest = Sha256::digest(text.as_bytes());
        digest.iter().take(16).map(|byte| format!("{byte:02x}")).collect()
    }

    /// Whether the key is that of files and settings: it is not where a line was edited.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.key == Self::key_of(&self.files, &self.settings)
    }
}
