//! Recordings of a cascade of chips.

use crate::bytes::File;
use crate::carry;
use crate::config::read_config;
use crate::error::Fallible;
use crate::read::Read;
use boresight_core::Remark;
use boresight_formats::dca1000::cascade;
use boresight_options::{Described, columns};
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// The files of a cascade as one capture.
#[derive(Described, Serialize)]
pub struct CascadeCapture<'a> {
    /// Bytes that a capture is made of, with the same configuration.
    #[serde(serialize_with = "columns::serialize")]
    pub bytes: Vec<u8>,
    /// What was left out, and what of the indices does not fit.
    pub warnings: &'a [Remark],
}

/// Puts the named files of the four chips together.
#[wasm_bindgen(js_name = joinCascade)]
pub fn join_cascade(files: &JsValue, config: &JsValue) -> Fallible<JsValue> {
    let files = Vec::<File>::read(files, "files")?;
    let (config, _) = read_config(config, "configuration")?;
    let named: Vec<_> = files.iter().map(|file| (&*file.name, &*file.bytes)).collect();
    let joined = cascade::join(&named, &config)?;
    Ok(carry::write(&CascadeCapture { bytes: joined.bytes, warnings: &joined.remarks }))
}
