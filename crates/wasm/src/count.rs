//! Counting sources.

use crate::carry;
use crate::error::Fallible;
use crate::estimate::Input;
use crate::read::Read;
use boresight_aoa::order::counting::{CountOptions, count_sources_in};
use boresight_options::{Described, columns};
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// How many sources there are, and why.
#[derive(Described, Serialize)]
pub struct CountResult {
    /// Number of sources.
    count: usize,
    /// Eigenvalues of the covariance, largest first.
    #[serde(serialize_with = "columns::serialize")]
    eigenvalues: Vec<f64>,
    /// For 0, 1, 2, ... sources: the information criterion, smallest at their number, or the largest eigenvalue left over the
    /// level of the largest-root test, above 1 for a source. Empty where nothing can be tested: of a single snapshot.
    #[serde(serialize_with = "columns::serialize")]
    criterion: Vec<f64>,
}

/// Counts sources by the eigenvalues of the covariance.
#[wasm_bindgen(js_name = countSources)]
pub fn count_sources(input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let input = Input::read(input, "input")?;
    let options: CountOptions = carry::read_optional(options)?;
    let (eigenvalues, count) = count_sources_in(input.data()?, &options)?;
    Ok(carry::write(&CountResult { count: count.sources, eigenvalues, criterion: count.values }))
}
