//! Raw captures of boards.

use super::chain::{chain_options, detections};
use super::recording::Recording;
use crate::arguments::{EstimateArguments, RadarArguments};
use crate::error::CliError;
use crate::files::{Files, radar_config};
use crate::output::remark;
use crate::{array, network};
use boresight_core::{Array, Waveform};
use boresight_formats::{Capture, RadarConfig, ReadingOptions, Settled};
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
pub fn run(arguments: &EstimateArguments, files: &Files) -> Result<String, CliError> {
    let (samples, radar) = open(&arguments.radar, &arguments.file, files)?;
    let (options, model) = (chain_options(arguments), &arguments.angle.model);
    let Radar { waveform, receivers, array } = &radar;
    let mut chain = network::chain(waveform, *receivers, array, &options, model, files)?;
    detections(arguments, &mut chain, &samples.frames()?)
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

/// A capture's bytes, with what they are read by.
pub struct Samples {
    bytes: Vec<u8>,
    /// Its configuration, with what overrides it.
    pub config: RadarConfig,
}

impl Samples {
    /// Reads a capture, or one of its sub-frames; `file` is as in [`Recording::find`].
    pub fn read(
        file: &Path,
        config: Option<&Path>,
        sub_frame: Option<usize>,
        reading: &ReadingOptions,
        files: &Files,
    ) -> Result<Self, CliError> {
        let path = config.ok_or_else(|| CliError::Option {
            option: "--config",
            expected:
                "the board's .cfg or .mmwave.json file, which gives the format of a .bin file"
                    .into(),
            given: "nothing".into(),
        })?;
        let config = sub_frame_of(radar_config(path, files)?, sub_frame)?;
        let mut remarks = config.remarks.clone();
        let bytes = Recording::find(file)?.read(&config, &mut remarks, files)?;
        let settled = Settled::new(&bytes, &config, reading)?;
        remarks.extend(settled.remarks);
        remark(remarks.into_iter().map(|remark| remark.message));
        Ok(Self { bytes, config: settled.config })
    }

    /// Its frames.
    pub fn frames(&self) -> Result<CaptureFrames<'_>, CliError> {
        Ok(CaptureFrames(Capture::new(&self.bytes, &self.config)?))
    }
}

/// Opens a capture.
pub fn open(
    arguments: &RadarArguments,
    file: &Path,
    files: &Files,
) -> Result<(Samples, Radar), CliError> {
    let (config, reading) = (arguments.config.as_deref(), &arguments.reading.options);
    let samples = Samples::read(file, config, arguments.subframe, reading, files)?;
    let array = board_array(arguments.array.as_deref(), &samples.config, files)?;
    let calibration = arguments.calibration.as_deref();
    let array = array::calibrated_board(array, calibration, &samples.config, files)?;
    let (waveform, receivers) = (samples.config.waveform, samples.config.receivers.len());
    Ok((samples, Radar { waveform, receivers, array }))
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
