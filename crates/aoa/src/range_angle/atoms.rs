//! Response of a region to a target: the product of a response along range (the bins of the
//! transform) and one along the array (its elements).

use boresight_core::Complex64;
use boresight_math::phasor::cis;
use ndarray::{Array2, ArrayView3};
use std::f64::consts::{PI, TAU};

/// Geometry of a region.
#[derive(Debug, Clone)]
pub(super) struct Atoms {
    /// Samples of a chirp.
    pub samples: usize,
    /// Range bins of the region.
    pub bins: usize,
    /// Element positions along the array relative to their mean, in half wavelengths.
    pub positions: Vec<f64>,
}

/// A response along one axis, and its derivative.
pub(super) struct Response {
    pub value: Vec<Complex64>,
    pub slope: Vec<Complex64>,
}

impl Atoms {
    /// Returns the response of the region's bins to a tone at `bin`, counted from the first bin. The
    /// phase refers to the middle of the chirp. A tone centred on a bin has amplitude 1 there.
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

    /// Returns the response of the elements to a plane wave with the given sine of the azimuth.
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
        // Expansion to second order, since the quotient cancels here.
        let curvature = -PI * PI / 3.0 * (1.0 - 1.0 / (n * n));
        return (1.0, curvature * distance);
    }
    let value = sine / (n * below);
    (value, PI / (n * below) * (cosine - value * below_slope))
}

/// Correlates each chirp with a response: the sum of `range^* x array^*` over bins and elements.
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

/// Stacks responses on a grid as the rows of a matrix.
pub(super) fn table(rows: impl ExactSizeIterator<Item = Vec<Complex64>>) -> Array2<Complex64> {
    let count = rows.len();
    let all: Vec<Complex64> = rows.flatten().collect();
    let width = all.len().checked_div(count).unwrap_or_default();
    Array2::from_shape_vec((count, width), all).unwrap_or_default()
}

/// Variance over the samples of the phase slope per bin, rad^2. It is the variance of the slope of a
/// matched filter's response to white noise.
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
