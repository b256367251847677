//! Simulation of snapshots and data cubes.

use crate::carry;
use crate::error::Fallible;
use crate::given;
use crate::read::{Fields, Read};
use boresight_core::{Array, Waveform};
use boresight_simulate::{CubeColumns, CubeRequest, CubeTarget, Scene, SnapshotRequest};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Snapshots of scenes with given or sampled targets.
#[wasm_bindgen(js_name = simulateSnapshots)]
pub fn simulate_snapshots(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let array: Array = fields.required("array")?;
    let scene: Scene = fields.required("targets")?;
    let request: SnapshotRequest = fields.spread()?;
    fields.finish()?;
    Ok(carry::write(&request.simulate(&array, scene)?))
}

/// The cube of a time-division MIMO radar: frames x loops x transmitters x receivers x samples.
#[wasm_bindgen(js_name = simulateCube)]
pub fn simulate_data_cube(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let waveform: Waveform = fields.required("waveform")?;
    let array: Array = fields.required("array")?;
    let targets: Vec<CubeTarget> = fields.described_required("targets")?;
    let request: CubeRequest = fields.spread()?;
    fields.finish()?;
    Ok(carry::write(&CubeColumns::from(&request.simulate(&waveform, &array, &targets)?)))
}

impl Read for Scene {
    const EXPECTED: &'static str = "an array of targets, or { count, ... } to sample them";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if given::is_array(value) {
            return carry::read_named(value, path).map(Self::Given);
        }
        Ok(Self::Sampled(carry::read_named(value, path)?))
    }
}
