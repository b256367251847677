//! IAA on a lattice: three FFTs and one small inverse an iteration.

use super::fourier::{LagTransforms, real};
use super::inverse::{HermitianTiles, Real, Singular, TILE};
use super::kernel::{Kernel, weighted_power};
use super::split::Split;
use boresight_core::{Complex64, Lattice};
use boresight_math::order::ascending;
use ndarray::ArrayView2;
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;

/// The fast form, in double or single precision.
///
/// The covariance depends on lags alone, `R_kl = r[p_k - p_l]`, with `r` the transform of the power
/// spectrum; `a^H R^-1 a` is the transform of the sums of `R^-1` along equal lags, and `a^H R^-1 y`
/// that of `R^-1 y` put on its positions.
pub struct FastKernel<T: Real, F> {
    fourier: F,
    span: usize,
    elements: usize,
    /// Least `a^H R^-1 a` over the trace of `R^-1` for which an iteration counts.
    least_share: T,
    /// Elements by rising lattice index; the indices themselves in that order.
    order: Vec<usize>,
    indices: Vec<usize>,
    /// For each entry of each tile, its lag plus `span - 1`; two more slots hold what the rows that
    /// fill up the last tile read.
    slots: Vec<[[u32; TILE]; TILE]>,
    table: Vec<Complex<T>>,
    matrix: HermitianTiles<T>,
    lags: Vec<Complex<T>>,
    sums: Vec<Complex<T>>,
    diagonal_sums: Vec<Complex<T>>,
    /// Snapshots in the order of rising index, filled up to whole tiles, of which the first `count` are in
    /// use; and `R^-1` times one.
    snapshots: Vec<Split<T>>,
    count: usize,
    solved: Split<T>,
    scattered: Vec<Complex<T>>,
    power: Vec<T>,
    denominator: Vec<T>,
    numerator: Vec<T>,
}

impl<T: Real, F: LagTransforms<T>> FastKernel<T, F> {
    /// Plans for a lattice and a grid of `grid` points uniform in the sine over `[-1, 1)`, with the
    /// transforms between the two. An iteration in
    /// which the smallest `a^H R^-1 a` is not above `least_share` of the trace of `R^-1` is refused.
    pub fn new(lattice: &Lattice, grid: usize, fourier: F, least_share: T) -> Self {
        let elements = lattice.indices.len();
        let span = lattice.span();
        let order = ascending(lattice.indices.iter().map(|&index| index as f64));
        let indices: Vec<usize> = order.iter().map(|&k| lattice.indices[k]).collect();
        let matrix = HermitianTiles::new(elements);
        let (zero_slot, one_slot) = (2 * span - 1, 2 * span);
        let mut slots = Vec::with_capacity(matrix.tiles().len());
        for i in 0..matrix.blocks() {
            for j in 0..=i {
                let mut tile = [[0; TILE]; TILE];
                for (r, row) in tile.iter_mut().enumerate() {
                    for (c, slot) in row.iter_mut().enumerate() {
                        let (k, l) = (TILE * i + r, TILE * j + c);
                        *slot = if k < elements && l < elements {
                            indices[k] + span - 1 - indices[l]
                        } else if k == l {
                            one_slot
                        } else {
                            zero_slot
                        } as u32;
                    }
                }
                slots.push(tile);
            }
        }
        let blocks = matrix.blocks();
        Self {
            fourier,
            span,
            elements,
            least_share,
            order,
            indices,
            slots,
            table: vec![Complex::zero(); 2 * span + 1],
            matrix,
            lags: vec![Complex::zero(); span],
            sums: vec![Complex::zero(); 2 * span + 1],
            diagonal_sums: vec![Complex::zero(); 2 * span + 1],
            snapshots: Vec::new(),
            count: 0,
            solved: Split::zero(blocks),
            scattered: vec![Complex::zero(); span],
            power: vec![T::zero(); grid],
            denominator: vec![T::zero(); grid],
            numerator: vec![T::zero(); grid],
        }
    }

    /// Takes the snapshots (elements x snapshots) times `scale`.
    pub fn take_snapshots(&mut self, y: ArrayView2<Complex64>, scale: f64) {
        let blocks = self.matrix.blocks();
        self.count = y.ncols();
        let kept = self.snapshots.len().max(self.count);
        self.snapshots.resize_with(kept, || Split::zero(blocks));
        for (column, split) in y.columns().into_iter().zip(&mut self.snapshots) {
            for (k, &element) in self.order.iter().enumerate() {
                let z = column[element] * scale;
                split.set(k, Complex::new(real(z.re), real(z.im)));
            }
        }
    }

    /// Takes over the powers of another kernel.
    pub fn take_power<S: Real, G>(&mut self, other: &FastKernel<S, G>) {
        for (power, given) in self.power.iter_mut().zip(&other.power) {
            *power = real(given.to_f64().unwrap_or(0.0));
        }
    }

