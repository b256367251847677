//! What one call may take.

use crate::error::Fallible;
use crate::read::Fields;
use boresight_core::Limits;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// The limits of calls to come; those that are not named go back to their defaults.
#[wasm_bindgen(js_name = setLimits)]
pub fn set_limits(limits: &JsValue) -> Fallible<()> {
    let mut fields = Fields::of_optional(limits)?;
    let limits: Limits = fields.spread()?;
    fields.finish()?;
    Ok(limits.set()?)
}
