//! Errors of simulation.

use boresight_core::{CoreError, Details, Diagnose};
use thiserror::Error;

/// Why something cannot be simulated.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] CoreError),
    /// The result would take more memory than one call may fill.
    #[error("{what} would take {given} complex values; expected at most {most} in one call")]
    TooLarge {
        /// What would be allocated.
        what: &'static str,
        /// Most values one call returns.
        most: usize,
        /// Values it would return.
        given: usize,
    },
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
            Self::TooLarge { .. } => "too-large",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::TooLarge { what, most, given } => {
                Details::new(*what, format!("at most {most} complex values"), given.to_string())
            }
            Self::Cancelled { done, total } => {
                Details::new("simulation", format!("{total} scans"), format!("stopped at {done}"))
            }
        }
    }
}

/// The product of the sizes, where it is at most `most`.
pub(crate) fn check_values(
    what: &'static str,
    sizes: &[usize],
    most: usize,
) -> Result<usize, SimulateError> {
    let given = sizes.iter().copied().fold(1, usize::saturating_mul);
    if given > most { Err(SimulateError::TooLarge { what, most, given }) } else { Ok(given) }
}
