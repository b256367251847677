//! Arrays by name or from a JSON file.

use crate::error::CliError;
use crate::files::{self, Files};
use boresight_core::array::Position;
use boresight_core::{Array, presets};
use serde::Deserialize;
use std::path::PathBuf;

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
