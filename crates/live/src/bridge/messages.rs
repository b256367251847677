//! What clients are told beside frames.

use super::frames::Counts;
use serde::Serialize;

/// Told first.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "camelCase", tag = "type", rename = "hello")]
pub struct Hello<'a> {
    /// Changes where a client of before would misread what follows.
    pub version: u32,
    /// Bytes of a frame.
    pub frame_bytes: u64,
    /// From the begin of a frame to that of the next, s.
    pub frame_interval_s: f64,
    /// The board's configuration, as its file has it.
    pub config: &'a str,
    /// What came so far.
    pub counts: Counts,
}

/// Told once a second.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "camelCase", tag = "type", rename = "status")]
pub struct Status {
    /// What came so far.
    pub counts: Counts,
    /// Frames that this client was sent.
    pub sent_frames: u64,
    /// Frames that this client was too slow for.
    pub skipped_frames: u64,
}

/// A message as text.
pub(super) fn text(message: &impl Serialize) -> String {
    serde_json::to_string(message).unwrap_or_default()
}
