//! Powers of the sources that IAA has found, by least squares at their directions between the points
//! of the grid.
//!
//! A source between two points of the grid puts a part of its power on each, so that the height of the
//! spectrum tells too little, the more so the higher the signal-to-noise ratio. Here the amplitudes of
//! all peaks are fitted to the data at once, by least squares with the powers of the spectrum as what is
//! known of them before (the mean of Gaussian amplitudes given the data):
//!
//! ```text
//! min_s |y - A s|^2 / v + sum_i |s_i|^2 / P_i,   s = (A^H A + v P^-1)^-1 A^H y
//! ```
//!
//! with the steering vectors `A` of the peaks, the heights `P` of the spectrum there and the noise power
//! `v` at one element. Of sources above the noise the second term takes no more than `v / (K P_i)`. Plain
//! least squares would also fit the noise with the many weak peaks, of which there may be more than
//! elements; here at most as many as elements are fitted, the strongest. Far above the noise the grid splits a source in
//! two peaks a few steps apart, between which its power could be shared in any way: a peak that near to a stronger one
//! is left out. What is left out keeps the height of the spectrum. The cost for `D` peaks is that of an inverse,
//! `K^3 / 2`, and of `D^2 K / 2`, less than an iteration's.

use super::inverse::{HermitianTiles, Singular};
use super::split::Split;
use crate::grid::Grid;
use crate::model::cosines::Geometry;
use crate::spectra::peaks::Peak;
use boresight_core::{Array, Complex64};
use boresight_math::phasor::cis;
use ndarray::ArrayView2;
use std::f64::consts::PI;

/// Noise power at one element over `K` times the median of IAA's spectrum. Delay and sum would have
/// 1 / ln 2; IAA gathers noise into peaks, so that its median is lower: measured 4 to 8 for 2 to 10
/// targets at 15 to 35 dB on 48 elements. Powers differ little between 3 and 30.
const NOISE_OVER_MEDIAN: f64 = 6.0;
/// Least noise, as a share of the strongest peak: where there is none, rounding is.
const LEAST_NOISE: f64 = 1e-7;
/// Steps of the grid within which two peaks are one source split in two; of two sources that near no array for which
/// the grid is fine enough makes two peaks.
const SPLIT_STEPS: f64 = 3.5;

/// Of a double-precision number.
const MANTISSA_BITS: u32 = 52;
/// Biased exponents that there are.
const EXPONENTS: usize = 1 << 11;

/// The fit with its memory, for one array.
pub struct PeakPowers {
    positions: Vec<[f64; 3]>,
    /// Direction cosines apart, up to which two peaks are one source.
    split: f64,
    /// Of the peaks that are fitted: which they are, and their steering vectors.
    kept: Vec<usize>,
    steering: Vec<Split<f64>>,
    matrix: HermitianTiles<f64>,
    snapshot: Split<f64>,
    beams: Split<f64>,
    amplitudes: Split<f64>,
    fitted: Vec<f64>,
    /// How many powers have each binary exponent.
    octaves: Vec<usize>,
}

impl PeakPowers {
    /// For an array and a grid.
    pub fn new(array: &Array, grid: &Grid) -> Self {
        let matrix = HermitianTiles::new(array.len());
        let zero = Split::zero(matrix.blocks());
        Self {
            positions: array.positions().to_vec(),
            split: (SPLIT_STEPS * 2.0 / grid.full_points as f64)
                .min(0.5 * Geometry::new(array).half_beam()),
            kept: Vec::new(),
            steering: Vec::new(),
            matrix,
            snapshot: zero.clone(),
            beams: zero.clone(),
            amplitudes: zero,
            fitted: Vec::new(),
            octaves: Vec::new(),
        }
    }

