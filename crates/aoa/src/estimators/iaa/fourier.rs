//! Transforms between an angle grid uniform in the sine and the lags of a lattice.

use super::inverse::Real;
use super::residues::Residues;
use boresight_math::fft::RealFft;
use rustfft::Fft;
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;
use std::f64::consts::PI;
use std::sync::Arc;

/// What the fast form asks of its transforms.
pub trait LagTransforms<T: Real>: Send {
    /// `lags[m] = sum_g values[g] exp(j pi d m u_g)` for `m` in `0..span`.
    fn lags(&mut self, values: &[T], lags: &mut [Complex<T>]);
    /// `out[g] = sum_m lags[m] exp(-j pi d m u_g)` over `m` from `-(span - 1)` to `span - 1`, with
    /// `lags[-m]` the conjugate of `lags[m]`: real.
    fn hermitian(&mut self, lags: &[Complex<T>], out: &mut [T]);
    /// Adds `|sum_i x[i] exp(-j pi d i u_g)|^2`, over the lattice index `i`, to `out[g]`.
    fn add_power(&mut self, x: &[Complex<T>], out: &mut [T]);
}

/// Sums of `exp(-j pi d m u_g)` over lattice indices `m`, and its transpose over the points
/// `u_g = -1 + 2 g / G` of the grid, for a lattice of `span` points spaced by `d` half wavelengths.
///
/// Where `q d` is whole for a small `q`, lattice and grid meet in an FFT of length `q G`; other
/// spacings take the chirp transform of Bluestein (1970).
pub enum LatticeFourier<T: Real> {
    /// By short FFTs side by side, for most grids that are powers of two.
    Residues(Residues<T>),
    /// By one FFT.
    Folded(Folded<T>),
    /// By two longer ones.
    Chirp(Chirp<T>),
}

/// Largest `q` for which a longer FFT is cheaper than a chirp transform.
const LARGEST_FACTOR: usize = 3;

impl<T: Real> LatticeFourier<T> {
    /// Plans the transforms.
    pub fn new(grid: usize, spacing: f64, span: usize) -> Self {
        let factor = (1..=LARGEST_FACTOR).find(|&q| {
            let steps = spacing * q as f64;
            (steps - steps.round()).abs() * (span as f64) < 1e-9
        });
        let residues = || Residues::new(grid, spacing, span);
        match factor {
            Some(1) => residues()
                .map_or_else(|| Self::Folded(Folded::new(grid, spacing, span, 1)), Self::Residues),
            Some(q) => Self::Folded(Folded::new(grid, spacing, span, q)),
            None => Self::Chirp(Chirp::new(grid, spacing, span)),
        }
    }
}

impl<T: Real> LagTransforms<T> for LatticeFourier<T> {
    fn lags(&mut self, values: &[T], lags: &mut [Complex<T>]) {
        match self {
            Self::Residues(r) => r.lags(values, lags),
            Self::Folded(f) => f.lags(values, lags),
            Self::Chirp(c) => c.lags(values, lags),
        }
    }

    fn hermitian(&mut self, lags: &[Complex<T>], out: &mut [T]) {
        match self {
            Self::Residues(r) => r.hermitian(lags, out),
            Self::Folded(f) => f.hermitian(lags, out),
            Self::Chirp(c) => c.hermitian(lags, out),
        }
    }

    fn add_power(&mut self, x: &[Complex<T>], out: &mut [T]) {
        let spectrum = match self {
            Self::Residues(r) => return r.add_power(x, out),
            Self::Folded(f) => f.vector(x),
            Self::Chirp(c) => c.vector(x),
        };
        for (sum, x) in out.iter_mut().zip(spectrum) {
            *sum = *sum + x.norm_sqr();
        }
    }
}

/// Where a lattice index lands in the FFT, and the phase it takes along.
struct Bin<T> {
    bin: usize,
    phase: Complex<T>,
}

