//! Errors of angle estimation.

use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why an estimator cannot be built or cannot take the data.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum AoaError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// The array does not suit the method.
    #[error("{method} needs {expected}; the array {given}")]
    Array {
        /// Name of the method.
        method: &'static str,
        /// What the method asks of the array.
        expected: String,
        /// What the array is.
        given: String,
    },
    /// More sources asked for than the array and the method can tell apart.
    #[error("{method} finds at most {most} sources here; {given} were asked for")]
    TooManySources {
        /// Name of the method.
        method: &'static str,
        /// The most it can find with this array and these options.
        most: usize,
        /// The number asked for.
        given: usize,
    },
    /// Too few, or too many, snapshots.
    #[error("{method} needs {expected}; {given} snapshots were given")]
    Snapshots {
        /// Name of the method.
        method: &'static str,
        /// What the method asks for.
        expected: String,
        /// The number given.
        given: usize,
    },
    /// The method works on snapshots and was given a covariance.
    #[error("{method} needs snapshots; a covariance was given")]
    NeedsSnapshots {
        /// Name of the method.
        method: &'static str,
    },
    /// The method is a network and there is no model.
    #[error(
        "{method} is a trained network; load a model with Network (JavaScript) or --model (command line)"
    )]
    NeedsModel {
        /// Name of the method.
        method: &'static str,
    },
    /// A network is to count the sources and there is none.
    #[error("{method} takes the number of sources from a counting network and needs one")]
    NeedsCounter {
        /// Name of the method.
        method: &'static str,
    },
    /// A network could not be run, or answered with what is no answer.
    #[error("{method}: {reason}")]
    Network {
        /// Name of the method.
        method: &'static str,
        /// What went wrong.
        reason: String,
    },
}

impl Diagnose for AoaError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Array { .. } => "unsuitable-array",
            Self::TooManySources { .. } => "too-many-sources",
            Self::Snapshots { .. } => "snapshot-count",
            Self::NeedsSnapshots { .. } => "needs-snapshots",
            Self::NeedsModel { .. } => "needs-model",
            Self::NeedsCounter { .. } => "needs-counting-network",
            Self::Network { .. } => "network-failed",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Array { expected, given, .. } => Details::new("array", expected, given),
            Self::TooManySources { most, given, .. } => {
                Details::new("sources", format!("at most {most}"), given.to_string())
            }
            Self::Snapshots { expected, given, .. } => {
                Details::new("snapshots", expected, given.to_string())
            }
            Self::NeedsSnapshots { .. } => Details::new("data", "snapshots", "a covariance"),
            Self::NeedsModel { .. } => Details::new("model", "a trained network", "none"),
            Self::NeedsCounter { .. } => {
                Details::new("sources", "a trained counting network", "none")
            }
            Self::Network { reason, .. } => Details::new("network", "an answer", reason),
        }
    }
}
