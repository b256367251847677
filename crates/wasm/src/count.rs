//! Counting sources.

use crate::error::Fallible;
use crate::estimate::Input;
use crate::read::{Fields, Read};
use crate::write::{Record, float64};
use boresight_aoa::counting::{Criterion, count_sources_in};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Counts sources by an information criterion on the eigenvalues of the covariance.
#[wasm_bindgen(js_name = countSources)]
pub fn count_sources(input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let input = Input::read(input, "input")?;
    let mut fields = Fields::of_optional(options)?;
    let mut criterion = Criterion::Mdl;
    let criteria = [("aic", Criterion::Aic), ("mdl", Criterion::Mdl)];
    fields.update_choice("criterion", &criteria, &mut criterion)?;
    let average_reversed = fields.optional("forwardBackward")?.unwrap_or(false);
    fields.finish()?;
    let (eigenvalues, count) = count_sources_in(input.data()?, average_reversed, criterion)?;
    Ok(Record::new()
        .with("count", count.sources)
        .with("eigenvalues", float64(&eigenvalues))
        .with("criterion", float64(&count.values))
        .into())
}
