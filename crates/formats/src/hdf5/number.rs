//! Numbers of HDF5 datasets: integers and floating point of any usual width and byte order, and what a file of a length can
//! hold.

use crate::error::FormatError;
use hdf5_pure::{
    ChunkIndex, Dataset, Datatype, DatatypeByteOrder, File, FloatingPointLayout, Layout,
};

/// Data may unpack to this, bytes, and [`GROWTH`] times the length of the file beside: what claims more
/// is none.
const ALLOWANCE: u64 = 16 << 20;
const GROWTH: u64 = 64;

/// Bytes that the data of a file may unpack to.
pub(crate) fn most_bytes(file: &File) -> u64 {
    file.file_size().saturating_mul(GROWTH).saturating_add(ALLOWANCE)
}

pub(crate) fn wrong(
    what: impl Into<String>,
    expected: impl Into<String>,
    given: impl ToString,
) -> FormatError {
    let given = given.to_string().chars().take(200).collect();
    FormatError::Hdf5 { what: what.into(), expected: expected.into(), given }
}

/// What a number is stored as.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    Signed,
    Unsigned,
    Float,
}

/// Where and how a field lies in a row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field {
    pub(crate) offset: usize,
    pub(crate) size: usize,
    pub(crate) kind: Kind,
    big_endian: bool,
}

impl Field {
    fn bits(self, row: &[u8]) -> u64 {
        let bytes = row.get(self.offset..self.offset + self.size).unwrap_or_default();
        let push = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        if self.big_endian { bytes.iter().fold(0, push) } else { bytes.iter().rev().fold(0, push) }
    }

    /// The field as an integer; a float is truncated.
    pub(crate) fn integer(self, row: &[u8]) -> i128 {
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
    pub(crate) fn number(self, row: &[u8]) -> f64 {
        match (self.kind, self.size) {
            (Kind::Float, 4) => f64::from(f32::from_bits(self.bits(row) as u32)),
            (Kind::Float, _) => f64::from_bits(self.bits(row)),
            _ => self.integer(row) as f64,
        }
    }
}

pub(crate) fn field(name: &str, offset: u64, datatype: &Datatype) -> Result<Field, FormatError> {
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

/// Refuses chunks that claim more bytes than the file has, as their length is reserved before they are read, and more chunks
/// than the data of the file can have, as several may share the same bytes.
pub(crate) fn chunks_inside(file: &File, name: &str, dataset: &Dataset) -> Result<(), FormatError> {
    let failed = |error| wrong(name, "a readable layout", error);
    let Layout::Chunked { chunk_shape, index } = dataset.layout().map_err(failed)? else {
        return Ok(());
    };
    let chunk_bytes = chunk_shape
        .iter()
        .try_fold(dataset.element_size().map_err(failed)?, |bytes, n| bytes.checked_mul(*n))
        .unwrap_or(u64::MAX);
    let no_more = |count: u64, most: u64| match count.checked_mul(chunk_bytes.max(1)) {
        Some(bytes) if bytes <= most => Ok(()),
        _ => Err(wrong(name, "no more chunks than the file can hold", count)),
    };
    if index == ChunkIndex::Implicit {
        // Unlike other indexes it takes no space: the chunks follow from the shape, one after the other.
        let shape = dataset.shape().map_err(failed)?;
        let count = shape
            .iter()
            .zip(&chunk_shape)
            .try_fold(1_u64, |count, (n, chunk)| count.checked_mul(n.div_ceil((*chunk).max(1))));
        no_more(count.unwrap_or(u64::MAX), file.file_size())?;
    }
    // An index that cannot be listed fails when rows are read.
    let chunks = dataset.chunks().unwrap_or_default();
    no_more(chunks.len() as u64, most_bytes(file))?;
    for chunk in chunks {
        let end = chunk.address.checked_add(chunk.storage_size);
        if end.is_none_or(|end| end > file.file_size()) {
            let given = format!("{} bytes at {}", chunk.storage_size, chunk.address);
            return Err(wrong(name, "chunks inside the file", given));
        }
    }
    Ok(())
}
