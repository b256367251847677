//! Detected cells of a frame, for estimating their angles elsewhere.

use crate::capture::Capture;
use crate::carry;
use crate::chain::read_cube_chain;
use crate::complex::Cube;
use crate::error::Fallible;
use crate::read::Read;
use boresight_pipeline::Chain;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Detected cells of a cube of one frame: loops x transmitters x receivers x samples, with or
/// without an axis of frames before.
#[wasm_bindgen(js_name = frameCells)]
pub fn frame_cells(cube: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let (waveform, array, options) = read_cube_chain(options)?;
    let cube = Cube::read(cube, "cube")?;
    let frame = cube.one_frame()?;
    let mut chain = Chain::new(&waveform, frame.dim().2, &array, &options)?;
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
