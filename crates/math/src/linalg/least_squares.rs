//! Linear systems by LU, and least squares by Gram-Schmidt orthogonalisation.

use super::split::{add_scaled, dot_conjugate};
use super::{from_nalgebra, to_nalgebra};
use crate::error::InputError;
use ndarray::{Array2, ArrayView1, ArrayView2};
use num_complex::Complex64;

/// Solves the square system `A X = B` by LU with partial pivoting; `None` if `A` is singular.
///
/// # Errors
/// [`InputError::Shape`] if `A` is not square or `B` has another number of rows.
pub fn solve(
    a: ArrayView2<Complex64>,
    b: ArrayView2<Complex64>,
) -> Result<Option<Array2<Complex64>>, InputError> {
    super::eigenvalues::check_square("system matrix", a)?;
    check_rows(a, b)?;
    Ok(to_nalgebra(a).lu().solve(&to_nalgebra(b)).map(|x| from_nalgebra(&x)))
}

/// The `X` that minimises `|A X - B|` for a tall `A` of full column rank; `None` if the rank is
/// deficient to 1e-13 of the largest pivot.
///
/// # Errors
/// [`InputError::Shape`] if `A` is empty or wide, or `B` has another number of rows.
pub fn least_squares(
    a: ArrayView2<Complex64>,
    b: ArrayView2<Complex64>,
) -> Result<Option<Array2<Complex64>>, InputError> {
    if a.nrows() < a.ncols() || a.is_empty() {
        return Err(InputError::Shape {
            what: "least-squares matrix".into(),
            expected: "at least as many rows as columns".into(),
            given: vec![a.nrows(), a.ncols()],
        });
    }
    check_rows(a, b)?;
    let (basis, triangle) = orthonormal(a);
    let n = a.ncols();
    let pivot = |i: usize| triangle[[i, i]].re;
    let largest = (0..n).map(pivot).fold(0.0, f64::max);
    if !largest.is_finite() || (0..n).any(|i| pivot(i).is_nan() || pivot(i) <= 1e-13 * largest) {
        return Ok(None);
    }
    let mut x = Array2::zeros((n, b.ncols()));
    for (from, mut to) in b.columns().into_iter().zip(x.columns_mut()) {
        let column = Column::new(from);
        for i in (0..n).rev() {
            let (re, im) = dot_conjugate(basis[i].parts(), column.parts());
            let known: Complex64 = (i + 1..n).map(|m| triangle[[i, m]] * to[m]).sum();
            to[i] = (Complex64::new(re, im) - known) / pivot(i);
        }
    }
    Ok(Some(x))
}

/// A column, real and imaginary parts apart.
struct Column {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Column {
    fn new(from: ArrayView1<Complex64>) -> Self {
        Self { re: from.iter().map(|z| z.re).collect(), im: from.iter().map(|z| z.im).collect() }
    }

    fn parts(&self) -> (&[f64], &[f64]) {
        (&self.re, &self.im)
    }
}

/// `A = Q R` by modified Gram-Schmidt, each column cleared twice, which leaves `Q` orthonormal to
/// rounding (Giraud, Langou and Rozloznik 2005): the columns of `Q`, and `R`.
fn orthonormal(a: ArrayView2<Complex64>) -> (Vec<Column>, Array2<Complex64>) {
    let n = a.ncols();
    let mut basis: Vec<Column> = Vec::with_capacity(n);
    let mut triangle = Array2::zeros((n, n));
    for (k, column) in a.columns().into_iter().enumerate() {
        let mut column = Column::new(column);
        for _ in 0..2 {
            for (i, q) in basis.iter().enumerate() {
                let (re, im) = dot_conjugate(q.parts(), column.parts());
                triangle[[i, k]] += Complex64::new(re, im);
                add_scaled((&mut column.re, &mut column.im), (-re, -im), q.parts());
            }
        }
        let size = dot_conjugate(column.parts(), column.parts()).0.sqrt();
        triangle[[k, k]] = Complex64::new(size, 0.0);
        column.re.iter_mut().chain(&mut column.im).for_each(|x| *x /= size);
        basis.push(column);
    }
    (basis, triangle)
}

fn check_rows(a: ArrayView2<Complex64>, b: ArrayView2<Complex64>) -> Result<(), InputError> {
    if a.nrows() == b.nrows() {
        return Ok(());
    }
    Err(InputError::Shape {
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
    fn nearly_dependent_columns_are_solved_to_their_condition() {
        let mut random = Random::new(5, 0);
        let mut a = Array2::from_shape_fn((12, 3), |_| random.complex_normal(1.0));
        for k in 0..12 {
            a[[k, 2]] = a[[k, 0]] + a[[k, 2]] * 1e-8;
        }
        let wanted = Array2::from_shape_fn((3, 2), |_| random.complex_normal(1.0));
        let b = a.dot(&wanted);
        let x = least_squares(a.view(), b.view()).unwrap().unwrap();
        assert!((&x - &wanted).iter().all(|z| z.norm() < 1e-6));
        assert!((a.dot(&x) - b).iter().all(|z| z.norm() < 1e-13));
    }

    #[test]
    fn singular_systems_have_no_solution() {
        let a = Array2::from_elem((3, 3), Complex64::new(1.0, 0.0));
        assert!(solve(a.view(), a.view()).unwrap().is_none());
        assert!(least_squares(a.view(), a.view()).unwrap().is_none());
        let short = solve(a.view(), Array2::zeros((2, 1)).view()).unwrap_err();
        assert!(matches!(short, InputError::Shape { .. }), "{short}");
    }
}
