//! Errors of the calibration.

use boresight_core::{CoreError, Details, Diagnose};
use thiserror::Error;

/// What can be wrong with the options or frames of a calibration.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// An argument is wrong.
    #[error(transparent)]
    Core(#[from] CoreError),
    /// A frame is older than the one before.
    #[error("time runs backwards: {given} s after {previous} s")]
    TimeBackwards {
        /// Time of the frame before, s.
        previous: f64,
        /// Time given, s.
        given: f64,
    },
}

impl Diagnose for CalibrateError {
    fn code(&self) -> &'static str {
        match self {
            Self::Core(error) => error.code(),
            Self::TimeBackwards { .. } => "time-backwards",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Core(error) => error.details(),
            Self::TimeBackwards { previous, given } => {
                Details::new("time", format!("at least {previous} s"), format!("{given} s"))
            }
        }
    }
}
