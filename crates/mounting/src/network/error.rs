//! What can be wrong with a network's weights.

use boresight_core::{Details, Diagnose};
use thiserror::Error;

/// Weights that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NetworkError {
    /// Bytes that are no file of weights, one of another version, or one that was damaged.
    #[error("malformed weights: expected {expected}, given {given}")]
    Malformed {
        /// What was expected.
        expected: String,
        /// What was given.
        given: String,
    },
    /// A tensor is missing or has another shape than the network needs.
    #[error("weights of another network: {tensor} is {given}; expected {expected}")]
    Unlike {
        /// Name of the tensor.
        tensor: String,
        /// The shape that the network needs.
        expected: String,
        /// The shape that was given.
        given: String,
    },
    /// A number is not finite.
    #[error("weights that are not finite: {tensor}")]
    NotFinite {
        /// Name of the tensor.
        tensor: String,
    },
}

impl Diagnose for NetworkError {
    fn code(&self) -> &'static str {
        match self {
            Self::Malformed { .. } => "malformed-weights",
            Self::Unlike { .. } => "unlike-weights",
            Self::NotFinite { .. } => "weights-not-finite",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Malformed { expected, given } => Details::new("weights", expected, given),
            Self::Unlike { tensor, expected, given } => Details::new(tensor, expected, given),
            Self::NotFinite { tensor } => Details::new(tensor, "finite numbers", "others"),
        }
    }
}
