//! Errors of networks.

use boresight_aoa::AoaError;
use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why a model cannot be loaded or run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NeuralError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// Array, options or data do not suit the method.
    #[error(transparent)]
    Angle(#[from] AoaError),
    /// The bytes are no ONNX model.
    #[error("not an ONNX model: {given}")]
    NotOnnx {
        /// What the bytes are instead.
        given: String,
    },
    /// The file ends too early.
    #[error("the ONNX file is truncated: it needs {expected} bytes and has {given}")]
    Truncated {
        /// Bytes it should have at least.
        expected: usize,
        /// Bytes it has.
        given: usize,
    },
    /// Part of the model contradicts the format or itself.
    #[error("malformed ONNX model: {what}: expected {expected}, found {given}")]
    Malformed {
        /// The part.
        what: String,
        /// What it has to be.
        expected: String,
        /// What it is.
        given: String,
    },
    /// The model needs an operator that is not supported.
    #[error("the model needs the operator {name}, which is not supported")]
    UnsupportedOperator {
        /// Name of the operator, with its domain where that is not ONNX's own.
        name: String,
    },
    /// The inference engine refuses the model: types or shapes inside it do not fit.
    #[error("the model cannot be {stage}: {reason}")]
    Refused {
        /// What was being done.
        stage: &'static str,
        /// Why not.
        reason: String,
    },
    /// Inputs or outputs are not those asked for.
    #[error("{what}: expected {expected}, the model has {given}")]
    Mismatch {
        /// Which input or output, or all of them.
        what: String,
        /// Names and shapes asked for.
        expected: String,
        /// Names and shapes in the model.
        given: String,
    },
    /// The card is none.
    #[error("not a model's card: {reason}")]
    Card {
        /// Where it is wrong.
        reason: String,
    },
    /// The file is not the one the card was written for.
    #[error("the file's SHA-256 is {given}; its card says {expected}")]
    Digest {
        /// The card's digest.
        expected: String,
        /// The file's.
        given: String,
    },
    /// A weight or an output is NaN or infinite.
    #[error("{what} holds {given}")]
    NotFinite {
        /// The weight or the output.
        what: String,
        /// The number it holds.
        given: f32,
    },
    /// The model is for another number of targets.
    #[error("a network for {expected} targets is needed; {name} is for {given}")]
    Targets {
        /// Its name.
        name: String,
        /// Targets it has to be for.
        expected: usize,
        /// Targets it is for.
        given: usize,
    },
    /// The model is of another kind than asked for.
    #[error("a network of kind {expected} is needed; this one is of kind {given}")]
    WrongKind {
        /// Kinds that will do.
        expected: &'static str,
        /// The model's kind.
        given: &'static str,
    },
}

impl Diagnose for NeuralError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Angle(error) => error.code(),
            Self::NotOnnx { .. } => "not-onnx",
            Self::Truncated { .. } => "truncated-file",
            Self::Malformed { .. } => "malformed-file",
            Self::UnsupportedOperator { .. } => "unsupported-operator",
            Self::Refused { .. } => "model-refused",
            Self::Mismatch { .. } => "model-mismatch",
            Self::Card { .. } => "malformed-card",
            Self::Digest { .. } => "digest",
            Self::NotFinite { .. } => "network-not-finite",
            Self::Targets { .. } | Self::WrongKind { .. } => "wrong-network",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Angle(error) => error.details(),
            Self::NotOnnx { given } => Details::new("model", "an ONNX model", given),
            Self::Truncated { expected, given } => Details::new(
                "model",
                format!("at least {expected} bytes"),
                format!("{given} bytes"),
            ),
            Self::Malformed { what, expected, given }
            | Self::Mismatch { what, expected, given } => Details::new(what, expected, given),
            Self::UnsupportedOperator { name } => {
                Details::new("operator", "one of the supported operators", name)
            }
            Self::Refused { stage, reason } => {
                Details::new("model", format!("one that can be {stage}"), reason)
            }
            Self::Card { reason } => Details::new("card", "the card of a model", reason),
            Self::Digest { expected, given } => {
                Details::new("SHA-256 of the model", expected, given)
            }
            Self::NotFinite { what, given } => {
                Details::new(what, "finite numbers", given.to_string())
            }
            Self::Targets { expected, given, .. } => {
                Details::new("network", format!("one for {expected} targets"), given.to_string())
            }
            Self::WrongKind { expected, given } => Details::new("network", *expected, *given),
        }
    }
}

/// The error of an estimator whose network failed.
pub(crate) fn network_failed(method: &'static str, error: NeuralError) -> AoaError {
    match error {
        NeuralError::Argument(error) => error.into(),
        NeuralError::Angle(error) => error,
        other => AoaError::Network { method, reason: other.to_string() },
    }
}
