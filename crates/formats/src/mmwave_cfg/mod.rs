//! The text configuration (`.cfg`) of Texas Instruments' mmWave SDK demos, versions 1 to 3.
//!
//! A line is a command and its arguments; `%` starts a comment. What shapes the raw samples is
//! read strictly; settings of the board's own processing are passed over; everything else is
//! reported as a [`Remark`].

mod commands;
mod frames;
mod line;
mod sequence;

use crate::error::FormatError;
use boresight_core::Remark;
use boresight_core::error::check_range;
use boresight_core::{Array, Waveform, presets};
use commands::Commands;
use line::Line;

/// Sample format of a capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AdcFormat {
    /// Bits of a sample: 12, 14 or 16, sign-extended to 16.
    pub bits: u32,
    /// Whether Q comes before I.
    pub q_first: bool,
    /// Whether the samples of one receiver follow each other (else receivers alternate).
    pub receiver_major: bool,
}

impl AdcFormat {
    /// The largest magnitude a sample can have, plus one: full scale.
    pub fn full_scale(&self) -> i32 {
        1 << (self.bits - 1)
    }
}

/// One of the sub-frames that follow each other in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SubFrame {
    /// Timing and frequency plan.
    pub waveform: Waveform,
    /// Transmitters, as their numbers on the chip (from 0), in order of transmission.
    pub transmitters: Vec<usize>,
}

/// What a configuration says of the radar and its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarConfig {
    /// Timing and frequency plan of a frame, or of the chosen sub-frame of an advanced one.
    pub waveform: Waveform,
    /// Receivers in use, as their numbers on the chip (from 0), ascending.
    pub receivers: Vec<usize>,
    /// Transmitters in use, as their numbers on the chip (from 0), in order of transmission.
    pub transmitters: Vec<usize>,
    /// The sub-frame that waveform and transmitters are of, from 0.
    pub sub_frame: usize,
    /// All sub-frames in order of transmission; one in a frame that has none.
    pub sub_frames: Vec<SubFrame>,
    /// Name of the preset whose virtual elements are exactly the configured channels in their
    /// order of transmission, if there is one.
    pub array_preset: Option<&'static str>,
    /// Platform named in a comment, such as `xWR16xx`.
    pub platform: Option<String>,
    /// SDK version named in a comment, such as `02.00`.
    pub sdk_version: Option<String>,
    /// Format of the samples.
    pub adc: AdcFormat,
    /// Frames to record; `None` until stopped.
    pub frames: Option<usize>,
    /// Lines not understood, and settings that bear on the samples but are not applied.
    pub remarks: Vec<Remark>,
}

impl RadarConfig {
    /// Reads a configuration. Comments, either line ending, a byte order mark and a missing
    /// `sensorStart` are fine; bytes that are not UTF-8 are replaced.
    ///
    /// # Errors
    /// [`FormatError::Config`] naming the line and argument that cannot be;
    /// [`FormatError::MissingCommand`] where one of `profileCfg`, `chirpCfg`, `frameCfg` and
    /// `channelCfg` is absent.
    pub fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        let text = String::from_utf8_lossy(bytes);
        let mut commands = Commands::default();
        for (index, raw) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let content = raw.split('%').next().unwrap_or_default();
            if let Some((_, comment)) = raw.split_once('%') {
                commands.comment(comment);
            }
            if let Some(line) = Line::of(index + 1, content) {
                commands.take(&line)?;
            }
        }
        commands.finish()
    }

    /// Bytes of one frame of raw samples, with all of its sub-frames.
    pub fn frame_bytes(&self) -> u64 {
        self.bytes_of(&self.sub_frames)
    }

    /// Where the samples of the chosen sub-frame stand in the bytes of a frame.
    pub fn sub_frame_bytes(&self) -> std::ops::Range<u64> {
        let end = |count| self.bytes_of(self.sub_frames.get(..count).unwrap_or_default());
        end(self.sub_frame)..end(self.sub_frame + 1)
    }

    fn bytes_of(&self, sub_frames: &[SubFrame]) -> u64 {
        let bytes = |waveform: &Waveform| {
            let chirps = waveform.chirps_per_loop();
            [waveform.loops, chirps, self.receivers.len(), waveform.samples, 4]
                .iter()
                .fold(1_u64, |product, &factor| product.saturating_mul(factor as u64))
        };
        let each = sub_frames.iter().map(|part| bytes(&part.waveform));
        each.fold(0, u64::saturating_add)
    }

    /// The same with another sub-frame chosen.
    ///
    /// # Errors
    /// [`boresight_core::CoreError::OutOfRange`] for one that is not there.
    pub fn choose(mut self, sub_frame: usize) -> Result<Self, FormatError> {
        let last = self.sub_frames.len().saturating_sub(1);
        check_range("sub-frame", sub_frame as f64, 0.0, last as f64)?;
        if let Some(part) = self.sub_frames.get(sub_frame).cloned() {
            (self.waveform, self.transmitters) = (part.waveform, part.transmitters);
            self.sub_frame = sub_frame;
        }
        self.find_preset();
        Ok(self)
    }

    fn find_preset(&mut self) {
        let board = self.platform.as_deref().and_then(board_preset);
        self.array_preset = board.filter(|name| {
            let board = presets::preset(name).ok();
            board.is_some() && board == self.array()
        });
    }

    /// The virtual array of the configured channels in their order of transmission, for platforms
    /// whose antennas are known.
    pub fn array(&self) -> Option<Array> {
        let board = presets::preset(board_preset(self.platform.as_deref()?)?).ok()?;
        let pick = |positions: &[[f64; 3]], which: &[usize]| -> Option<Vec<[f64; 3]>> {
            which.iter().map(|&k| positions.get(k).copied()).collect()
        };
        Array::mimo(&pick(board.tx(), &self.transmitters)?, &pick(board.rx(), &self.receivers)?)
            .ok()
    }
}

/// The preset of a platform's evaluation board.
fn board_preset(platform: &str) -> Option<&'static str> {
    match platform.to_ascii_lowercase().as_str() {
        "xwr16xx" | "awr1642" | "iwr1642" => Some("awr1642"),
        "xwr18xx" | "awr1843" | "iwr1843" => Some("awr1843"),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
