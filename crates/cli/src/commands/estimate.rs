//! `boresight estimate`.

use super::{board, capture, cube, snapshots};
use crate::arguments::EstimateArguments;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::numbers;
use boresight_formats::{BoardLog, tables};
use ndarray::Array3;

/// Runs the command and returns what it prints.
pub fn run(arguments: &EstimateArguments, files: &Files) -> Result<String, CliError> {
    let path = &arguments.file;
    match files::ending(path).as_str() {
        ending if ending == "bin" || path.is_dir() => capture::run(arguments, files),
        "dat" => {
            board::run(arguments, files, |config| Ok(BoardLog::parse(&files.read(path)?, config)))
        }
        "mcap" => board::recorded(arguments, path, files),
        "csv" => {
            let matrix = tables::read_snapshots(&files.read(path)?)?;
            let scenes: Array3<_> = matrix.insert_axis(ndarray::Axis(0));
            snapshots::run(arguments, &scenes, files)
        }
        ending if numbers::ENDINGS.contains(&ending) => {
            let array = numbers::read(path, arguments.radar.dataset.as_deref(), files)?;
            match array.shape.len() {
                1..=3 => snapshots::run(arguments, &snapshots::scenes(&array)?, files),
                _ => cube::run(arguments, &array, files),
            }
        }
        other => Err(CliError::Option {
            option: "FILE",
            expected: "a file ending in .bin, .npy, .mat, .h5, .csv, .dat or .mcap".into(),
            given: if other.is_empty() { "no ending".into() } else { format!(".{other}") },
        }),
    }
}
