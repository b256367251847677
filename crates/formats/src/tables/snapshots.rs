//! Snapshots of an array as a table.

use super::{Columns, field, finite, from_csv, wrong};
use crate::error::FormatError;
use boresight_core::Complex64;
use ndarray::{Array2, ArrayView2};

/// Snapshots (elements x snapshots) as text: the columns `snapshot`, `element` (both from 0),
/// `re`, `im`, one line a number.
pub fn write_snapshots(snapshots: ArrayView2<'_, Complex64>) -> String {
    let mut text = String::from("snapshot,element,re,im\n");
    for (n, snapshot) in snapshots.columns().into_iter().enumerate() {
        for (k, z) in snapshot.iter().enumerate() {
            text.push_str(&format!("{n},{k},{},{}\n", z.re, z.im));
        }
    }
    text
}

/// Reads a table as [`write_snapshots`] makes it, lines in any order, and returns elements x
/// snapshots.
///
/// # Errors
/// [`FormatError::Table`] naming line and column, also when a number is missing or given twice.
pub fn read_snapshots(bytes: &[u8]) -> Result<Array2<Complex64>, FormatError> {
    let mut reader = csv::Reader::from_reader(bytes);
    let columns = Columns::read(&mut reader)?;
    let names = ["snapshot", "element", "re", "im"];
    let mut places = [0; 4];
    for (place, name) in places.iter_mut().zip(names) {
        *place = columns.need(name)?;
    }
    let mut entries = vec![];
    let (mut snapshots, mut elements) = (0_usize, 0_usize);
    for record in reader.records() {
        let record = record.map_err(|error| from_csv(&error))?;
        let index = |k: usize| {
            let value: usize = field(&record, places[k], names[k], "an integer of at least 0")?;
            if value < usize::MAX {
                return Ok(value);
            }
            Err(wrong(&record, names[k], "a smaller integer", &value.to_string()))
        };
        let (n, k) = (index(0)?, index(1)?);
        let z = Complex64::new(
            finite(&record, places[2], names[2])?,
            finite(&record, places[3], names[3])?,
        );
        snapshots = snapshots.max(n + 1);
        elements = elements.max(k + 1);
        entries.push((n, k, z, record.position().map_or(1, csv::Position::line)));
    }
    if elements.checked_mul(snapshots) != Some(entries.len()) || entries.is_empty() {
        return Err(FormatError::Table {
            line: entries.last().map_or(1, |entry| entry.3),
            what: "the number of lines".into(),
            expected: format!("one for each of {elements} elements x {snapshots} snapshots"),
            given: entries.len().to_string(),
        });
    }
    let mut seen = Array2::from_elem((elements, snapshots), false);
    let mut matrix = Array2::zeros((elements, snapshots));
    for (n, k, z, line) in entries {
        if std::mem::replace(&mut seen[[k, n]], true) {
            return Err(FormatError::Table {
                line,
                what: format!("snapshot {n}, element {k}"),
                expected: "once".into(),
                given: "a second time".into(),
            });
        }
        matrix[[k, n]] = z;
    }
    Ok(matrix)
}
