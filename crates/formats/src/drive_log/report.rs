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

/// What a reader found, kept and left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadReport {
    /// Detections in the files.
    pub detections: u64,
    /// Motion samples in the files.
    pub motion: u64,
    dropped: [u64; DropReason::ALL.len()],
    /// What else to know.
    pub remarks: Vec<Remark>,
}

impl ReadReport {
    pub(crate) fn drop(&mut self, reason: DropReason) {
        self.dropped[reason as usize] += 1;
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
