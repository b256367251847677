//! Simulation of snapshots and data cubes.

use crate::carry;
use crate::error::Fallible;
use crate::imperfections::read_imperfections;
use crate::read::{Angle, Fields, Read};
use boresight_core::{Array, Direction, Waveform};
use boresight_simulate::{
    CubeColumns, CubeOptions, CubeTarget, Field, Fluctuation, Scene, SnapshotOptions,
    SnapshotSimulator, Target, simulate_cube,
};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Snapshots of scenes with given or sampled targets.
#[wasm_bindgen(js_name = simulateSnapshots)]
pub fn simulate_snapshots(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let array: Array = fields.required("array")?;
    let scene: Scene = fields.required("targets")?;
    let snr_db = fields.required("snrDb")?;
    let snapshots = fields.optional("snapshots")?.unwrap_or(1);
    let scenes = fields.optional("scenes")?.unwrap_or(1);
    let first_scene: usize = fields.optional("firstScene")?.unwrap_or(0);
    let fluctuation: Fluctuation = fields.described("fluctuation")?.unwrap_or_default();
    let seed = fields.required("seed")?;
    let imperfections = read_imperfections(&mut fields, &array, seed)?;
    fields.finish()?;
    let options = SnapshotOptions { scene, snr_db, snapshots, fluctuation, imperfections, seed };
    let simulator = SnapshotSimulator::new(&array, &options)?;
    Ok(carry::write(&simulator.scenes(first_scene as u64, scenes)?))
}

/// The cube of a time-division MIMO radar: frames x loops x transmitters x receivers x samples.
#[wasm_bindgen(js_name = simulateCube)]
pub fn simulate_data_cube(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let waveform: Waveform = fields.required("waveform")?;
    let array: Array = fields.required("array")?;
    let targets: Vec<CubeTarget> = fields.required("targets")?;
    let snr_db = fields.required("snrDb")?;
    let frames = fields.optional("frames")?.unwrap_or(1);
    let is_near = fields.optional("nearField")?.unwrap_or(false);
    let field = if is_near { Field::Near } else { Field::Far };
    let seed = fields.required("seed")?;
    let imperfections = read_imperfections(&mut fields, &array, seed)?;
    fields.finish()?;
    let options = CubeOptions { snr_db, frames, field, imperfections, seed };
    let cube = simulate_cube(&waveform, &array, &targets, &options)?;
    Ok(carry::write(&CubeColumns::from(&cube)))
}

impl Read for Scene {
    const EXPECTED: &'static str = "an array of targets, or { count, ... } to sample them";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if js_sys::Array::is_array(value) {
            return Vec::read(value, path).map(Self::Given);
        }
        Ok(Self::Sampled(carry::read_named(value, path)?))
    }
}

impl Read for Target {
    const EXPECTED: &'static str = "{ azimuthDeg }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let azimuth: Angle = fields.required("azimuthDeg")?;
        let target = Self {
            direction: direction(azimuth, &mut fields)?,
            power_db: fields.optional("powerDb")?.unwrap_or(0.0),
            phase_rad: fields.optional::<f64>("phaseDeg")?.map(f64::to_radians),
        };
        fields.finish()?;
        Ok(target)
    }
}

impl Read for CubeTarget {
    const EXPECTED: &'static str = "{ rangeM }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let azimuth = fields.optional("azimuthDeg")?.unwrap_or(Angle { rad: 0.0 });
        let target = Self {
            range_m: fields.required("rangeM")?,
            rate_mps: fields.optional("rateMps")?.unwrap_or(0.0),
            direction: direction(azimuth, &mut fields)?,
            power_db: fields.optional("powerDb")?.unwrap_or(0.0),
            phase_rad: fields.optional::<f64>("phaseDeg")?.map(f64::to_radians),
        };
        fields.finish()?;
        Ok(target)
    }
}

fn direction(azimuth: Angle, fields: &mut Fields) -> Fallible<Direction> {
    let elevation = fields.optional("elevationDeg")?.unwrap_or(Angle { rad: 0.0 });
    Ok(Direction::new(azimuth.rad, elevation.rad))
}
