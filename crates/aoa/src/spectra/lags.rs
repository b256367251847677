//! A Hermitian form over the steering vectors of a lattice as a trigonometric polynomial: the sums
//! along equal lags, and its refinement at a cost of one lag after the other.

use crate::spectra::quadratic::Towards;
use boresight_core::{Complex64, Lattice};
use boresight_math::phasor::cis;
use ndarray::ArrayView2;
use std::f64::consts::PI;

/// `f(u) = q_0 + 2 Re sum_m q_m exp(-j pi d m u)`.
pub(crate) struct LagPolynomial {
    spacing: f64,
    lags: Vec<Complex64>,
}

impl LagPolynomial {
    /// The form's sums along equal lags; its lower triangle is read.
    pub fn new(lattice: &Lattice, form: ArrayView2<Complex64>) -> Self {
        let mut lags = vec![Complex64::ZERO; lattice.span()];
        let mut trace = 0.0;
        for ((k, row), &nk) in form.rows().into_iter().enumerate().zip(&lattice.indices) {
            trace += row[k].re;
            for (value, &nl) in row.iter().zip(&lattice.indices[..k]) {
                if nk >= nl {
                    lags[nk - nl] += value;
                } else {
                    lags[nl - nk] += value.conj();
                }
            }
        }
        // Elements at one place meet at lag zero off the diagonal, from both sides of it.
        lags[0] = Complex64::new(trace + 2.0 * lags[0].re, 0.0);
        Self { spacing: lattice.spacing, lags }
    }

    /// `q_m` for `m` from 0 on.
    pub fn lags(&self) -> &[Complex64] {
        &self.lags
    }

    /// Value, slope and curvature by `u`.
    fn at(&self, u: f64) -> [f64; 3] {
        let turn = cis(-PI * self.spacing * u);
        let mut power = turn;
        let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
        for (m, q) in self.lags.iter().enumerate().skip(1) {
            let term = q * power;
            let m = m as f64;
            value += term.re;
            slope += m * term.im;
            bend -= m * m * term.re;
            power *= turn;
        }
        let scale = PI * self.spacing;
        [self.lags[0].re + 2.0 * value, 2.0 * scale * slope, 2.0 * scale * scale * bend]
    }

    /// The stationary point nearest to `start` and the value there, by Newton steps that go
    /// downhill (or uphill) and stray from `start` by no more than `widest`.
    pub fn refine(&self, start: f64, widest: f64, towards: Towards) -> (f64, f64) {
        let sign = if towards == Towards::Minimum { 1.0 } else { -1.0 };
        let mut u = start;
        let mut here = self.at(u).map(|x| sign * x);
        for _ in 0..8 {
            let [value, slope, bend] = here;
            let mut step = if bend > 0.0 { -slope / bend } else { -slope.signum() * widest };
            step = step.clamp(-0.5 * widest, 0.5 * widest);
            let mut accepted = false;
            for _ in 0..6 {
                let next = (u + step).clamp(-1.0, 1.0);
                let there = self.at(next).map(|x| sign * x);
                if there[0] <= value && (next - start).abs() <= widest {
                    (u, here, accepted) = (next, there, true);
                    break;
                }
                step *= 0.25;
            }
            if !accepted || step.abs() < 1e-13 {
                break;
            }
        }
        (u, sign * here[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::steering::steering_vector;
    use boresight_core::{Array, Direction, Random};
    use boresight_math::linalg::adjoint;
    use ndarray::Array2;

    #[test]
    fn value_and_derivatives_are_those_of_the_form() {
        let mut random = Random::new(13, 0);
        let positions: Vec<[f64; 3]> =
            [0.0, -1.4, -2.1, 2.8].iter().map(|&y| [0.2, y, 0.0]).collect();
        let array = Array::new(&positions).unwrap();
        let x = Array2::from_shape_fn((4, 3), |_| random.complex_normal(1.0));
        let form = x.dot(&adjoint(x.view()));
        let polynomial = LagPolynomial::new(&array.lattice().unwrap(), form.view());
        let (u, h) = (0.31, 1e-4);
        let [value, slope, bend] = polynomial.at(u);
        let a = steering_vector(&array, Direction::azimuth(u.asin()));
        let exact: Complex64 = a.iter().zip(form.dot(&a)).map(|(a, b)| a.conj() * b).sum();
        assert!((value - exact.re).abs() < 1e-12 * value.abs());
        let (left, right) = (polynomial.at(u - h)[0], polynomial.at(u + h)[0]);
        assert!((slope - (right - left) / (2.0 * h)).abs() < 1e-4 * slope.abs());
        assert!((bend - (right - 2.0 * value + left) / (h * h)).abs() < 1e-4 * bend.abs());
    }

    #[test]
    fn refinement_ends_on_a_stationary_point_and_stays_near() {
        let array = Array::ula(8).unwrap();
        let a = steering_vector(&array, Direction::azimuth(0.2)).insert_axis(ndarray::Axis(1));
        let form = a.dot(&adjoint(a.view()));
        let polynomial = LagPolynomial::new(&array.lattice().unwrap(), form.view());
        let truth = 0.2f64.sin();
        let (u, value) = polynomial.refine(truth + 3e-3, 0.01, Towards::Maximum);
        assert!((u - truth).abs() < 1e-10 && (value - 64.0).abs() < 1e-10);
        let (u, _) = polynomial.refine(truth + 0.05, 0.01, Towards::Maximum);
        assert!((u - truth - 0.05).abs() <= 0.01 + 1e-12);
    }
}
