//! Radars and results over sockets.
//!
//! - [`bridge`]: raw samples of a DCA1000 capture card, from its UDP packets to frames over a WebSocket.

pub mod bridge;
mod error;

pub use error::LiveError;
