//! What a reader kept of a drive log and what it left out.

use crate::error::Remark;

/// Why a row of a drive log was left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    /// A second motion sample of the same time.
    MotionDuplicate,
}

impl DropReason {
    /// All reasons.
    pub const ALL: [Self; 6] = [
        Self::NotFinite,
        Self::InvalidMarker,
        Self::Status,
        Self::Duplicate,
        Self::MotionNotFinite,
        Self::MotionDuplicate,
    ];

    /// A stable name in kebab case.
    pub fn code(self) -> &'static str {
        match self {
            Self::NotFinite => "not-finite",
            Self::InvalidMarker => "invalid-marker",
            Self::Status => "status",
            Self::Duplicate => "duplicate",
            Self::MotionNotFinite => "motion-not-finite",
            Self::MotionDuplicate => "motion-duplicate",
        }
    }
}

/// Where the mountings of a log are from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MountingSource {
    /// `sensors.json` of the recording.
    SensorsJson,
    /// The format's own car, as no file states them.
    Format,
}

impl MountingSource {
    /// A stable name in kebab case.
    pub fn name(self) -> &'static str {
        match self {
            Self::SensorsJson => "sensors-json",
            Self::Format => "format",
        }
    }
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
    dropped: [u64; DropReason::ALL.len()],
    /// What else to know.
    pub remarks: Vec<Remark>,
}

impl ReadReport {
    pub(crate) fn drop(&mut self, reason: DropReason) {
        self.dropped[reason as usize] += 1;
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
        DropReason::ALL.into_iter().map(|r| (r, self.dropped(r))).filter(|(_, count)| *count > 0)
    }
}
