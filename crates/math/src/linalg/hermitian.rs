//! Eigendecomposition of Hermitian matrices.

use super::tridiagonal::{Tridiagonal, ql};
use crate::error::{InputError, check_finite};
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

/// Eigenvalues and eigenvectors of a Hermitian matrix, of which the lower triangle is read, largest
/// eigenvalue first.
///
/// # Errors
/// [`InputError::Shape`] if the matrix is empty or not square, [`InputError::NotFinite`] if an entry
/// is not finite or an eigenvalue overflows, [`InputError::NotConverged`] if the QL iteration reaches
/// its bound.
pub fn hermitian_eigen(matrix: ArrayView2<Complex64>) -> Result<HermitianEigen, InputError> {
    leading_hermitian_eigen(matrix, matrix.nrows())
}

/// All eigenvalues of a Hermitian matrix, of which the lower triangle is read, and the eigenvectors
/// of the `count` largest (of all, if there are fewer): the signal subspace at a fraction of the
/// cost of the whole basis, as orthogonal as that.
///
/// # Errors
/// As [`hermitian_eigen`].
pub fn leading_hermitian_eigen(
    matrix: ArrayView2<Complex64>,
    count: usize,
) -> Result<HermitianEigen, InputError> {
    leading_hermitian_eigen_by(matrix, |_| count)
}

/// As [`leading_hermitian_eigen`], the number of vectors being decided on the eigenvalues, which
/// `count` is given largest first.
///
/// # Errors
/// As [`hermitian_eigen`].
pub fn leading_hermitian_eigen_by(
    matrix: ArrayView2<Complex64>,
    count: impl FnOnce(&[f64]) -> usize,
) -> Result<HermitianEigen, InputError> {
    super::eigenvalues::check_square("Hermitian matrix", matrix)?;
    check_finite("Hermitian matrix", matrix.iter().flat_map(|z| [z.re, z.im]))?;
    let n = matrix.nrows();
    let mut reduced = Tridiagonal::new(matrix)?;
    let rotations = ql(&mut reduced.diagonal, &mut reduced.off_diagonal)?;
    let values = &reduced.diagonal;
    let order = crate::order::descending(values.iter().copied());
    let sorted: Vec<f64> = order.iter().map(|&i| values[i] * reduced.scale).collect();
    check_finite("eigenvalues of the Hermitian matrix", sorted.iter().copied())?;
    let count = count(&sorted).min(n);
    let mut vectors = Array2::zeros((n, count));
    for (block, columns) in order[..count].chunks(LANES).enumerate() {
        let mut real = vec![[0.0; LANES]; n];
        for (lane, &column) in columns.iter().enumerate() {
            real[column][lane] = 1.0;
        }
        for rotation in rotations.iter().rev() {
            rotation.apply(&mut real);
        }
        let (re, im) = reduced.back_transform(&real);
        for row in 0..n {
            for lane in 0..columns.len() {
                vectors[[row, block * LANES + lane]] = Complex64::new(re[row][lane], im[row][lane]);
            }
        }
    }
    Ok(HermitianEigen { values: Array1::from(sorted), vectors })
}

