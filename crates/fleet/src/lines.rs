//! Files of lines that only grow: what was written before a stop is there after it, and of a line that a killed process left
//! unfinished nothing is.

use std::fs::{File, OpenOptions};
use std::io::{BufReader, Error, Read, Result, Seek, SeekFrom, Take, Write};
use std::path::Path;

/// Calls to the system that a file of lines makes.
pub trait LineStorage: Read + Write + Seek {
    /// Sets the length of the file.
    ///
    /// # Errors
    /// Those of the file.
    fn set_len(&mut self, length: u64) -> Result<()>;
    /// Waits until the data are on the disk.
    ///
    /// # Errors
    /// Those of the file.
    fn sync_data(&mut self) -> Result<()>;
}

impl LineStorage for File {
    fn set_len(&mut self, length: u64) -> Result<()> {
        Self::set_len(self, length)
    }

    fn sync_data(&mut self) -> Result<()> {
        Self::sync_data(self)
    }
}

/// A file that one process at a time adds whole lines to.
#[derive(Debug)]
pub struct LineFile<F = File> {
    file: F,
    /// End of the last whole line.
    length: u64,
    /// Whether the file may have bytes behind that.
    unfinished: bool,
}

impl LineFile {
    /// Opens a file for this process alone, and creates it if it does not exist. The lock ends with the process. The file is not changed until a
    /// line is added.
    ///
    /// # Errors
    /// [`std::io::ErrorKind::WouldBlock`] where another process has it open in this way; those of the file.
    pub fn open(path: &Path) -> Result<Self> {
        let exists = match path.metadata() {
            // To open a pipe or a device may wait forever.
            Ok(found) if !found.is_file() => return Err(Error::other("no regular file")),
            found => found.is_ok(),
        };
        let mut options = OpenOptions::new();
        let file = options.create(true).read(true).write(true).truncate(false).open(path)?;
        file.try_lock()?;
        if !exists {
            sync_folder(path)?;
        }
        Self::of(file)
    }
}

impl<F: LineStorage> LineFile<F> {
    /// Lines in a storage that this process has for itself.
    ///
    /// # Errors
    /// Those of the storage.
    pub fn of(mut file: F) -> Result<Self> {
        let end = file.seek(SeekFrom::End(0))?;
        let length = end_of_lines(&mut file, end)?;
        Ok(Self { file, length, unfinished: length < end })
    }

    /// The whole lines so far, from the first.
    ///
    /// # Errors
    /// Those of the file.
    pub fn reader(&mut self) -> Result<BufReader<Take<&mut F>>> {
        self.file.seek(SeekFrom::Start(0))?;
        Ok(BufReader::new((&mut self.file).take(self.length)))
    }

    /// The unfinished line behind the whole ones, which is cut off before the next line is added.
    ///
    /// # Errors
    /// Those of the file.
    pub fn unfinished(&mut self) -> Result<BufReader<&mut F>> {
        self.file.seek(SeekFrom::Start(self.length))?;
        Ok(BufReader::new(&mut self.file))
    }

    /// Removes all lines.
    ///
    /// # Errors
    /// Those of the file.
    pub fn clear(&mut self) -> Result<()> {
        self.file.set_len(0)?;
        self.length = 0;
        self.unfinished = false;
        Ok(())
    }

    /// Adds a line, which ends in the only line feed it has, whole or not at all.
    ///
    /// # Errors
    /// Those of the file, [`std::io::ErrorKind::StorageFull`] among them; what there was before is then still there.
    pub fn append(&mut self, line: &str) -> Result<()> {
        if self.unfinished {
            self.file.set_len(self.length)?;
            self.unfinished = false;
        }
        self.file.seek(SeekFrom::Start(self.length))?;
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // If this fails too, the next line or the next process cuts it off.
            self.unfinished = self.file.set_len(self.length).is_err();
            return Err(error);
        }
        self.length += line.len() as u64;
        Ok(())
    }

    /// Waits until the added lines are on the disk.
    ///
    /// # Errors
    /// Those of the file.
    pub fn sync(&mut self) -> Result<()> {
        self.file.sync_data()
    }
}

/// Waits until the name of a new or replaced file is on the disk, where folders can be opened for that.
///
/// # Errors
/// Those of the folder.
pub fn sync_folder(path: &Path) -> Result<()> {
    if cfg!(unix) {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        match File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all()) {
            // A folder that may be written and not read, or whose file system keeps no order of its own.
            Err(error)
                if !matches!(
                    error.kind(),
                    std::io::ErrorKind::PermissionDenied
                        | std::io::ErrorKind::InvalidInput
                        | std::io::ErrorKind::Unsupported
                ) =>
            {
                return Err(error);
            }
            _ => {}
        }
    }
    Ok(())
}

/// What of a text is whole lines.
#[must_use]
pub fn whole_lines(text: &str) -> &str {
    &text[..text.rfind('\n').map_or(0, |end| end + 1)]
}

/// The place behind the last line feed.
fn end_of_lines(file: &mut (impl Read + Seek), mut end: u64) -> Result<u64> {
    let mut buffer = [0; 4096];
    while end > 0 {
        let begin = end.saturating_sub(buffer.len() as u64);
        let chunk = &mut buffer[..(end - begin) as usize];
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(chunk)?;
        if let Some(at) = chunk.iter().rposition(|byte| *byte == b'\n') {
            return Ok(begin + at as u64 + 1);
        }
        end = begin;
    }
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufRead, ErrorKind};

    #[test]
    fn half_a_line_is_cut_off_wherever_it_begins_and_the_file_is_one_writers() {
        let path = std::env::temp_dir().join(format!("boresight-lines-{}", std::process::id()));
        for torn in [0, 1, 4095, 4096, 4097, 10_000] {
            for lines in ["", "one\n", "one\ntwo\n"] {
                std::fs::write(&path, format!("{lines}{}", "x".repeat(torn))).unwrap();
                let before = std::fs::read(&path).unwrap();
                let mut file = LineFile::open(&path).unwrap();
                assert_eq!(std::fs::read(&path).unwrap(), before, "opening changes nothing");
                let mut rest = String::new();
                file.unfinished().unwrap().read_to_string(&mut rest).unwrap();
                assert_eq!(rest.len(), torn);
                assert_eq!(LineFile::open(&path).unwrap_err().kind(), ErrorKind::WouldBlock);
                let found: Vec<String> =
                    file.reader().unwrap().lines().map(|line| line.unwrap()).collect();
                assert_eq!(found, lines.lines().collect::<Vec<_>>(), "{torn}");
                file.append("three\n").unwrap();
                drop(file);
                let text = std::fs::read_to_string(&path).unwrap();
                assert_eq!(text, format!("{lines}three\n"));
            }
        }
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn lines_end_in_line_feeds() {
        assert_eq!(whole_lines("a\nb"), "a\n");
        assert_eq!(whole_lines("b"), "");
    }
}
