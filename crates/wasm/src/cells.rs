//! Detected cells of a frame, for estimating their angles elsewhere.

use crate::capture::Capture;
use crate::carry;
use crate::chain::{read_angle, read_cube_chain};
use crate::complex::Cube;
use crate::error::Fallible;
use crate::estimate::shape_error;
use crate::read::{Fields, Read};
use boresight_aoa as aoa;
use boresight_core::Array;
use boresight_pipeline::{AngleOptions, Chain, suited};
use ndarray::ArrayView4;
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Detected cells of a cube of one frame: loops x transmitters x receivers x samples, with or
/// without an axis of frames before.
#[wasm_bindgen(js_name = frameCells)]
pub fn frame_cells(cube: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let (waveform, array, options) = read_cube_chain(options)?;
    let cube = Cube::read(cube, "cube")?;
    let expected = "[loops, transmitters, receivers, samples], or that after one frame";
    let wrong = || shape_error("cube", expected, &cube.shape);
    let shape = match cube.shape[..] {
        [a, b, c, d] | [1, a, b, c, d] => (a, b, c, d),
        _ => return Err(wrong()),
    };
    let frame = ArrayView4::from_shape(shape, &cube.data).map_err(|_| wrong())?;
    let mut chain = Chain::new(&waveform, shape.2, &array, &options)?;
    Ok(carry::write(&chain.cells(frame)?))
}

#[wasm_bindgen]
impl Capture {
    /// Detected cells of one frame.
    #[wasm_bindgen(js_name = frameCells)]
    pub fn frame_cells(&mut self, frame: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        Ok(carry::write(&self.cells_of(frame, options)?))
    }
}

/// What the chain changes in the options of a method.
#[derive(Serialize)]
struct Suited {
    dynamic_range_db: f64,
    loading: f64,
}

/// What the chain changes in the options of a method so that a cell gives sources only:
/// `{ dynamicRangeDb, loading }`.
#[wasm_bindgen(js_name = suitedAngle)]
pub fn suited_angle(array: &JsValue, angle: &JsValue) -> Fallible<JsValue> {
    let array = Array::read(array, "array")?;
    let AngleOptions { method, options } = read_angle(Fields::of_optional(angle)?)?;
    options.check()?;
    let aoa::Options { dynamic_range_db, loading, .. } = suited(method, &array, &options);
    Ok(carry::write(&Suited { dynamic_range_db, loading }))
}
