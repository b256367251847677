//! Data cubes.

use super::capture::{Radar, board_array, sub_frame_of};
use super::chain::{chain_options, detections};
use crate::arguments::{EstimateArguments, RadarArguments};
use crate::error::CliError;
use crate::files::{self, Files, radar_config};
use crate::{array, network};
use boresight_core::{Complex32, InputError, Waveform};
use boresight_formats::NpyArray;
use boresight_pipeline::CubeFrames;
use ndarray::{Array5, Axis};

/// Detections in a data cube.
pub fn run(
    arguments: &EstimateArguments,
    file: &NpyArray,
    files: &Files,
) -> Result<String, CliError> {
    let (cube, radar) = open(&arguments.radar, file, files)?;
    let (options, model) = (chain_options(arguments), &arguments.angle.model);
    let Radar { waveform, receivers, array } = &radar;
    let mut chain = network::chain(waveform, *receivers, array, &options, model, files)?;
    detections(arguments, &mut chain, &CubeFrames(cube.view()))
}

/// Opens a data cube.
pub fn open(
    arguments: &RadarArguments,
    file: &NpyArray,
    files: &Files,
) -> Result<(Array5<Complex32>, Radar), CliError> {
    let cube = read(file)?;
    let (waveform, array) = match &arguments.config {
        Some(path) => {
            let config = radar_config(path, files)?;
            let config = sub_frame_of(config, arguments.subframe)?;
            let array = board_array(arguments.array.as_deref(), &config, files)?;
            let calibration = arguments.calibration.as_deref();
            (config.waveform, array::calibrated_board(array, calibration, &config, files)?)
        }
        None => {
            let waveform = named_waveform(arguments.waveform.as_deref(), files)?;
            let array = arguments.array.as_ref().ok_or_else(|| CliError::Option {
                option: "--array",
                expected: "the array of the cube".into(),
                given: "nothing".into(),
            })?;
            let array = array::array(array, files)?;
            (waveform, array::calibrated(array, arguments.calibration.as_deref(), files)?)
        }
    };
    let receivers = cube.len_of(Axis(3));
    Ok((cube, Radar { waveform, receivers, array }))
}

/// A data cube of frames x loops x chirps of a loop x receivers x samples; a cube of one frame may lack the first axis.
pub fn read(file: &NpyArray) -> Result<Array5<Complex32>, CliError> {
    let mut shape = file.shape.clone();
    if shape.len() == 4 {
        shape.insert(0, 1);
    }
    let wrong = || InputError::Shape {
        what: "the array".into(),
        expected: "1 to 3 axes (snapshots), or 4 or 5 (a data cube)".into(),
        given: file.shape.clone(),
    };
    let shape: [usize; 5] = shape.try_into().map_err(|_| wrong())?;
    Ok(Array5::from_shape_vec(shape, file.to_complex32()).map_err(|_| wrong())?)
}

/// The waveform of a data cube that has no configuration beside it.
pub fn named_waveform(name: Option<&str>, files: &Files) -> Result<Waveform, CliError> {
    let name = name.ok_or_else(|| CliError::Option {
        option: "--waveform",
        expected: "the waveform of the cube, or --config".into(),
        given: "nothing".into(),
    })?;
    files::waveform(name, files)
}
