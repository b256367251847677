//! Plans of fast Fourier transforms in single and double precision.
//!
//! The planners are generic and large; compiled here once for each precision, they are not
//! compiled again in every crate that transforms something.

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftNum, FftPlanner};
use std::sync::Arc;

/// A precision that transforms can be planned in: `f32` or `f64`. No plan normalises.
pub trait Transforms: FftNum {
    /// `X[k] = sum x[n] exp(-2 pi j n k / length)`.
    fn plan_forward(length: usize) -> Arc<dyn Fft<Self>>;

    /// `x[n] = sum X[k] exp(+2 pi j n k / length)`.
    fn plan_inverse(length: usize) -> Arc<dyn Fft<Self>>;

    /// The forward transform of real input: bins `0..=length / 2`.
    fn plan_real_forward(length: usize) -> Arc<dyn RealToComplex<Self>>;

    /// The inverse of bins `0..=length / 2` to real output.
    fn plan_real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>>;
}

macro_rules! transforms {
    ($real:ty) => {
        impl Transforms for $real {
            fn plan_forward(length: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_forward(length)
            }

            fn plan_inverse(length: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_inverse(length)
            }

            fn plan_real_forward(length: usize) -> Arc<dyn RealToComplex<Self>> {
                RealFftPlanner::new().plan_fft_forward(length)
            }

            fn plan_real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>> {
                RealFftPlanner::new().plan_fft_inverse(length)
            }
        }
    };
}

transforms!(f32);
transforms!(f64);

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    #[test]
    fn there_and_back_is_a_multiplication_by_the_length() {
        for length in [1, 8, 12, 97] {
            let input: Vec<Complex64> =
                (0..length).map(|n| Complex64::new(n as f64, 1.0 - n as f64)).collect();
            let mut values = input.clone();
            f64::plan_forward(length).process(&mut values);
            f64::plan_inverse(length).process(&mut values);
            let error = values.iter().zip(&input).map(|(a, b)| (a - b * length as f64).norm());
            assert!(error.fold(0.0, f64::max) < 1e-9 * (length * length) as f64);
        }
    }

    #[test]
    fn a_real_transform_is_the_head_of_the_complex_one() {
        let real: Vec<f64> = (0..16).map(|n| f64::from(n * n % 7)).collect();
        let plan = f64::plan_real_forward(16);
        let mut head = plan.make_output_vec();
        plan.process(&mut real.clone(), &mut head).unwrap();
        let mut all: Vec<Complex64> = real.iter().map(|&x| x.into()).collect();
        f64::plan_forward(16).process(&mut all);
        assert!(head.iter().zip(&all).all(|(a, b)| (a - b).norm() < 1e-12));
    }
}
