//! Arrays of numbers from files of several formats.

use crate::error::CliError;
use crate::files::{self, Files};
use boresight_formats::{NpyArray, hdf5};
use std::path::Path;

/// Endings of the files that [`read`] reads.
pub const ENDINGS: [&str; 4] = ["npy", "mat", "h5", "hdf5"];

/// The array of a file by its ending; of a file with several, the one of the name.
pub fn read(path: &Path, dataset: Option<&str>, files: &Files) -> Result<NpyArray, CliError> {
    let bytes = files.read(path)?;
    match (files::ending(path).as_str(), dataset) {
        ("npy", None) => Ok(NpyArray::parse(&bytes)?),
        ("npy", Some(given)) => Err(CliError::Option {
            option: "--dataset",
            expected: "a .mat, .h5 or .hdf5 file: a .npy file has one array".into(),
            given: format!("{given:?}"),
        }),
        _ => Ok(hdf5::read(bytes, dataset)?),
    }
}
