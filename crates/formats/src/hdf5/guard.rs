//! Access to untrusted HDF5 files. Every metadata read passes checks that the parser does not make itself, so that the
//! work and memory for a file stay in proportion to its length.

use hdf5_pure::{
    Error, File, FileAccessProperties, FormatError, ReadSeekSource, Source, WriteMarkPolicy,
};
use std::io::{Cursor, Read, Seek};
use std::sync::atomic::{AtomicU64, Ordering};

/// Metadata bytes read per byte of the file, and in addition to them. A parsed byte takes up to ten in memory. Cyclic links
/// and B-trees whose nodes share children exhaust this budget instead of running on.
const METADATA_GROWTH: u64 = 16;
const METADATA_ALLOWANCE: u64 = 1 << 20;
/// Cost of a metadata read in addition to its bytes.
const READ_COST: u64 = 32;
/// Limits of the structures checked below. The HDF5 library writes at most 32 bits and trees of a few levels.
const MAX_ARRAY_BITS: u8 = 62;
const MAX_PAGE_BITS: u8 = 24;
const MAX_TREE_DEPTH: u16 = 16;
/// Shortest record of a version 2 B-tree, in bytes.
const MIN_RECORD_BYTES: u16 = 8;

/// A source that charges metadata reads to a budget and rejects headers that the parser would trust.
struct Guarded<R> {
    inner: ReadSeekSource<R>,
    budget: AtomicU64,
}

impl<R: Read + Seek + Send> Guarded<R> {
    fn new(inner: R) -> Result<Self, FormatError> {
        let inner = ReadSeekSource::new(inner)?;
        let budget = inner.len().saturating_mul(METADATA_GROWTH) + METADATA_ALLOWANCE;
        Ok(Self { inner, budget: AtomicU64::new(budget) })
    }
}

impl<R: Read + Seek + Send> Source for Guarded<R> {
    fn len(&self) -> u64 {
        self.inner.len()
    }

    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> Result<(), FormatError> {
        self.inner.read_at(offset, buffer)
    }

    fn read_metadata_at(&self, offset: u64, length: usize) -> Result<Vec<u8>, FormatError> {
        let cost = READ_COST.saturating_add(length as u64);
        self.budget
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(cost))
            .map_err(|_| {
                FormatError::Source("metadata is read more often than its size allows".into())
            })?;
        let bytes = self.read_exact_at(offset, length)?;
        match fault(&bytes, self.len()) {
            Some(what) => Err(FormatError::Source(format!("{what} at byte {offset}"))),
            None => Ok(bytes),
        }
    }
}

/// Opens a file in memory.
pub(crate) fn from_bytes(bytes: Vec<u8>) -> Result<File, Error> {
    // Bytes in memory are a snapshot even if a writer still held the file.
    let properties =
        FileAccessProperties::new().with_write_mark_policy(WriteMarkPolicy::AllowSnapshot);
    File::from_source_with_options(Guarded::new(Cursor::new(bytes))?, properties)
}

/// Opens a file on disk, which is read piece by piece.
pub(crate) fn from_file(file: std::fs::File) -> Result<File, Error> {
    File::from_source(Guarded::new(file)?)
}

/// The reason why a metadata block cannot be part of a file of this length, if there is one.
fn fault(block: &[u8], file_bytes: u64) -> Option<&'static str> {
    match block {
        [b'E', b'A', b'H', b'D', _, _, _, array_bits, _, min_elements, direct, page_bits, ..] => {
            let possible = *array_bits <= MAX_ARRAY_BITS
                && *page_bits <= MAX_PAGE_BITS
                && min_elements.is_power_of_two();
            // Super block i has 2^(i / 2) data blocks. The addresses of those of the first `direct` super blocks lie in
            // the index block, so there are fewer than bytes in the file.
            let super_blocks = array_bits.saturating_sub(min_elements.trailing_zeros() as u8);
            let addresses = || -> u64 {
                (0..=super_blocks).take((*direct).into()).map(|i| 1_u64 << (i / 2)).sum()
            };
            (!possible || addresses() > file_bytes).then_some("impossible extensible array")
        }
        [b'F', b'A', b'H', b'D', _, _, _, page_bits, ..] => {
            (*page_bits > MAX_PAGE_BITS).then_some("impossible fixed array")
        }
        [b'B', b'T', b'H', b'D', _, _, _, _, _, _, r0, r1, d0, d1, ..] => {
            let [record_bytes, depth] = [[*r0, *r1], [*d0, *d1]].map(u16::from_le_bytes);
            (record_bytes < MIN_RECORD_BYTES || depth > MAX_TREE_DEPTH)
                .then_some("impossible B-tree")
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_that_the_parser_would_trust_are_rejected() {
        let array = |bits, direct, page_bits| {
            [&b"EAHD\0\0\x08"[..], &[bits, 4, 16, direct, page_bits]].concat()
        };
        assert_eq!(fault(&array(32, 4, 10), 4096), None);
        for block in [array(255, 255, 10), array(32, 255, 10), array(32, 4, 64)] {
            assert_eq!(fault(&block, 4096), Some("impossible extensible array"), "{block:?}");
        }
        let tree = |record_bytes, depth| {
            [&b"BTHD\0\x08\0\x02\0\0"[..], &[record_bytes, 0, depth, 0, 100, 40]].concat()
        };
        assert_eq!(fault(&tree(17, 1), 4096), None);
        for block in [tree(0, 1), tree(17, 255)] {
            assert_eq!(fault(&block, 4096), Some("impossible B-tree"), "{block:?}");
        }
    }

    #[test]
    fn reading_the_same_metadata_again_and_again_ends() {
        let source = Guarded::new(Cursor::new(vec![0; 4096])).unwrap();
        let reads = (0..1_000_000).take_while(|_| source.read_metadata_at(0, 4096).is_ok()).count();
        assert_eq!(
            reads as u64,
            (4096 * METADATA_GROWTH + METADATA_ALLOWANCE) / (4096 + READ_COST)
        );
        // Data is not charged.
        assert!(source.read_exact_at(0, 4096).is_ok());
    }
}
