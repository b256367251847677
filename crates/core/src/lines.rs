//! Files of lines that only grow: what was written before a stop is there after it, and of a line that a killed process left
//! unfinished nothing is.

use std::fs::{File, OpenOptions};
use std::io::{BufReader, Read, Result, Seek, SeekFrom, Write};
use std::path::Path;

/// A file that one process at a time adds whole lines to.
#[derive(Debug)]
pub struct LineFile {
    file: File,
    length: u64,
}

impl LineFile {
    /// Opens a file, which need not be there, for this process alone, and cuts off what comes behind its last line. The lock goes with the
    /// process.
    ///
    /// # Errors
    /// [`std::io::ErrorKind::WouldBlock`] where another process has it open in this way; those of the file.
    pub fn open(path: &Path) -> Result<Self> {
        let mut options = OpenOptions::new();
        let mut file = options.create(true).read(true).write(true).truncate(false).open(path)?;
        file.try_lock()?;
        let length = end_of_lines(&mut file)?;
        file.set_len(length)?;
        Ok(Self { file, length })
    }

    /// The lines so far, from the first.
    ///
    /// # Errors
    /// Those of the file.
    pub fn reader(&mut self) -> Result<BufReader<&mut File>> {
        self.file.seek(SeekFrom::Start(0))?;
        Ok(BufReader::new(&mut self.file))
    }

    /// Adds a line, which ends in the only line feed it has, whole or not at all.
    ///
    /// # Errors
    /// Those of the file, [`std::io::ErrorKind::StorageFull`] among them; what there was before is then still there.
    pub fn append(&mut self, line: &str) -> Result<()> {
        self.file.seek(SeekFrom::Start(self.length))?;
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // What cannot be cut off now is when the file is opened next.
            let _ = self.file.set_len(self.length);
            return Err(error);
        }
        self.length += line.len() as u64;
        Ok(())
    }

    /// Asks the system to put what was added onto the disk.
    ///
    /// # Errors
    /// Those of the file.
    pub fn sync(&self) -> Result<()> {
        self.file.sync_data()
    }
}

/// What of a text is whole lines.
#[must_use]
pub fn whole_lines(text: &str) -> &str {
    &text[..text.rfind('\n').map_or(0, |end| end + 1)]
}

/// The place behind the last line feed.
fn end_of_lines(file: &mut File) -> Result<u64> {
    let mut end = file.seek(SeekFrom::End(0))?;
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
                let mut file = LineFile::open(&path).unwrap();
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
