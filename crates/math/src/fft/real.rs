//! Transforms of real numbers.

use super::Transforms;
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;
use rustfft::{Fft, FftNum};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Transforms between N real values and the `N / 2 + 1` bins that determine their spectrum. An even
/// length takes a complex transform of half of it (Sorensen et al. 1987).
pub struct RealFft<T: Transforms> {
    length: usize,
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
    /// `exp(-2 pi j k / N)` for `k` up to `N / 4`; none for an odd length.
    twiddles: Vec<Complex<T>>,
    work: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: Transforms> RealFft<T> {
    /// Plans both directions for `length` values.
    pub fn new(length: usize) -> Self {
        let even = length.is_multiple_of(2);
        let complex = if even { length / 2 } else { length };
        let (forward, inverse) = (T::plan_forward(complex), T::plan_inverse(complex));
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        let twiddle = |k: usize| {
            let (sine, cosine) = libm::sincos(-TAU * k as f64 / length as f64);
            Complex::new(number(cosine), number(sine))
        };
        Self {
            length,
            forward,
            inverse,
            twiddles: if even { (0..=complex / 2).map(twiddle).collect() } else { Vec::new() },
            work: vec![Complex::zero(); complex],
            scratch: vec![Complex::zero(); scratch],
        }
    }

    /// Number of bins.
    pub fn bins(&self) -> usize {
        self.length / 2 + 1
    }

    /// `bins[k] = sum_n values[n] exp(-2 pi j k n / N)`. Does nothing unless there are N values and
    /// [`RealFft::bins`] bins.
    pub fn forward(&mut self, values: &[T], bins: &mut [Complex<T>]) {
        if values.len() != self.length || bins.len() != self.bins() || self.length == 0 {
            return;
        }
        if self.twiddles.is_empty() {
            for (z, &x) in self.work.iter_mut().zip(values) {
                *z = Complex::new(x, T::zero());
            }
            self.forward.process_with_scratch(&mut self.work, &mut self.scratch);
            for (bin, z) in bins.iter_mut().zip(&self.work) {
                *bin = *z;
            }
            return;
        }
        for (z, x) in self.work.iter_mut().zip(values.chunks_exact(2)) {
            *z = Complex::new(x[0], x[1]);
        }
        self.forward.process_with_scratch(&mut self.work, &mut self.scratch);
        let half = self.work.len();
        let first = self.work[0];
        bins[0] = Complex::new(first.re + first.im, T::zero());
        bins[half] = Complex::new(first.re - first.im, T::zero());
        let scale = number(0.5);
        for (k, w) in self.twiddles.iter().enumerate().skip(1) {
            let (low, high) = (self.work[k], self.work[half - k].conj());
            let sum = (low + high).scale(scale);
            let turned = (low - high).scale(scale) * w;
            let odd = Complex::new(turned.im, -turned.re);
            bins[k] = sum + odd;
            bins[half - k] = (sum - odd).conj();
        }
    }

    /// `values[n] = sum_k bins[k] exp(2 pi j k n / N)` over N bins, of which the upper half are the
    /// conjugates of the lower; imaginary parts of bins that stand alone are not read. Does nothing
    /// unless there are [`RealFft::bins`] bins and N values.
    pub fn inverse(&mut self, bins: &[Complex<T>], values: &mut [T]) {
        if values.len() != self.length || bins.len() != self.bins() || self.length == 0 {
            return;
        }
        let count = self.work.len();
        if self.twiddles.is_empty() {
            self.work[0] = Complex::new(bins[0].re, T::zero());
            for k in 1..self.bins() {
                self.work[k] = bins[k];
                self.work[count - k] = bins[k].conj();
            }
            self.inverse.process_with_scratch(&mut self.work, &mut self.scratch);
            for (x, z) in values.iter_mut().zip(&self.work) {
                *x = z.re;
            }
            return;
        }
        let (first, last) = (bins[0].re, bins[count].re);
        self.work[0] = Complex::new(first + last, first - last);
        for (k, w) in self.twiddles.iter().enumerate().skip(1) {
            let (low, high) = (bins[k], bins[count - k].conj());
            let sum = low + high;
            let turned = (low - high) * w.conj();
            let odd = Complex::new(-turned.im, turned.re);
            self.work[k] = sum + odd;
            self.work[count - k] = (sum - odd).conj();
        }
        self.inverse.process_with_scratch(&mut self.work, &mut self.scratch);
        for (x, z) in values.chunks_exact_mut(2).zip(&self.work) {
            x.copy_from_slice(&[z.re, z.im]);
        }
    }
}

fn number<T: FftNum>(x: f64) -> T {
    T::from_f64(x).unwrap_or_else(T::zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use num_complex::Complex64;

    const LENGTHS: [usize; 10] = [1, 2, 3, 4, 6, 7, 12, 30, 33, 64];

    /// The definition, with `sign` in its exponent.
    fn definition(x: &[Complex64], sign: f64) -> Vec<Complex64> {
        let n = x.len();
        let wave = |k: usize, i: usize| Complex64::cis(sign * TAU * (k * i % n) as f64 / n as f64);
        (0..n).map(|k| (0..n).map(|i| wave(k, i) * x[i]).sum()).collect()
    }

    fn assert_close(found: &[Complex64], expected: &[Complex64]) {
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).norm() < 1e-12 * expected.len() as f64, "{}: {a} {b}", expected.len());
        }
    }

    #[test]
    fn plans_equal_the_definition() {
        let mut random = Random::new(3, 0);
        for length in LENGTHS {
            let x: Vec<Complex64> = (0..length).map(|_| random.complex_normal(1.0)).collect();
            for (plan, sign) in
                [(f64::plan_forward(length), -1.0), (f64::plan_inverse(length), 1.0)]
            {
                let mut found = x.clone();
                plan.process(&mut found);
                assert_close(&found, &definition(&x, sign));
            }
        }
    }

    #[test]
    fn real_transforms_equal_the_complex_ones() {
        let mut random = Random::new(4, 0);
        for length in LENGTHS {
            let mut fft = RealFft::new(length);
            let values: Vec<f64> = (0..length).map(|_| random.unit() - 0.5).collect();
            let complex: Vec<Complex64> = values.iter().map(|&x| x.into()).collect();
            let mut bins = vec![Complex64::ZERO; fft.bins()];
            fft.forward(&values, &mut bins);
            assert_close(&bins, &definition(&complex, -1.0)[..fft.bins()]);
            let mut back = vec![0.0; length];
            fft.inverse(&bins, &mut back);
            for (x, y) in values.iter().zip(&back) {
                assert!((x * length as f64 - y).abs() < 1e-12 * length as f64, "{length}: {x} {y}");
            }
        }
    }

    #[test]
    fn inverse_takes_the_real_part_of_bins_that_stand_alone() {
        let mut fft = RealFft::new(8);
        let mut bins = vec![Complex64::ZERO; 5];
        (bins[0].im, bins[4].im) = (1.0, -2.0);
        let mut values = [1.0; 8];
        fft.inverse(&bins, &mut values);
        assert_eq!(values, [0.0; 8]);
    }
}
