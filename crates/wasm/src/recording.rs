//! Recordings in several files: parts of a long one, and those of a cascade of chips.

use crate::bytes::File;
use crate::carry;
use crate::config::read_config;
use crate::error::Fallible;
use crate::read::Read;
use boresight_core::Remark;
use boresight_formats::dca1000::{cascade, parts};
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

/// The files of one recording.
#[derive(Described, Serialize)]
pub struct RecordingParts {
    /// Indices of the files in order of time; of a cascade, in order of name.
    pub order: Vec<usize>,
    /// Whether they are the files of a cascade, which `joinCascade` joins.
    pub cascade: bool,
    /// Names of files that are missing between them.
    pub missing: Vec<String>,
}

/// Orders the files of a recording by their names.
#[wasm_bindgen(js_name = recordingParts)]
pub fn recording_parts(names: &JsValue) -> Fallible<JsValue> {
    let names = Vec::<String>::read(names, "names")?;
    let parts = parts::parts(&names.iter().map(String::as_str).collect::<Vec<_>>())?;
    let parts::Parts { order, is_cascade: cascade, missing } = parts;
    Ok(carry::write(&RecordingParts { order, cascade, missing }))
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
