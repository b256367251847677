//! Mutated files of every reader. None may panic, and none may take more memory than stated below.
//!
//! `BORESIGHT_MUTATIONS` is the number of files, a third of them HDF5 with valid checksums. Files follow from their number
//! alone, so that a failure is repeated with the same count or a larger one.

// The allocator that counts; failures outside of the test function.
#![allow(unsafe_code, clippy::unwrap_used)]

use boresight_fuzz_targets::TARGETS;
use boresight_fuzz_targets::hdf5_files::{ARRAYS, RECORDINGS, Sealed};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::alloc::{GlobalAlloc, Layout, System};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Files unless `BORESIGHT_MUTATIONS` says otherwise.
const DEFAULT_FILES: usize = 1500;
/// What the data of a file may unpack to: this, and in addition a multiple of its length. docs/formats.md states it too.
const DATA_BYTES: usize = 16 << 20;
const DATA_PER_BYTE: usize = 64;
/// Copies of the data of an HDF5 file that exist at a time: unpacked chunks, rows, numbers, and the copy of the target.
const HDF5_COPIES: usize = 4;
/// Most changes of one file.
const MAX_CHANGES: usize = 8;
/// Values that lengths and counts break at.
const EDGES: [u8; 8] = [0, 1, 2, 0x7f, 0x80, 0xfe, 0xff, 0x20];

struct Counting;

static USED: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn grow(bytes: usize) {
    PEAK.fetch_max(USED.fetch_add(bytes, Ordering::Relaxed) + bytes, Ordering::Relaxed);
}

// SAFETY: every call is passed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Counted as a copy: old and new exist at the same time.
        grow(size);
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Mutator(ChaCha8Rng);

impl Mutator {
    fn below(&mut self, limit: usize) -> usize {
        self.0.next_u64() as usize % limit.max(1)
    }

    fn value(&mut self) -> u8 {
        let edge = self.below(2) == 0;
        let index = self.below(256);
        if edge { EDGES[index % EDGES.len()] } else { index as u8 }
    }

    /// Some bytes of a file with checksums, mostly inside its blocks and next to each other.
    fn changed(&mut self, file: &Sealed) -> Vec<u8> {
        let mut changes = vec![];
        for _ in 0..=self.below(MAX_CHANGES) {
            let place = match &file.blocks[..] {
                blocks if !blocks.is_empty() && self.below(4) > 0 => {
                    let block = &blocks[self.below(blocks.len())];
                    block.start + self.below(block.len())
                }
                _ => self.below(file.bytes.len()),
            };
            let run = [1, 1, 2, 4, 8][self.below(5)];
            let value = self.value();
            changes.extend((place..place + run).map(|at| (at, value)));
        }
        file.changed(changes)
    }

    /// A file of any kind with bytes changed, cut, repeated or removed.
    fn mutated(&mut self, file: &[u8]) -> Vec<u8> {
        let mut bytes = file.to_vec();
        for _ in 0..=self.below(MAX_CHANGES) {
            let at = self.below(bytes.len());
            let end = at + self.below(64).min(bytes.len() - at);
            match self.below(8) {
                0 => bytes.truncate(at),
                1 => drop(bytes.drain(at..end)),
                2 => {
                    let copy = bytes[at..end].to_vec();
                    let place = self.below(bytes.len());
                    bytes.splice(place..place, copy);
                }
                3 => bytes.insert(at, self.value()),
                _ => {
                    let value = self.value();
                    if let Some(byte) = bytes.get_mut(at) {
                        *byte = value;
                    }
                }
            }
        }
        bytes
    }
}

struct Outcome {
    files: usize,
    failed: Vec<usize>,
    peak_bytes: usize,
    beyond: Vec<(usize, usize, usize)>,
}

/// Gives mutated files to a target, and counts.
fn run(
    check: fn(&[u8]),
    copies: usize,
    numbers: impl Iterator<Item = usize>,
    mut file: impl FnMut(usize, &mut Mutator) -> Vec<u8>,
) -> Outcome {
    let mut outcome = Outcome { files: 0, failed: vec![], peak_bytes: 0, beyond: vec![] };
    for number in numbers {
        let bytes = file(number, &mut Mutator(ChaCha8Rng::seed_from_u64(number as u64)));
        let before = USED.load(Ordering::Relaxed);
        PEAK.store(before, Ordering::Relaxed);
        if catch_unwind(AssertUnwindSafe(|| check(&bytes))).is_err() {
            outcome.failed.push(number);
            if let Some(folder) = std::env::var_os("BORESIGHT_MUTATIONS_KEEP") {
                let path = Path::new(&folder).join(number.to_string());
                std::fs::write(path, &bytes).unwrap();
            }
        }
        let peak = PEAK.load(Ordering::Relaxed) - before;
        outcome.peak_bytes = outcome.peak_bytes.max(peak);
        if peak > copies * (DATA_BYTES + DATA_PER_BYTE * bytes.len()) {
            outcome.beyond.push((number, bytes.len(), peak));
        }
        outcome.files += 1;
    }
    outcome
}

#[test]
fn mutated_files_are_read_or_refused() {
    let files: usize = std::env::var("BORESIGHT_MUTATIONS")
        .map_or(DEFAULT_FILES, |count| count.parse().expect("a number of files"));
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    let sealed: [(&str, &[Sealed]); 2] = [("hdf5", &ARRAYS), ("drive_h5", &RECORDINGS)];
    // Networks take up to a second each, and files of edits have no seeds.
    let others: Vec<_> = TARGETS
        .iter()
        .filter(|(name, _)| *name != "network" && seeds.join(name).exists())
        .collect();
    let mut results = vec![];
    for (name, all) in sealed {
        let (_, check) = TARGETS.iter().find(|target| target.0 == name).unwrap();
        let file = |number: usize, mutator: &mut Mutator| mutator.changed(&all[number % all.len()]);
        results.push((name, run(*check, HDF5_COPIES, 0..files / 6, file)));
    }
    let share = (files - files / 6 * 2).div_ceil(others.len());
    for (name, check) in &others {
        let folder = std::fs::read_dir(seeds.join(name)).unwrap();
        let mut paths: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        let all: Vec<_> = paths.iter().map(|path| std::fs::read(path).unwrap()).collect();
        let file = |number: usize, mutator: &mut Mutator| mutator.mutated(&all[number % all.len()]);
        results.push((name, run(*check, 1, 0..share, file)));
    }
    println!("{:<16}{:>8}{:>8}{:>14}", "target", "files", "failed", "peak, bytes");
    for (name, Outcome { files, failed, peak_bytes, .. }) in &results {
        println!("{name:<16}{files:>8}{:>8}{peak_bytes:>14}", failed.len());
    }
    for (name, outcome) in &results {
        assert!(outcome.failed.is_empty(), "{name}: panics for files {:?}", outcome.failed);
        assert!(
            outcome.beyond.is_empty(),
            "{name}: number, length and peak of files that take too much memory: {:?}",
            outcome.beyond
        );
    }
}
