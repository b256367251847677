//! Responses of a region to a target: along range those of the transform's bins, along the array
//! those of its elements. A target's response is the product of the two.

use boresight_core::Complex64;
use boresight_core::steering::cis;
use ndarray::{Array2, ArrayView3};
use std::f64::consts::{PI, TAU};

/// The bins and elements of a region.
#[derive(Debug, Clone)]
pub(super) struct Atoms {
    /// Samples of a chirp.
    pub samples: usize,
    /// Range bins of the region.
    pub bins: usize,
    /// Positions along the array, from their mean, half wavelengths.
    pub positions: Vec<f64>,
}

/// A response along one axis, and its derivative.
pub(super) struct Response {
    pub value: Vec<Complex64>,
    pub slope: Vec<Complex64>,
}

impl Atoms {
    /// What the bins of the region have of a tone `bin` bins beyond its first, its phase that of the
    /// middle of the chirp. The amplitude of a tone in the middle of a bin is 1 there.
    ///
    /// Bin `n` has `exp(-j c n) sin(pi d) / (N sin(pi d / N))` with the distance `d = bin - n` and
    /// `c = pi (N - 1) / N`.
    pub fn range(&self, bin: f64) -> Response {
        let n = self.samples as f64;
        let (value, slope) = (0..self.bins)
            .map(|at| {
                let distance = bin - at as f64;
                let phase = cis(-PI * (n - 1.0) / n * at as f64);
                let (kernel, slope) = dirichlet(distance, n);
                (phase * kernel, phase * slope)
            })
            .unzip();
        Response { value, slope }
    }

    /// What the elements receive from a sine of the azimuth.
    pub fn array(&self, sine: f64) -> Response {
        let value: Vec<Complex64> = self.positions.iter().map(|p| cis(PI * p * sine)).collect();
        let slopes = value.iter().zip(&self.positions);
        let slope = slopes.map(|(z, p)| z * Complex64::new(0.0, PI * p)).collect();
        Response { value, slope }
    }
}

/// Dirichlet's kernel `sin(pi d) / (n sin(pi d / n))` and its derivative.
fn dirichlet(distance: f64, n: f64) -> (f64, f64) {
    let (sine, cosine) = (PI * distance).sin_cos();
    let (below, below_slope) = (PI * distance / n).sin_cos();
    if below.abs() < 1e-6 {
        // To second order, where the quotient is rounded away.
        let curvature = -PI * PI / 3.0 * (1.0 - 1.0 / (n * n));
        return (1.0, curvature * distance);
    }
    let value = sine / (n * below);
    (value, PI / (n * below) * (cosine - value * below_slope))
}

/// The sum of `range^* x array^*` over bins and elements of each chirp.
pub(super) fn correlate(
    x: &ArrayView3<'_, Complex64>,
    range: &[Complex64],
    array: &[Complex64],
) -> Vec<Complex64> {
    let mut sums = vec![Complex64::default(); x.dim().2];
    for (bin, r) in x.outer_iter().zip(range) {
        for (element, a) in bin.outer_iter().zip(array) {
            let weight = (r * a).conj();
            sums.iter_mut().zip(element).for_each(|(sum, z)| *sum += weight * z);
        }
    }
    sums
}

/// `x^H y`.
pub(super) fn inner(x: &[Complex64], y: &[Complex64]) -> Complex64 {
    x.iter().zip(y).map(|(x, y)| x.conj() * y).sum()
}

/// The responses on a grid, those of a place by row.
pub(super) fn table(rows: impl ExactSizeIterator<Item = Vec<Complex64>>) -> Array2<Complex64> {
    let count = rows.len();
    let all: Vec<Complex64> = rows.flatten().collect();
    let width = all.len().checked_div(count).unwrap_or_default();
    Array2::from_shape_vec((count, width), all).unwrap_or_default()
}

/// Slope, squared, of the response of the samples to noise: the variance of their phase a bin.
pub(super) fn range_spread(samples: usize) -> f64 {
    let n = samples as f64;
    (TAU / n).powi(2) * (n * n - 1.0) / 12.0
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_range_response_is_the_transform_of_a_tone() {
        let (samples, bins) = (32, 9);
        let atoms = Atoms { samples, bins, positions: vec![0.0] };
        for bin in [3.0, 3.0 + 1e-9, 4.37, -0.5] {
            let response = atoms.range(bin);
            for at in 0..bins {
                let tone = |s: usize| {
                    cis(TAU * (bin - at as f64) * s as f64 / samples as f64) / samples as f64
                };
                let middle = cis(-PI * bin * (samples as f64 - 1.0) / samples as f64);
                let expected = (0..samples).map(tone).sum::<Complex64>() * middle;
                assert!((response.value[at] - expected).norm() < 1e-9, "{bin} {at}");
            }
        }
    }

    #[test]
    fn slopes_are_those_of_the_responses() {
        let atoms = Atoms { samples: 32, bins: 9, positions: vec![-1.5, 0.2, 1.3] };
        let h = 1e-6;
        for bin in [3.0, 4.37, 4.0 + 1e-8] {
            let (low, high) = (atoms.range(bin - h), atoms.range(bin + h));
            for (at, slope) in atoms.range(bin).slope.iter().enumerate() {
                let expected = (high.value[at] - low.value[at]) / (2.0 * h);
                assert!((slope - expected).norm() < 1e-6, "{bin} {at} {slope} {expected}");
            }
        }
        let (low, high) = (atoms.array(0.3 - h), atoms.array(0.3 + h));
        for (at, slope) in atoms.array(0.3).slope.iter().enumerate() {
            assert!((slope - (high.value[at] - low.value[at]) / (2.0 * h)).norm() < 1e-8);
        }
    }
}
