//! Configurations of mmWave boards.

use crate::bytes::Text;
use crate::error::Fallible;
use crate::read::Read;
use crate::waveform::{summary_record, waveform_record};
use crate::write::{Record, list, remarks};
use boresight_formats::RadarConfig;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Reads the text of a `.cfg` file.
#[wasm_bindgen(js_name = parseConfig)]
pub fn parse_config(text: &JsValue) -> Fallible<JsValue> {
    Ok(config_record(&read_config(text, "configuration")?).into())
}

/// A configuration from its text.
pub fn read_config(text: &JsValue, path: &str) -> Fallible<RadarConfig> {
    Ok(RadarConfig::parse(&Text::read(text, path)?.0)?)
}

/// A configuration as a plain object.
pub fn config_record(config: &RadarConfig) -> Record {
    Record::new()
        .with("waveform", waveform_record(&config.waveform))
        .with("summary", summary_record(&config.waveform))
        .with("receivers", config.receivers.len())
        .with("transmitters", config.transmitters.len())
        .with("receiverNumbers", list(config.receivers.iter().copied()))
        .with("transmitterNumbers", list(config.transmitters.iter().copied()))
        .with("array", or_null(config.array_preset))
        .with("platform", or_null(config.platform.as_deref()))
        .with("sdkVersion", or_null(config.sdk_version.as_deref()))
        .with("sampleBits", config.adc.bits)
        .with("frameBytes", config.frame_bytes() as f64)
        .with("frames", config.frames.map_or(JsValue::NULL, JsValue::from))
        .with("warnings", remarks(&config.remarks))
}

fn or_null(text: Option<&str>) -> JsValue {
    text.map_or(JsValue::NULL, JsValue::from)
}
