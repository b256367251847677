//! Options of the estimators out of JavaScript.

use crate::error::Fallible;
use crate::read::{Read, choice};
use boresight_aoa::Method;
use wasm_bindgen::JsValue;

impl Read for Method {
    const EXPECTED: &'static str = "the name of a method";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let known: Vec<_> = Self::ALL
            .iter()
            .chain(&Self::NETWORKS)
            .map(|method| (method.name(), *method))
            .collect();
        choice(value, path, &known)
    }
}
