//! From the UDP packets of a DCA1000 capture card in raw mode to whole frames over a WebSocket, which pages can read
//! and UDP they cannot.
//!
//! A client is sent a [`Hello`] as JSON, then binary messages of a frame each: its number as a little-endian 64-bit
//! integer, and its samples as a recording has them. [`Status`] comes once a second.

mod clients;
mod frames;
mod messages;
mod packet;
mod replay;
mod server;

pub use frames::{Counts, Frame, FrameAssembler};
pub use messages::{Hello, Status};
pub use packet::{HEADER_BYTES, Packet, write_header};
pub use replay::{Replay, replay_target};
pub use server::{Bridge, BridgeOptions, MOST_CLIENTS};
