//! What a board says of its own frames.

use crate::bytes::Bytes;
use crate::config::read_config;
use crate::error::Fallible;
use crate::read::Read;
use crate::write::{Record, float64, list, remarks};
use boresight_formats::{BoardFrame, BoardLog, BoardObject, RadarConfig, UartStream};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Reads a recording of a board's data port; the text of its configuration may be `undefined`.
#[wasm_bindgen(js_name = parseBoardLog)]
pub fn parse_board_log(bytes: &JsValue, config: &JsValue) -> Fallible<JsValue> {
    let bytes = Bytes::read(bytes, "board log")?.0;
    let log = BoardLog::parse(&bytes, optional_config(config)?.as_ref());
    Ok(Record::new()
        .with("frames", list(log.frames.iter().map(frame_record)))
        .with("skippedBytes", log.skipped_bytes as f64)
        .with("damagedPackets", log.damaged_packets as f64)
        .with("warnings", remarks(&log.remarks))
        .into())
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
        Ok(list(self.inner.push(&bytes).iter().map(frame_record)).into())
    }

    /// Ends the input and gives what was still held back.
    pub fn finish(&mut self) -> JsValue {
        list(self.inner.finish().iter().map(frame_record)).into()
    }

    /// What was skipped or damaged so far.
    pub fn counts(&self) -> JsValue {
        Record::new()
            .with("skippedBytes", self.inner.skipped_bytes() as f64)
            .with("damagedPackets", self.inner.damaged_packets() as f64)
            .with("warnings", remarks(&self.inner.remarks()))
            .into()
    }
}

fn optional_config(text: &JsValue) -> Fallible<Option<RadarConfig>> {
    if text.is_undefined() { Ok(None) } else { read_config(text, "configuration").map(Some) }
}

fn frame_record(frame: &BoardFrame) -> Record {
    let sdk_version = frame.sdk_version.map(|part| part.to_string()).join(".");
    let profile = |db: &Option<Vec<f64>>| db.as_deref().map(float64);
    Record::new()
        .with("frameNumber", frame.frame_number)
        .with("platform", frame.platform.as_str())
        .with("sdkVersion", sdk_version)
        .with("objects", list(frame.objects.iter().map(object_record)))
        .with_some("rangeProfileDb", profile(&frame.range_profile_db))
        .with_some("noiseProfileDb", profile(&frame.noise_profile_db))
        .with("complete", frame.complete)
}

fn object_record(object: &BoardObject) -> Record {
    Record::new()
        .with("rangeM", object.range_m)
        .with("rateMps", object.rate_mps.map_or(JsValue::NULL, JsValue::from))
        .with("azimuthDeg", object.azimuth_rad.to_degrees())
        .with("elevationDeg", object.elevation_rad.to_degrees())
        .with("xM", object.x_m)
        .with("yM", object.y_m)
        .with("zM", object.z_m)
        .with_some("rangeBin", object.bins.map(|(range, _)| range))
        .with_some("dopplerBin", object.bins.map(|(_, doppler)| doppler))
        .with_some("peak", object.peak)
        .with_some("snrDb", object.snr_db)
}
