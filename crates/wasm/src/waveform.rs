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

/// Names of the waveforms known by name.
#[cfg(feature = "core")]
#[wasm_bindgen(js_name = waveformPresets)]
pub fn presets() -> Vec<String> {
    boresight_simulate::waveform_presets().map(Into::into).collect()
}

/// The waveform of a name.
#[cfg(feature = "core")]
#[wasm_bindgen(js_name = waveformPreset)]
pub fn preset(name: &JsValue) -> Fallible<JsValue> {
    let name = String::read(name, "name")?;
    Ok(carry::write(&boresight_simulate::waveform_preset(&name)?))
}
