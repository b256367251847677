//! Errors of array calibration.

use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why an array cannot be calibrated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ArrayCalibrationError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// No cell holds a single strong target.
    #[error("none of {given} cells holds one strong target; expected {expected}")]
    NoCells {
        /// What is asked of a cell, in words.
        expected: String,
        /// Cells there were.
        given: usize,
    },
    /// What was asked for cannot be found from such data.
    #[error("{what} is not determined by {given}; expected {expected}")]
    NotDetermined {
        /// The quantity.
        what: &'static str,
        /// What it takes.
        expected: String,
        /// What there is.
        given: String,
    },
}

impl Diagnose for ArrayCalibrationError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::NoCells { .. } => "no-calibration-cells",
            Self::NotDetermined { .. } => "not-determined",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::NoCells { expected, given } => {
                Details::new("cells", expected, format!("{given} cells, none of them such"))
            }
            Self::NotDetermined { what, expected, given } => Details::new(*what, expected, given),
        }
    }
}
