//! Files of records, which only grow.

use crate::error::FleetError;
use crate::lines::{LineFile, LineStorage};
use crate::record::Record;
use crate::schema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// What the names of files of records begin with.
pub const NAME: &str = "records";
/// What is wrong with a line that says nothing of a log.
pub(crate) const NEITHER: &str = "neither done nor failed";
/// Longest line that is read, bytes: a record of 255 radars with all that is told of each.
const LONGEST_LINE: u64 = 64 << 20;

/// Beginning of every record, up to the digits of its key, and what follows these.
const BEGINNING: [&[u8]; 2] = [b"{\"key\":\"", b"\",\"vehicle\":\""];
/// Digits of a key.
const KEY_DIGITS: usize = 32;
/// What stands before the checksum at the end of a record, and behind it.
const CHECKSUM: [&str; 2] = [",\"crc32\":\"", "\"}"];
/// Digits of a checksum.
const CHECKSUM_DIGITS: usize = 8;

/// A file that one run adds records to.
#[derive(Debug)]
pub struct Store<F = File> {
    file: LineFile<F>,
    path: PathBuf,
}

impl Store {
    /// Opens a file, and creates it if it does not exist. An unfinished record at its end is cut off before the next one is added. A file with
    /// other content than records is only replaced with `force`.
    ///
    /// # Errors
    /// [`FleetError::Busy`] where another run has it; [`FleetError::Foreign`] for other content; those of the file.
    pub fn open(path: &Path, force: bool) -> Result<Self, FleetError> {
        let file = LineFile::open(path).map_err(|error| FleetError::file("write", path, error))?;
        Self::of(file, path, force)
    }
}

