//! The car's motion at the times of frames; for the TypeScript around this crate, which checks what goes in.

use boresight_core::drive::interpolated;
use wasm_bindgen::prelude::wasm_bindgen;

/// Values at times by linear interpolation of samples in order of time; NaN before the first, after the last, and in gaps
/// longer than `max_gap_s`.
#[wasm_bindgen]
pub fn interpolate(samples_s: &[f64], values: &[f64], times_s: &[f64], max_gap_s: f64) -> Vec<f64> {
    let at = |time_s: &f64| interpolated(samples_s, values, *time_s, max_gap_s);
    times_s.iter().map(|time_s| at(time_s).unwrap_or(f64::NAN)).collect()
}
