//! Whether a method suits an array.

use crate::error::Fallible;
use crate::options::read_options;
use crate::read::{Fields, Read};
use boresight_aoa::Method;
use boresight_aoa::suits::{Unsuited, unsuited as why};
use boresight_core::Array;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Why options of an estimator cannot work on so many snapshots; null where they can.
#[wasm_bindgen]
pub fn unsuited(options: &JsValue, snapshots: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let method: Method = fields.required("method")?;
    let array: Array = fields.required("array")?;
    let options = read_options(&mut fields)?;
    fields.finish()?;
    let reason = why(method, &array, &options, usize::read(snapshots, "snapshots")?);
    Ok(reason.map_or(JsValue::NULL, |reason: Unsuited| reason.name().into()))
}
