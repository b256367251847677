//! Detections and snapshots as CSV.

use crate::bytes::Text;
use crate::carry;
use crate::complex::ComplexData;
use crate::error::Fallible;
use crate::estimate::as_matrix;
use crate::read::{Read, items};
use boresight_formats::tables::{
    DetectionRow, read_detections, read_snapshots, write_detections, write_snapshots,
};
use boresight_options::shaped::ComplexArray;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Detections as a table.
#[wasm_bindgen(js_name = writeDetectionsCsv)]
pub fn write_detections_csv(detections: &JsValue) -> Fallible<String> {
    let rows: Vec<DetectionRow> = items(detections, "detections")?
        .iter()
        .map(|(item, path)| carry::read_named(item, path))
        .collect::<Fallible<_>>()?;
    Ok(write_detections(&rows))
}

/// Detections from a table.
#[wasm_bindgen(js_name = readDetectionsCsv)]
pub fn read_detections_csv(text: &JsValue) -> Fallible<js_sys::Array> {
    Ok(carry::write_all(read_detections(&Text::read(text, "table")?.0)?))
}

/// Snapshots, elements x snapshots, as a table.
#[wasm_bindgen(js_name = writeSnapshotsCsv)]
pub fn write_snapshots_csv(snapshots: &JsValue) -> Fallible<String> {
    let snapshots = ComplexData::read(snapshots, "snapshots")?;
    Ok(write_snapshots(as_matrix(&snapshots, "snapshots")?))
}

/// Snapshots from a table.
#[wasm_bindgen(js_name = readSnapshotsCsv)]
pub fn read_snapshots_csv(text: &JsValue) -> Fallible<JsValue> {
    let snapshots = read_snapshots(&Text::read(text, "table")?.0)?;
    Ok(carry::write(&ComplexArray::from(&snapshots)))
}
