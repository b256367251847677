//! Waveforms and the numbers that follow from them.

use crate::error::Fallible;
use crate::read::{Fields, Read};
use crate::write::Record;
use boresight_core::Waveform;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

impl Read for Waveform {
    const EXPECTED: &'static str = "a waveform";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let waveform = Self {
            start_frequency_hz: fields.required("startFrequencyHz")?,
            slope_hz_per_s: fields.required("slopeHzPerS")?,
            sample_rate_hz: fields.required("sampleRateHz")?,
            samples: fields.required("samples")?,
            adc_start_s: fields.required("adcStartS")?,
            chirp_interval_s: fields.required("chirpIntervalS")?,
            transmitters: fields.required("transmitters")?,
            loops: fields.required("loops")?,
            frame_interval_s: fields.required("frameIntervalS")?,
        };
        fields.finish()?;
        waveform.check()?;
        Ok(waveform)
    }
}

/// Resolutions and limits of a waveform.
#[wasm_bindgen(js_name = waveformSummary)]
pub fn waveform_summary(waveform: &JsValue) -> Fallible<JsValue> {
    Ok(summary_record(&Waveform::read(waveform, "waveform")?).into())
}

/// A waveform as a plain object.
pub fn waveform_record(waveform: &Waveform) -> Record {
    Record::new()
        .with("startFrequencyHz", waveform.start_frequency_hz)
        .with("slopeHzPerS", waveform.slope_hz_per_s)
        .with("sampleRateHz", waveform.sample_rate_hz)
        .with("samples", waveform.samples)
        .with("adcStartS", waveform.adc_start_s)
        .with("chirpIntervalS", waveform.chirp_interval_s)
        .with("transmitters", waveform.transmitters)
        .with("loops", waveform.loops)
        .with("frameIntervalS", waveform.frame_interval_s)
}

/// What follows from a waveform as a plain object.
pub fn summary_record(waveform: &Waveform) -> Record {
    Record::new()
        .with("bandwidthHz", waveform.bandwidth_hz())
        .with("centreFrequencyHz", waveform.centre_frequency_hz())
        .with("wavelengthM", waveform.wavelength_m())
        .with("rangeResolutionM", waveform.range_resolution_m())
        .with("maxRangeM", waveform.max_range_m())
        .with("rateResolutionMps", waveform.rate_resolution_mps())
        .with("maxRateMps", waveform.max_rate_mps())
        .with("frameTimeS", waveform.loop_interval_s() * waveform.loops as f64)
}
