//! Packets that the demo firmware of Texas Instruments' mmWave SDK (1 to 3) sends over the board's
//! data port: a magic word, a header and type-length-value parts, padded to 32 bytes.
//!
//! The board's x points right and its y forward; here x points forward and y left, so
//! `x_m = y_board`, `y_m = -x_board` and azimuth is positive to the left.

mod packet;
mod parts;
mod stream;

use crate::error::Remark;
use crate::mmwave_cfg::RadarConfig;
use boresight_core::Complex32;
pub use stream::UartStream;

/// What every packet starts with.
pub const MAGIC: [u8; 8] = [2, 1, 4, 3, 6, 5, 8, 7];

/// Longest packet taken for one; a header that claims more is damaged.
pub const MAX_PACKET_BYTES: usize = 1 << 18;

/// An object the board detected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoardObject {
    /// Distance, m.
    pub range_m: f64,
    /// Range rate, m/s, positive when receding; `None` where the packet holds only a Doppler bin
    /// and no configuration tells its width.
    pub rate_mps: Option<f64>,
    /// Azimuth, rad, positive to the left.
    pub azimuth_rad: f64,
    /// Elevation, rad, positive upwards.
    pub elevation_rad: f64,
    /// Position forward, m.
    pub x_m: f64,
    /// Position to the left, m.
    pub y_m: f64,
    /// Position upwards, m.
    pub z_m: f64,
    /// Range and signed Doppler bin (SDK 1 and 2).
    pub bins: Option<(usize, i32)>,
    /// Peak value as sent (SDK 1 and 2).
    pub peak: Option<f64>,
    /// Ratio to the noise, dB (side information of SDK 3).
    pub snr_db: Option<f64>,
}

/// How long the board took, as it says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoardStats {
    /// Processing between frames, us.
    pub processing_us: u32,
    /// Time to send the packet, us.
    pub transmit_us: u32,
    /// Margin left between frames, us.
    pub frame_margin_us: u32,
    /// Margin left between chirps, us.
    pub chirp_margin_us: u32,
    /// Load while chirps are sent, percent.
    pub active_load_percent: u32,
    /// Load between frames, percent.
    pub idle_load_percent: u32,
}

/// One packet: what the board made of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct BoardFrame {
    /// Number the board gave the frame.
    pub frame_number: u32,
    /// SDK version: major, minor, bug fix, build.
    pub sdk_version: [u8; 4],
    /// Platform, such as `xWR16xx`.
    pub platform: String,
    /// Sub-frame, 0 where frames are plain.
    pub sub_frame: u32,
    /// Processor cycles at sending.
    pub cpu_cycles: u32,
    /// Objects.
    pub objects: Vec<BoardObject>,
    /// Range profile at zero Doppler, dB over the board's own unit.
    pub range_profile_db: Option<Vec<f64>>,
    /// Noise profile, likewise.
    pub noise_profile_db: Option<Vec<f64>>,
    /// Range x virtual antenna at zero Doppler, as sent, receiver fastest.
    pub azimuth_heat_map: Option<Vec<Complex32>>,
    /// Range x Doppler map as sent, Doppler fastest.
    pub range_doppler_map: Option<Vec<u16>>,
    /// Timing.
    pub stats: Option<BoardStats>,
    /// Parts of a type not known here.
    pub unknown_parts: usize,
    /// Whether the whole packet was there; false for one that the end of the input cut, of which
    /// the leading whole parts are given.
    pub complete: bool,
}

/// All packets of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct BoardLog {
    /// Packets, in order.
    pub frames: Vec<BoardFrame>,
    /// Bytes that belong to no packet.
    pub skipped_bytes: u64,
    /// Packets that were cut or damaged.
    pub damaged_packets: u64,
    /// Remarks on both.
    pub remarks: Vec<Remark>,
}

impl BoardLog {
    /// Reads a recording of the board's data port. Damage is counted, not an error. With the
    /// configuration the board ran, Doppler bins become range rates.
    pub fn parse(bytes: &[u8], config: Option<&RadarConfig>) -> Self {
        let mut stream = UartStream::new(config);
        let mut frames = stream.push(bytes);
        frames.extend(stream.finish());
        Self {
            frames,
            skipped_bytes: stream.skipped_bytes(),
            damaged_packets: stream.damaged_packets(),
            remarks: stream.remarks(),
        }
    }
}

#[cfg(test)]
mod tests;
