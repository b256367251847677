//! Waveforms and the numbers that follow from them.

use crate::carry;
use crate::error::Fallible;
use crate::read::Read;
use boresight_core::Waveform;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

impl Read for Waveform {
    const EXPECTED: &'static str = "a waveform";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let waveform: Self = carry::read_named(value, path)?;
        waveform.check()?;
        Ok(waveform)
    }
}

/// Resolutions and limits of a waveform.
#[wasm_bindgen(js_name = waveformSummary)]
pub fn waveform_summary(waveform: &JsValue) -> Fallible<JsValue> {
    Ok(carry::write(&Waveform::read(waveform, "waveform")?.summary()))
}
