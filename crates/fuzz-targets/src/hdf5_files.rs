//! HDF5 files with valid checksums: files to change, and checksums that are computed again after a change. Without that the
//! first checksum would reject nearly every changed file.

use hdf5_pure::{AttrValue, FileBuilder, MaxExtent};
use std::ops::Range;
use std::sync::LazyLock;

/// First bytes of an HDF5 file without a user block.
pub const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
/// What blocks with a checksum at their end begin with.
const BLOCKS: [&[u8; 4]; 14] = [
    b"OHDR", b"OCHK", b"EAHD", b"EAIB", b"EADB", b"EASB", b"FAHD", b"FADB", b"BTHD", b"BTLF",
    b"BTIN", b"FRHP", b"FHIB", b"SMTB",
];
/// Longest block searched for its end, in bytes.
const LONGEST_BLOCK: usize = 2048;
const CHECKSUM_BYTES: usize = 4;

/// A file and its blocks with checksums.
#[derive(Debug, Clone)]
pub struct Sealed {
    /// The file.
    pub bytes: Vec<u8>,
    /// Contents of each block, whose checksum follows.
    pub blocks: Vec<Range<usize>>,
}

impl Sealed {
    /// Finds the blocks of a file whose checksums are valid: each ends where the checksum of what lies before it follows.
    pub fn new(bytes: Vec<u8>) -> Self {
        let begins = |at: usize| {
            bytes[at..].starts_with(SIGNATURE)
                || BLOCKS.iter().any(|name| bytes[at..].starts_with(*name))
        };
        let blocks = (0..bytes.len()).filter(|at| begins(*at)).filter_map(|start| {
            let last = bytes.len().saturating_sub(CHECKSUM_BYTES).min(start + LONGEST_BLOCK);
            (start + 4..=last)
                .find(|end| bytes[*end..].starts_with(&lookup3(&bytes[start..*end]).to_le_bytes()))
                .map(|end| start..end)
        });
        let blocks = blocks.collect();
        Self { bytes, blocks }
    }

    /// The file with bytes changed at some places, and valid checksums.
    pub fn changed(&self, changes: impl IntoIterator<Item = (usize, u8)>) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        let length = bytes.len();
        for (place, value) in changes {
            bytes[place % length] = value;
        }
        for block in &self.blocks {
            let checksum = lookup3(&bytes[block.clone()]);
            bytes[block.end..block.end + CHECKSUM_BYTES].copy_from_slice(&checksum.to_le_bytes());
        }
        bytes
    }
}

/// Recordings in the layout of `RadarScenes`.
pub static RECORDINGS: LazyLock<Vec<Sealed>> = LazyLock::new(|| {
    [
        &include_bytes!("../../../tests/golden/radarscenes/latest_growing.h5")[..],
        include_bytes!("../../../tests/golden/radarscenes/latest_filtered.h5"),
        include_bytes!("../../../tests/golden/radarscenes/latest_chunked.h5"),
        include_bytes!("../../../tests/golden/radarscenes/latest_contiguous.h5"),
        include_bytes!("../../../tests/golden/radarscenes/growing.h5"),
        include_bytes!("../../../tests/golden/radarscenes/filtered.h5"),
    ]
    .map(|bytes| Sealed::new(bytes.to_vec()))
    .into()
});

/// Files of arrays.
pub static ARRAYS: LazyLock<Vec<Sealed>> = LazyLock::new(|| {
    [
        every_index(),
        many_attributes(),
        include_bytes!("../../../tests/golden/hdf5/one.h5").to_vec(),
        include_bytes!("../../../tests/golden/hdf5/matlab.mat").to_vec(),
        include_bytes!("../../../tests/golden/hdf5/several.h5").to_vec(),
    ]
    .map(Sealed::new)
    .into()
});

/// Datasets with each chunk index that is written by the library's latest format, with filters and attributes.
fn every_index() -> Vec<u8> {
    let numbers: Vec<f64> = (0..96).map(f64::from).collect();
    let mut file = FileBuilder::new();
    file.create_dataset("fixed").with_f64_data(&numbers).with_shape(&[96]).with_chunks(&[16]);
    file.create_dataset("growing")
        .with_f64_data(&numbers)
        .with_shape(&[96])
        .with_maxshape(&[MaxExtent::Unlimited])
        .with_chunks(&[2])
        .with_shuffle()
        .with_deflate(6);
    file.create_dataset("single")
        .with_f64_data(&numbers)
        .with_shape(&[8, 12])
        .with_chunks(&[8, 12])
        .with_fletcher32()
        .set_attr("MATLAB_class", AttrValue::String("double".into()));
    file.create_dataset("contiguous").with_complex64_data(&[(1.0, 2.0), (3.0, 4.0)]);
    file.finish().expect("a file of four datasets")
}

