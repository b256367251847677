//! Errors of the sockets.

use boresight_core::{Details, Diagnose};
use boresight_formats::FormatError;
use thiserror::Error;

/// Why a socket cannot be served.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LiveError {
    /// A file that is served or that says what is served cannot be used.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// An address cannot be listened on.
    #[error("{what}: {address} cannot be listened on: {error}")]
    Listen {
        /// What would have been received there.
        what: &'static str,
        /// The address.
        address: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// A socket failed while it was in use.
    #[error("{what}: {error}")]
    Socket {
        /// What the socket is for.
        what: &'static str,
        /// What the system says.
        error: std::io::Error,
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
            Self::Format(error) => error.code(),
            Self::Listen { .. } => "not-listening",
            Self::Socket { .. } => "socket",
            Self::FrameSize { .. } => "frame-size",
            Self::Origin { .. } => "origin",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Format(error) => error.details(),
            Self::Listen { what, address, error } => Details::new(
                format!("{what} at {address}"),
                "an address of this machine with a free port",
                error.to_string(),
            ),
            Self::Socket { what, error } => {
                Details::new(*what, "a socket that works", error.to_string())
            }
            Self::FrameSize { expected, given } => {
                Details::new("bytes of a frame", expected, given.to_string())
            }
            Self::Origin { expected, given } => Details::new("origin", *expected, given),
        }
    }
}
