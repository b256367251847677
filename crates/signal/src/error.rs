//! Errors of signal processing.

use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why a processing step cannot be set up or cannot take the data.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SignalError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// Guard and training cells around the cell under test do not fit the map.
    #[error("a CFAR window of {given} cells along {axis} does not fit a map of {cells}")]
    Window {
        /// Axis of the map.
        axis: &'static str,
        /// Cells the map has along it.
        cells: usize,
        /// Cells the window needs.
        given: usize,
    },
}

impl Diagnose for SignalError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Window { .. } => "cfar-window",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Window { axis, cells, given } => Details::new(
                format!("CFAR window along {axis}"),
                format!("at most {cells} cells"),
                given.to_string(),
            ),
        }
    }
}
