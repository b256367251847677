//! Calibration of arrays from captures, cubes, snapshots and tables.

use crate::calibrated::{ArrayChoice, array_calibration};
use crate::capture::{Capture, cube_frames};
use crate::carry;
use crate::complex::{ComplexData, Cube};
use crate::config::read_config;
use crate::error::Fallible;
use crate::estimate::shape_error;
use crate::read::{Fields, Read};
use crate::report::reporter;
use boresight_array_calibration::{
    CalibrationOptions, CalibrationResult, Cell, SteeringTable, calibrate,
};
use boresight_core::{Array, Direction, InputError, Waveform};
use boresight_math::error::check_range;
use boresight_pipeline::FrameSource;
use boresight_pipeline::array_calibration::{CalibrationFrames, calibrate_array};
use js_sys::Function;
use ndarray::{ArrayView3, Axis};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
impl Capture {
    /// Calibrates the array from frames of the capture. `report` as in `combineFrames`.
    #[wasm_bindgen(js_name = calibrateArray)]
    pub fn calibrate_array(
        &self,
        options: &JsValue,
        report: Option<Function>,
    ) -> Fallible<JsValue> {
        let mut fields = Fields::of_optional(options)?;
        let frames = read_frames(&mut fields, self.frames())?;
        let array = ArrayChoice::read(&mut fields)?;
        let options = fields.spread()?;
        fields.finish()?;
        let array = self.array_or(array)?;
        let (waveform, receivers, source) = self.recording()?;
        let mut report = reporter(report);
        let radar = (&waveform, receivers, &array);
        Ok(carry::write(&calibrate_array(radar, &source, &frames, &options, &mut report)?))
    }
}

/// Calibrates an array from a cube: frames x loops x transmitters x receivers x samples.
#[wasm_bindgen(js_name = calibrateCubeArray)]
pub fn calibrate_cube_array(
    cube: &JsValue,
    options: &JsValue,
    report: Option<Function>,
) -> Fallible<JsValue> {
    let cube = Cube::read(cube, "cube")?;
    let source = cube_frames(&cube)?;
    let mut fields = Fields::new(options, "")?;
    let waveform: Waveform = fields.required("waveform")?;
    let frames = read_frames(&mut fields, source.frames())?;
    let array = ArrayChoice::read(&mut fields)?.required()?;
    let options: CalibrationOptions = fields.spread()?;
    fields.finish()?;
    let receivers = source.0.len_of(Axis(3));
    let mut report = reporter(report);
    let radar = (&waveform, receivers, &array);
    Ok(carry::write(&calibrate_array(radar, &source, &frames, &options, &mut report)?))
}

/// Calibrates an array from snapshots of cells: `{ snapshots, noisePower, azimuthDeg, elevationDeg }`.
#[wasm_bindgen(js_name = calibrateArray)]
pub fn calibrate_cells(input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let cells = read_cells(input)?;
    let mut fields = Fields::new(options, "")?;
    let array = ArrayChoice::read(&mut fields)?.required()?;
    let options: CalibrationOptions = fields.spread()?;
    fields.finish()?;
    Ok(carry::write(&calibrate(&array, &cells, &options)?))
}

/// Calibrates an array by a table of measured steering vectors.
#[wasm_bindgen(js_name = calibrateBySteeringTable)]
pub fn calibrate_by_steering_table(table: &JsValue, array: &JsValue) -> Fallible<JsValue> {
    let table: SteeringTable = carry::read_named(table, "table")?;
    let result: CalibrationResult = table.calibrate(&Array::read(array, "array")?)?;
    Ok(carry::write(&result))
}

/// The line that makes a board apply a calibration.
#[wasm_bindgen(js_name = tiCompensation)]
pub fn ti_compensation(calibration: &JsValue, config: &JsValue) -> Fallible<String> {
    let calibration = array_calibration(calibration, "calibration")?;
    let (config, _) = read_config(config, "configuration")?;
    Ok(config.compensation_of(&calibration)?.to_string())
}

/// The calibration that the coefficients in a board's configuration are, which captures with it are processed by unless told
/// otherwise; null where there are none to apply. Of the platform's array unless another is named.
#[wasm_bindgen(js_name = configuredCalibration)]
pub fn configured_calibration(config: &JsValue, array: &JsValue) -> Fallible<JsValue> {
    let (config, _) = read_config(config, "configuration")?;
    let array = match array.is_undefined() {
        true => config.array(),
        false => Some(Array::read(array, "array")?),
    };
    let found = array.and_then(|array| config.calibration(&array));
    Ok(found.map_or(JsValue::NULL, |calibration| carry::write(&calibration)))
}

/// `firstFrame` and `frameCount`, by default the first half of the frames; `checkFirstFrame` and
/// `checkFrameCount`, by default all frames after these.
fn read_frames(fields: &mut Fields, count: usize) -> Fallible<CalibrationFrames> {
    let within =
        |what: &str, given: usize, most: usize| check_range(what, given as f64, 0.0, most as f64);
    let halves = CalibrationFrames::halves(count);
    let first = fields.optional::<usize>("firstFrame")?;
    let frames = fields.optional::<usize>("frameCount")?;
    let made_from = match (first, frames) {
        (None, None) => halves.made_from,
        (first, frames) => {
            let first = first.unwrap_or(0);
            within("first_frame", first, count.saturating_sub(1))?;
            let frames = frames.unwrap_or(count - first);
            within("frame_count", frames, count - first)?;
            first..first + frames
        }
    };
    let first = fields.optional::<usize>("checkFirstFrame")?.unwrap_or(made_from.end.min(count));
    within("check_first_frame", first, count)?;
    let frames = fields.optional::<usize>("checkFrameCount")?.unwrap_or(count - first);
    within("check_frame_count", frames, count - first)?;
    Ok(CalibrationFrames { made_from, checked_on: first..first + frames })
}

fn read_cells(input: &JsValue) -> Fallible<Vec<Cell>> {
    let mut fields = Fields::new(input, "input")?;
    let snapshots = fields.required::<ComplexData>("snapshots")?;
    let noise_power = fields.required("noisePower")?;
    let azimuth = fields.optional::<Vec<f64>>("azimuthDeg")?;
    let elevation = fields.optional::<Vec<f64>>("elevationDeg")?;
    fields.finish()?;
    let axes = match snapshots.shape[..] {
        [cells, channels] => Some((cells, channels, 1)),
        [cells, channels, count] => Some((cells, channels, count)),
        _ => None,
    };
    let expected = "[cells, channels] or [cells, channels, snapshots]";
    let view = axes
        .and_then(|axes| ArrayView3::from_shape(axes, &snapshots.data).ok())
        .ok_or_else(|| shape_error("snapshots", expected, &snapshots.shape))?;
    let count = view.len_of(Axis(0));
    for (what, given) in [("azimuth_deg", &azimuth), ("elevation_deg", &elevation)] {
        if let Some(given) = given.as_ref().filter(|given| given.len() != count) {
            let (what, expected) = (what.into(), format!("[{count}], one a cell"));
            return Err(InputError::Shape { what, expected, given: vec![given.len()] }.into());
        }
    }
    let mut cells = vec![];
    for (index, cell) in view.outer_iter().enumerate() {
        let cell = Cell::of(cell, noise_power)?;
        cells.push(match &azimuth {
            Some(azimuth) => {
                let elevation = elevation.as_ref().map_or(0.0, |elevation| elevation[index]);
                let direction = Direction::new(azimuth[index].to_radians(), elevation.to_radians());
                direction.check()?;
                cell.at(direction)
            }
            None => cell,
        });
    }
    Ok(cells)
}
