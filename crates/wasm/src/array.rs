//! Antenna arrays.

use crate::carry;
use crate::error::Fallible;
use crate::read::{Fields, Read, wrong_type};
use boresight_core::array::Position;
use boresight_core::presets::{PRESETS, preset};
use boresight_core::{Array, Geometry};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

impl Read for Array {
    const EXPECTED: &'static str = "a preset's name, { positions } or { tx, rx }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if let Some(name) = value.as_string() {
            return Ok(preset(&name)?);
        }
        if !value.is_object() {
            return Err(wrong_type(path, Self::EXPECTED, value));
        }
        let mut fields = Fields::new(value, path)?;
        if let Some(positions) = fields.optional::<Vec<Position>>("positions")? {
            fields.finish()?;
            return Ok(Self::new(&positions)?);
        }
        let tx: Vec<Position> = fields.required("tx")?;
        let rx: Vec<Position> = fields.required("rx")?;
        let without_duplicates = fields.optional("withoutDuplicates")?.unwrap_or(false);
        fields.finish()?;
        let array = Self::mimo(&tx, &rx)?;
        Ok(if without_duplicates { array.without_duplicates() } else { array })
    }
}

/// Names of the array presets, beside `ulaN`.
#[wasm_bindgen(js_name = arrayPresets)]
pub fn array_presets() -> js_sys::Array {
    carry::write_all(PRESETS)
}

/// Geometry of an array given by name, positions, or transmitters and receivers.
#[wasm_bindgen(js_name = array)]
pub fn array_geometry(input: &JsValue) -> Fallible<JsValue> {
    Ok(carry::write(&Geometry::from(&Array::read(input, "array")?)))
}
