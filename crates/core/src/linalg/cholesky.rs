//! Cholesky factorisation of Hermitian positive definite matrices.

use crate::error::CoreError;
use ndarray::{Array1, Array2, ArrayView1, ArrayView2};
use num_complex::Complex64;

/// Lower triangular `L` with `A = L L^H`.
#[derive(Debug, Clone)]
pub struct Cholesky {
    lower: Array2<Complex64>,
}

impl Cholesky {
    /// Factors a Hermitian matrix, of which the lower triangle is read.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if not square, [`CoreError::NotPositiveDefinite`] at the first pivot
    /// that is not positive.
    pub fn new(matrix: ArrayView2<Complex64>) -> Result<Self, CoreError> {
        let n = matrix.nrows();
        if matrix.ncols() != n {
            return Err(CoreError::Shape {
                what: "matrix to factor".into(),
                expected: "a square matrix".into(),
                given: vec![n, matrix.ncols()],
            });
        }
        let mut lower = Array2::zeros((n, n));
        for i in 0..n {
            for k in 0..=i {
                let mut sum = matrix[[i, k]];
                for m in 0..k {
                    let (a, b): (Complex64, Complex64) = (lower[[i, m]], lower[[k, m]]);
                    sum -= a * b.conj();
                }
                if i == k {
                    if sum.re.is_nan() || sum.re <= 0.0 {
                        return Err(CoreError::NotPositiveDefinite {
                            what: "matrix".into(),
                            index: i,
                            given: sum.re,
                        });
                    }
                    lower[[i, i]] = Complex64::new(sum.re.sqrt(), 0.0);
                } else {
                    lower[[i, k]] = sum / lower[[k, k]].re;
                }
            }
        }
        Ok(Self { lower })
    }

    /// The factor `L`.
    pub fn lower(&self) -> ArrayView2<'_, Complex64> {
        self.lower.view()
    }

    /// `L^-1 b`.
    pub fn forward(&self, b: ArrayView1<Complex64>) -> Array1<Complex64> {
        let mut x = b.to_owned();
        for i in 0..x.len() {
            let mut sum = x[i];
            for m in 0..i {
                sum -= self.lower[[i, m]] * x[m];
            }
            x[i] = sum / self.lower[[i, i]].re;
        }
        x
    }

    /// `A^-1 b`.
    pub fn solve(&self, b: ArrayView1<Complex64>) -> Array1<Complex64> {
        let mut x = self.forward(b);
        for i in (0..x.len()).rev() {
            let mut sum = x[i];
            for m in i + 1..x.len() {
                sum -= self.lower[[m, i]].conj() * x[m];
            }
            x[i] = sum / self.lower[[i, i]].re;
        }
        x
    }

    /// `A^-1`.
    pub fn inverse(&self) -> Array2<Complex64> {
        let n = self.lower.nrows();
        let mut inverse = Array2::zeros((n, n));
        for k in 0..n {
            let mut unit = Array1::zeros(n);
            unit[k] = Complex64::new(1.0, 0.0);
            inverse.column_mut(k).assign(&self.solve(unit.view()));
        }
        inverse
    }

    /// Natural logarithm of the determinant of `A`.
    pub fn log_determinant(&self) -> f64 {
        2.0 * self.lower.diag().iter().map(|z| z.re.ln()).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn inverse_times_matrix_is_the_identity() {
        let mut random = Random::new(1, 0);
        let x = Array2::from_shape_fn((9, 20), |_| random.complex_normal(1.0));
        let a = x.dot(&super::super::adjoint(x.view()));
        let factor = Cholesky::new(a.view()).unwrap();
        let error = factor.inverse().dot(&a) - Array2::<Complex64>::eye(9);
        assert!(error.iter().all(|z| z.norm() < 1e-11));
        let rebuilt = factor.lower().dot(&super::super::adjoint(factor.lower()));
        assert!((rebuilt - a).iter().all(|z| z.norm() < 1e-11));
    }

    #[test]
    fn indefinite_matrices_are_refused() {
        let mut a = Array2::<Complex64>::eye(3);
        a[[1, 1]] = Complex64::new(-1.0, 0.0);
        let error = Cholesky::new(a.view()).unwrap_err();
        assert!(matches!(error, CoreError::NotPositiveDefinite { index: 1, .. }));
        a[[1, 1]] = Complex64::new(f64::NAN, 0.0);
        assert!(Cholesky::new(a.view()).is_err());
    }
}