/// See [`LatticeFourier`].
pub struct Folded<T: Real> {
    bins: Vec<Bin<T>>,
    length: usize,
    complex: Arc<dyn Fft<T>>,
    transform: RealFft<T>,
    real: Vec<T>,
    half: Vec<Complex<T>>,
    full: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Real> Folded<T> {
    fn new(grid: usize, spacing: f64, span: usize, q: usize) -> Self {
        let length = q * grid;
        let stride = (spacing * q as f64).round() as usize;
        let bins = (0..span)
            .map(|i| Bin { bin: stride * i % length, phase: cis(PI * spacing * i as f64) })
            .collect();
        let complex = T::plan_forward(length);
        let transform = RealFft::new(length);
        let scratch = complex.get_inplace_scratch_len();
        Self {
            bins,
            length,
            complex,
            transform,
            real: vec![T::zero(); length],
            half: vec![Complex::zero(); length / 2 + 1],
            full: vec![Complex::zero(); length],
            scratch: vec![Complex::zero(); scratch],
        }
    }

    fn lags(&mut self, values: &[T], lags: &mut [Complex<T>]) {
        self.real[..values.len()].copy_from_slice(values);
        self.real[values.len()..].fill(T::zero());
        self.transform.forward(&self.real, &mut self.half);
        for (lag, Bin { bin, phase }) in lags.iter_mut().zip(&self.bins) {
            let value = if 2 * bin <= self.length {
                self.half[*bin]
            } else {
                self.half[self.length - bin].conj()
            };
            *lag = (value * phase).conj();
        }
    }

    fn hermitian(&mut self, lags: &[Complex<T>], out: &mut [T]) {
        self.half.fill(Complex::zero());
        for (m, (lag, &Bin { bin, phase })) in lags.iter().zip(&self.bins).enumerate() {
            let value = (lag * phase).conj();
            if m == 0 {
                self.half[0].re = self.half[0].re + value.re;
            } else if bin == 0 || 2 * bin == self.length {
                self.half[bin].re = self.half[bin].re + value.re + value.re;
            } else if 2 * bin < self.length {
                self.half[bin] = self.half[bin] + value;
            } else {
                self.half[self.length - bin] = self.half[self.length - bin] + value.conj();
            }
        }
        self.transform.inverse(&self.half, &mut self.real);
        let count = out.len();
        out.copy_from_slice(&self.real[..count]);
    }

    fn vector(&mut self, x: &[Complex<T>]) -> &[Complex<T>] {
        self.full.fill(Complex::zero());
        for (x, Bin { bin, phase }) in x.iter().zip(&self.bins) {
            self.full[*bin] = self.full[*bin] + x * phase;
        }
        self.complex.process_with_scratch(&mut self.full, &mut self.scratch);
        &self.full
    }
}

/// See [`LatticeFourier`].
pub struct Chirp<T: Real> {
    grid: usize,
    /// `exp(-j pi d n^2 / G)`.
    chirp: Vec<Complex<T>>,
    /// `exp(j pi d i)`, which moves the grid from `[0, 2)` to `[-1, 1)`.
    shift: Vec<Complex<T>>,
    /// Transform of the conjugate chirp over both signs of `n`, over the FFT length.
    kernel: Vec<Complex<T>>,
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
    full: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Real> Chirp<T> {
    fn new(grid: usize, spacing: f64, span: usize) -> Self {
        let longest = grid.max(span);
        let length = (2 * longest - 1).next_power_of_two();
        let rate = spacing / grid as f64;
        let chirp: Vec<Complex<T>> = (0..longest)
            .map(|n| {
                let turns = rate * (n * n) as f64;
                cis(-PI * (turns % 2.0))
            })
            .collect();
        let (forward, inverse) = (T::plan_forward(length), T::plan_inverse(length));
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        let mut scratch = vec![Complex::zero(); scratch];
        let mut kernel = vec![Complex::zero(); length];
        let scale: T = real(1.0 / length as f64);
        for (n, c) in chirp.iter().enumerate() {
            kernel[n] = c.conj().scale(scale);
            kernel[(length - n) % length] = kernel[n];
        }
        forward.process_with_scratch(&mut kernel, &mut scratch);
        Self {
            grid,
            chirp,
            shift: (0..span).map(|i| cis(PI * spacing * i as f64)).collect(),
            kernel,
            forward,
            inverse,
            full: vec![Complex::zero(); length],
            scratch,
        }
    }

    /// Convolves `full` with the conjugate chirp.
    fn convolve(&mut self) {
        self.forward.process_with_scratch(&mut self.full, &mut self.scratch);
        for (x, k) in self.full.iter_mut().zip(&self.kernel) {
            *x = *x * k;
        }
        self.inverse.process_with_scratch(&mut self.full, &mut self.scratch);
    }

    fn lags(&mut self, values: &[T], lags: &mut [Complex<T>]) {
        self.full.fill(Complex::zero());
        for ((x, &value), chirp) in self.full.iter_mut().zip(values).zip(&self.chirp) {
            *x = chirp.scale(value);
        }
        self.convolve();
        for (m, lag) in lags.iter_mut().enumerate() {
            *lag = (self.full[m] * self.chirp[m] * self.shift[m]).conj();
        }
    }

    fn hermitian(&mut self, lags: &[Complex<T>], out: &mut [T]) {
        self.vector(lags);
        let two = T::one() + T::one();
        for (out, x) in out.iter_mut().zip(&self.full) {
            *out = two * x.re - lags[0].re;
        }
    }

    fn vector(&mut self, x: &[Complex<T>]) -> &[Complex<T>] {
        self.full.fill(Complex::zero());
        for (i, x) in x.iter().enumerate() {
            self.full[i] = x * self.shift[i] * self.chirp[i];
        }
        self.convolve();
        for (x, chirp) in self.full.iter_mut().zip(&self.chirp).take(self.grid) {
            *x = *x * chirp;
        }
        &self.full
    }
}

/// `exp(j phase)`, rounded to the type once.
pub(super) fn cis<T: Real>(phase: f64) -> Complex<T> {
    let z = boresight_math::phasor::cis(phase % (2.0 * PI));
    Complex::new(real(z.re), real(z.im))
}

/// A number of the type; zero for what the type cannot hold.
pub fn real<T: Real>(x: f64) -> T {
    <T as rustfft::num_traits::FromPrimitive>::from_f64(x).unwrap_or_else(T::zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::{Complex64, Random};

    #[test]
    fn transforms_equal_their_sums() {
        let mut random = Random::new(12, 0);
        for (grid, spacing, span) in [
            (256, 1.0, 8),
            (1024, 1.0, 93),
            (128, 3.0, 31),
            (64, 1.0, 2),
            (64, 1.0, 20),
            (64, 1.0, 50),
            (24, 1.0, 50),
            (64, 1.0, 200),
            (33, 2.0, 20),
            (64, 0.5, 20),
            (50, 2.0 / 3.0, 40),
            (48, 0.483, 30),
            (32, 1.7, 90),
        ] {
            let mut fourier = LatticeFourier::<f64>::new(grid, spacing, span);
            let wave = |m: usize, g: usize| {
                Complex64::cis(-PI * spacing * m as f64 * (-1.0 + 2.0 * g as f64 / grid as f64))
            };
            let values: Vec<f64> = (0..grid).map(|_| random.unit()).collect();
            let mut lags = vec![Complex64::ZERO; span];
            fourier.lags(&values, &mut lags);
            for (m, lag) in lags.iter().enumerate() {
                let sum: Complex64 = (0..grid).map(|g| wave(m, g).conj() * values[g]).sum();
                assert!((sum - lag).norm() < 1e-10, "{grid} {spacing} {m}: {sum} {lag}");
            }
            let mut x: Vec<Complex64> = (0..span).map(|_| random.complex_normal(1.0)).collect();
            let mut out = vec![1.0; grid];
            fourier.add_power(&x, &mut out);
            for g in 0..grid {
                let sum: Complex64 = (0..span).map(|m| wave(m, g) * x[m]).sum();
                assert!((1.0 + sum.norm_sqr() - out[g]).abs() < 1e-9, "{grid} {spacing} {g}");
            }
            x[0].im = 0.0;
            fourier.hermitian(&x, &mut out);
            for g in 0..grid {
                let sum: Complex64 = (0..span).map(|m| wave(m, g) * x[m]).sum();
                let expected = 2.0 * sum.re - x[0].re;
                assert!((expected - out[g]).abs() < 1e-10, "{grid} {spacing} {g}");
            }
        }
    }
}
