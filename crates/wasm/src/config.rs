//! Configurations of mmWave boards.

use crate::bytes::Text;
use crate::carry;
use crate::error::Fallible;
use crate::given;
use crate::read::{Fields, Read};
use boresight_core::{Remark, Waveform, WaveformSummary};
use boresight_formats::{Layout, RadarConfig, ReadingOptions};
use boresight_options::Described;
use js_sys::ArrayBuffer;
use serde::Serialize;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

/// Reads the text of a `.cfg` file.
#[wasm_bindgen(js_name = parseConfig)]
pub fn parse_config(text: &JsValue) -> Fallible<JsValue> {
    Ok(carry::write(&ConfigRecord::from(&read_config(text, "configuration")?.0)))
}

/// The text of a `.cfg` file with a comment that chooses one of its sub-frames.
#[wasm_bindgen(js_name = subFrameConfig)]
pub fn sub_frame_config(text: &JsValue, sub_frame: &JsValue) -> Fallible<String> {
    let bytes = Text::read(text, "configuration")?.0;
    let sub_frame = usize::read(sub_frame, "sub_frame")?;
    RadarConfig::parse(&bytes)?.choose(sub_frame)?;
    Ok(format!("{}\n% Sub-frame: {sub_frame}\n", String::from_utf8_lossy(&bytes).trim_end()))
}

/// A configuration from its text, or from an object of the text with what overrides it in how samples are read; that
/// is put into it, and given beside it.
pub fn read_config(value: &JsValue, path: &str) -> Fallible<(RadarConfig, ReadingOptions)> {
    let (text, reading) = match Text::read(value, path) {
        Err(_) if given::is_plain(value) && !is_bytes(value) => {
            let mut fields = Fields::new(value, path)?;
            let text = fields.required("text")?;
            let reading = fields.spread()?;
            fields.finish()?;
            (text, reading)
        }
        text => (text?, ReadingOptions::default()),
    };
    let Text(text) = text;
    let mut config = RadarConfig::parse(&text)?;
    reading.apply(&mut config)?;
    Ok((config, reading))
}

/// Whether a value is meant as the bytes of a text, though they cannot be had.
fn is_bytes(value: &JsValue) -> bool {
    ArrayBuffer::is_view(value) || value.has_type::<ArrayBuffer>()
}

/// What a configuration says of the radar and its samples.
#[derive(Described, Serialize)]
#[option(name = "RadarConfig")]
pub struct ConfigRecord<'a> {
    /// Timing and frequency plan of a frame.
    waveform: Waveform,
    /// What follows from it.
    summary: WaveformSummary,
    /// Number of receivers in use.
    receivers: usize,
    /// Number of transmitters in use.
    transmitters: usize,
    /// Numbers of the receivers on the chip, from 0.
    receiver_numbers: &'a [usize],
    /// Numbers of the transmitters on the chip, from 0, in order of transmission.
    transmitter_numbers: &'a [usize],
    /// Preset that fits the platform and channels, if there is one.
    array: Option<&'static str>,
    /// Platform named in a comment, such as `xWR16xx`.
    platform: Option<&'a str>,
    /// Version of the board's software named in a comment, such as `02.00`.
    sdk_version: Option<&'a str>,
    /// Bits of a sample.
    sample_bits: u32,
    /// Order of I and Q that samples are read with.
    #[option(typescript = "'iq' | 'qi'")]
    iq_order: &'static str,
    /// Where samples stand in the bytes.
    layout: Layout,
    /// Sub-frames of a frame; 1 for frames without.
    sub_frames: usize,
    /// The one that waveform and transmitters are of, from 0.
    sub_frame: usize,
    /// Bytes of one frame of raw samples, with all of its sub-frames.
    frame_bytes: u64,
    /// Frames to record; null until stopped.
    frames: Option<usize>,
    /// Lines that were not understood, and other remarks.
    warnings: &'a [Remark],
}

impl<'a> From<&'a RadarConfig> for ConfigRecord<'a> {
    fn from(config: &'a RadarConfig) -> Self {
        Self {
            waveform: config.waveform,
            summary: config.waveform.summary(),
            receivers: config.receivers.len(),
            transmitters: config.transmitters.len(),
            receiver_numbers: &config.receivers,
            transmitter_numbers: &config.transmitters,
            array: config.array_preset,
            platform: config.platform.as_deref(),
            sdk_version: config.sdk_version.as_deref(),
            sample_bits: config.adc.bits,
            iq_order: if config.adc.q_first { "qi" } else { "iq" },
            layout: config.adc.layout,
            sub_frames: config.sub_frames.len(),
            sub_frame: config.sub_frame,
            frame_bytes: config.frame_bytes(),
            frames: config.frames,
            warnings: &config.remarks,
        }
    }
}
