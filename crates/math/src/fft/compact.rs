//! Plans made of few kernels, for where the size of the program counts.

use super::Transforms;
use super::power_of_two::PowerOfTwo;
use rustfft::algorithm::butterflies::{Butterfly3, Butterfly5, Butterfly7};
use rustfft::algorithm::{BluesteinsAlgorithm, Dft, MixedRadix};
use rustfft::{Fft, FftDirection};
use std::sync::Arc;

/// Plans transforms of `length` numbers. Products of 2, 3, 5 and 7 are split into their factors
/// (Cooley and Tukey 1965); all else takes Bluestein's chirp (1970), at some six times the cost.
pub fn plan<T: Transforms>(length: usize, direction: FftDirection) -> Arc<dyn Fft<T>> {
    if length < 2 {
        return Arc::new(Dft::new(length, direction));
    }
    let even = 1 << length.trailing_zeros();
    let mut rest = length / even;
    let mut plan: Option<Arc<dyn Fft<T>>> =
        (even > 1).then(|| Arc::new(PowerOfTwo::new(even, direction)) as Arc<dyn Fft<T>>);
    for (factor, kernel) in small::<T>(direction) {
        while rest.is_multiple_of(factor) {
            rest /= factor;
            plan = Some(match plan {
                Some(plan) => Arc::new(MixedRadix::new(plan, kernel.clone())),
                None => kernel.clone(),
            });
        }
    }
    match plan {
        Some(plan) if rest == 1 => plan,
        _ => {
            let inner = PowerOfTwo::new((2 * length - 1).next_power_of_two(), direction);
            Arc::new(BluesteinsAlgorithm::new(length, Arc::new(inner)))
        }
    }
}

fn small<T: Transforms>(direction: FftDirection) -> [(usize, Arc<dyn Fft<T>>); 3] {
    [
        (7, Arc::new(Butterfly7::new(direction))),
        (5, Arc::new(Butterfly5::new(direction))),
        (3, Arc::new(Butterfly3::new(direction))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use num_complex::{Complex32, Complex64};
    use rustfft::FftPlanner;
    use std::f64::consts::TAU;

    /// `X[k]` by the definition; `sign` is that of its exponent.
    fn bin(x: &[Complex64], k: usize, sign: f64) -> Complex64 {
        let n = x.len();
        let term = |i: usize| crate::phasor::cis(sign * TAU * (k * i % n) as f64 / n as f64) * x[i];
        // In parts, so that rounding grows with the root of the length.
        (0..n).step_by(32).map(|i| (i..n.min(i + 32)).map(term).sum::<Complex64>()).sum()
    }

    fn noise(length: usize) -> Vec<Complex64> {
        let mut random = Random::new(3, length as u64);
        (0..length).map(|_| random.complex_normal(1.0)).collect()
    }

    const DIRECTIONS: [(FftDirection, f64); 2] =
        [(FftDirection::Forward, -1.0), (FftDirection::Inverse, 1.0)];

    /// Bins are sums of `length` random numbers, so of size `sqrt(length)`. Bluestein's form goes
    /// through two transforms of up to four times the length and rounds most; 32 units are twice
    /// what it takes in the worst of 4 million bins.
    fn rounding(length: usize) -> f64 {
        32.0 * f64::EPSILON * (length as f64).sqrt()
    }

    #[test]
    fn every_length_is_the_definition() {
        for length in 1..=2048_usize {
            let x = noise(length);
            // All bins of short transforms, and some of long ones spread over all residues.
            let step = if length <= 128 { 1 } else { length / 6 + length % 2 };
            for (direction, sign) in DIRECTIONS {
                let mut y = x.clone();
                plan::<f64>(length, direction).process(&mut y);
                for k in (0..length).step_by(step) {
                    let error = (y[k] - bin(&x, k, sign)).norm();
                    assert!(error < rounding(length), "{length}, bin {k}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn every_bin_of_every_length_is_that_of_the_full_planner() {
        for length in (1..=2048).chain([3072, 4096, 4099, 8192, 10_000]) {
            let x = noise(length);
            for (direction, _) in DIRECTIONS {
                let mut expected = x.clone();
                FftPlanner::new().plan_fft(length, direction).process(&mut expected);
                let mut y = x.clone();
                plan::<f64>(length, direction).process(&mut y);
                let error = y.iter().zip(&expected).map(|(a, b)| (a - b).norm());
                let worst = error.fold(0.0, f64::max);
                assert!(worst < rounding(length), "{length}: {worst:e}");
            }
        }
    }

    /// In place, out of place and from data that must not change, for some blocks in one call; several at
    /// a time give the same bits as one by one.
    #[test]
    fn every_way_of_calling_gives_the_same() {
        let lengths = [1, 2, 3, 8, 12, 31, 64, 105, 128, 304, 2048];
        for (length, blocks) in lengths.into_iter().flat_map(|n| [(n, 2), (n, 7)]) {
            for (direction, _) in DIRECTIONS {
                let fft = plan::<f64>(length, direction);
                assert_eq!((fft.len(), fft.fft_direction()), (length, direction));
                let x = noise(blocks * length);
                let mut expected = x.clone();
                expected.chunks_mut(length).for_each(|block| fft.process(block));
                let mut y = x.clone();
                fft.process(&mut y);
                assert_eq!(y, expected);
                let mut input = x.clone();
                let mut scratch = vec![Complex64::ZERO; fft.get_outofplace_scratch_len()];
                y.fill(Complex64::ZERO);
                fft.process_outofplace_with_scratch(&mut input, &mut y, &mut scratch);
                assert_near(&y, &expected);
                let mut scratch = vec![Complex64::ZERO; fft.get_immutable_scratch_len()];
                y.fill(Complex64::ZERO);
                fft.process_immutable_with_scratch(&x, &mut y, &mut scratch);
                assert_near(&y, &expected);
            }
        }
    }

    fn assert_near(y: &[Complex64], expected: &[Complex64]) {
        for (a, b) in y.iter().zip(expected) {
            assert!((a - b).norm() < rounding(y.len()), "{}: {a} {b}", y.len());
        }
    }

    #[test]
    fn single_precision_is_as_good_as_single_precision_gets() {
        for length in 2..=520 {
            let x = noise(length);
            let mut expected = x.clone();
            FftPlanner::new().plan_fft_forward(length).process(&mut expected);
            let mut y: Vec<Complex32> =
                x.iter().map(|z| Complex32::new(z.re as f32, z.im as f32)).collect();
            plan::<f32>(length, FftDirection::Forward).process(&mut y);
            let wide = |z: &Complex32| Complex64::new(z.re.into(), z.im.into());
            let error: f64 = y.iter().zip(&expected).map(|(a, b)| (wide(a) - b).norm_sqr()).sum();
            let power: f64 = expected.iter().map(Complex64::norm_sqr).sum();
            let relative = (error / power).sqrt();
            assert!(relative < 4.0 * f64::from(f32::EPSILON), "{length}: {relative:e}");
        }
    }
}
