//! JavaScript bindings of everything but the networks, which build on this crate.
//!
//! A binding function reads its options, calls one function of the crates beneath and writes the
//! result as a plain object with typed arrays of its own. Degrees become radians here and nowhere
//! else. Errors are thrown as objects `{ code, message, what, expected, given }`, which the
//! TypeScript around this crate turns into a `BoresightError`.
//!
//! Two modules come of it, by feature: `core` with arrays, estimators, captures and images, and
//! `drives` with readers and simulation of drives (HDF5 alone weighs a third of all else) and the
//! calibration of mounting angles. `chain` is the part of the core that
//! the module of networks (crates/wasm-neural) holds as well: estimators, captures, their chain.

// Each module leaves helpers of the others unused.
#![cfg_attr(not(all(feature = "core", feature = "drives")), allow(dead_code))]

#[cfg(feature = "chain")]
pub mod array;
#[cfg(feature = "core")]
pub mod array_calibration;
#[cfg(feature = "core")]
pub mod board;
#[cfg(feature = "core")]
pub mod bounds;
pub mod bytes;
#[cfg(feature = "drives")]
pub mod calibrate;
#[cfg(feature = "chain")]
pub mod calibrated;
#[cfg(feature = "core")]
pub mod calibration_methods;
#[cfg(feature = "chain")]
pub mod capture;
pub mod carry;
#[cfg(feature = "chain")]
mod cells;
#[cfg(feature = "chain")]
pub mod chain;
pub mod complex;
#[cfg(feature = "chain")]
pub mod config;
#[cfg(feature = "core")]
pub mod count;
#[cfg(feature = "drives")]
pub mod drive;
#[cfg(feature = "drives")]
mod drive_calibrator;
pub mod error;
#[cfg(feature = "chain")]
pub mod estimate;
pub mod given;
#[cfg(feature = "drives")]
pub mod hdf5;
#[cfg(feature = "core")]
pub mod image;
mod limits;
#[cfg(any(feature = "core", feature = "drives"))]
pub mod npy;
#[cfg(feature = "chain")]
pub mod options;
mod panic;
pub mod read;
#[cfg(feature = "core")]
pub mod recording;
#[cfg(feature = "core")]
pub mod region;
pub mod report;
#[cfg(feature = "drives")]
mod scan_motion;
#[cfg(feature = "core")]
pub mod simulate;
#[cfg(feature = "core")]
pub mod street;
#[cfg(feature = "drives")]
mod studio;
#[cfg(feature = "core")]
mod suits;
#[cfg(feature = "core")]
mod tables;
#[cfg(feature = "core")]
pub mod trajectory;
#[cfg(feature = "chain")]
mod waveform;

#[cfg(feature = "core")]
use wasm_bindgen::prelude::wasm_bindgen;

/// Version of the package.
#[cfg(feature = "core")]
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").into()
}
