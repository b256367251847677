//! Antenna arrays.

use crate::error::Fallible;
use crate::read::{Fields, Read, wrong_type};
use crate::write::{Record, list};
use boresight_core::array::Position;
use boresight_core::presets::{PRESETS, preset};
use boresight_core::resolution::resolution_rad;
use boresight_core::steering::unambiguous_sine;
use boresight_core::{Array, Extent};
use std::f64::consts::FRAC_PI_2;
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
    list(PRESETS)
}

/// Geometry of an array given by name, positions, or transmitters and receivers.
#[wasm_bindgen(js_name = array)]
pub fn array_geometry(input: &JsValue) -> Fallible<JsValue> {
    Ok(geometry(&Array::read(input, "array")?).into())
}

/// The array as a plain object.
pub fn geometry(array: &Array) -> Record {
    let positions = |p: &[Position]| list(p.iter().map(|&p| list(p)));
    let channel = |tx: usize, rx: usize| Record::new().with("tx", tx).with("rx", rx);
    let unambiguous_rad =
        array.lattice().map_or(FRAC_PI_2, |lattice| unambiguous_sine(&lattice).asin());
    Record::new()
        .with("positions", positions(array.positions()))
        .with("tx", positions(array.tx()))
        .with("rx", positions(array.rx()))
        .with("channels", list(array.channels().iter().map(|c| channel(c.tx, c.rx))))
        .with("aperture", array.aperture())
        .with("extent", extent_name(array.extent()))
        .with("uniform", array.is_uniform())
        .with("unambiguousDeg", unambiguous_rad.to_degrees())
        .with("resolutionDeg", resolution_rad(array).to_degrees())
}

fn extent_name(extent: Extent) -> &'static str {
    match extent {
        Extent::Point => "point",
        Extent::Azimuth => "azimuth",
        Extent::Line => "line",
        Extent::Area => "area",
    }
}
