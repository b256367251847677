//! Errors of simulation.

use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why something cannot be simulated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// The caller stopped the simulation.
    #[error("stopped after {done} of {total} scans")]
    Cancelled {
        /// Scans done.
        done: usize,
        /// Scans asked for.
        total: usize,
    },
}

impl Diagnose for SimulateError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Cancelled { .. } => "cancelled",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Cancelled { done, total } => {
                Details::new("simulation", format!("{total} scans"), format!("stopped at {done}"))
            }
        }
    }
}
