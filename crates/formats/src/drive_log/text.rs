//! Text of a table, plain or packed with gzip, read as a stream.

use crate::error::FormatError;
use crate::tables::{Columns, from_csv, wrong};
use std::f64::consts::TAU;
use std::io::{Error, Read};

/// A packed table may unpack to this, bytes, and [`GROWTH`] times its own length beside.
const ALLOWANCE: usize = 16 << 20;
const GROWTH: usize = 64;

/// Whether the bytes begin as a gzip file does.
pub(crate) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

struct Limited<R> {
    inner: R,
    left: usize,
}

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Error> {
        let count = self.inner.read(buffer)?;
        self.left = self.left.checked_sub(count).ok_or_else(|| {
            Error::other(format!(
                "unpacks to more than {GROWTH} times its length, as no table does"
            ))
        })?;
        Ok(count)
    }
}

/// The rows of a table, one at a time.
pub(crate) struct Rows<'a> {
    reader: csv::Reader<Box<dyn Read + 'a>>,
    record: csv::StringRecord,
    any: bool,
    pub(crate) columns: Columns,
}

impl<'a> Rows<'a> {
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let plain: Box<dyn Read + 'a> = if is_gzip(bytes) {
            let left = ALLOWANCE.saturating_add(bytes.len().saturating_mul(GROWTH));
            Box::new(Limited { inner: flate2::read::MultiGzDecoder::new(bytes), left })
        } else {
            // A byte order mark, as spreadsheets write.
            Box::new(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
        };
        let mut reader = csv::Reader::from_reader(plain);
        let columns = Columns::read(&mut reader)?;
        Ok(Self { reader, record: csv::StringRecord::new(), any: false, columns })
    }

    /// Refuses a table of which no row has been read.
    pub(crate) fn not_empty(&self) -> Result<(), FormatError> {
        if self.any {
            return Ok(());
        }
        Err(FormatError::Table {
            line: 2,
            what: "the table".into(),
            expected: "at least one row below the header line".into(),
            given: "empty".into(),
        })
    }

    /// The next row, `None` at the end.
    pub(crate) fn next(&mut self) -> Result<Option<&csv::StringRecord>, FormatError> {
        let more = self.reader.read_record(&mut self.record).map_err(|error| from_csv(&error))?;
        self.any |= more;
        Ok(more.then_some(&self.record))
    }
}

/// Line of a row, from 1.
pub(crate) fn line(record: &csv::StringRecord) -> u64 {
    record.position().map_or(1, csv::Position::line)
}

/// Refuses an angle of more than one turn: degrees in a column of radians.
pub(crate) fn turn(
    record: &csv::StringRecord,
    column: usize,
    name: &str,
    angle_rad: f64,
) -> Result<(), FormatError> {
    if angle_rad.is_finite() && angle_rad.abs() > TAU {
        let given = record.get(column).unwrap_or_default();
        return Err(wrong(record, name, "an angle of at most one turn", given));
    }
    Ok(())
}