    /// Replaces the `powers` of `peaks`, strongest first, which come from the whole grid's `spectrum`, by those fitted
    /// to the snapshots `y` (elements x snapshots) times `scale`; leaves them where the fit fails. The noise power is
    /// what the spectrum tells, and `noise` at least.
    pub fn fit(
        &mut self,
        y: ArrayView2<Complex64>,
        scale: f64,
        spectrum: &[f64],
        noise: f64,
        peaks: &[Peak],
        powers: &mut [f64],
    ) {
        let strongest = powers.iter().copied().fold(0.0, f64::max);
        let told = NOISE_OVER_MEDIAN * self.positions.len() as f64 * self.median(spectrum);
        let noise = noise.max(told).max(LEAST_NOISE * strongest);
        self.choose(peaks, powers);
        if !noise.is_finite() || self.invert(powers, noise).is_err() {
            return;
        }
        self.fitted.clear();
        self.fitted.resize(self.kept.len(), 0.0);
        for column in y.columns() {
            for (k, z) in column.iter().enumerate() {
                self.snapshot.set(k, z * scale);
            }
            self.beams.clear();
            for (i, steering) in self.steering[..self.kept.len()].iter().enumerate() {
                self.beams.set(i, steering.dot(&self.snapshot));
            }
            self.matrix.negated_product(&self.beams, &mut self.amplitudes);
            for (i, fitted) in self.fitted.iter_mut().enumerate() {
                *fitted += self.amplitudes.get(i).norm_sqr();
            }
        }
        for (&peak, fitted) in self.kept.iter().zip(&self.fitted) {
            let mean = fitted / y.ncols() as f64;
            if mean.is_finite() {
                powers[peak] = mean;
            }
        }
    }

    /// Middle of the octave that the median of some powers lies in: the noise needs no better.
    fn median(&mut self, spectrum: &[f64]) -> f64 {
        self.octaves.clear();
        self.octaves.resize(EXPONENTS, 0);
        for power in spectrum {
            self.octaves[(power.to_bits() >> MANTISSA_BITS) as usize % EXPONENTS] += 1;
        }
        let mut below = 0;
        let half = spectrum.len() / 2;
        let octave = self.octaves.iter().position(|count| {
            below += count;
            below > half
        });
        // The exponent with half a mantissa.
        octave.map_or(0.0, |at| {
            f64::from_bits(((at as u64) << MANTISSA_BITS) | 1 << (MANTISSA_BITS - 1))
        })
    }

    /// The peaks to fit, and their steering vectors.
    fn choose(&mut self, peaks: &[Peak], powers: &[f64]) {
        let blocks = self.matrix.blocks();
        self.kept.clear();
        for (k, peak) in peaks.iter().enumerate() {
            let here = peak.direction.unit();
            let is_split = self.kept.iter().any(|&stronger| {
                let there = peaks[stronger].direction.unit();
                (here[1] - there[1]).powi(2) + (here[2] - there[2]).powi(2) < self.split.powi(2)
            });
            if is_split || powers[k] <= 0.0 || self.kept.len() == self.positions.len() {
                continue;
            }
            let place = self.kept.len();
            if place == self.steering.len() {
                self.steering.push(Split::zero(blocks));
            }
            for (element, p) in self.positions.iter().enumerate() {
                let along: f64 = p.iter().zip(&here).map(|(p, u)| p * u).sum();
                self.steering[place].set(element, cis(PI * along));
            }
            self.kept.push(k);
        }
    }

    /// Minus the inverse of `A^H A + noise P^-1`, with ones on the diagonal beyond the peaks.
    fn invert(&mut self, powers: &[f64], noise: f64) -> Result<(), Singular> {
        let elements = self.positions.len() as f64;
        self.matrix.set_identity();
        for (i, &peak) in self.kept.iter().enumerate() {
            for j in 0..i {
                self.matrix.set(i, j, self.steering[i].dot(&self.steering[j]));
            }
            let own = Complex64::new(elements + noise / powers[peak], 0.0);
            self.matrix.set(i, i, own);
        }
        self.matrix.negative_inverse(4.0 * elements * f64::EPSILON * elements)
    }
}
