//! Options of the estimators out of JavaScript.

use crate::error::Fallible;
use crate::read::{Fields, Read, choice};
use boresight_aoa::{EstimatorOptions, Method};
use boresight_core::Array;
use boresight_core::describe::Named;
use wasm_bindgen::JsValue;

impl Read for Method {
    const EXPECTED: &'static str = "the name of a method";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let known: Vec<_> = Self::VARIANTS.iter().map(|method| (method.name(), *method)).collect();
        choice(value, path, &known)
    }
}

/// Reads an estimator: its method, the array it works on, and its options.
pub fn read_estimator(options: &JsValue) -> Fallible<(Method, Array, EstimatorOptions)> {
    let mut fields = Fields::new(options, "")?;
    let estimator = (fields.required("method")?, fields.required("array")?, fields.spread()?);
    fields.finish()?;
    Ok(estimator)
}
