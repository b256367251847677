//! Reading and writing files.

use crate::destination::{Destination, file_behind};
use crate::error::CliError;
use crate::output::remark;
use boresight_core::Waveform;
use boresight_fleet::lines::sync_folder;
use boresight_formats::{RadarConfig, mmwave_studio};
use boresight_report::Source;
use boresight_simulate::{waveform_preset, waveform_presets};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Maximum number of bytes read from a pipe, whose length is unknown.
const MOST_PIPED: u64 = 1 << 30;

/// The files of a run: all reading and writing goes through it, so that nothing is lost by accident.
#[derive(Debug, Default)]
pub struct Files {
    /// Whether files that are there may be replaced.
    force: bool,
    /// Files that were read, which are never written, behind all links.
    inputs: RefCell<Vec<PathBuf>>,
    /// Files that are going to be written, behind all links.
    outputs: RefCell<Vec<PathBuf>>,
    standard_output: Cell<bool>,
}

impl Files {
    /// Of a run that may replace files with `force`.
    pub fn new(force: bool) -> Self {
        Self { force, ..Self::default() }
    }

    /// Whether files that are there may be replaced.
    pub fn force(&self) -> bool {
        self.force
    }

    /// The bytes of a file.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, CliError> {
        let failed = |error| CliError::File { action: "read", path: path.into(), error };
        let mut input = self.open(path)?;
        let mut bytes = vec![];
        // A sparse file can claim more than there is memory.
        let length = input.length().map_err(failed)?;
        bytes.try_reserve_exact(length).map_err(|_| failed(ErrorKind::OutOfMemory.into()))?;
        input.read_to_end(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }

    /// Opens a file, or a pipe that is a descriptor of this process, to read, and keeps it from being written.
    pub fn open(&self, path: &Path) -> Result<Input, CliError> {
        let failed = |error| CliError::File { action: "read", path: path.into(), error };
        self.check_input(path)?;
        let file = File::open(path).map_err(failed)?;
        let is_file = file.metadata().map_err(failed)?.is_file();
        Ok(Input { file, remaining: (!is_file).then_some(MOST_PIPED) })
    }

    /// Refuses what has no end or may never begin, before it is opened, and keeps the file from being written.
    pub fn check_input(&self, path: &Path) -> Result<(), CliError> {
        let failed = |error| CliError::File { action: "read", path: path.into(), error };
        self.note_input(path);
        match unreadable(path, &path.metadata().map_err(failed)?) {
            Some(what) => {
                let why = format!("it is {what}; expected a file, or /dev/stdin for a pipe");
                Err(failed(std::io::Error::other(why)))
            }
            None => Ok(()),
        }
    }

    /// Keeps a file that is read by other means from being written.
    pub fn note_input(&self, path: &Path) {
        if let Ok(path) = file_behind(path) {
            self.inputs.borrow_mut().push(path);
        }
    }

    /// The files that were read, with the digests of their bytes as they are now, by name.
    pub fn sources(&self) -> Result<Vec<Source>, CliError> {
        let mut paths = self.inputs.borrow().clone();
        paths.sort();
        paths.dedup();
        paths.iter().map(|path| source(path)).collect()
    }

    /// Where an output goes. Refused are a file that is there, without `--force`, and with it too a file that was
    /// read and one that is written already.
    pub fn destination(&self, path: &Path) -> Result<Destination, CliError> {
        self.destination_of(path, false)
    }

    /// The same, where `own` says that a file there is of an earlier run of the same thing.
    pub fn destination_of(&self, path: &Path, own: bool) -> Result<Destination, CliError> {
        let failed = |error| CliError::File { action: "write", path: path.into(), error };
        let destination = Destination::new(path).map_err(failed)?;
        if destination.is_standard_output() {
            self.standard_output.set(true);
        }
        self.refuse_input(&destination)?;
        if let Some(file) = destination.file() {
            let mut outputs = self.outputs.borrow_mut();
            if outputs.iter().any(|other| other == file) {
                return Err(CliError::SameOutput { path: path.into() });
            }
            outputs.push(file.into());
        }
        if destination.replaces() && !self.force && !own {
            return Err(CliError::Exists { path: path.into() });
        }
        Ok(destination)
    }

    fn refuse_input(&self, destination: &Destination) -> Result<(), CliError> {
        match destination.file() {
            Some(file) if self.inputs.borrow().iter().any(|input| input == file) => {
                Err(CliError::OwnInput { path: destination.named().into() })
            }
            _ => Ok(()),
        }
    }

    /// Writes a file whole or not at all.
    pub fn write(&self, destination: Destination, bytes: &[u8]) -> Result<(), CliError> {
        let path = destination.named().to_owned();
        self.write_with(destination, |out| {
            out.write_all(bytes).map_err(|error| CliError::File { action: "write", path, error })
        })
    }

    /// Writes a file whole or not at all, with what `fill` puts into it.
    pub fn write_with<T>(
        &self,
        destination: Destination,
        fill: impl FnOnce(&mut dyn Write) -> Result<T, CliError>,
    ) -> Result<T, CliError> {
        // What was read since it was asked for counts, too.
        self.refuse_input(&destination)?;
        destination.write_with(fill)
    }

