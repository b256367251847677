//! Rows of a compound HDF5 dataset: fields by name, of any width and byte order, read a window of
//! rows at a time so that only the file and one window are in memory.

use crate::error::FormatError;
pub(super) use crate::hdf5::number::{Field, wrong};
use crate::hdf5::number::{chunks_inside, field, most_bytes};
use hdf5_pure::{Dataset, Datatype, File};

/// Bytes of rows read at a time, at least one chunk.
const WINDOW_BYTES: u64 = 1 << 20;
/// A row counts as at least so long, about what a scan of one detection takes in memory: else a file
/// of overlapping fields grows without need.
const LEAST_ROW_BYTES: u64 = 64;

/// A one-dimensional dataset of rows.
pub(super) struct Table {
    name: &'static str,
    dataset: Dataset,
    row_bytes: usize,
    rows: u64,
    window: u64,
    datatype: Datatype,
}

impl Table {
    pub(super) fn open(file: &File, name: &'static str) -> Result<Self, FormatError> {
        let failed = |error: hdf5_pure::Error| wrong(name, "a readable compound dataset", error);
        let dataset = file.dataset(name).map_err(failed)?;
        let datatype = dataset.datatype().map_err(failed)?;
        let Datatype::Compound { size, .. } = datatype else {
            return Err(wrong(name, "a compound dataset", "another type"));
        };
        let shape = dataset.shape().map_err(failed)?;
        let [rows] = shape[..] else {
            return Err(wrong(name, "one axis", format!("{} axes", shape.len())));
        };
        let limit = most_bytes(file);
        let row_bytes = u64::from(size).max(1);
        let chunk = match dataset.chunk_shape().map_err(failed)?.as_deref() {
            Some([rows]) => (*rows).max(1),
            _ => 1,
        };
        for count in [rows, chunk] {
            let counted = count.checked_mul(row_bytes.max(LEAST_ROW_BYTES));
            if counted.is_none_or(|bytes| bytes > limit) {
                return Err(wrong(name, "no more rows than the file can hold", count));
            }
        }
        chunks_inside(file, name, &dataset)?;
        let window = (WINDOW_BYTES / row_bytes).max(1).next_multiple_of(chunk);
        Ok(Self { name, dataset, row_bytes: size as usize, rows, window, datatype })
    }

    /// Whether the rows have a field.
    pub(super) fn has(&self, name: &str) -> bool {
        matches!(&self.datatype, Datatype::Compound { members, .. }
            if members.iter().any(|member| member.name == name))
    }

    /// Refuses a dataset without rows.
    pub(super) fn not_empty(&self) -> Result<(), FormatError> {
        if self.rows == 0 { Err(wrong(self.name, "at least one row", "none")) } else { Ok(()) }
    }

    /// A field that must be there and inside its row.
    pub(super) fn field(&self, name: &str) -> Result<Field, FormatError> {
        let what = format!("{}.{name}", self.name);
        let members: &[_] = match &self.datatype {
            Datatype::Compound { members, .. } => members,
            _ => &[],
        };
        let member = members
            .iter()
            .find(|member| member.name == name)
            .ok_or_else(|| wrong(what.as_str(), "a field of the dataset", "none"))?;
        let field = field(&what, member.byte_offset, &member.datatype)?;
        if field.offset.checked_add(field.size).is_none_or(|end| end > self.row_bytes) {
            return Err(wrong(what, "inside its row", member.byte_offset));
        }
        Ok(field)
    }

    /// Calls `each` with the number and bytes of every row, in order.
    pub(super) fn for_each(
        &self,
        mut each: impl FnMut(u64, &[u8]) -> Result<(), FormatError>,
    ) -> Result<(), FormatError> {
        let mut start = 0;
        while start < self.rows {
            let count = self.window.min(self.rows - start);
            let bytes = self.window_bytes(start, count)?;
            for (row, k) in bytes.chunks_exact(self.row_bytes).zip(start..) {
                each(k, row)?;
            }
            start += count;
        }
        Ok(())
    }

    /// The first row, if there is one.
    pub(super) fn first(&self) -> Result<Option<Vec<u8>>, FormatError> {
        if self.rows == 0 { Ok(None) } else { self.window_bytes(0, 1).map(Some) }
    }

    fn window_bytes(&self, start: u64, count: u64) -> Result<Vec<u8>, FormatError> {
        let what = || format!("{} from row {start}", self.name);
        let bytes = self
            .dataset
            .read_raw_rows(start, count)
            .map_err(|error| wrong(what(), "readable rows", error))?;
        let expected = self.row_bytes as u64 * count;
        if bytes.len() as u64 != expected {
            return Err(wrong(what(), format!("{expected} bytes"), bytes.len()));
        }
        Ok(bytes)
    }
}
