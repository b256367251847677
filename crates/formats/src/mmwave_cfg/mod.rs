//! The text configuration (`.cfg`) of Texas Instruments' mmWave SDK demos, versions 1 to 3.
//!
//! A line is a command and its arguments; `%` starts a comment. What shapes the raw samples is
//! read strictly; settings of the board's own processing are passed over; everything else is
//! reported as a [`Remark`].

mod antennas;
mod commands;
mod line;
mod sequence;

use crate::error::FormatError;
use boresight_core::Remark;
use boresight_core::{Array, Waveform};
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

/// What a configuration says of the radar and its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarConfig {
    /// Timing and frequency plan of a frame.
    pub waveform: Waveform,
    /// Receivers in use, as their numbers on the chip (from 0), ascending.
    pub receivers: Vec<usize>,
    /// Transmitters in use, as their numbers on the chip (from 0), in order of transmission.
    pub transmitters: Vec<usize>,
    /// Name of the preset whose virtual elements are exactly the configured channels in their
    /// order of transmission, if there is one.
    pub array_preset: Option<&'static str>,
    /// The board's antennas, in the order of their numbers on the chip: those that the configuration's own
    /// `antGeometry0`, `antGeometry1` and `antPhaseRot` tell, or those of the platform's evaluation board.
    pub board: Option<Array>,
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

    /// Bytes of one frame of raw samples.
    pub fn frame_bytes(&self) -> u64 {
        let waveform = &self.waveform;
        [waveform.loops, waveform.transmitters, self.receivers.len(), waveform.samples, 4]
            .iter()
            .fold(1_u64, |product, &factor| product.saturating_mul(factor as u64))
    }

    /// The virtual array of the configured channels in their order of transmission, where the
    /// board's antennas are known.
    pub fn array(&self) -> Option<Array> {
        let board = self.board.as_ref()?;
        let (tx, rx) = (&self.transmitters, &self.receivers);
        let array = Array::mimo(&picked(board.tx(), tx)?, &picked(board.rx(), rx)?).ok()?;
        let turned = (picked(board.inverted_tx(), tx)?, picked(board.inverted_rx(), rx)?);
        array.with_inverted(&turned.0, &turned.1).ok()
    }
}

fn picked<T: Copy>(all: &[T], which: &[usize]) -> Option<Vec<T>> {
    which.iter().map(|&k| all.get(k).copied()).collect()
}

#[cfg(test)]
mod tests;
