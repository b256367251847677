//! Arrays of HDF5 files, MATLAB's among them.

use crate::bytes::Bytes;
use crate::carry;
use crate::error::Fallible;
use crate::npy::NpyRecord;
use crate::read::Read;
use boresight_formats::hdf5::{ArrayEntry, list, read};
use boresight_options::Described;
use serde::{Deserialize, Serialize};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Which array of a file is read.
#[derive(Debug, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ReadArrayOptions {
    /// Its name, with those of its groups before it and `/` between; needed where the file has several.
    dataset: Option<String>,
}

/// An array of real or complex numbers in a file.
#[derive(Debug, Described, Serialize)]
#[option(name = "ArrayEntry")]
pub struct ArrayRecord {
    /// Its name, with those of its groups before it and `/` between.
    dataset: String,
    /// What its numbers are.
    #[option(typescript = "'real' | 'complex'")]
    kind: &'static str,
    /// Lengths of its axes, in MATLAB's order in files of MATLAB.
    shape: Vec<usize>,
}

impl From<ArrayEntry> for ArrayRecord {
    fn from(entry: ArrayEntry) -> Self {
        let kind = if entry.complex { "complex" } else { "real" };
        Self { dataset: entry.name, kind, shape: entry.shape }
    }
}

/// Reads an array of an HDF5 file or one of MATLAB 7.3; integers become `Float64Array`.
#[wasm_bindgen(js_name = readArray)]
pub fn read_array(bytes: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let ReadArrayOptions { dataset } = carry::read_optional(options)?;
    let array = read(Bytes::read(bytes, "file")?.0, dataset.as_deref())?;
    Ok(carry::write(&NpyRecord::from(array)))
}

/// The arrays of numbers in such a file.
#[wasm_bindgen(js_name = listArrays)]
pub fn list_arrays(bytes: &JsValue) -> Fallible<js_sys::Array> {
    let entries = list(Bytes::read(bytes, "file")?.0)?;
    Ok(carry::write_all(entries.into_iter().map(ArrayRecord::from)))
}
