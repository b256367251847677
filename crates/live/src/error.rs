//! Errors of servers.

use boresight_calibrate::CalibrateError;
use boresight_core::{CoreError, Details, Diagnose};
use thiserror::Error;

/// Why a server cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LiveError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] CoreError),
    /// Calibration refused.
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    /// The system refuses an address to listen at.
    #[error("cannot listen at {address}: {given}")]
    Listen {
        /// Host and port.
        address: String,
        /// What the system says.
        given: String,
    },
}

impl Diagnose for LiveError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Calibrate(error) => error.code(),
            Self::Listen { .. } => "cannot-listen",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Calibrate(error) => error.details(),
            Self::Listen { address, given } => {
                Details::new(address, "an address of this machine and a free port", given)
            }
        }
    }
}
