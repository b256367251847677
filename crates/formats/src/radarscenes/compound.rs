//! Rows of a compound HDF5 dataset: fields by name, of any width and byte order, read a window of
//! rows at a time so that only the file and one window are in memory.

use crate::error::FormatError;
use hdf5_pure::{Dataset, Datatype, DatatypeByteOrder, File, FloatingPointLayout};

/// Bytes of rows read at a time, at least one chunk.
const WINDOW_BYTES: u64 = 1 << 20;
/// Rows may unpack to this, bytes, and [`GROWTH`] times the length of the file beside: what claims more
/// is no recording.
const ALLOWANCE: u64 = 16 << 20;
const GROWTH: u64 = 64;
/// A row counts as at least so long, about what a scan of one detection takes in memory: else a file
/// of overlapping fields grows without need.
const LEAST_ROW_BYTES: u64 = 64;

pub(super) fn wrong(
    what: impl Into<String>,
    expected: impl Into<String>,
    given: impl ToString,
) -> FormatError {
    let given = given.to_string().chars().take(200).collect();
    FormatError::Hdf5 { what: what.into(), expected: expected.into(), given }
}

/// What a number is stored as.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Signed,
    Unsigned,
    Float,
}

/// Where and how a field lies in a row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field {
    offset: usize,
    size: usize,
    kind: Kind,
    big_endian: bool,
}

impl Field {
    fn bits(self, row: &[u8]) -> u64 {
        let bytes = row.get(self.offset..self.offset + self.size).unwrap_or_default();
        let push = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        if self.big_endian { bytes.iter().fold(0, push) } else { bytes.iter().rev().fold(0, push) }
    }

    /// The field as an integer; a float is truncated.
    pub(super) fn integer(self, row: &[u8]) -> i128 {
        let bits = self.bits(row);
        match self.kind {
            Kind::Unsigned => i128::from(bits),
            Kind::Signed => {
                let unused = 64 - 8 * self.size as u32;
                i128::from(((bits << unused) as i64) >> unused)
            }
            Kind::Float => self.number(row) as i128,
        }
    }

    /// The field as a number.
    pub(super) fn number(self, row: &[u8]) -> f64 {
        match (self.kind, self.size) {
            (Kind::Float, 4) => f64::from(f32::from_bits(self.bits(row) as u32)),
            (Kind::Float, _) => f64::from_bits(self.bits(row)),
            _ => self.integer(row) as f64,
        }
    }
}

fn field(name: &str, offset: u64, datatype: &Datatype) -> Result<Field, FormatError> {
    let (size, kind, order, whole) = match datatype {
        Datatype::FixedPoint { size, byte_order, layout } => {
            let kind = if layout.signed { Kind::Signed } else { Kind::Unsigned };
            let bits = u64::from(layout.bit_precision);
            let whole = layout.bit_offset == 0 && bits == 8 * u64::from(*size);
            (*size, kind, byte_order, whole && matches!(size, 1 | 2 | 4 | 8))
        }
        Datatype::FloatingPoint { size, byte_order, layout } => {
            let whole = (*size == 4 && *layout == FloatingPointLayout::IEEE754_BINARY32)
                || (*size == 8 && *layout == FloatingPointLayout::IEEE754_BINARY64);
            (*size, Kind::Float, byte_order, whole)
        }
        _ => return Err(wrong(name, "a number", "another type")),
    };
    let big_endian = match order {
        DatatypeByteOrder::LittleEndian => false,
        DatatypeByteOrder::BigEndian => true,
        _ => return Err(wrong(name, "little or big endian numbers", "another byte order")),
    };
    let offset = usize::try_from(offset).map_err(|_| wrong(name, "inside its row", offset))?;
    if !whole {
        return Err(wrong(name, "integers of 1 to 8 bytes, floats of 4 or 8", "another width"));
    }
    Ok(Field { offset, size: size as usize, kind, big_endian })
}

/// Refuses chunks that claim more bytes than the file has: their length is reserved before it is read.
fn chunks_inside(file: &File, name: &str, dataset: &Dataset) -> Result<(), FormatError> {
    // Contiguous data has none; an index that cannot be listed fails when rows are read.
    for chunk in dataset.chunks().unwrap_or_default() {
        let end = chunk.address.checked_add(chunk.storage_size);
        if end.is_none_or(|end| end > file.file_size()) {
            let given = format!("{} bytes at {}", chunk.storage_size, chunk.address);
            return Err(wrong(name, "chunks inside the file", given));
        }
    }
    Ok(())
}

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
        let limit = file.file_size().saturating_mul(GROWTH).saturating_add(ALLOWANCE);
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
