//! NumPy's array files.

use crate::bytes::Bytes;
use crate::complex::{ComplexData, RealData};
use crate::error::Fallible;
use crate::read::{Fields, Read, choice};
use crate::write::{Record, complex32, complex64, float32, float64, list};
use boresight_formats::npy::{NpyArray, NpyData, write};
use js_sys::Uint8Array;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Reads a `.npy` file; integers become `Float64Array`.
#[wasm_bindgen(js_name = readNpy)]
pub fn read_npy(bytes: &JsValue) -> Fallible<JsValue> {
    let array = NpyArray::parse(&Bytes::read(bytes, "npy file")?.0)?;
    let data: JsValue = match &array.data {
        NpyData::Float32(numbers) => float32(numbers).into(),
        NpyData::Float64(numbers) => float64(numbers).into(),
        NpyData::Complex32(numbers) => complex32(numbers).into(),
        NpyData::Complex64(numbers) => complex64(numbers).into(),
        NpyData::Integer(numbers) => {
            float64(&numbers.iter().map(|&n| n as f64).collect::<Vec<_>>()).into()
        }
    };
    Ok(Record::new()
        .with("kind", if array.is_complex() { "complex" } else { "real" })
        .with("data", data)
        .with("shape", list(array.shape))
        .into())
}

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
