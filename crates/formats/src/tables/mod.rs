//! Tables as comma-separated values with a header line. Files are read by people and spreadsheets,
//! so angles in them are in degrees; in memory they are in radians as everywhere.

mod detections;
mod snapshots;

use crate::error::FormatError;
pub use detections::{DetectionRow, read_detections, write_detections};
pub use snapshots::{read_snapshots, write_snapshots};

/// The positions of named columns in a header line.
pub(crate) struct Columns {
    names: csv::StringRecord,
}

impl Columns {
    pub(crate) fn read<R: std::io::Read>(reader: &mut csv::Reader<R>) -> Result<Self, FormatError> {
        let names = reader.headers().map_err(|error| from_csv(&error))?.clone();
        Ok(Self { names })
    }

    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|given| given.trim() == name)
    }

    pub(crate) fn need(&self, name: &str) -> Result<usize, FormatError> {
        self.find(name).ok_or_else(|| FormatError::Table {
            line: 1,
            what: format!("column {name}"),
            expected: "in the header line".into(),
            given: "none".into(),
        })
    }
}

pub(crate) fn from_csv(error: &csv::Error) -> FormatError {
    let line = error.position().map_or(1, csv::Position::line);
    if let csv::ErrorKind::Io(error) = error.kind() {
        return FormatError::Compressed { given: error.to_string() };
    }
    let (expected, given) = match error.kind() {
        csv::ErrorKind::Utf8 { .. } => ("UTF-8 text".into(), "other bytes".into()),
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            (format!("{expected_len} fields, as in the header"), format!("{len}"))
        }
        _ => ("comma-separated values".into(), error.to_string()),
    };
    FormatError::Table { line, what: "the line".into(), expected, given }
}

pub(crate) fn field<T: std::str::FromStr>(
    record: &csv::StringRecord,
    column: usize,
    name: &str,
    expected: &str,
) -> Result<T, FormatError> {
    let text = record.get(column).unwrap_or_default().trim();
    text.parse().map_err(|_| wrong(record, name, expected, text))
}

pub(crate) fn finite(
    record: &csv::StringRecord,
    column: usize,
    name: &str,
) -> Result<f64, FormatError> {
    let value: f64 = field(record, column, name, "a number")?;
    if value.is_finite() {
        return Ok(value);
    }
    Err(wrong(record, name, "a finite number", &value.to_string()))
}

pub(crate) fn wrong(
    record: &csv::StringRecord,
    what: &str,
    expected: &str,
    given: &str,
) -> FormatError {
    FormatError::Table {
        line: record.position().map_or(1, csv::Position::line),
        what: what.into(),
        expected: expected.into(),
        given: given.chars().take(40).collect(),
    }
}

#[cfg(test)]
mod tests;