    /// Fills the tiles from the lags and `loading` on the diagonal.
    fn fill(&mut self, loading: T) {
        let last = self.span - 1;
        for (m, lag) in self.lags.iter().enumerate() {
            self.table[last + m] = *lag;
            self.table[last - m] = lag.conj();
        }
        let zero_lag = Complex::new(self.lags[0].re + loading, T::zero());
        self.table[2 * last + 1] = Complex::zero();
        self.table[2 * last + 2] = zero_lag;
        for (tile, slots) in self.matrix.tiles_mut().iter_mut().zip(&self.slots) {
            for r in 0..TILE {
                for c in 0..TILE {
                    let z = self.table[slots[r][c] as usize];
                    tile.re[r][c] = z.re;
                    tile.im[r][c] = z.im;
                }
            }
        }
        // Added here and not to lag zero, which elements at one place share off the diagonal.
        for i in 0..self.matrix.blocks() {
            let tile = &mut self.matrix.tiles_mut()[i * (i + 1) / 2 + i];
            for r in 0..TILE {
                tile.re[r][r] = zero_lag.re;
            }
        }
    }

    /// Sums of the inverse along equal lags, into `lags`.
    fn sum_lags(&mut self) {
        self.sums.fill(Complex::zero());
        self.diagonal_sums.fill(Complex::zero());
        let mut tiles = self.matrix.tiles().iter().zip(&self.slots);
        for i in 0..self.matrix.blocks() {
            for (tile, slots) in tiles.by_ref().take(i) {
                add_tile(&mut self.sums, tile, slots);
            }
            if let Some((tile, slots)) = tiles.next() {
                add_tile(&mut self.diagonal_sums, tile, slots);
            }
        }
        let last = self.span - 1;
        for (m, lag) in self.lags.iter_mut().enumerate() {
            let below = self.sums[last + m] + self.sums[last - m].conj();
            // The tiles hold minus the inverse.
            *lag = -(below + self.diagonal_sums[last + m]);
        }
    }
}

/// Puts a vector on its lattice indices.
fn scatter<T: Real>(indices: &[usize], vector: &Split<T>, out: &mut [Complex<T>]) {
    out.fill(Complex::zero());
    for (k, &index) in indices.iter().enumerate() {
        out[index] = out[index] + vector.get(k);
    }
}

#[inline(always)]
fn add_tile<T: Real>(
    sums: &mut [Complex<T>],
    tile: &super::inverse::Tile<T>,
    slots: &[[u32; TILE]; TILE],
) {
    for r in 0..TILE {
        for c in 0..TILE {
            let sum = &mut sums[slots[r][c] as usize];
            *sum = Complex::new(sum.re + tile.re[r][c], sum.im + tile.im[r][c]);
        }
    }
}

impl<T: Real, F: LagTransforms<T>> Kernel for FastKernel<T, F> {
    fn start(&mut self, y: ArrayView2<Complex64>, scale: f64) {
        self.take_snapshots(y, scale);
        self.numerator.fill(T::zero());
        for split in &self.snapshots[..self.count] {
            self.solved.re.copy_from_slice(&split.re);
            self.solved.im.copy_from_slice(&split.im);
            scatter(&self.indices, &self.solved, &mut self.scattered);
            self.fourier.add_power(&self.scattered, &mut self.numerator);
        }
        let gain: T = real(1.0 / (self.elements * self.elements * y.ncols()) as f64);
        for (power, numerator) in self.power.iter_mut().zip(&self.numerator) {
            *power = *numerator * gain;
        }
    }

    fn iterate(&mut self, loading: f64) -> Result<(), Singular> {
        self.fourier.lags(&self.power, &mut self.lags);
        let loading: T = real(loading);
        let smallest =
            real::<T>(4.0 * self.elements as f64) * T::epsilon() * (self.lags[0].re + loading);
        self.fill(loading);
        self.matrix.negative_inverse(smallest)?;
        self.sum_lags();
        self.fourier.hermitian(&self.lags, &mut self.denominator);
        if self.least_share > T::zero() {
            let least =
                self.denominator.iter().fold(T::infinity(), |a, &b| if b < a { b } else { a });
            if least.is_nan() || least <= self.least_share * self.lags[0].re {
                return Err(Singular);
            }
        }
        self.numerator.fill(T::zero());
        for snapshot in 0..self.count {
            self.matrix.negated_product(&self.snapshots[snapshot], &mut self.solved);
            scatter(&self.indices, &self.solved, &mut self.scattered);
            self.fourier.add_power(&self.scattered, &mut self.numerator);
        }
        let count: T = real(self.count as f64);
        for ((power, n), d) in self.power.iter_mut().zip(&self.numerator).zip(&self.denominator) {
            *power = weighted_power(*n, *d, count);
        }
        Ok(())
    }

    fn element_power(&self) -> f64 {
        self.power.iter().map(|p| p.to_f64().unwrap_or(0.0)).sum()
    }

    fn power_from(&self, first: usize, out: &mut [f64]) {
        for (out, power) in out.iter_mut().zip(&self.power[first..]) {
            *out = power.to_f64().unwrap_or(0.0);
        }
    }

    fn map_power(&mut self, change: &mut dyn FnMut(f64) -> f64) {
        for power in &mut self.power {
            *power = real(change(power.to_f64().unwrap_or(0.0)));
        }
    }
}
