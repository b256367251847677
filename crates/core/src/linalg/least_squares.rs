//! Linear systems and least squares by Householder QR.

use super::{from_nalgebra, to_nalgebra};
use crate::error::CoreError;
use ndarray::{Array2, ArrayView2};
use num_complex::Complex64;

/// Solves the square system `A X = B` by LU with partial pivoting; `None` if `A` is singular.
///
/// # Errors
/// [`CoreError::Shape`] if `A` is not square or `B` has another number of rows.
pub fn solve(
    a: ArrayView2<Complex64>,
    b: ArrayView2<Complex64>,
) -> Result<Option<Array2<Complex64>>, CoreError> {
    super::eigenvalues::check_square("system matrix", a)?;
    check_rows(a, b)?;
    Ok(to_nalgebra(a).lu().solve(&to_nalgebra(b)).map(|x| from_nalgebra(&x)))
}

/// The `X` that minimises `|A X - B|` for a tall `A` of full column rank; `None` if the rank is
/// deficient to 1e-13 of the largest pivot.
///
/// # Errors
/// [`CoreError::Shape`] if `A` is empty or wide, or `B` has another number of rows.
pub fn least_squares(
    a: ArrayView2<Complex64>,
    b: ArrayView2<Complex64>,
) -> Result<Option<Array2<Complex64>>, CoreError> {
    if a.nrows() < a.ncols() || a.is_empty() {
        return Err(CoreError::Shape {
            what: "least-squares matrix".into(),
            expected: "at least as many rows as columns".into(),
            given: vec![a.nrows(), a.ncols()],
        });
    }
    check_rows(a, b)?;
    let qr = to_nalgebra(a).qr();
    let (q, r) = qr.unpack();
    let largest = r.diagonal().iter().map(|z| z.norm()).fold(0.0, f64::max);
    if r.diagonal().iter().any(|z| z.norm() <= 1e-13 * largest || !z.norm().is_finite()) {
        return Ok(None);
    }
    let rhs = q.adjoint() * to_nalgebra(b);
    Ok(r.solve_upper_triangular(&rhs).map(|x| from_nalgebra(&x)))
}

fn check_rows(a: ArrayView2<Complex64>, b: ArrayView2<Complex64>) -> Result<(), CoreError> {
    if a.nrows() == b.nrows() {
        return Ok(());
    }
    Err(CoreError::Shape {
        what: "right-hand side".into(),
        expected: format!("{} rows", a.nrows()),
        given: vec![b.nrows(), b.ncols()],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::adjoint;
    use crate::random::Random;

    #[test]
    fn the_residual_is_orthogonal_to_the_columns() {
        let mut random = Random::new(4, 0);
        let a = Array2::from_shape_fn((8, 3), |_| random.complex_normal(1.0));
        let b = Array2::from_shape_fn((8, 2), |_| random.complex_normal(1.0));
        let x = least_squares(a.view(), b.view()).unwrap().unwrap();
        let residual = adjoint(a.view()).dot(&(a.dot(&x) - &b));
        assert!(residual.iter().all(|z| z.norm() < 1e-12));
    }

    #[test]
    fn singular_systems_have_no_solution() {
        let a = Array2::from_elem((3, 3), Complex64::new(1.0, 0.0));
        assert!(solve(a.view(), a.view()).unwrap().is_none());
        assert!(least_squares(a.view(), a.view()).unwrap().is_none());
        assert!(solve(a.view(), Array2::zeros((2, 1)).view()).is_err());
    }
}
