//! Raw captures of boards.

use super::chain::{chain_options, detections};
use crate::arguments::{EstimateArguments, RadarArguments};
use crate::error::CliError;
use crate::files::Files;
use crate::output::remark;
use crate::{array, network};
use boresight_core::{Array, Waveform};
use boresight_formats::dca1000::cascade;
use boresight_formats::{Capture, RadarConfig, ReadingOptions, Settled};
use boresight_pipeline::{Frame, FrameSource};
use std::path::{Path, PathBuf};

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
    /// Reads the capture in `file`, one of its sub-frames where it has several; of a cascade of chips the files beside it that belong to it, or those of a folder.
    pub fn read(
        file: &Path,
        config: Option<&Path>,
        sub_frame: Option<usize>,
        reading: &ReadingOptions,
        files: &Files,
    ) -> Result<Self, CliError> {
        let path = config.ok_or_else(|| CliError::Option {
            option: "--config",
            expected: "the board's .cfg file, which tells how to read a .bin file".into(),
            given: "nothing".into(),
        })?;
        let config = sub_frame_of(RadarConfig::parse(&files.read(path)?)?, sub_frame)?;
        let mut remarks = config.remarks.clone();
        let bytes = match cascade_files(file)? {
            Some(parts) => {
                let read = |path: &PathBuf| Ok((path.display().to_string(), files.read(path)?));
                let parts = parts.iter().map(read).collect::<Result<Vec<_>, CliError>>()?;
                let named: Vec<_> = parts.iter().map(|(name, bytes)| (&**name, &**bytes)).collect();
                let joined = cascade::join(&named, &config)?;
                remarks.extend(joined.remarks);
                joined.bytes
            }
            None => files.read(file)?,
        };
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

/// The files of a cascade in a folder, or beside one of them.
fn cascade_files(path: &Path) -> Result<Option<Vec<PathBuf>>, CliError> {
    let is_part = |path: &Path| path.to_str().is_some_and(cascade::is_part);
    let folder = match path.is_dir() {
        true => path,
        false if is_part(path) => match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        },
        false => return Ok(None),
    };
    let failed = |error| CliError::File { action: "read", path: folder.into(), error };
    let mut parts = vec![];
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if is_part(&path) {
            parts.push(path);
        }
    }
    parts.sort();
    Ok(Some(parts))
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
