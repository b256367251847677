//! What a drive log came to, as a line of JSON.

use crate::job::Job;
use crate::schema;
use boresight_mounting::NormalEquations;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What running a job gives. It depends on the job and the version alone, not on when, where and beside what it ran. `R` is what is known of a radar's
/// angle: all that `boresight calibrate --json` says where records are made, the part that merging reads where they are read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Record<R = Value> {
    /// Key of the job.
    pub key: String,
    /// The vehicle.
    pub vehicle: String,
    /// The drive.
    pub drive: String,
    /// When it began, s since 1970, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// Where the log was.
    pub path: String,
    /// What was found; none where the job failed.
    #[serde(default = "none", skip_serializing_if = "Option::is_none")]
    pub done: Option<Done<R>>,
    /// Why the job failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<Failure>,
    /// Version of the format of the line; 1 where it is absent.
    #[serde(default = "schema::first")]
    pub schema: u32,
    /// Version of Boresight that ran the job; empty where it is absent.
    #[serde(default)]
    pub version: String,
}

fn none<R>() -> Option<Done<R>> {
    None
}

/// What was found in a log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Done<R = Value> {
    /// Format of the log.
    pub format: String,
    /// From the first scan to the last, s.
    pub duration_s: f64,
    /// What to know of the reading, as text.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// The radars, by number.
    pub radars: Vec<RadarRecord<R>>,
}

/// What was found of a radar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct RadarRecord<R = Value> {
    /// Its number in the log.
    pub sensor: u8,
    /// The angle, as `boresight calibrate --json` tells it.
    pub result: R,
    /// What the drive says of the unknowns that drives share; none of methods that weigh all frames at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equations: Option<NormalEquations>,
}

/// The part of a radar's result that merging reads.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct RadarResult {
    /// Mounting angle, deg.
    pub angle_deg: f64,
    /// Its standard deviation, deg; none where the drive says nothing.
    #[serde(default)]
    pub sigma_deg: Option<f64>,
    /// The angle that the radar should be mounted at, deg.
    #[serde(default)]
    pub nominal_deg: Option<f64>,
    /// Whether the angle had settled.
    pub converged: bool,
    /// When the angle changed during the drive, s on the log's clock.
    #[serde(default)]
    pub changed_s: Option<f64>,
    /// What became of the frames.
    pub frames: Frames,
    /// What to know of it.
    #[serde(default)]
    pub warnings: Vec<Warning>,
}

/// Frames of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub struct Frames {
    /// Given.
    pub given: u64,
    /// In the angle.
    pub used: u64,
}

/// A warning, by its code.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct Warning {
    /// Such as `not-converged`.
    pub code: String,
}

/// Why a job failed: what its error says of itself.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Failure {
    /// A stable name in kebab case, such as `malformed-file`; `changed` where files are not those planned.
    pub code: String,
    /// The message.
    pub message: String,
    /// What was wrong.
    pub what: String,
    /// What would have been accepted.
    pub expected: String,
    /// What was given.
    pub given: String,
}

impl<R> Record<R> {
    /// The record of a job that failed.
    pub fn failure(job: &Job, failed: Failure) -> Self {
        Self { failed: Some(failed), ..Self::of(job) }
    }

    /// The record of a job that was done.
    pub fn success(job: &Job, done: Done<R>) -> Self {
        Self { done: Some(done), ..Self::of(job) }
    }

    fn of(job: &Job) -> Self {
        Self {
            key: job.key.clone(),
            vehicle: job.vehicle.clone(),
            drive: job.drive.clone(),
            time_s: job.time_s,
            path: job.path.clone(),
            done: None,
            failed: None,
            schema: schema::SCHEMA,
            version: env!("CARGO_PKG_VERSION").into(),
        }
    }
}
