//! Eigendecomposition of Hermitian matrices.

use super::{from_nalgebra, to_nalgebra};
use crate::error::{CoreError, check_finite};
use ndarray::{Array1, Array2, ArrayView2};
use num_complex::Complex64;

/// `A = V diag(values) V^H` with unitary `V`.
#[derive(Debug, Clone)]
pub struct HermitianEigen {
    /// Eigenvalues, largest first.
    pub values: Array1<f64>,
    /// Eigenvectors as columns, in the order of `values`.
    pub vectors: Array2<Complex64>,
}

/// Eigenvalues and eigenvectors of a Hermitian matrix, largest eigenvalue first.
///
/// # Errors
/// [`CoreError::Shape`] if the matrix is empty or not square, [`CoreError::NotFinite`] if an entry
/// is not finite.
pub fn hermitian_eigen(matrix: ArrayView2<Complex64>) -> Result<HermitianEigen, CoreError> {
    super::eigenvalues::check_square("Hermitian matrix", matrix)?;
    check_finite("Hermitian matrix", matrix.iter().flat_map(|z| [z.re, z.im]))?;
    let eigen = to_nalgebra(matrix).symmetric_eigen();
    let vectors = from_nalgebra(&eigen.eigenvectors);
    let mut order: Vec<usize> = (0..matrix.nrows()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    Ok(HermitianEigen {
        values: order.iter().map(|&i| eigen.eigenvalues[i]).collect(),
        vectors: vectors.select(ndarray::Axis(1), &order),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::adjoint;
    use crate::random::Random;

    #[test]
    fn rebuilds_the_matrix_from_a_unitary_basis() {
        let mut random = Random::new(2, 0);
        for n in [1, 2, 7, 32] {
            let x = Array2::from_shape_fn((n, n), |_| random.complex_normal(1.0));
            let a = &x + &adjoint(x.view());
            let eigen = hermitian_eigen(a.view()).unwrap();
            let scaled = &eigen.vectors * &eigen.values.mapv(|v| Complex64::new(v, 0.0));
            let back = scaled.dot(&adjoint(eigen.vectors.view()));
            let gram = adjoint(eigen.vectors.view()).dot(&eigen.vectors);
            assert!((back - &a).iter().all(|z| z.norm() < 1e-12 * (n as f64 + 4.0)));
            assert!((gram - Array2::<Complex64>::eye(n)).iter().all(|z| z.norm() < 1e-12));
            assert!(eigen.values.windows(2).into_iter().all(|w| w[0] >= w[1]));
        }
    }

    #[test]
    fn degenerate_and_bad_matrices() {
        let eigen = hermitian_eigen(Array2::<Complex64>::zeros((4, 4)).view()).unwrap();
        assert!(eigen.values.iter().all(|&v| v == 0.0));
        let nan = Array2::from_elem((2, 2), Complex64::new(f64::NAN, 0.0));
        assert!(matches!(hermitian_eigen(nan.view()), Err(CoreError::NotFinite { .. })));
        assert!(hermitian_eigen(Array2::zeros((2, 3)).view()).is_err());
        assert!(hermitian_eigen(Array2::zeros((0, 0)).view()).is_err());
    }
}
