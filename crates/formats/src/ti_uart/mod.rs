//! Packets that the demo firmware of Texas Instruments' mmWave SDK (1 to 3) sends over the board's
//! data port: a magic word, a header and type-length-value parts, padded to 32 bytes.
//!
//! The board's x points right and its y forward; here x points forward and y left, so
//! `x_m = y_board`, `y_m = -x_board` and azimuth is positive to the left.

mod packet;
mod parts;
mod recorded;
mod stream;

use crate::mmwave_cfg::RadarConfig;
use boresight_core::Remark;
use boresight_options::{Described, Flat, columns};
use serde::{Serialize, Serializer};
pub use stream::UartStream;

/// What every packet starts with.
pub const MAGIC: [u8; 8] = [2, 1, 4, 3, 6, 5, 8, 7];

/// Longest packet taken for one; a header that claims more is damaged.
pub const MAX_PACKET_BYTES: usize = 1 << 18;

/// An object the board detected.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct BoardObject {
    /// Distance.
    pub range_m: f64,
    /// Range rate, positive when receding; none where the packet holds only a Doppler bin and no
    /// configuration tells its width.
    pub rate_mps: Option<f64>,
    /// Azimuth, positive to the left.
    pub azimuth_rad: f64,
    /// Elevation, positive upwards.
    pub elevation_rad: f64,
    /// Position forward.
    pub x_m: f64,
    /// Position to the left.
    pub y_m: f64,
    /// Position upwards.
    pub z_m: f64,
    /// Range bin (SDK 1 and 2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_bin: Option<usize>,
    /// Doppler bin, signed (SDK 1 and 2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub doppler_bin: Option<i32>,
    /// Peak value as sent (SDK 1 and 2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak: Option<f64>,
    /// Ratio to the noise (side information of SDK 3).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snr_db: Option<f64>,
}

/// How long the board took, as it says.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct BoardStats {
    /// Processing between frames.
    pub processing_s: f64,
    /// Time to send the packet.
    pub transmit_s: f64,
    /// Margin left between frames.
    pub frame_margin_s: f64,
    /// Margin left between chirps.
    pub chirp_margin_s: f64,
    /// Load while chirps are sent, percent.
    pub active_load_percent: u32,
    /// Load between frames, percent.
    pub idle_load_percent: u32,
}

/// One packet: what the board made of one frame.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct BoardFrame {
    /// Number the board gave the frame.
    pub frame_number: u32,
    /// SDK version: major, minor, bug fix, build.
    #[option(described_as = String)]
    #[serde(serialize_with = "with_points")]
    pub sdk_version: [u8; 4],
    /// Platform, such as `xWR16xx`.
    pub platform: String,
    /// Sub-frame, 0 where frames are plain.
    #[serde(skip)]
    pub sub_frame: u32,
    /// Processor cycles at sending.
    #[serde(skip)]
    pub cpu_cycles: u32,
    /// Objects.
    pub objects: Vec<BoardObject>,
    /// Range profile at zero Doppler over the board's own unit, as sent.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub range_profile_db: Option<Vec<f64>>,
    /// Noise profile, likewise.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub noise_profile_db: Option<Vec<f64>>,
    /// Range x virtual antenna at zero Doppler, as sent, receiver fastest: real and imaginary parts in turn.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub azimuth_heat_map: Option<Vec<f32>>,
    /// Range x Doppler map over the board's own unit, as sent: Doppler fastest, from zero up to the highest and on from
    /// the lowest.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub range_doppler_db: Option<Vec<f64>>,
    /// Timing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stats: Option<BoardStats>,
    /// Parts of a type not known here.
    #[serde(skip)]
    pub unknown_parts: usize,
    /// Whether the whole packet was there; false for one that the end of the input cut, of which
    /// the leading whole parts are given.
    pub complete: bool,
}

/// A version in the usual writing.
fn with_points<S: Serializer>(parts: &[u8; 4], serializer: S) -> Result<S::Ok, S::Error> {
    parts.map(|part| part.to_string()).join(".").serialize(serializer)
}

/// What was lost of a board's output.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
pub struct BoardLogCounts {
    /// Bytes that belong to no packet.
    pub skipped_bytes: u64,
    /// Packets that were cut or damaged.
    pub damaged_packets: u64,
    /// Remarks on both.
    #[serde(rename = "warnings")]
    pub remarks: Vec<Remark>,
}

/// All packets of a recording.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct BoardLog {
    /// Packets, in order.
    pub frames: Vec<BoardFrame>,
    /// What was lost.
    pub counts: Flat<BoardLogCounts>,
}

impl BoardLog {
    /// Reads a recording of the board's data port. Damage is counted, not an error. With the
    /// configuration the board ran, Doppler bins become range rates.
    pub fn parse(bytes: &[u8], config: Option<&RadarConfig>) -> Self {
        let mut stream = UartStream::new(config);
        let mut frames = stream.push(bytes);
        frames.extend(stream.finish());
        Self { frames, counts: stream.counts().into() }
    }
}

#[cfg(test)]
mod tests;
