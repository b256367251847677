//! Simulation of snapshots and data cubes.

use crate::error::Fallible;
use crate::imperfections::read_imperfections;
use crate::read::{Angle, Fields, Read};
use crate::write::{Record, complex32, complex64, list};
use boresight_core::{Array, Direction, Waveform};
use boresight_simulate::{
    CubeOptions, CubeTarget, Field, Fluctuation, Scene, SceneSampling, SnapshotOptions,
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
    let mut fluctuation = Fluctuation::default();
    let kinds = [
        ("random-phase", Fluctuation::RandomPhase),
        ("complex-normal", Fluctuation::ComplexNormal),
        ("coherent", Fluctuation::Coherent),
    ];
    fields.update_choice("fluctuation", &kinds, &mut fluctuation)?;
    let seed = fields.required("seed")?;
    let imperfections = read_imperfections(&mut fields, &array, seed)?;
    fields.finish()?;
    let options = SnapshotOptions { scene, snr_db, snapshots, fluctuation, imperfections, seed };
    let simulator = SnapshotSimulator::new(&array, &options)?;
    let simulated = simulator.scenes(first_scene as u64, scenes)?;
    let truth = simulated.truth.iter().map(|targets| list(targets.iter().map(target_record)));
    Ok(Record::new()
        .with("data", complex64(&simulated.values.iter().copied().collect::<Vec<_>>()))
        .with("shape", list(simulated.values.shape().iter().copied()))
        .with("truth", list(truth))
        .into())
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
    Ok(Record::new()
        .with("data", complex32(&cube.iter().copied().collect::<Vec<_>>()))
        .with("shape", list(cube.shape().iter().copied()))
        .into())
}

impl Read for Scene {
    const EXPECTED: &'static str = "an array of targets, or { count, ... } to sample them";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if js_sys::Array::is_array(value) {
            return Vec::read(value, path).map(Self::Given);
        }
        let mut sampling = SceneSampling::default();
        let mut fields = Fields::new(value, path)?;
        fields.update("count", &mut sampling.targets)?;
        if let Some(half) = fields.optional::<Angle>("fieldOfViewDeg")? {
            sampling.field_of_view_rad = half.rad;
        }
        if let Some(half) = fields.optional::<Angle>("elevationFieldOfViewDeg")? {
            sampling.elevation_field_of_view_rad = half.rad;
        }
        fields.update("powerDb", &mut sampling.power_db)?;
        fields.finish()?;
        Ok(Self::Sampled(sampling))
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

fn target_record(target: &Target) -> Record {
    Record::new()
        .with("azimuthDeg", target.direction.azimuth_rad.to_degrees())
        .with("elevationDeg", target.direction.elevation_rad.to_degrees())
        .with("powerDb", target.power_db)
        .with_some("phaseDeg", target.phase_rad.map(f64::to_degrees))
}
