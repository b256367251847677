//! Cholesky factorisation of Hermitian positive definite matrices.

use super::split::{add_scaled, dot_conjugate};
use crate::error::InputError;
use ndarray::{Array1, Array2, ArrayView1, ArrayView2};
use num_complex::Complex64;

/// Lower triangular `L` with `A = L L^H`.
///
/// Row `i` of the factor takes `i + 1` places from `i (i + 1) / 2` on, so that every inner loop
/// runs over neighbouring numbers.
#[derive(Debug, Clone)]
pub struct Cholesky {
    size: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

/// Where row `i` of a packed triangle starts.
fn start(i: usize) -> usize {
    i * (i + 1) / 2
}

impl Cholesky {
    /// Factors a Hermitian matrix, of which the lower triangle is read.
    ///
    /// # Errors
    /// [`InputError::Shape`] if not square, [`InputError::NotPositiveDefinite`] at the first pivot
    /// that is not positive.
    pub fn new(matrix: ArrayView2<Complex64>) -> Result<Self, InputError> {
        let n = matrix.nrows();
        if matrix.ncols() != n {
            return Err(InputError::Shape {
                what: "matrix to factor".into(),
                expected: "a square matrix".into(),
                given: vec![n, matrix.ncols()],
            });
        }
        let (mut re, mut im) = (vec![0.0; start(n)], vec![0.0; start(n)]);
        for i in 0..n {
            let (above_re, row_re) = re.split_at_mut(start(i));
            let (above_im, row_im) = im.split_at_mut(start(i));
            let (row_re, row_im) = (&mut row_re[..=i], &mut row_im[..=i]);
            for k in 0..i {
                let pivot = start(k)..start(k) + k;
                let other = (&above_re[pivot.clone()], &above_im[pivot]);
                let (sum_re, sum_im) = dot_conjugate(other, (&row_re[..k], &row_im[..k]));
                let scale = 1.0 / above_re[start(k) + k];
                row_re[k] = (matrix[[i, k]].re - sum_re) * scale;
                row_im[k] = (matrix[[i, k]].im - sum_im) * scale;
            }
            let (row, row_again) = ((&row_re[..i], &row_im[..i]), (&row_re[..i], &row_im[..i]));
            let pivot = matrix[[i, i]].re - dot_conjugate(row, row_again).0;
            if pivot.is_nan() || pivot <= 0.0 {
                return Err(InputError::NotPositiveDefinite {
                    what: "matrix".into(),
                    index: i,
                    given: pivot,
                });
            }
            row_re[i] = pivot.sqrt();
        }
        Ok(Self { size: n, re, im })
    }

    fn row(&self, i: usize) -> (&[f64], &[f64]) {
        let range = start(i)..start(i) + i;
        (&self.re[range.clone()], &self.im[range])
    }

