//! Whether a method suits an array.

use crate::error::Fallible;
use crate::options::read_estimator;
use crate::read::Read;
use boresight_aoa::suits::{Unsuited, unsuited as why};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Why options of an estimator cannot work on so many snapshots; null where they can.
#[wasm_bindgen]
pub fn unsuited(options: &JsValue, snapshots: &JsValue) -> Fallible<JsValue> {
    let (method, array, options) = read_estimator(options)?;
    let reason = why(method, &array, &options, usize::read(snapshots, "snapshots")?);
    Ok(reason.map_or(JsValue::NULL, |reason: Unsuited| reason.name().into()))
}