impl<F: LineStorage> Store<F> {
    /// Records in a file of lines; errors name it by the path.
    ///
    /// # Errors
    /// [`FleetError::Foreign`] for other content, without `force`; those of the file.
    pub fn of(mut file: LineFile<F>, path: &Path, force: bool) -> Result<Self, FleetError> {
        let failed = |error| FleetError::file("write", path, error);
        if !holds_records(&mut file).map_err(failed)? {
            if !force {
                return Err(FleetError::Foreign { path: path.into() });
            }
            file.clear().map_err(failed)?;
        }
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
    pub fn sync(&mut self) -> Result<(), FleetError> {
        self.file.sync().map_err(|error| FleetError::file("write", &self.path, error))
    }
}

/// Whether a file holds records, or nothing. What a run leaves that is killed or loses its power counts: the beginning of a record, and zeros.
fn holds_records<F: LineStorage>(file: &mut LineFile<F>) -> std::io::Result<bool> {
    let mut lines = file.reader()?;
    let (mut line, mut damaged) = (vec![], false);
    loop {
        line.clear();
        (&mut lines).take(LONGEST_LINE).read_until(b'\n', &mut line)?;
        let Some((_, text)) = line.split_last() else { break };
        match is_damaged(text) {
            // Its checksum shows that it was a record, zeros do not.
            true if checksum(text).is_some() => return Ok(true),
            true => damaged = true,
            false => return Ok(serde_json::from_slice::<Known>(text).is_ok_and(|of| of.is_one())),
        }
    }
    let mut rest = file.unfinished()?;
    let mut begun = vec![];
    (&mut rest).take(64).read_to_end(&mut begun)?;
    if begins_a_record(&begun) && !damaged {
        return Ok(true);
    }
    // All of it has to be zeros.
    Ok(is_zeros(&mut file.reader()?)? && is_zeros(&mut file.unfinished()?)?)
}

fn is_zeros(reader: &mut impl BufRead) -> std::io::Result<bool> {
    loop {
        let bytes = reader.fill_buf()?;
        if bytes.is_empty() {
            return Ok(true);
        }
        if bytes.iter().any(|byte| ![0, b'\n'].contains(byte)) {
            return Ok(false);
        }
        let length = bytes.len();
        reader.consume(length);
    }
}

/// Whether a text is the beginning of a record, as far as it goes.
fn begins_a_record(text: &[u8]) -> bool {
    let [before, behind] = BEGINNING;
    let agrees = |text: &[u8], with: &[u8]| text.iter().zip(with).all(|(a, b)| a == b);
    let (start, rest) = text.split_at(text.len().min(before.len()));
    let (key, rest) = rest.split_at(rest.len().min(KEY_DIGITS));
    agrees(start, before) && key.iter().all(u8::is_ascii_hexdigit) && agrees(rest, behind)
}

/// A record as a line, which ends with the checksum of what stands before that.
///
/// # Errors
/// [`FleetError::File`], which no record leads to.
pub fn line<R: Serialize>(record: &Record<R>) -> Result<String, FleetError> {
    let text = serde_json::to_string(record);
    let failed =
        |error: serde_json::Error| FleetError::file("write", Path::new("a record"), error.into());
    let mut text = text.map_err(failed)?;
    // The brace comes again behind the checksum.
    text.pop();
    let sum = crc32fast::hash(text.as_bytes());
    let [before, behind] = CHECKSUM;
    text += &format!("{before}{sum:08x}{behind}\n");
    Ok(text)
}

/// The text that the checksum at the end of a record is of, and the checksum; `None` for a record without one.
fn checksum(line: &[u8]) -> Option<(&[u8], &[u8])> {
    let [before, behind] = CHECKSUM;
    let rest = line.strip_suffix(behind.as_bytes())?;
    let (rest, sum) = rest.split_at_checked(rest.len().checked_sub(CHECKSUM_DIGITS)?)?;
    Some((rest.strip_suffix(before.as_bytes())?, sum))
}

/// Whether a line is not as it was written: its checksum is another, or it has zeros, as files have after a loss of power.
fn is_damaged(line: &[u8]) -> bool {
    match checksum(line) {
        Some((text, sum)) => format!("{:08x}", crc32fast::hash(text)).as_bytes() != sum,
        None => line.contains(&0),
    }
}

/// The files of records among paths: files as they are, of folders those that [`crate::part::Part::file_name`] calls so, `records*.jsonl`: a plan may lie
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

/// Hands each whole line of a file to `take`, with its number from 1. Returns the number of lines that are damaged or unfinished, which are not
/// handed over.
///
/// # Errors
/// Those of the file, and of `take`.
pub fn each_line(
    path: &Path,
    mut take: impl FnMut(u64, &[u8]) -> Result<(), FleetError>,
) -> Result<u64, FleetError> {
    let failed = |error| FleetError::file("read", path, error);
    let file = File::open(path).map_err(failed)?;
    let mut reader = BufReader::with_capacity(1 << 18, file);
    let (mut buffer, mut damaged) = (vec![], 0);
    for number in 1.. {
        buffer.clear();
        let mut limited = (&mut reader).take(LONGEST_LINE);
        limited.read_until(b'\n', &mut buffer).map_err(failed)?;
        match buffer.split_last() {
            None => break,
            Some((b'\n', line)) if is_damaged(line) => damaged += 1,
            Some((b'\n', line)) => take(number, line)?,
            Some(_) if buffer.len() as u64 >= LONGEST_LINE => take(number, &buffer)?,
            Some(_) => return Ok(damaged + 1),
        }
    }
    Ok(damaged)
}

/// What of a record tells whether its job is to run.
#[derive(Deserialize)]
struct Known {
    key: String,
    done: Option<IgnoredAny>,
    failed: Option<IgnoredAny>,
}

impl Known {
    fn is_one(&self) -> bool {
        self.done.is_some() || self.failed.is_some()
    }
}

/// Keys of the jobs that have a record in a folder, without those whose records are damaged; `without_failed` leaves out those that failed.
///
/// # Errors
/// [`FleetError::Record`] for lines that are none, [`FleetError::Newer`] for those of a newer release; those of the files.
pub fn keys_of(folder: &Path, without_failed: bool) -> Result<HashSet<String>, FleetError> {
    let mut keys = HashSet::new();
    for path in files(&[folder.to_owned()])? {
        each_line(&path, |line, text| {
            let wrong = |error: String| FleetError::Record { path: path.clone(), line, error };
            if let Some(found) = schema::newer(text) {
                return Err(FleetError::Newer { path: path.clone(), line, found });
            }
            let known: Known =
                serde_json::from_slice(text).map_err(|error| wrong(error.to_string()))?;
            if !known.is_one() {
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
