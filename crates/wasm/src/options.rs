//! Options of the estimators out of JavaScript.

use crate::calibrated::ArrayChoice;
use crate::error::Fallible;
use crate::read::{Fields, Read, choice};
use boresight_aoa::{EstimatorOptions, Method};
use boresight_core::Array;
use boresight_options::Named;
use wasm_bindgen::JsValue;

impl Read for Method {
    const EXPECTED: &'static str = "the name of a method";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let known: Vec<_> = Self::VARIANTS.iter().map(|method| (method.name(), *method)).collect();
        choice(value, path, &known)
    }
}

/// Reads an estimator: its method, the array it works on, calibrated where that is asked for, and its options.
pub fn read_estimator(options: &JsValue) -> Fallible<(Method, Array, EstimatorOptions)> {
    let mut fields = Fields::new(options, "")?;
    let (method, array) = (fields.required("method")?, ArrayChoice::read(&mut fields)?);
    let options = fields.spread()?;
    fields.finish()?;
    Ok((method, array.required()?, options))
}