/// Vectors transformed together, side by side in vector registers.
pub(super) const LANES: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::adjoint;
    use crate::random::Random;

    fn random_hermitian(n: usize, seed: u64) -> Array2<Complex64> {
        let mut random = Random::new(seed, 0);
        let x = Array2::from_shape_fn((n, n), |_| random.complex_normal(1.0));
        &x + &adjoint(x.view())
    }

    fn check(a: &Array2<Complex64>, tolerance: f64) {
        let n = a.nrows();
        let eigen = hermitian_eigen(a.view()).unwrap();
        let scaled = &eigen.vectors * &eigen.values.mapv(|v| Complex64::new(v, 0.0));
        let back = scaled.dot(&adjoint(eigen.vectors.view()));
        let gram = adjoint(eigen.vectors.view()).dot(&eigen.vectors);
        let largest = a.iter().map(|z| z.norm()).fold(0.0, f64::max);
        assert!((back - a).iter().all(|z| z.norm() <= tolerance * largest), "n = {n}");
        assert!((gram - Array2::<Complex64>::eye(n)).iter().all(|z| z.norm() <= tolerance));
        assert!(eigen.values.windows(2).into_iter().all(|w| w[0] >= w[1]));
    }

    #[test]
    fn rebuilds_the_matrix_from_a_unitary_basis() {
        for n in [1, 2, 3, 4, 7, 8, 9, 32, 65] {
            check(&random_hermitian(n, 2), 1e-14 * (n as f64 + 4.0));
        }
    }

    #[test]
    fn repeated_graded_and_extreme_eigenvalues() {
        let n = 12;
        let basis = hermitian_eigen(random_hermitian(n, 3).view()).unwrap().vectors;
        let spread = |k: usize| 10.0_f64.powi(-2 * k as i32);
        let repeated = |k: usize| if k < 5 { 2.0 } else { 1.0 };
        let low_rank = |k: usize| if k < 2 { 1.0 } else { 0.0 };
        for (values, scale) in [
            (Array1::from_shape_fn(n, spread), 1.0),
            (Array1::from_shape_fn(n, repeated), 1.0),
            (Array1::from_shape_fn(n, low_rank), 1.0),
            (Array1::from_shape_fn(n, repeated), 1e-200),
            (Array1::from_shape_fn(n, repeated), 1e200),
        ] {
            let scaled = &basis * &values.mapv(|v| Complex64::new(v * scale, 0.0));
            let a = scaled.dot(&adjoint(basis.view()));
            check(&a, 1e-13);
            let found = hermitian_eigen(a.view()).unwrap().values;
            let error = (&found / scale - &values).fold(0.0_f64, |m, e| m.max(e.abs()));
            assert!(error < 1e-14 * 20.0, "{error}");
        }
    }

    #[test]
    fn diagonal_and_permuted_matrices() {
        let mut a = Array2::from_diag(&Array1::from_shape_fn(6, |k| Complex64::new(k as f64, 0.0)));
        check(&a, 1e-15);
        a[[5, 0]] = Complex64::new(0.0, 3.0);
        a[[0, 5]] = Complex64::new(0.0, -3.0);
        check(&a, 1e-14);
    }

    #[test]
    fn leading_vectors_are_those_of_the_whole_basis() {
        let a = random_hermitian(13, 4);
        let whole = hermitian_eigen(a.view()).unwrap();
        for count in [0, 1, 3, 5, 13, 20] {
            let part = leading_hermitian_eigen(a.view(), count).unwrap();
            assert_eq!(part.vectors.dim(), (13, count.min(13)));
            assert_eq!(part.values, whole.values);
            assert_eq!(part.vectors, whole.vectors.slice(ndarray::s![.., ..count.min(13)]));
        }
    }

    #[test]
    fn eigenvalues_are_those_of_an_independent_implementation() {
        let mut random = Random::new(6, 0);
        for (n, rank, fade) in [(5, 5, 1.0), (32, 32, 1.0), (32, 3, 1e-4), (20, 20, 0.1)] {
            let x = Array2::from_shape_fn((n, rank), |(i, k)| {
                random.complex_normal(f64::powi(fade, (i + k) as i32 % 12))
            });
            let a = x.dot(&adjoint(x.view()));
            check(&a, 1e-14 * (n as f64 + 4.0));
            let found = hermitian_eigen(a.view()).unwrap().values;
            let mut wanted =
                super::super::to_nalgebra(a.view()).symmetric_eigenvalues().as_slice().to_vec();
            wanted.sort_by(|x, y| y.total_cmp(x));
            for (found, wanted) in found.iter().zip(&wanted) {
                assert!(
                    (found - wanted).abs()
                        < 1e-14 * n as f64 * wanted.abs().max(found.abs())
                            + 1e-14 * a.diag().sum().re,
                    "{found} {wanted}"
                );
            }
        }
    }

    /// Random matrices whose rows and columns are scaled by factors from 1e-300 to 1e300, with
    /// zeroed rows, exact copies of rows and denormal entries.
    #[test]
    fn extreme_finite_matrices_have_a_unitary_basis_and_finite_eigenvalues() {
        let mut random = Random::new(7, 0);
        for trial in 0..4000 {
            let n = 2 + trial % 9;
            let scales: Vec<f64> = (0..n)
                .map(|k| match (trial / 9 + k) % 7 {
                    0 => 0.0,
                    1 => 10f64.powf(random.uniform(-160.0, -70.0)),
                    2 => 10f64.powf(random.uniform(-40.0, 0.0)),
                    3 => 10f64.powf(random.uniform(100.0, 153.0)),
                    _ => 1.0,
                })
                .collect();
            let common =
                if trial % 5 == 0 { 10f64.powf(random.uniform(-300.0, -150.0)) } else { 1.0 };
            let x = Array2::from_shape_fn((n, 1 + trial % 4), |(i, _)| {
                random.complex_normal(1.0) * scales[i]
            });
            let a = x.dot(&adjoint(x.view())) * Complex64::new(common, 0.0);
            check(&a, 1e-13);
        }
    }

    #[test]
    fn eigenvalues_that_overflow_are_refused() {
        let a = Array2::from_elem((8, 8), Complex64::new(1e308, 0.0));
        let error = hermitian_eigen(a.view()).unwrap_err();
        assert!(matches!(error, InputError::NotFinite { .. }), "{error}");
    }

    #[test]
    fn degenerate_and_bad_matrices() {
        let eigen = hermitian_eigen(Array2::<Complex64>::zeros((4, 4)).view()).unwrap();
        assert!(eigen.values.iter().all(|&v| v == 0.0));
        let nan = Array2::from_elem((2, 2), Complex64::new(f64::NAN, 0.0));
        assert!(matches!(hermitian_eigen(nan.view()), Err(InputError::NotFinite { .. })));
        let flat = hermitian_eigen(Array2::zeros((2, 3)).view()).unwrap_err();
        assert!(matches!(flat, InputError::Shape { .. }), "{flat}");
        let none = hermitian_eigen(Array2::zeros((0, 0)).view()).unwrap_err();
        assert!(matches!(none, InputError::Shape { .. }), "{none}");
    }
}
