//! Raw captures of boards.

use super::chain::{chain_options, detections};
use crate::arguments::{EstimateArguments, RadarArguments};
use crate::error::CliError;
use crate::files::Files;
use crate::output::remark;
use crate::{array, network};
use boresight_core::{Array, Waveform};
use boresight_formats::{Capture, RadarConfig};
use boresight_pipeline::{Frame, FrameSource};
use std::path::Path;

/// The frames of a capture.
pub struct CaptureFrames<'a>(pub Capture<'a>);

impl FrameSource for CaptureFrames<'_> {
    type Error = CliError;

    fn frames(&self) -> usize {
        self.0.frames()
    }

    fn frame(&self, index: usize) -> Result<Frame, CliError> {
        let raw = self.0.frame(index)?;
        Ok(Frame { samples: raw.samples, clipped: raw.clipped })
    }
}

/// Detections in a capture.
pub fn run(arguments: &EstimateArguments, bytes: &[u8], files: &Files) -> Result<String, CliError> {
    let (source, radar) = open(&arguments.radar, bytes, files)?;
    let (options, model) = (chain_options(arguments), &arguments.angle.model);
    let Radar { waveform, receivers, array } = &radar;
    let mut chain = network::chain(waveform, *receivers, array, &options, model, files)?;
    detections(arguments, &mut chain, &source)
}

/// The radar frames are of.
pub struct Radar {
    /// Its waveform.
    pub waveform: Waveform,
    /// Its receivers.
    pub receivers: usize,
    /// Its array.
    pub array: Array,
}

/// Opens a capture.
pub fn open<'a>(
    arguments: &RadarArguments,
    bytes: &'a [u8],
    files: &Files,
) -> Result<(CaptureFrames<'a>, Radar), CliError> {
    let (frames, config) = read(arguments.config.as_deref(), arguments.subframe, bytes, files)?;
    let array = board_array(arguments.array.as_deref(), &config, files)?;
    let (waveform, receivers) = (config.waveform, config.receivers.len());
    Ok((frames, Radar { waveform, receivers, array }))
}

/// The frames of a capture, of one of its sub-frames where it has several, and its configuration.
pub fn read<'a>(
    config: Option<&Path>,
    sub_frame: Option<usize>,
    bytes: &'a [u8],
    files: &Files,
) -> Result<(CaptureFrames<'a>, RadarConfig), CliError> {
    let path = config.ok_or_else(|| CliError::Option {
        option: "--config",
        expected: "the board's .cfg file, which tells how to read a .bin file".into(),
        given: "nothing".into(),
    })?;
    let config = sub_frame_of(RadarConfig::parse(&files.read(path)?)?, sub_frame)?;
    let capture = Capture::new(bytes, &config)?;
    remark(config.remarks.iter().chain(capture.remarks()).map(|remark| remark.message.clone()));
    Ok((CaptureFrames(capture), config))
}

/// The configuration of one of its sub-frames; what others there are is said.
pub fn sub_frame_of(
    config: RadarConfig,
    sub_frame: Option<usize>,
) -> Result<RadarConfig, CliError> {
    let (count, sub_frame) = (config.sub_frames.len(), sub_frame.unwrap_or(config.sub_frame));
    if count > 1 {
        remark([format!("sub-frame {sub_frame} of {count} is read; --subframe chooses another")]);
    }
    Ok(config.choose(sub_frame)?)
}

/// The array of a name, or the board's.
pub fn board_array(
    name: Option<&str>,
    config: &RadarConfig,
    files: &Files,
) -> Result<Array, CliError> {
    match name {
        Some(name) => array::array(name, files),
        None => config.array().ok_or_else(|| CliError::Option {
            option: "--array",
            expected: "an array, since the configuration names no board with a known one".into(),
            given: "nothing".into(),
        }),
    }
}