/// A dataset with more attributes than its header holds, so that they lie in a heap with a B-tree.
fn many_attributes() -> Vec<u8> {
    let mut file = FileBuilder::new();
    let dataset = file.create_dataset("dataset").with_f64_data(&[1.0, 2.0]);
    for index in 0..20 {
        dataset.set_attr(&format!("attribute{index}"), AttrValue::I64(index));
    }
    file.finish().expect("a file of one dataset")
}

/// The file that a target reads from its input: a whole file, or one of `files` chosen by the first byte, with changes of
/// three bytes each (place, little end first, and value).
pub fn file_of(input: &[u8], files: &[Sealed]) -> Vec<u8> {
    let whole = input.starts_with(SIGNATURE) || input.starts_with(b"MATLAB");
    let (Some((choice, changes)), false) = (input.split_first(), whole) else {
        return input.to_vec();
    };
    let changes = changes.as_chunks::<3>().0.iter();
    files[usize::from(*choice) % files.len()].changed(
        changes.map(|[low, high, value]| (usize::from(u16::from_le_bytes([*low, *high])), *value)),
    )
}

/// The checksum of HDF5's metadata: Bob Jenkins' lookup3 (`hashlittle`) from 0.
pub fn lookup3(bytes: &[u8]) -> u32 {
    let start = 0xdead_beef_u32.wrapping_add(bytes.len() as u32);
    let (mut a, mut b, mut c) = (start, start, start);
    let mut rest = bytes;
    loop {
        let (block, after) = rest.split_at(rest.len().min(12));
        let mut padded = [0; 12];
        padded[..block.len()].copy_from_slice(block);
        let word = |i: usize| u32::from_le_bytes([0, 1, 2, 3].map(|k| padded[4 * i + k]));
        if block.is_empty() {
            return c;
        }
        a = a.wrapping_add(word(0));
        b = b.wrapping_add(word(1));
        c = c.wrapping_add(word(2));
        if after.is_empty() {
            break;
        }
        for (shift, next) in [4, 6, 8, 16, 19, 4].into_iter().enumerate().map(|(i, s)| (s, i % 3)) {
            let (x, y, z) = match next {
                0 => (&mut a, &mut c, b),
                1 => (&mut b, &mut a, c),
                _ => (&mut c, &mut b, a),
            };
            *x = x.wrapping_sub(*y) ^ y.rotate_left(shift);
            *y = y.wrapping_add(z);
        }
        rest = after;
    }
    for (x, y, shift) in
        [(2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24)]
    {
        let mut words = [a, b, c];
        words[x] = (words[x] ^ words[y]).wrapping_sub(words[y].rotate_left(shift));
        [a, b, c] = words;
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lookup3_has_the_values_its_author_gives() {
        assert_eq!(lookup3(b""), 0xdead_beef);
        assert_eq!(lookup3(b"Four score and seven years ago"), 0x1777_0551);
    }

    #[test]
    fn every_kind_of_block_is_found_and_sealed_again() {
        let files = RECORDINGS.iter().chain(ARRAYS.iter());
        let mut kinds = std::collections::BTreeSet::new();
        for file in files {
            kinds.extend(
                file.blocks.iter().map(|block| file.bytes[block.start..block.start + 4].to_vec()),
            );
            assert_eq!(file.changed([]), file.bytes, "checksums of an unchanged file");
            if let Some(block) = file.blocks.first() {
                let place = block.end - 1;
                let changed = file.changed([(place, !file.bytes[place])]);
                assert_ne!(changed[block.end..block.end + 4], file.bytes[block.end..block.end + 4]);
            }
        }
        for kind in [
            b"\x89HDF", b"OHDR", b"EAHD", b"EAIB", b"EADB", b"FAHD", b"FADB", b"BTHD", b"BTLF",
            b"FRHP",
        ] {
            assert!(
                kinds.contains(&kind[..]),
                "{:?} among {kinds:?}",
                String::from_utf8_lossy(kind)
            );
        }
    }
}
