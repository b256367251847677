//! Configurations of mmWave Studio.

use crate::bytes::Text;
use crate::error::Fallible;
use crate::read::Read;
use boresight_formats::mmwave_studio;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Translates the JSON of mmWave Studio into the text of a `.cfg` file.
#[wasm_bindgen(js_name = studioConfig)]
pub fn studio_config(mmwave: &JsValue, setup: &JsValue) -> Fallible<String> {
    let Text(mmwave) = Text::read(mmwave, "mmwave")?;
    let setup = match setup.is_undefined() {
        true => None,
        false => Some(Text::read(setup, "setup")?.0),
    };
    Ok(mmwave_studio::config_text(&mmwave, setup.as_deref())?)
}
