//! What a reader kept of a drive log and what it left out.

use super::mcap::DriveTopic;
use boresight_core::Remark;
use boresight_options::{Described, Named};
use serde::Serialize;

/// Why a row of a drive log was left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DropReason {
    /// A detection with a NaN or an infinity where a number is needed.
    NotFinite,
    /// A detection whose range rate marks it as invalid.
    InvalidMarker,
    /// A detection that its radar's status calls none.
    Status,
    /// A second detection of the same track in one scan.
    Duplicate,
    /// A motion sample with a NaN or an infinity where a number is needed.
    MotionNotFinite,
    /// A second motion sample of the same time, or a pose so near to another that their difference is noise.
    MotionDuplicate,
    /// A pose with no other near it in time, so that it tells no motion.
    MotionAlone,
    /// A detection that its radar calls invalid (`invalid_state` of nuScenes).
    InvalidState,
    /// A detection whose range rate its radar calls ambiguous (`ambig_state` of nuScenes).
    AmbiguousDoppler,
    /// A detection on a thing that has stopped, or of an unknown kind (`dyn_prop` of nuScenes).
    DynamicProperty,
    /// A detection of an earlier scan, which another frame has as its own.
    EarlierScan,
}

/// Where the mountings of a log are from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum MountingSource {
    /// `sensors.json` of the recording.
    SensorsJson,
    /// The format's own car, as no file states them.
    Format,
    /// `calibrated_sensor.json` of the data set.
    CalibratedSensor,
    /// Fixed transforms of the recording (`/tf_static`).
    TfStatic,
}

/// What a reader found, kept and left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadReport {
    /// Detections in the files.
    pub detections: u64,
    /// Motion samples in the files.
    pub motion: u64,
    /// Detections kept although a number that no estimator needs is none: range, cross-section, and
    /// in `RadarScenes` `vr_compensated`, `x_seq` and `y_seq`.
    pub incomplete: u64,
    /// Motion samples kept although their speed or pose is none.
    pub motion_incomplete: u64,
    /// Name and category of the sequence, where the recording states them.
    pub sequence: Option<(String, Option<String>)>,
    /// Where the mountings are from, where the log has any.
    pub mountings: Option<MountingSource>,
    /// Topics of the recording, by their names, where the format has topics.
    pub topics: Vec<DriveTopic>,
    /// Time of the recording at which the log begins, s since 1970, where its times were shifted.
    pub start_s: Option<f64>,
    dropped: [u64; DropReason::VARIANTS.len()],
    /// What else to know.
    pub remarks: Vec<Remark>,
}

impl ReadReport {
    pub(crate) fn drop(&mut self, reason: DropReason) {
        self.drop_many(reason, 1);
    }

    pub(crate) fn drop_many(&mut self, reason: DropReason, count: u64) {
        self.dropped[reason as usize] += count;
    }

    /// Remarks on a file that belongs to no drive log.
    pub fn ignored(&mut self, name: &str) {
        self.remarks.push(Remark::new(
            "ignored-file",
            format!("{name} is not part of the drive log and was left out"),
        ));
    }

    /// Rows left out for a reason.
    pub fn dropped(&self, reason: DropReason) -> u64 {
        self.dropped[reason as usize]
    }

    /// The reasons that occurred, with the number of rows left out for each.
    pub fn drops(&self) -> impl Iterator<Item = (DropReason, u64)> {
        DropReason::VARIANTS.iter().map(|&r| (r, self.dropped(r))).filter(|(_, count)| *count > 0)
    }
}
