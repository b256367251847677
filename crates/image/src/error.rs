//! Errors of images.

use boresight_core::{CoreError, Details, Diagnose};
use thiserror::Error;

/// Why an image cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] CoreError),
    /// More cells than an image may have.
    #[error("{what} has {given} cells; expected at most {most}")]
    TooLarge {
        /// The image.
        what: &'static str,
        /// The most it may have.
        most: usize,
        /// Cells asked for.
        given: f64,
    },
}

impl ImageError {
    /// Refuses an image of more than `most` cells.
    pub(crate) fn check_cells(
        what: &'static str,
        counts: impl IntoIterator<Item = usize>,
        most: usize,
    ) -> Result<(), Self> {
        let given: f64 = counts.into_iter().map(|count| count as f64).product();
        if given <= most as f64 { Ok(()) } else { Err(Self::TooLarge { what, most, given }) }
    }
}

impl Diagnose for ImageError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::TooLarge { .. } => "too-large",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::TooLarge { what, most, given } => {
                Details::new(*what, format!("at most {most} cells"), given.to_string())
            }
        }
    }
}
