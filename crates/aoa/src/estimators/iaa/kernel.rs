//! What the fast and the dense form of IAA have in common.

use super::inverse::{Real, Singular};
use boresight_core::Complex64;
use ndarray::ArrayView2;

/// One form of IAA with its state, iterated from outside.
pub trait Kernel: Send {
    /// Takes the snapshots (elements x snapshots) times `scale` and sets the power of every point
    /// to that of delay and sum.
    fn start(&mut self, y: ArrayView2<Complex64>, scale: f64);

    /// One iteration: `R = A P A^H + loading I`, then for every point
    /// `P = mean_n |a^H R^-1 y_n|^2 / (a^H R^-1 a)^2`.
    ///
    /// # Errors
    /// [`Singular`] if `R` is, to rounding, or if its inverse is not as accurate as it should be; the powers
    /// are then as before.
    fn iterate(&mut self, loading: f64) -> Result<(), Singular>;

    /// Sum of the powers: the diagonal of `R` without loading.
    fn element_power(&self) -> f64;

    /// Powers of the points that begin with `first`, as many as `out` holds.
    fn power_from(&self, first: usize, out: &mut [f64]);

    /// Changes every power.
    fn map_power(&mut self, change: &mut dyn FnMut(f64) -> f64);
}

/// `sum / (count d^2)`, and zero where rounding has left nothing that can be divided by.
#[inline(always)]
pub fn weighted_power<T: Real>(sum: T, d: T, count: T) -> T {
    let power = sum / d / d / count;
    if d > T::zero() && power < T::infinity() { power } else { T::zero() }
}
