//! What a board says of its own frames.

use crate::bytes::Bytes;
use crate::carry;
use crate::config::read_config;
use crate::error::Fallible;
use crate::read::Read;
use boresight_formats::{BoardLog, RadarConfig, UartStream};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Reads a recording of a board's data port; the text of its configuration may be `undefined`.
#[wasm_bindgen(js_name = parseBoardLog)]
pub fn parse_board_log(bytes: &JsValue, config: &JsValue) -> Fallible<JsValue> {
    let bytes = Bytes::read(bytes, "board log")?.0;
    Ok(carry::write(&BoardLog::parse(&bytes, optional_config(config)?.as_ref())))
}

/// Takes the bytes of a board's data port piece by piece.
#[wasm_bindgen]
pub struct BoardLogStream {
    inner: UartStream,
}

#[wasm_bindgen]
impl BoardLogStream {
    /// A stream; the text of the board's configuration may be `undefined`.
    #[wasm_bindgen(constructor)]
    pub fn new(config: &JsValue) -> Fallible<Self> {
        Ok(Self { inner: UartStream::new(optional_config(config)?.as_ref()) })
    }

    /// Takes the next bytes and gives the packets they complete.
    pub fn push(&mut self, bytes: &JsValue) -> Fallible<JsValue> {
        let bytes = Bytes::read(bytes, "bytes")?.0;
        Ok(carry::write(&self.inner.push(&bytes)))
    }

    /// Ends the input and gives what was still held back.
    pub fn finish(&mut self) -> JsValue {
        carry::write(&self.inner.finish())
    }

    /// What was skipped or damaged so far.
    pub fn counts(&self) -> JsValue {
        carry::write(&self.inner.counts())
    }
}

fn optional_config(text: &JsValue) -> Fallible<Option<RadarConfig>> {
    if text.is_undefined() {
        Ok(None)
    } else {
        read_config(text, "configuration").map(|(config, _)| Some(config))
    }
}
