//! Arrays by name or from a JSON file, and their calibrations.

use crate::error::CliError;
use crate::files::{self, Files};
use boresight_core::array::Position;
use boresight_core::{Array, ArrayCalibration, presets};
use boresight_formats::{RadarConfig, json};
use boresight_options::Naming;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// What leaves out the calibration of a configuration.
const NO_CALIBRATION: &str = "none";

#[derive(Deserialize)]
#[serde(untagged, deny_unknown_fields)]
enum ArrayFile {
    Positions { positions: Vec<Position> },
    Mimo { tx: Vec<Position>, rx: Vec<Position> },
}

/// The array `text` names, or that the JSON file of that name holds.
pub fn array(text: &str, files: &Files) -> Result<Array, CliError> {
    let path = PathBuf::from(text);
    if files::ending(&path) != "json" {
        return Ok(presets::preset(text)?);
    }
    let file = serde_json::from_slice(&files.read(&path)?).map_err(|error| CliError::Json {
        path,
        expected: "positions, or tx and rx: lists of [x, y, z] in half wavelengths",
        error,
    })?;
    Ok(match file {
        ArrayFile::Positions { positions } => Array::new(&positions)?,
        ArrayFile::Mimo { tx, rx } => Array::mimo(&tx, &rx)?,
    })
}

/// The calibration in a JSON file.
pub fn calibration(path: &Path, files: &Files) -> Result<ArrayCalibration, CliError> {
    let calibration: ArrayCalibration =
        json::read(&files.read(path)?).map_err(|error| CliError::Json {
            path: path.into(),
            expected: "a calibration as `boresight array calibrate` writes it",
            error,
        })?;
    calibration.check_named(Naming::JavaScript)?;
    Ok(calibration)
}

/// An array with a calibration that `text` names, if any.
pub fn calibrated(array: Array, text: Option<&str>, files: &Files) -> Result<Array, CliError> {
    match text {
        None | Some(NO_CALIBRATION) => Ok(array),
        Some(path) => Ok(array.calibrated(&calibration(Path::new(path), files)?)?),
    }
}

/// A board's array with the calibration that `text` names, or else that of its configuration.
pub fn calibrated_board(
    array: Array,
    text: Option<&str>,
    config: &RadarConfig,
    files: &Files,
) -> Result<Array, CliError> {
    match text {
        None => Ok(config.compensated(&array)?),
        text => calibrated(array, text, files),
    }
}
