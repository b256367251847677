//! Errors of the chain.

use boresight_aoa::AoaError;
use boresight_array_calibration::ArrayCalibrationError;
use boresight_core::{Details, Diagnose, InputError};
use boresight_image::ImageError;
use boresight_signal::SignalError;
use thiserror::Error;

/// Why a chain cannot be planned or a frame not be processed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// A step of signal processing refused.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// Angle estimation refused.
    #[error(transparent)]
    Angle(#[from] AoaError),
    /// An image cannot be made.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// An array cannot be calibrated.
    #[error(transparent)]
    ArrayCalibration(#[from] ArrayCalibrationError),
    /// The array has other channels than the frames.
    #[error("the array {given}; the frames have {expected}")]
    Channels {
        /// Transmitters and receivers of the frames, in words.
        expected: String,
        /// What the array has instead.
        given: String,
    },
    /// Regions are those of transmitters that take turns.
    #[error("regions are found in time-division multiplexing alone; the transmitters send at once")]
    Multiplexing,
    /// The caller asked to stop.
    #[error("stopped after {done} of {total} steps")]
    Cancelled {
        /// Steps done.
        done: usize,
        /// Steps there would have been.
        total: usize,
    },
}

impl Diagnose for PipelineError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Signal(error) => error.code(),
            Self::Angle(error) => error.code(),
            Self::Image(error) => error.code(),
            Self::ArrayCalibration(error) => error.code(),
            Self::Channels { .. } => "channels",
            Self::Multiplexing => "multiplexing",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Signal(error) => error.details(),
            Self::Angle(error) => error.details(),
            Self::Image(error) => error.details(),
            Self::ArrayCalibration(error) => error.details(),
            Self::Channels { expected, given } => Details::new("array", expected, given),
            Self::Multiplexing => {
                Details::new("multiplexing", "time-division", "transmitters that send at once")
            }
            Self::Cancelled { done, total } => {
                Details::new("steps", total.to_string(), format!("{done}, then a request to stop"))
            }
        }
    }
}
