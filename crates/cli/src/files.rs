//! Reading and writing files.

use crate::error::CliError;
use boresight_core::Waveform;
use boresight_formats::RadarConfig;
use boresight_simulate::{waveform_3dcnn_experiment, waveform_3dcnn_simulated, waveform_awr1642};
use serde::Deserialize;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The bytes of a file.
pub fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    std::fs::read(path).map_err(|error| CliError::File { action: "read", path: path.into(), error })
}

/// Writes a file whole or not at all.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    write_with(path, |file| {
        file.write_all(bytes).map_err(|error| CliError::File {
            action: "write",
            path: path.into(),
            error,
        })
    })
}

/// Writes a file whole or not at all, under another name first, with what `fill` puts into it.
pub fn write_with<T>(
    path: &Path,
    fill: impl FnOnce(&mut File) -> Result<T, CliError>,
) -> Result<T, CliError> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = path.with_file_name(name);
    let failed = |error| CliError::File { action: "write", path: path.into(), error };
    let mut file = File::create(&part).map_err(failed)?;
    let filled = fill(&mut file);
    drop(file);
    filled
        .and_then(|value| std::fs::rename(&part, path).map_err(failed).map(|()| value))
        .inspect_err(|_| {
            // The name is ours; that it cannot be removed either adds nothing to the report.
            let _ = std::fs::remove_file(&part);
        })
}

/// Makes a folder and those above it, where they are not there.
pub fn make_folder(path: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(path).map_err(|error| CliError::File {
        action: "write",
        path: path.into(),
        error,
    })
}

/// The ending of a file's name, in lower case.
pub fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// A JSON file with a waveform, by itself or beside other things.
#[derive(Deserialize)]
#[serde(untagged)]
enum WaveformFile {
    Within { waveform: Waveform },
    Alone(Waveform),
}

/// A waveform by its name, from a board's configuration, or from a JSON file.
pub fn waveform(text: &str) -> Result<Waveform, CliError> {
    match text {
        "awr1642" => return Ok(waveform_awr1642()),
        "3dcnn-simulated" => return Ok(waveform_3dcnn_simulated()),
        "3dcnn-experiment" => return Ok(waveform_3dcnn_experiment()),
        _ => {}
    }
    let path = PathBuf::from(text);
    match ending(&path).as_str() {
        "cfg" => Ok(RadarConfig::parse(&read(&path)?)?.waveform),
        "json" => {
            let file = serde_json::from_slice(&read(&path)?).map_err(|error| CliError::Json {
                path,
                expected: "a waveform (startFrequencyHz, slopeHzPerS, sampleRateHz, samples, \
                           adcStartS, chirpIntervalS, transmitters, loops, frameIntervalS)",
                error,
            })?;
            let (WaveformFile::Within { waveform } | WaveformFile::Alone(waveform)) = file;
            waveform.check()?;
            Ok(waveform)
        }
        _ => Err(CliError::Option {
            option: "--waveform",
            expected: "awr1642, 3dcnn-simulated, 3dcnn-experiment, a .json or a .cfg file".into(),
            given: format!("{text:?}"),
        }),
    }
}
