//! Drives as messages of the schemas that Foxglove, Lichtblick and others know, for MCAP files and sockets.
//!
//! Messages are JSON, described by JSON Schema. Those of Foxglove's own schemas have its names; our own
//! have the names and units of results outside Rust. Frames have x forward, y left and z up: `world` is the
//! log's global frame, `car` that of the rear axle, `radar_N` that of a radar.

pub mod clock;
pub mod cloud;
mod drive;
pub mod messages;
pub mod scene;
mod schema;
pub mod transform;
pub mod typed;

pub use clock::Clock;
pub use drive::{CarMotion, DriveTopics, topic};

use std::borrow::Cow;

/// What readers are told of a topic before its messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Its topic.
    pub topic: String,
    /// How messages are encoded, in the names of MCAP.
    pub encoding: &'static str,
    /// Name of the type of its messages.
    pub schema_name: &'static str,
    /// How the schema is written, in the names of MCAP.
    pub schema_encoding: &'static str,
    /// The schema.
    pub schema: Cow<'static, str>,
    /// Whether the last message holds until the next, so that who comes late needs it.
    pub lasting: bool,
}

/// A message on one of the channels of a stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The channel, by its place among those of the stream.
    pub channel: usize,
    /// Time of the log, ns.
    pub time_ns: u64,
    /// The encoded message.
    pub data: Vec<u8>,
}

/// Of a radar: its number, and the frame that its detections are in.
#[must_use]
pub fn frame_id(sensor: u8) -> String {
    format!("radar_{sensor}")
}

/// The car's frame.
pub const CAR: &str = "car";
/// The log's global frame.
pub const WORLD: &str = "world";

#[cfg(test)]
mod tests;
