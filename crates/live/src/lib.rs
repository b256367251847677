//! Radars and results over sockets.
//!
//! - [`bridge`]: raw samples of a DCA1000 capture card, from its UDP packets to frames over a WebSocket.
//! - [`foxglove`]: a server that plays drives and their calibration to viewers.
//! - [`origin`]: which pages may connect to either.

mod admission;
pub mod bridge;
mod error;
pub mod foxglove;
mod handshake;
pub mod origin;

pub use error::LiveError;
