//! JavaScript bindings: the one crate that knows `wasm_bindgen`.
//!
//! A binding function reads its options, calls one function of the crates beneath and writes the
//! result as a plain object with typed arrays of its own. Degrees become radians here and nowhere
//! else. Errors are thrown as objects `{ code, message, what, expected, given }`, which the
//! TypeScript around this crate turns into a `BoresightError`.

pub mod array;
mod board;
mod bounds;
mod bytes;
mod calibrate;
pub mod capture;
mod chain;
mod complex;
mod config;
mod count;
pub mod error;
pub mod estimate;
mod frames;
mod imperfections;
mod names;
mod npy;
mod options;
mod panic;
mod read;
pub mod simulate;
mod tables;
mod waveform;
mod write;

use wasm_bindgen::prelude::wasm_bindgen;

/// Version of the package.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").into()
}
