//! Regions of the range spectrum, their targets counted and told apart by three networks, or fitted without any.

use crate::network::Network;
use boresight_core::{Array, Waveform};
use boresight_neural::RegionNetworks;
use boresight_pipeline::regions::RegionChainOptions;
use boresight_pipeline::{FrameSource, RegionChain};
use boresight_wasm::calibrated::ArrayChoice;
use boresight_wasm::capture::{Capture, cube_frames};
use boresight_wasm::carry;
use boresight_wasm::complex::Cube;
use boresight_wasm::error::{BindingError, Fallible};
use boresight_wasm::read::{Fields, Read};
use std::ops::{ControlFlow, Range};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Regions and targets of each frame of a cube: frames x loops x transmitters x receivers x samples.
#[wasm_bindgen(js_name = cubeRegions)]
pub fn cube_regions(
    counting: &Network,
    one: &Network,
    two: &Network,
    cube: &JsValue,
    options: &JsValue,
) -> Fallible<js_sys::Array> {
    of_cube(Some([counting, one, two]), cube, options)
}

/// As [`cube_regions`], without networks.
#[wasm_bindgen(js_name = jointCubeRegions)]
pub fn joint_cube_regions(cube: &JsValue, options: &JsValue) -> Fallible<js_sys::Array> {
    of_cube(None, cube, options)
}

/// Regions and targets of each frame of a capture, or of one.
#[wasm_bindgen(js_name = captureRegions)]
pub fn capture_regions(
    counting: &Network,
    one: &Network,
    two: &Network,
    bytes: &JsValue,
    config: &JsValue,
    options: &JsValue,
    frame: &JsValue,
) -> Fallible<js_sys::Array> {
    of_capture(Some([counting, one, two]), bytes, config, options, frame)
}

/// As [`capture_regions`], without networks.
#[wasm_bindgen(js_name = jointCaptureRegions)]
pub fn joint_capture_regions(
    bytes: &JsValue,
    config: &JsValue,
    options: &JsValue,
    frame: &JsValue,
) -> Fallible<js_sys::Array> {
    of_capture(None, bytes, config, options, frame)
}

fn of_cube(
    networks: Option<[&Network; 3]>,
    cube: &JsValue,
    options: &JsValue,
) -> Fallible<js_sys::Array> {
    let cube = Cube::read(cube, "cube")?;
    let source = cube_frames(&cube)?;
    let mut fields = Fields::new(options, "")?;
    let waveform: Waveform = fields.required("waveform")?;
    let array = ArrayChoice::read(&mut fields)?.required()?;
    let options = fields.spread()?;
    fields.finish()?;
    let receivers = source.0.len_of(ndarray::Axis(3));
    let mut chain = chain(networks, &waveform, receivers, &array, &options)?;
    written(&mut chain, &source, 0..source.frames())
}

fn of_capture(
    networks: Option<[&Network; 3]>,
    bytes: &JsValue,
    config: &JsValue,
    options: &JsValue,
    frame: &JsValue,
) -> Fallible<js_sys::Array> {
    let capture = Capture::new(bytes, config)?;
    let frames = capture.read_frames(frame)?;
    let mut fields = Fields::of_optional(options)?;
    let array = capture.array_or(ArrayChoice::read(&mut fields)?)?;
    let options = fields.spread()?;
    fields.finish()?;
    let (waveform, receivers, source) = capture.recording()?;
    let mut chain = chain(networks, &waveform, receivers, &array, &options)?;
    written(&mut chain, &source, frames)
}

fn chain(
    networks: Option<[&Network; 3]>,
    waveform: &Waveform,
    receivers: usize,
    array: &Array,
    options: &RegionChainOptions,
) -> Fallible<RegionChain> {
    let Some([counting, one, two]) = networks else {
        return Ok(RegionChain::joint(waveform, receivers, array, options)?);
    };
    let networks = RegionNetworks { counting: &counting.model, one: &one.model, two: &two.model };
    let counted = networks.counted(array, options.refine)?;
    Ok(RegionChain::new(waveform, receivers, options, counted)?)
}

fn written<S: FrameSource>(
    chain: &mut RegionChain,
    source: &S,
    frames: Range<usize>,
) -> Fallible<js_sys::Array>
where
    BindingError: From<S::Error>,
{
    let results = js_sys::Array::new();
    let take = |result| {
        results.push(&carry::write(&result));
    };
    chain.each(source, frames, take, &mut |_| ControlFlow::Continue(()))?;
    Ok(results)
}
