//! Cramer-Rao bounds.

use crate::carry;
use crate::error::Fallible;
use crate::read::Fields;
use boresight_aoa::bounds::{BoundRequest, BoundTarget, target_bound};
use boresight_core::Array;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Bounds of the angles of uncorrelated targets; of a single snapshot with the given phases.
#[wasm_bindgen(js_name = cramerRaoBound)]
pub fn cramer_rao_bound(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let array: Array = fields.required("array")?;
    let targets: Vec<BoundTarget> = fields.described_required("targets")?;
    let options: BoundRequest = fields.spread()?;
    fields.finish()?;
    Ok(carry::write(&target_bound(&array, &targets, &options)?))
}
