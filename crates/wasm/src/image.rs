//! Range-azimuth maps, bird's-eye views and the measure of their sidelobes.

use crate::carry;
use crate::complex::float_array;
use crate::error::{BindingError, Fallible};
use crate::estimate::shape_error;
use crate::given;
use crate::read::{Fields, Read, wrong_type};
use boresight_aoa::{Method, SpectrumKind};
use boresight_core::drive::Mounting;
use boresight_core::{Array, InputError, Waveform};
use boresight_image::{
    Axis, BirdsEyeView, Gate, Grid, GridOptions, Outside, RangeAzimuthDoppler, RangeAzimuthMap,
    SpectrumPlan, Target, ViewGrid, birds_eye_view, sidelobe_measure,
};
use boresight_math::decibels::db_to_power;
use boresight_math::error::check_range;
use boresight_options::{Described, Flat};
use boresight_pipeline::image::{Angles, Content, chain_options, map_grid};
use boresight_pipeline::{AngleOptions, ChainOptions, suited};
use boresight_signal::CfarOptions;
use js_sys::{Int8Array, Uint32Array};
use ndarray::Array2;
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Adds the targets or spectra of a frame's cells up to a map.
#[wasm_bindgen(js_name = rangeAzimuthMap)]
pub fn range_azimuth_map(input: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(input, "")?;
    let cells = Cells::read(fields.object("cells")?)?;
    let estimates = fields.object("estimates")?;
    let mut estimates = estimates.ok_or_else(|| missing("estimates", "estimates of the cells"))?;
    let from = fields.described("from")?.unwrap_or(Content::Targets);
    let grid = Grid::of(&fields.described_required("grid")?)?;
    fields.finish()?;
    let mut image = RangeAzimuthDoppler::new(grid, None)?;
    match from {
        Content::Spectra => add_spectra(&mut image, &cells, &mut estimates)?,
        Content::Targets => add_targets(&mut image, &cells, &mut estimates)?,
    }
    Ok(carry::write(&image.to_map().columns()))
}

/// What a map needs of cells.
struct Cells {
    range_m: Vec<f64>,
    power_db: Vec<f64>,
}

impl Cells {
    /// Reads two of the fields of a frame's cells; the others are of no use here.
    fn read(fields: Option<Fields>) -> Fallible<Self> {
        let mut fields = fields.ok_or_else(|| missing("cells", "cells of a frame"))?;
        let range_m = float_array(&mut fields, "rangeM")?.0;
        let power_db = float_array(&mut fields, "powerDb")?.0;
        check_length("cells.powerDb", range_m.len(), power_db.len())?;
        Ok(Self { range_m, power_db })
    }
}

fn missing(what: &str, expected: &str) -> BindingError {
    BindingError::Missing { what: what.into(), expected: expected.into() }
}

fn check_length(what: &str, expected: usize, given: usize) -> Fallible<()> {
    if given == expected {
        return Ok(());
    }
    Err(shape_error(what, &format!("[{expected}]"), &[given]))
}

fn add_targets(
    image: &mut RangeAzimuthDoppler,
    cells: &Cells,
    estimates: &mut Fields,
) -> Fallible<()> {
    let cell: Vec<f64> = match estimates.raw("cell")? {
        Some(value) => given::numbers::<Uint32Array, f64>(&value, &|| "estimates.cell".into())?
            .ok_or_else(|| wrong_type("estimates.cell", "a Uint32Array", &value))?,
        None => return Err(missing("estimates.cell", "a Uint32Array")),
    };
    let azimuth_deg = float_array(estimates, "azimuthDeg")?.0;
    let power_db = float_array(estimates, "powerDb")?.0;
    let has_confidence = estimates.raw("confidence")?.is_some();
    let confidence = match has_confidence {
        true => float_array(estimates, "confidence")?.0,
        false => vec![1.0; cell.len()],
    };
    for (what, length) in [
        ("estimates.azimuthDeg", azimuth_deg.len()),
        ("estimates.powerDb", power_db.len()),
        ("estimates.confidence", confidence.len()),
    ] {
        check_length(what, cell.len(), length)?;
    }
    for (index, &cell) in cell.iter().enumerate() {
        let last = cells.range_m.len() as f64 - 1.0;
        check_range("cell of an estimate", cell, 0.0, last)?;
        image.add_target(&Target {
            range_m: cells.range_m[cell as usize],
            rate_mps: 0.0,
            azimuth_rad: azimuth_deg[index].to_radians(),
            power: db_to_power(power_db[index]),
            confidence: confidence[index],
        })?;
    }
    Ok(())
}