    /// The diagonal of `L`.
    pub fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.size).map(|i| self.re[start(i) + i])
    }

    /// The factor `L`.
    pub fn lower(&self) -> Array2<Complex64> {
        Array2::from_shape_fn((self.size, self.size), |(i, k)| {
            if k <= i {
                Complex64::new(self.re[start(i) + k], self.im[start(i) + k])
            } else {
                Complex64::ZERO
            }
        })
    }

    /// `L^-1 b`.
    pub fn forward(&self, b: ArrayView1<Complex64>) -> Array1<Complex64> {
        let mut x = b.to_owned();
        for i in 0..self.size {
            let (re, im) = self.row(i);
            let mut sum = x[i];
            for (k, (re, im)) in re.iter().zip(im).enumerate() {
                sum -= Complex64::new(*re, *im) * x[k];
            }
            x[i] = sum / self.re[start(i) + i];
        }
        x
    }

    /// `A^-1 b`.
    pub fn solve(&self, b: ArrayView1<Complex64>) -> Array1<Complex64> {
        let mut x = self.forward(b);
        for i in (0..self.size).rev() {
            let value = x[i] / self.re[start(i) + i];
            x[i] = value;
            let (re, im) = self.row(i);
            for (k, (re, im)) in re.iter().zip(im).enumerate() {
                x[k] -= Complex64::new(*re, -im) * value;
            }
        }
        x
    }

    /// `A^-1`, exactly Hermitian.
    pub fn inverse(&self) -> Array2<Complex64> {
        let n = self.size;
        let (re, im) = self.inverse_factor();
        // A^-1 = M^H M with M = L^-1, one row of M at a time.
        let (mut sum_re, mut sum_im) = (vec![0.0; n * n], vec![0.0; n * n]);
        for k in 0..n {
            let row = (&re[start(k)..=start(k) + k], &im[start(k)..=start(k) + k]);
            for i in 0..=k {
                let range = i * n..i * n + i + 1;
                let target = (&mut sum_re[range.clone()], &mut sum_im[range]);
                add_scaled(target, (row.0[i], -row.1[i]), row);
            }
        }
        let mut inverse = Array2::zeros((n, n));
        for i in 0..n {
            for k in 0..i {
                let value = Complex64::new(sum_re[i * n + k], sum_im[i * n + k]);
                inverse[[i, k]] = value;
                inverse[[k, i]] = value.conj();
            }
            inverse[[i, i]] = Complex64::new(sum_re[i * n + i], 0.0);
        }
        inverse
    }

    /// `L^-1`, packed as `L` is.
    fn inverse_factor(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut re, mut im) = (vec![0.0; self.re.len()], vec![0.0; self.im.len()]);
        for i in 0..self.size {
            let (above_re, row_re) = re.split_at_mut(start(i));
            let (above_im, row_im) = im.split_at_mut(start(i));
            let (factor_re, factor_im) = self.row(i);
            let scale = 1.0 / self.re[start(i) + i];
            for k in 0..i {
                let range = start(k)..=start(k) + k;
                let other = (&above_re[range.clone()], &above_im[range]);
                let factor = (-scale * factor_re[k], -scale * factor_im[k]);
                add_scaled((&mut row_re[..=k], &mut row_im[..=k]), factor, other);
            }
            row_re[i] = scale;
        }
        (re, im)
    }

    /// Natural logarithm of the determinant of `A`.
    pub fn log_determinant(&self) -> f64 {
        2.0 * self.diagonal().map(f64::ln).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::hermitian_eigen;
    use crate::random::Random;

    #[test]
    fn inverse_times_matrix_is_the_identity() {
        let mut random = Random::new(1, 0);
        let x = Array2::from_shape_fn((9, 20), |_| random.complex_normal(1.0));
        let a = x.dot(&super::super::adjoint(x.view()));
        let factor = Cholesky::new(a.view()).unwrap();
        let error = factor.inverse().dot(&a) - Array2::<Complex64>::eye(9);
        assert!(error.iter().all(|z| z.norm() < 1e-11));
        let lower = factor.lower();
        let rebuilt = lower.dot(&super::super::adjoint(lower.view()));
        assert!((rebuilt - &a).iter().all(|z| z.norm() < 1e-11));
        let b = x.column(0);
        let residual = a.dot(&factor.solve(b)) - b;
        assert!(residual.iter().all(|z| z.norm() < 1e-11));
        assert!((lower.dot(&factor.forward(b)) - b).iter().all(|z| z.norm() < 1e-12));
        let determinant = hermitian_eigen(a.view()).unwrap().values.mapv(f64::ln).sum();
        assert!((factor.log_determinant() - determinant).abs() < 1e-10);
    }

    #[test]
    fn indefinite_matrices_are_refused() {
        let mut a = Array2::<Complex64>::eye(3);
        a[[1, 1]] = Complex64::new(-1.0, 0.0);
        let error = Cholesky::new(a.view()).unwrap_err();
        assert!(matches!(error, InputError::NotPositiveDefinite { index: 1, .. }));
        a[[1, 1]] = Complex64::new(f64::NAN, 0.0);
        let error = Cholesky::new(a.view()).unwrap_err();
        assert!(matches!(error, InputError::NotPositiveDefinite { index: 1, .. }));
    }
}
