//! Errors of images.

use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why an image cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
}

impl Diagnose for ImageError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
        }
    }
}
