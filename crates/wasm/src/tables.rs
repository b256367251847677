//! Detections and snapshots as CSV.

use crate::bytes::Text;
use crate::complex::ComplexData;
use crate::error::Fallible;
use crate::estimate::as_matrix;
use crate::read::{Fields, Read};
use crate::write::{Record, complex64, list};
use boresight_formats::tables::{
    DetectionRow, read_detections, read_snapshots, write_detections, write_snapshots,
};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Detections as a table.
#[wasm_bindgen(js_name = writeDetectionsCsv)]
pub fn write_detections_csv(detections: &JsValue) -> Fallible<String> {
    Ok(write_detections(&Vec::<DetectionRow>::read(detections, "detections")?))
}

/// Detections from a table.
#[wasm_bindgen(js_name = readDetectionsCsv)]
pub fn read_detections_csv(text: &JsValue) -> Fallible<js_sys::Array> {
    Ok(list(read_detections(&Text::read(text, "table")?.0)?.iter().map(detection_record)))
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
    let numbers: Vec<_> = snapshots.iter().copied().collect();
    Ok(Record::new()
        .with("data", complex64(&numbers))
        .with("shape", list([snapshots.nrows(), snapshots.ncols()]))
        .into())
}

impl Read for DetectionRow {
    const EXPECTED: &'static str = "a detection";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let row = Self {
            frame: fields.required("frame")?,
            range_m: fields.required("rangeM")?,
            rate_mps: fields.required("rateMps")?,
            azimuth_rad: fields.required::<f64>("azimuthDeg")?.to_radians(),
            elevation_rad: fields.required::<f64>("elevationDeg")?.to_radians(),
            power_db: fields.required("powerDb")?,
            snr_db: fields.required("snrDb")?,
            range_bin: fields.required("rangeBin")?,
            doppler_bin: fields.required("dopplerBin")?,
        };
        fields.finish()?;
        Ok(row)
    }
}

fn detection_record(row: &DetectionRow) -> Record {
    Record::new()
        .with("frame", row.frame)
        .with("rangeM", row.range_m)
        .with("rateMps", row.rate_mps)
        .with("azimuthDeg", row.azimuth_rad.to_degrees())
        .with("elevationDeg", row.elevation_rad.to_degrees())
        .with("powerDb", row.power_db)
        .with("snrDb", row.snr_db)
        .with("rangeBin", row.range_bin)
        .with("dopplerBin", row.doppler_bin)
}
