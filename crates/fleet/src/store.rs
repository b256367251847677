//! Files of records, which only grow.

use crate::{FleetError, Record};
use boresight_core::lines::LineFile;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// What the names of files of records begin with.
pub const NAME: &str = "records";
/// What is wrong with a line that says nothing of a log.
pub(crate) const NEITHER: &str = "neither done nor failed";
/// Longest line that is read, bytes: a record of 255 radars with all that is told of each.
const LONGEST_LINE: u64 = 64 << 20;

/// A file that one run adds records to.
#[derive(Debug)]
pub struct Store {
    file: LineFile,
    path: PathBuf,
}

impl Store {
    /// Opens a file, which need not be there. What a killed run left unfinished is cut off.
    ///
    /// # Errors
    /// [`FleetError::Busy`] where another run has it; those of the file.
    pub fn open(path: &Path) -> Result<Self, FleetError> {
        let file = LineFile::open(path).map_err(|error| FleetError::file("write", path, error))?;
        Ok(Self { file, path: path.into() })
    }

    /// Adds a record, whole or not at all.
    ///
    /// # Errors
    /// [`FleetError::DiskFull`] and others of the file; the records before are still there.
    pub fn append(&mut self, record: &Record) -> Result<(), FleetError> {
        let failed = |error| FleetError::file("write", &self.path, error);
        self.file.append(&line(record)?).map_err(failed)
    }

    /// Asks the system to put the records onto the disk.
    ///
    /// # Errors
    /// Those of the file.
    pub fn sync(&self) -> Result<(), FleetError> {
        self.file.sync().map_err(|error| FleetError::file("write", &self.path, error))
    }
}

/// A record as a line.
///
/// # Errors
/// [`FleetError::File`], which no record leads to.
pub fn line<R: Serialize>(record: &Record<R>) -> Result<String, FleetError> {
    let text = serde_json::to_string(record);
    let text = text.map_err(|error| FleetError::file("write", Path::new("a record"), error.into()));
    Ok(text? + "\n")
}

/// The files of records among paths: files as they are, of folders those that [`boresight_core::Part::file_name`] calls so, `records*.jsonl`: a plan may lie
/// beside them. In order, each once.
///
/// # Errors
/// Those of the files.
pub fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, FleetError> {
    let mut found = vec![];
    for path in paths {
        let failed = |error| FleetError::file("read", path, error);
        if !path.is_dir() {
            found.push(path.canonicalize().map_err(failed)?);
            continue;
        }
        for entry in std::fs::read_dir(path).map_err(failed)? {
            let entry = entry.map_err(failed)?.path();
            let name = entry.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with(NAME) && name.ends_with(".jsonl") && entry.is_file() {
                found.push(entry.canonicalize().map_err(failed)?);
            }
        }
    }
    found.sort();
    found.dedup();
    Ok(found)
}

/// Hands each whole line of a file to `take`, with its number from 1; whether something unfinished comes behind the last.
///
/// # Errors
/// Those of the file, and of `take`.
pub fn each_line(
    path: &Path,
    mut take: impl FnMut(u64, &[u8]) -> Result<(), FleetError>,
) -> Result<bool, FleetError> {
    let failed = |error| FleetError::file("read", path, error);
    let file = File::open(path).map_err(failed)?;
    let mut reader = BufReader::with_capacity(1 << 18, file);
    let mut buffer = vec![];
    for number in 1.. {
        buffer.clear();
        let mut limited = std::io::Read::take(&mut reader, LONGEST_LINE);
        limited.read_until(b'\n', &mut buffer).map_err(failed)?;
        match buffer.split_last() {
            None => return Ok(false),
            Some((b'\n', line)) => take(number, line)?,
            Some(_) if buffer.len() as u64 >= LONGEST_LINE => take(number, &buffer)?,
            Some(_) => return Ok(true),
        }
    }
    Ok(false)
}

/// What of a record tells whether its job is to run.
#[derive(Deserialize)]
struct Known {
    key: String,
    done: Option<IgnoredAny>,
    failed: Option<IgnoredAny>,
}

/// Keys of the jobs that have a record in a folder; `without_failed` leaves out those that failed.
///
/// # Errors
/// [`FleetError::Record`] for lines that are none; those of the files.
pub fn keys_of(folder: &Path, without_failed: bool) -> Result<HashSet<String>, FleetError> {
    let mut keys = HashSet::new();
    for path in files(&[folder.to_owned()])? {
        each_line(&path, |line, text| {
            let wrong = |error: String| FleetError::Record { path: path.clone(), line, error };
            let known: Known =
                serde_json::from_slice(text).map_err(|error| wrong(error.to_string()))?;
            if known.done.is_none() && known.failed.is_none() {
                return Err(wrong(NEITHER.into()));
            }
            if !(without_failed && known.failed.is_some()) {
                keys.insert(known.key);
            }
            Ok(())
        })?;
    }
    Ok(keys)
}