fn add_spectra(
    image: &mut RangeAzimuthDoppler,
    cells: &Cells,
    estimates: &mut Fields,
) -> Fallible<()> {
    if cells.range_m.is_empty() {
        return Ok(());
    }
    let expected = "spectra, which not every method has, and which have to be asked for";
    let spectra = estimates.object("spectra")?;
    let mut spectra = spectra.ok_or_else(|| missing("estimates.spectra", expected))?;
    let azimuth_deg = float_array(&mut spectra, "azimuthDeg")?.0;
    let azimuth_rad: Vec<f64> = azimuth_deg.iter().map(|azimuth| azimuth.to_radians()).collect();
    let power: Vec<f32> =
        float_array(&mut spectra, "power")?.0.into_iter().map(|power| power as f32).collect();
    let is_pseudo = spectra.described("kind")? == Some(SpectrumKind::Pseudo);
    let plan = SpectrumPlan::new(&azimuth_rad, &image.grid)?;
    let each = power.len() / cells.range_m.len();
    check_length("estimates.spectra.power", cells.range_m.len() * each.max(1), power.len())?;
    for (index, power) in power.chunks_exact(each).enumerate() {
        let level = is_pseudo.then(|| db_to_power(cells.power_db[index]));
        image.add_spectrum(&plan, cells.range_m[index], 0.0, power, level)?;
    }
    Ok(())
}

/// A map as it was given out.
struct Map(RangeAzimuthMap);

impl Read for Map {
    const EXPECTED: &'static str = "a range-azimuth map";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let range_m = axis(&mut fields, "rangeM", |range_m| range_m)?;
        let sine = axis(&mut fields, "azimuthDeg", |azimuth| azimuth.to_radians().sin())?;
        let power = powers(&mut fields, (range_m.len(), sine.len()))?;
        let grid = Grid { range_m, sine };
        Ok(Self(RangeAzimuthMap { grid, power, outside: Outside::default() }))
    }
}

/// An evenly spaced axis from its first and last point.
fn axis(fields: &mut Fields, name: &'static str, unit: fn(f64) -> f64) -> Fallible<Axis> {
    let path = fields.path_of(name);
    let values = float_array(fields, name)?.0;
    let [first, .., last] = values[..] else {
        return Err(shape_error(&path, "two points or more", &[values.len()]));
    };
    Ok(Axis::new(&path, unit(first), unit(last), values.len())?)
}

fn powers(fields: &mut Fields, shape: (usize, usize)) -> Fallible<Array2<f32>> {
    let path = fields.path_of("power");
    let power: Vec<f32> =
        float_array(fields, "power")?.0.into_iter().map(|power| power as f32).collect();
    if let Some(index) = power.iter().position(|power| !(0.0..=f32::MAX).contains(power)) {
        let given = power[index].into();
        return Err(InputError::NotFinite { what: path, index, given }.into());
    }
    let given = [power.len()];
    let expected = format!("[{}, {}]", shape.0, shape.1);
    Array2::from_shape_vec(shape, power).map_err(|_| shape_error(&path, &expected, &given))
}

/// One of the radars of a view.
struct Radar {
    map: Map,
    mounting: Mounting,
}

impl Read for Radar {
    const EXPECTED: &'static str = "{ map, mounting }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let map = fields.required("map")?;
        let mounting = fields.described_required("mounting")?;
        fields.finish()?;
        Ok(Self { map, mounting })
    }
}

/// Maps of several radars on the ground around the car.
#[wasm_bindgen(js_name = birdsEyeView)]
pub fn view(input: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(input, "")?;
    let radars: Vec<Radar> = fields.required("radars")?;
    let grid = ViewGrid::of(&fields.described_required("grid")?)?;
    fields.finish()?;
    let radars: Vec<_> = radars.iter().map(|radar| (&radar.map.0, radar.mounting)).collect();
    Ok(carry::write(&birds_eye_view(&radars, grid)?.columns()))
}

