//! The text configuration (`.cfg`) of Texas Instruments' mmWave SDK demos, versions 1 to 3.
//!
//! A line is a command and its arguments; `%` starts a comment. What shapes the raw samples is
//! read strictly; settings of the board's own processing are passed over; everything else is
//! reported as a [`Remark`].

mod antennas;
mod commands;
mod compensation;
mod frames;
mod line;
mod sequence;

use crate::dca1000::layout::{Layout, Plan};
use crate::error::FormatError;
use crate::mmwave_studio;
use antennas::preset_of;
use boresight_core::{Array, Remark, Sampling, Waveform, presets};
use boresight_math::error::check_range;
use commands::Commands;
pub use compensation::Compensation;
use line::Line;

/// Sample format of a capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AdcFormat {
    /// Bits of a sample: 12, 14 or 16, sign-extended to 16.
    pub bits: u32,
    /// Whether Q comes before I.
    pub q_first: bool,
    /// Where samples stand.
    pub layout: Layout,
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
    /// Receivers in use, as their numbers on the chip (from 0), ascending; of a cascade, 4 to a chip, from left to
    /// right on the board ([`crate::dca1000::CASCADE_RECEIVERS`]).
    pub receivers: Vec<usize>,
    /// Transmitters in use, as their numbers on the chip (from 0; of a cascade 3 to a chip), in order of transmission.
    pub transmitters: Vec<usize>,
    /// The sub-frame that waveform and transmitters are of, from 0.
    pub sub_frame: usize,
    /// All sub-frames in order of transmission; one in a frame that has none.
    pub sub_frames: Vec<SubFrame>,
    /// Name of the preset whose virtual elements are exactly the configured channels in their
    /// order of transmission, if there is one.
    pub array_preset: Option<&'static str>,
    /// The board's antennas, in the order of their numbers on the chip: those that the configuration's own
    /// `antGeometry0`, `antGeometry1` and `antPhaseRot` tell, or those of the platform's evaluation board.
    pub board: Option<Array>,
    /// Whether lines of the antennas' own tell the board.
    pub antenna_lines: bool,
    /// Platform named in a comment, such as `xWR16xx`.
    pub platform: Option<String>,
    /// SDK version named in a comment, such as `02.00`.
    pub sdk_version: Option<String>,
    /// Format of the samples.
    pub adc: AdcFormat,
    /// Frames to record; `None` until stopped.
    pub frames: Option<usize>,
    /// Range bias and coefficients of the channels, where the line is there and can be read.
    pub compensation: Option<Compensation>,
    /// Lines not understood, and settings that bear on the samples but are not applied.
    pub remarks: Vec<Remark>,
}

impl RadarConfig {
    /// Reads the text of a `.cfg` file. Comments, either line ending, a byte order mark and a
    /// missing `sensorStart` are fine; bytes that are not UTF-8 are replaced.
    ///
    /// # Errors
    /// [`FormatError::Config`] naming the line and argument that cannot be;
    /// [`FormatError::MissingCommand`] where one of `profileCfg`, `chirpCfg`, `frameCfg` and
    /// `channelCfg` is absent; [`FormatError::ConfigField`] for JSON, which
    /// [`mmwave_studio::config_text`] translates.
    pub fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        if mmwave_studio::is_json(bytes) {
            return Err(FormatError::ConfigField {
                field: "the text".into(),
                expected: "commands of a .cfg file; studioConfig translates JSON into them".into(),
                given: "JSON".into(),
            });
        }
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
        self.bytes_before(self.sub_frames.len())
    }

    /// Where the samples of the chosen sub-frame stand in the bytes of a frame.
    pub fn sub_frame_bytes(&self) -> std::ops::Range<u64> {
        self.bytes_before(self.sub_frame)..self.bytes_before(self.sub_frame + 1)
    }

    fn bytes_before(&self, count: usize) -> u64 {
        let of = |(index, part): (usize, &SubFrame)| {
            let waveform = if index == self.sub_frame { &self.waveform } else { &part.waveform };
            self.plan_of(waveform).words().saturating_mul(2)
        };
        self.sub_frames.iter().take(count).enumerate().map(of).fold(0, u64::saturating_add)
    }

    /// The same with another sub-frame chosen.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] for one that is not there.
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

    /// Names the preset that the array is: that of the platform, or of any board where the configuration's own lines
    /// tell another.
    fn find_preset(&mut self) {
        let of = |name: &str| presets::preset(name).ok();
        let platform = self.platform.as_deref().and_then(preset_of).map(|(name, _)| name);
        let names = match platform {
            _ if self.adc.layout == Layout::Cascade => vec!["cascade86"],
            Some(name) if of(name) == self.board => vec![name],
            _ => presets::PRESETS.to_vec(),
        };
        let array = self.array();
        self.array_preset = names.into_iter().find(|name| array.is_some() && of(name) == array);
    }

    /// Where the samples of the chosen sub-frame stand.
    pub(crate) fn plan(&self) -> Plan {
        self.plan_of(&self.waveform)
    }

    fn plan_of(&self, waveform: &Waveform) -> Plan {
        Plan {
            layout: self.adc.layout,
            sampling: waveform.sampling,
            chirps: waveform.loops.saturating_mul(waveform.chirps_per_loop()),
            samples: waveform.samples,
            receivers: self.receivers.clone(),
        }
    }

    /// Checks that samples can be laid out so.
    pub(crate) fn check_layout(&self) -> Result<(), FormatError> {
        let wrong = |what, expected: &str, given: String| {
            Err(FormatError::Layout { what, expected: expected.into(), given })
        };
        let (samples, layout) = (self.waveform.samples, self.adc.layout);
        let pairs = layout == Layout::TwoLane && self.waveform.sampling == Sampling::Complex;
        if pairs && samples % 2 == 1 {
            let even = "an even number, since they are stored in pairs";
            return wrong("samples a chirp", even, samples.to_string());
        }
        let most = if layout == Layout::Cascade { 16 } else { 4 };
        if layout != Layout::TwoLane && self.receivers.iter().any(|&number| number >= most) {
            let given = format!("{:?}", self.receivers);
            return wrong("receivers", "numbers below 4, one a lane", given);
        }
        Ok(())
    }

    /// The virtual array of the configured channels in their order of transmission, where the
    /// board's antennas are known. A cascade's is its row: elevated elements, and those at places that another has, are
    /// left out.
    pub fn array(&self) -> Option<Array> {
        let (tx, rx) = (&self.transmitters, &self.receivers);
        if self.adc.layout == Layout::Cascade {
            return presets::cascade_row(tx, rx).ok();
        }
        let board = self.board.as_ref()?;
        let array = Array::mimo(&picked(board.tx(), tx)?, &picked(board.rx(), rx)?).ok()?;
        let turned = (picked(board.inverted_tx(), tx)?, picked(board.inverted_rx(), rx)?);
        array.with_inverted(&turned.0, &turned.1).ok()
    }
}

fn picked<T: Copy>(all: &[T], which: &[usize]) -> Option<Vec<T>> {
    which.iter().map(|&k| all.get(k).copied()).collect()
}

/// The lanes of a platform, or a board, by the number in its name.
fn platform_layout(platform: &str) -> Option<Layout> {
    let name = platform.to_ascii_lowercase();
    match name.get(3..5)? {
        "12" | "14" | "22" => Some(Layout::FourLane),
        "16" | "18" | "64" | "68" => Some(Layout::TwoLane),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
