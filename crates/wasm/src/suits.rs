//! Whether a method suits an array.

use crate::carry;
use crate::error::Fallible;
use crate::options::read_estimator;
use crate::read::Read;
use boresight_aoa::suits::unsuited as why;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Why options of an estimator cannot work on so many snapshots; null where they can.
#[wasm_bindgen]
pub fn unsuited(options: &JsValue, snapshots: &JsValue) -> Fallible<JsValue> {
    let (method, array, options) = read_estimator(options)?;
    Ok(carry::write(&why(method, &array, &options, usize::read(snapshots, "snapshots")?)))
}
