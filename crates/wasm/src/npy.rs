//! NumPy's array files, and the arrays of other files as these.

// The module of drives has the record alone.
#![cfg_attr(not(feature = "core"), allow(unused_imports))]

use crate::bytes::Bytes;
use crate::carry;
use crate::complex::{ComplexData, RealData};
use crate::error::Fallible;
use crate::read::{Fields, Read, choice};
use boresight_formats::npy::{NpyArray, NpyData, write};
use boresight_options::{Described, columns};
use js_sys::Uint8Array;
use serde::{Serialize, Serializer};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// An array of a file: `.npy`, MATLAB's or HDF5.
#[derive(Described, Serialize)]
#[option(name = "NpyArray")]
pub struct NpyRecord {
    /// Complex numbers are interleaved [re, im].
    #[option(typescript = "'real' | 'complex'")]
    kind: &'static str,
    /// The numbers in C order, in their precision; integers as doubles.
    #[option(typescript = "Float32Array | Float64Array")]
    data: Numbers,
    /// Lengths of the axes.
    shape: Vec<usize>,
}

enum Numbers {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

impl Serialize for Numbers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Single(numbers) => columns::serialize(numbers, serializer),
            Self::Double(numbers) => columns::serialize(numbers, serializer),
        }
    }
}

impl From<NpyArray> for NpyRecord {
    fn from(array: NpyArray) -> Self {
        let kind = if array.is_complex() { "complex" } else { "real" };
        let data = match array.data {
            NpyData::Float32(numbers) => Numbers::Single(numbers),
            NpyData::Float64(numbers) => Numbers::Double(numbers),
            NpyData::Complex32(numbers) => {
                Numbers::Single(numbers.iter().flat_map(|z| [z.re, z.im]).collect())
            }
            NpyData::Complex64(numbers) => {
                Numbers::Double(numbers.iter().flat_map(|z| [z.re, z.im]).collect())
            }
            NpyData::Integer(numbers) => {
                Numbers::Double(numbers.iter().map(|&n| n as f64).collect())
            }
        };
        Self { kind, data, shape: array.shape }
    }
}

#[cfg(feature = "core")]
/// Reads a `.npy` file; integers become `Float64Array`.
#[wasm_bindgen(js_name = readNpy)]
pub fn read_npy(bytes: &JsValue) -> Fallible<JsValue> {
    let array = NpyArray::parse(&Bytes::read(bytes, "npy file")?.0)?;
    Ok(carry::write(&NpyRecord::from(array)))
}

#[cfg(feature = "core")]
/// The bytes of a `.npy` file of `{ kind, data, shape }`, in the precision of `data`.
#[wasm_bindgen(js_name = writeNpy)]
pub fn write_npy(array: &JsValue) -> Fallible<Uint8Array> {
    let mut fields = Fields::new(array, "array")?;
    let kinds = [("complex", true), ("real", false)];
    let kind = fields.required::<String>("kind")?;
    let is_complex = choice(&kind.into(), "array.kind", &kinds)?;
    let bytes = if is_complex {
        match ComplexData::of(fields)? {
            ComplexData { data, shape, single: false } => write(&shape, &data)?,
            array => write(&array.shape, &array.to_complex32())?,
        }
    } else {
        match RealData::of(fields)? {
            RealData { data, shape, single: false } => write(&shape, &data)?,
            RealData { data, shape, .. } => {
                let data: Vec<f32> = data.iter().map(|&x| x as f32).collect();
                write(&shape, &data)?
            }
        }
    };
    Ok(Uint8Array::new_from_slice(&bytes))
}
