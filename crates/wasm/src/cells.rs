//! Detected cells of a frame, for estimating their angles elsewhere.

use crate::capture::Capture;
use crate::chain::{read_angle, read_cube_chain};
use crate::complex::Cube;
use crate::error::Fallible;
use crate::estimate::shape_error;
use crate::frames::counts_record;
use crate::read::{Fields, Read};
use crate::write::{Record, complex64, finite_db, float64, list};
use boresight_core::Array;
use boresight_core::units::power_to_db;
use boresight_pipeline::{AngleOptions, Chain, DetectedCell, FrameCells, suited};
use js_sys::Uint32Array;
use ndarray::ArrayView4;
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
    Ok(cells_record(&chain.cells(frame)?).into())
}

#[wasm_bindgen]
impl Capture {
    /// Detected cells of one frame.
    #[wasm_bindgen(js_name = frameCells)]
    pub fn frame_cells(&mut self, frame: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        Ok(cells_record(&self.cells_of(frame, options)?).into())
    }
}

/// What the chain changes in the options of a method so that a cell gives sources only:
/// `{ dynamicRangeDb, loading }`.
#[wasm_bindgen(js_name = suitedAngle)]
pub fn suited_angle(array: &JsValue, angle: &JsValue) -> Fallible<JsValue> {
    let array = Array::read(array, "array")?;
    let AngleOptions { method, options } = read_angle(Fields::of_optional(angle)?)?;
    options.check()?;
    let options = suited(method, &array, &options);
    Ok(Record::new()
        .with("dynamicRangeDb", options.dynamic_range_db)
        .with("loading", options.loading)
        .into())
}

fn cells_record(cells: &FrameCells) -> Record {
    let each =
        |of: fn(&DetectedCell) -> f64| float64(&cells.cells.iter().map(of).collect::<Vec<_>>());
    let bins = |of: fn(&DetectedCell) -> usize| {
        let bins: Vec<u32> = cells.cells.iter().map(|cell| of(cell) as u32).collect();
        Uint32Array::new_from_slice(&bins)
    };
    let values: Vec<_> = cells.snapshots.iter().copied().collect();
    let (count, elements, _) = cells.snapshots.dim();
    let snapshots =
        Record::new().with("data", complex64(&values)).with("shape", list([count, elements]));
    Record::new()
        .with("rangeM", each(|cell| cell.range_m))
        .with("rateMps", each(|cell| cell.rate_mps))
        .with("powerDb", each(|cell| finite_db(cell.power)))
        .with("snrDb", each(|cell| power_to_db(cell.snr.max(f64::MIN_POSITIVE))))
        .with("rangeBin", bins(|cell| cell.range_bin))
        .with("dopplerBin", bins(|cell| cell.doppler_bin))
        .with("snapshots", snapshots)
        .with("counts", counts_record(&cells.counts))
}
