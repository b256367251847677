//! Errors of the sockets.

use boresight_core::{Details, Diagnose, InputError};
use boresight_formats::FormatError;
use boresight_mounting::MountingError;
use thiserror::Error;

/// Why a socket cannot be served.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LiveError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// Calibration refused.
    #[error(transparent)]
    Calibrate(#[from] MountingError),
    /// A file that is served or that says what is served cannot be used.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The system refuses an address to listen at.
    #[error("cannot listen at {address} for {what}: {given}")]
    Listen {
        /// What would have been received there.
        what: &'static str,
        /// Host and port.
        address: String,
        /// What the system says.
        given: String,
    },
    /// A socket failed while it was in use.
    #[error("{what}: {given}")]
    Socket {
        /// What the socket is for.
        what: &'static str,
        /// What the system says.
        given: String,
    },
    /// Frames of a configuration are too large or empty.
    #[error("a frame of the configuration has {given} bytes; expected {expected}")]
    FrameSize {
        /// What would have been accepted.
        expected: String,
        /// Bytes of a frame.
        given: u64,
    },
    /// An origin of pages is none.
    #[error("origin {given:?}; expected {expected}")]
    Origin {
        /// What would have been accepted.
        expected: &'static str,
        /// What was given.
        given: String,
    },
}

impl Diagnose for LiveError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Calibrate(error) => error.code(),
            Self::Format(error) => error.code(),
            Self::Listen { .. } => "cannot-listen",
            Self::Socket { .. } => "socket",
            Self::FrameSize { .. } => "frame-size",
            Self::Origin { .. } => "origin",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Calibrate(error) => error.details(),
            Self::Format(error) => error.details(),
            Self::Listen { what, address, given } => Details::new(
                format!("{what} at {address}"),
                "an address of this machine and a free port",
                given,
            ),
            Self::Socket { what, given } => Details::new(*what, "a socket that works", given),
            Self::FrameSize { expected, given } => {
                Details::new("bytes of a frame", expected, given.to_string())
            }
            Self::Origin { expected, given } => Details::new("origin", *expected, given),
        }
    }
}
