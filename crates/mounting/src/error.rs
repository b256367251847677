//! Errors of the calibration.

use crate::network::NetworkError;
use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// What can be wrong with the options or frames of a calibration.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MountingError {
    /// An argument is wrong.
    #[error(transparent)]
    Core(#[from] InputError),
    /// A snapshot of a version that this release does not read.
    #[error("unsupported snapshot: expected version {first} to {last}, given version {given}")]
    UnsupportedSnapshot {
        /// First version that is read.
        first: u8,
        /// Last version that is read.
        last: u8,
        /// Version given.
        given: u8,
    },
    /// Bytes that are no snapshot, or a damaged one.
    #[error("malformed snapshot: expected {expected}, given {given}")]
    MalformedSnapshot {
        /// What was expected.
        expected: String,
        /// What was given.
        given: String,
    },
    /// Snapshots that are not of one radar.
    #[error(
        "snapshots of one radar are merged: {what} is {expected} in the first and {given} in another"
    )]
    UnlikeSnapshots {
        /// The option that differs.
        what: String,
        /// Its value in the first.
        expected: f64,
        /// Its value in the other.
        given: f64,
    },
    /// Equations of a drive that no drive leads to.
    #[error("equations of drives to merge: expected {expected}, given {given} in drive {drive}")]
    UnsoundEquations {
        /// Which drive, from 0.
        drive: usize,
        /// What was expected.
        expected: &'static str,
        /// What was given.
        given: &'static str,
    },
    /// A motion by a network without its weights.
    #[error("{motion} needs the weights of its network, given {given}")]
    NeedsNetwork {
        /// Name of the motion.
        motion: &'static str,
        /// What was given.
        given: &'static str,
    },
    /// Weights that cannot be used.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A frame is older than the one before.
    #[error("time runs backwards: {given} s after {previous} s")]
    TimeBackwards {
        /// Time of the frame before, s.
        previous: f64,
        /// Time given, s.
        given: f64,
    },
}

impl MountingError {
    /// The same error about an option that another front end calls otherwise.
    #[must_use]
    pub fn renamed(self, name: impl Fn(&str) -> String) -> Self {
        match self {
            Self::UnlikeSnapshots { what, expected, given } => {
                Self::UnlikeSnapshots { what: name(&what), expected, given }
            }
            other => other,
        }
    }
}

impl Diagnose for MountingError {
    fn code(&self) -> &'static str {
        match self {
            Self::Core(error) => error.code(),
            Self::UnsupportedSnapshot { .. } => "unsupported-snapshot",
            Self::MalformedSnapshot { .. } => "malformed-snapshot",
            Self::UnlikeSnapshots { .. } => "unlike-snapshots",
            Self::UnsoundEquations { .. } => "unsound-equations",
            Self::NeedsNetwork { .. } => "needs-weights",
            Self::Network(error) => error.code(),
            Self::TimeBackwards { .. } => "time-backwards",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Core(error) => error.details(),
            Self::MalformedSnapshot { expected, given } => {
                Details::new("snapshot", expected, given)
            }
            Self::UnsupportedSnapshot { first, last, given } => Details::new(
                "snapshot",
                format!("version {first} to {last}"),
                format!("version {given}"),
            ),
            Self::UnlikeSnapshots { what, expected, given } => {
                Details::new(what, expected.to_string(), given.to_string())
            }
            Self::UnsoundEquations { drive, expected, given } => {
                Details::new(format!("equations of drive {drive}"), *expected, *given)
            }
            Self::NeedsNetwork { motion, given } => {
                Details::new("weights", format!("a file of weights for {motion}"), *given)
            }
            Self::Network(error) => error.details(),
            Self::TimeBackwards { previous, given } => {
                Details::new("time", format!("at least {previous} s"), format!("{given} s"))
            }
        }
    }
}

/// What a motion is answered that the recursive method does not take.
pub(crate) fn tracked_only(given: &str) -> MountingError {
    InputError::Incompatible {
        what: "motion".into(),
        expected: "tracked or deepego, with the recursive method".into(),
        given: given.into(),
    }
    .into()
}
