//! Dense complex linear algebra on [`ndarray`] matrices, and [`small`] real matrices.

mod cholesky;
mod eigenvalues;
mod hermitian;
mod least_squares;
mod roots;
pub mod small;
mod split;
mod tridiagonal;

pub use cholesky::Cholesky;
pub use eigenvalues::eigenvalues;
pub use hermitian::{
    HermitianEigen, hermitian_eigen, leading_hermitian_eigen, leading_hermitian_eigen_by,
};
pub use least_squares::{least_squares, solve};
pub use roots::polynomial_roots;

use ndarray::{Array2, ArrayView2};
use num_complex::Complex64;

/// Conjugate transpose.
pub fn adjoint(matrix: ArrayView2<Complex64>) -> Array2<Complex64> {
    matrix.t().mapv(|z| z.conj())
}

fn to_nalgebra(matrix: ArrayView2<Complex64>) -> nalgebra::DMatrix<Complex64> {
    nalgebra::DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| matrix[[i, k]])
}

fn from_nalgebra(matrix: &nalgebra::DMatrix<Complex64>) -> Array2<Complex64> {
    Array2::from_shape_fn(matrix.shape(), |(i, k)| matrix[(i, k)])
}
