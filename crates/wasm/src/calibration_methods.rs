//! The methods of mounting angles by name; what runs them is in the module of drives.

use crate::carry;
use boresight_mounting::Method;
use boresight_options::Described;
use serde::Serialize;
use wasm_bindgen::prelude::wasm_bindgen;

/// A method of mounting angles.
#[derive(Described, Serialize)]
pub struct CalibrationMethodInfo {
    /// Its name.
    name: Method,
    /// Name for people.
    title: &'static str,
    /// Where it was published.
    reference: &'static str,
}

/// The methods that find a mounting angle.
#[wasm_bindgen(js_name = calibrationMethods)]
pub fn calibration_methods() -> js_sys::Array {
    carry::write_all(Method::ALL.map(|name| CalibrationMethodInfo {
        name,
        title: name.title(),
        reference: name.reference(),
    }))
}
