//! Eigenvalues of general complex matrices.

use super::to_nalgebra;
use crate::error::{InputError, check_finite};
use ndarray::ArrayView2;
use num_complex::Complex64;

/// Eigenvalues of a square complex matrix by the QR algorithm, in no particular order; `None` if
/// the iteration does not settle within 100 sweeps a row.
///
/// # Errors
/// [`InputError::Shape`] if the matrix is empty or not square, [`InputError::NotFinite`] if an entry
/// is not finite.
pub fn eigenvalues(matrix: ArrayView2<Complex64>) -> Result<Option<Vec<Complex64>>, InputError> {
    check_square("matrix", matrix)?;
    check_finite("matrix", matrix.iter().flat_map(|z| [z.re, z.im]))?;
    let sweeps = 100 * matrix.nrows();
    let schur = nalgebra::Schur::try_new(to_nalgebra(matrix), f64::EPSILON, sweeps);
    Ok(schur.map(|schur| schur.unpack().1.diagonal().iter().copied().collect()))
}

pub(super) fn check_square(what: &str, matrix: ArrayView2<Complex64>) -> Result<(), InputError> {
    if matrix.nrows() == matrix.ncols() && matrix.nrows() > 0 {
        return Ok(());
    }
    Err(InputError::Shape {
        what: what.into(),
        expected: "a square matrix".into(),
        given: vec![matrix.nrows(), matrix.ncols()],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::hermitian_eigen;
    use crate::random::Random;
    use ndarray::{Array2, array};

    #[test]
    fn similar_matrices_keep_their_eigenvalues() {
        let mut random = Random::new(3, 0);
        for n in [1usize, 2, 3, 8] {
            let x = Array2::from_shape_fn((n, n), |_| random.complex_normal(1.0));
            let h = &x + &crate::linalg::adjoint(x.view());
            let basis = hermitian_eigen(h.view()).unwrap().vectors;
            let wanted: Vec<Complex64> = (0..n).map(|_| random.complex_normal(1.0)).collect();
            let upper = Array2::from_shape_fn((n, n), |(i, k)| match i.cmp(&k) {
                std::cmp::Ordering::Less => random.complex_normal(1.0),
                std::cmp::Ordering::Equal => wanted[i],
                std::cmp::Ordering::Greater => Complex64::ZERO,
            });
            let a = basis.dot(&upper).dot(&crate::linalg::adjoint(basis.view()));
            let found = eigenvalues(a.view()).unwrap().unwrap();
            for value in &wanted {
                assert!(found.iter().any(|z| (z - value).norm() < 1e-9), "{value} in {found:?}");
            }
        }
    }

    #[test]
    fn a_rotation_has_complex_eigenvalues() {
        let one = Complex64::new(1.0, 0.0);
        let rotation = array![[Complex64::ZERO, -one], [one, Complex64::ZERO]];
        let found = eigenvalues(rotation.view()).unwrap().unwrap();
        assert!(found.iter().all(|z| z.re.abs() < 1e-12 && (z.im.abs() - 1.0).abs() < 1e-12));
    }
}