    /// Whether data goes to the standard output, where words would be in its way.
    pub fn standard_output_taken(&self) -> bool {
        self.standard_output.get()
    }
}

/// A file or a pipe that is read.
#[derive(Debug)]
pub struct Input {
    file: File,
    /// Number of bytes that may still come from a pipe.
    remaining: Option<u64>,
}

impl Input {
    /// Length of a file; 0 for a pipe.
    fn length(&self) -> std::io::Result<usize> {
        let length = if self.remaining.is_some() { 0 } else { self.file.metadata()?.len() };
        usize::try_from(length).map_err(|_| ErrorKind::OutOfMemory.into())
    }
}

impl Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.file.read(buffer)?;
        if let Some(remaining) = &mut self.remaining {
            *remaining = remaining.checked_sub(count as u64).ok_or_else(|| {
                let why = format!("more than {MOST_PIPED} bytes from a pipe; expected a file");
                std::io::Error::other(why)
            })?;
        }
        Ok(count)
    }
}

/// What a path leads to, if it cannot be read to an end: a device, a socket, or a named pipe, which blocks until somebody
/// writes to it.
#[cfg(unix)]
fn unreadable(path: &Path, metadata: &std::fs::Metadata) -> Option<&'static str> {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    if kind.is_char_device() || kind.is_block_device() {
        Some("a device")
    } else if kind.is_socket() {
        Some("a socket")
    } else if kind.is_fifo() && path.canonicalize().is_ok() {
        // A pipe that is a descriptor alone has no path behind its links.
        Some("a named pipe")
    } else {
        None
    }
}

#[cfg(not(unix))]
fn unreadable(_: &Path, _: &std::fs::Metadata) -> Option<&'static str> {
    None
}

/// A file with the digest of its bytes.
pub fn source(path: &Path) -> Result<Source, CliError> {
    let failed = |error| CliError::File { action: "read", path: path.into(), error };
    let mut hasher = Sha256::new();
    let mut file = File::open(path).map_err(failed)?;
    let mut buffer = vec![0; 1 << 16];
    let mut bytes = 0;
    loop {
        match file.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => {
                hasher.update(&buffer[..count]);
                bytes += count as u64;
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(failed(error)),
        }
    }
    let sha256 = hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Source { name, bytes, sha256 })
}

/// Makes a folder and those above it, where they are not there.
pub fn make_folder(path: &Path) -> Result<(), CliError> {
    let failed = |error| CliError::File { action: "write", path: path.into(), error };
    let new: Vec<&Path> = path.ancestors().take_while(|folder| !folder.exists()).collect();
    std::fs::create_dir_all(path).map_err(failed)?;
    new.into_iter().filter(|folder| folder.exists()).try_for_each(sync_folder).map_err(failed)
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

/// A board's configuration, as [`config_text`] reads it.
pub fn radar_config(path: &Path, files: &Files) -> Result<RadarConfig, CliError> {
    Ok(RadarConfig::parse(&config_text(path, files)?)?)
}

/// The text of a `.cfg` file. mmWave Studio's `NAME.mmwave.json` is translated into one, with the
/// board that the `NAME.setup.json` beside it names, if that exists.
pub fn config_text(path: &Path, files: &Files) -> Result<Vec<u8>, CliError> {
    let text = files.read(path)?;
    if !mmwave_studio::is_json(&text) {
        return Ok(text);
    }
    let setup = setup_of(path).filter(|setup| setup.exists());
    if let Some(setup) = &setup {
        remark([format!("the board is read from {}", setup.display())]);
    }
    let setup = setup.map(|setup| files.read(&setup)).transpose()?;
    Ok(mmwave_studio::config_text(&text, setup.as_deref())?.into_bytes())
}

/// Where mmWave Studio writes the setup that belongs to a configuration.
fn setup_of(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let stem = name.strip_suffix(".json")?;
    let stem = stem.strip_suffix(".mmwave").unwrap_or(stem);
    Some(path.with_file_name(format!("{stem}.setup.json")))
}

/// Names of the waveforms known by name.
pub fn known_waveforms() -> String {
    waveform_presets().collect::<Vec<_>>().join(", ")
}

/// A waveform by its name, from a board's configuration, or from a JSON file.
pub fn waveform(text: &str, files: &Files) -> Result<Waveform, CliError> {
    if let Ok(waveform) = waveform_preset(text) {
        return Ok(waveform);
    }
    let path = PathBuf::from(text);
    match ending(&path).as_str() {
        "cfg" => Ok(radar_config(&path, files)?.waveform),
        "json" if text.ends_with(".mmwave.json") => Ok(radar_config(&path, files)?.waveform),
        "json" => {
            let file =
                serde_json::from_slice(&files.read(&path)?).map_err(|error| CliError::Json {
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
            expected: format!("{}, a .json, .mmwave.json or .cfg file", known_waveforms()),
            given: format!("{text:?}"),
        }),
    }
}
