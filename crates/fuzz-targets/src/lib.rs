//! Bodies of the fuzz targets. The targets in `fuzz/` run them under libFuzzer; the tests of this crate run them on stable
//! Rust with seeds, regression inputs and mutated files.

// A target reports what it finds by a panic.
#![allow(clippy::expect_used, clippy::panic)]

pub mod hdf5_files;
pub mod targets;

pub use targets::TARGETS;