/// How much of a view is not where targets are.
#[wasm_bindgen(js_name = sidelobeMeasure)]
pub fn measure(view: &JsValue, targets: &JsValue, gate: &JsValue) -> Fallible<JsValue> {
    let view = read_view(Fields::new(view, "view")?)?;
    let targets: Vec<Place> = Vec::read(targets, "targets")?;
    let targets: Vec<[f64; 2]> = targets.into_iter().map(|Place(place)| place).collect();
    let measured = sidelobe_measure(&view, &targets, read_gate(Fields::new(gate, "gate")?)?)?;
    Ok(carry::write(&measured))
}

fn read_view(mut fields: Fields) -> Fallible<BirdsEyeView> {
    let (x_m, y_m) = (axis(&mut fields, "xM", |x| x)?, axis(&mut fields, "yM", |y| y)?);
    let cell_m = fields.required("cellM")?;
    check_range("view.cellM", cell_m, 1e-3, 1e3)?;
    let shape = (x_m.len(), y_m.len());
    let power = powers(&mut fields, shape)?;
    let radar = match fields.raw("radar")? {
        Some(value) => given::numbers::<Int8Array, f64>(&value, &|| "view.radar".into())?
            .ok_or_else(|| wrong_type("view.radar", "an Int8Array", &value))?,
        None => return Err(missing("view.radar", "an Int8Array")),
    };
    let given = [radar.len()];
    let radar = radar.into_iter().map(|radar| radar as i8).collect();
    let radar = Array2::from_shape_vec(shape, radar)
        .map_err(|_| shape_error("view.radar", "a radar for each cell", &given))?;
    let mountings: Vec<Mounting> = fields.described_required("mountings")?;
    Ok(BirdsEyeView { grid: ViewGrid { x_m, y_m, cell_m }, power, radar, mountings })
}

/// A place on the ground; whatever else a target has is of no use here.
struct Place([f64; 2]);

impl Read for Place {
    const EXPECTED: &'static str = "{ xM, yM }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        Ok(Self([fields.required("xM")?, fields.required("yM")?]))
    }
}

fn read_gate(mut fields: Fields) -> Fallible<Gate> {
    let gate = match fields.optional("gateM")? {
        Some(radius_m) => Gate::Circle { radius_m },
        None => {
            Gate::Resolution { range_m: fields.required("rangeM")?, sine: fields.required("sine")? }
        }
    };
    fields.finish()?;
    Ok(gate)
}

/// How an image is made unless something else is asked for.
#[derive(Described, Serialize)]
pub struct ImageDefaults {
    /// Of the chain: an image takes every detected cell.
    chain: Flat<ImageChain>,
    /// The method.
    method: Method,
    /// What the chain makes of the method's own, so that a cell gives sources only.
    dynamic_range_db: f64,
    /// The same.
    loading: f64,
    /// Spectra where the method has them.
    from: Content,
    /// The waveform's range bins, and azimuths over the field of view.
    grid: GridOptions,
}

#[derive(Described, Serialize)]
struct ImageChain {
    cfar: CfarOptions,
    peak_grouping: bool,
    max_detections: usize,
}

impl ImageDefaults {
    /// Those of a radar and a method of angle estimation.
    #[must_use]
    pub fn of(waveform: &Waveform, array: &Array, angle: &AngleOptions) -> Self {
        let AngleOptions { method, options } = angle;
        let suited = suited(*method, array, options);
        let ChainOptions { cfar, peak_grouping, max_detections, .. } = chain_options();
        Self {
            chain: ImageChain { cfar, peak_grouping, max_detections }.into(),
            method: *method,
            dynamic_range_db: suited.dynamic_range_db,
            loading: suited.loading,
            from: Angles::of(*method).content,
            grid: map_grid(waveform),
        }
    }
}

/// How an image is made of a cube unless something else is asked for.
#[wasm_bindgen(js_name = imageDefaults)]
pub fn image_defaults(waveform: &JsValue, array: &JsValue, angle: &JsValue) -> Fallible<JsValue> {
    let waveform = Waveform::read(waveform, "waveform")?;
    let array = Array::read(array, "array")?;
    let angle = carry::read_named(angle, "angle")?;
    Ok(carry::write(&ImageDefaults::of(&waveform, &array, &angle)))
}
