//! Options of the chain from frames to detections.

use crate::calibrated::ArrayChoice;
use crate::error::Fallible;
use crate::read::Fields;
use boresight_core::{Array, Waveform};
use boresight_pipeline::{AngleOptions, ChainOptions};
use wasm_bindgen::JsValue;

/// Reads the options of the chain over a cube, of which nothing else is known.
pub fn read_cube_chain(options: &JsValue) -> Fallible<(Waveform, Array, ChainOptions)> {
    let mut fields = Fields::new(options, "")?;
    let waveform = fields.required("waveform")?;
    let (array, options) = read_chain(&mut fields)?;
    fields.finish()?;
    Ok((waveform, array.required()?, options))
}

/// Reads the options of the chain, and the array where one is named.
pub fn read_chain(fields: &mut Fields) -> Fallible<(ArrayChoice, ChainOptions)> {
    Ok((ArrayChoice::read(fields)?, fields.spread()?))
}

/// Reads a method with its options; the conventional beamformer where none is named.
pub fn read_angle(mut fields: Fields) -> Fallible<AngleOptions> {
    let angle = fields.spread()?;
    fields.finish()?;
    Ok(angle)
}
