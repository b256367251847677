//! Power over the channels.

use boresight_core::Complex32;
use ndarray::{Array2, ArrayView3};

/// Mean power over the channels (non-coherent integration) of a cube of channels x range x
/// Doppler: range x Doppler. Zero where there are no channels.
pub fn power_map(cube: ArrayView3<Complex32>) -> Array2<f32> {
    let (channels, ranges, dopplers) = cube.dim();
    let mut power = Array2::zeros((ranges, dopplers));
    for plane in cube.outer_iter() {
        power.zip_mut_with(&plane, |sum, z| *sum += z.norm_sqr());
    }
    let share = 1.0 / channels.max(1) as f32;
    power.mapv_inplace(|p| p * share);
    power
}

/// Adds the power of each value to a sum.
pub(crate) fn accumulate_power(values: &[Complex32], power: &mut [f32]) {
    for (sum, z) in power.iter_mut().zip(values) {
        *sum += z.norm_sqr();
    }
}
