//! Spatial covariance: sample average, forward-backward averaging, spatial smoothing, loading.

use crate::error::SignalError;
use boresight_core::{Complex64, InputError};
use boresight_math::error::check_range;
use ndarray::{Array2, ArrayView2, s};
use wide::f64x2;

/// Snapshots handled together, in the lanes of a vector register.
const LANES: usize = 2;

/// Rows handled together; each entry loaded serves this many products.
const ROWS: usize = 2;

/// Sample covariance `R = Y Y^H / L` of elements x snapshots `Y` with `L` snapshots: elements x
/// elements, exactly Hermitian with a real diagonal. Zero where there are no snapshots.
pub fn sample_covariance(snapshots: ArrayView2<Complex64>) -> Array2<Complex64> {
    let (elements, count) = snapshots.dim();
    let rows = Rows::of(snapshots);
    let scale = 1.0 / count.max(1) as f64;
    let mut covariance = Array2::zeros((elements, elements));
    for i in 0..elements.div_ceil(ROWS) {
        for k in 0..=i {
            let products = inner_products(&rows, i * ROWS, k * ROWS);
            for (row, products) in products.iter().enumerate() {
                for (column, value) in products.iter().enumerate() {
                    let at = [i * ROWS + row, k * ROWS + column];
                    if at[0] < elements && at[1] <= at[0] {
                        let im = if at[0] == at[1] { 0.0 } else { value.im };
                        let value = Complex64::new(value.re, im) * scale;
                        covariance[at] = value;
                        covariance[[at[1], at[0]]] = value.conj();
                    }
                }
            }
        }
    }
    covariance
}

/// Rows of snapshots, real and imaginary parts apart, one after the other.
struct Rows {
    re: Vec<f64x2>,
    im: Vec<f64x2>,
    /// Groups of lanes in a row.
    groups: usize,
}

impl Rows {
    /// The rows of a matrix, filled up with zeros to whole groups of lanes and of rows.
    fn of(matrix: ArrayView2<Complex64>) -> Self {
        let groups = matrix.ncols().div_ceil(LANES);
        let all = groups * matrix.nrows().next_multiple_of(ROWS);
        let (mut re, mut im) = (vec![f64x2::ZERO; all], vec![f64x2::ZERO; all]);
        for (k, from) in matrix.outer_iter().enumerate() {
            let row = k * groups..(k + 1) * groups;
            for (g, (re, im)) in re[row.clone()].iter_mut().zip(&mut im[row]).enumerate() {
                let z = from[g * LANES];
                let next = from.get(g * LANES + 1).copied().unwrap_or(Complex64::ZERO);
                (*re, *im) = (f64x2::new([z.re, next.re]), f64x2::new([z.im, next.im]));
            }
        }
        Self { re, im, groups }
    }

    /// Real and imaginary parts of row `k`.
    fn row(&self, k: usize) -> impl Iterator<Item = (&f64x2, &f64x2)> {
        let row = k * self.groups..(k + 1) * self.groups;
        self.re[row.clone()].iter().zip(&self.im[row])
    }
}

/// `sum x conj(y)` for every `x` of the group of rows that begins with one and `y` of another.
fn inner_products(rows: &Rows, x: usize, y: usize) -> [[Complex64; ROWS]; ROWS] {
    let mut re = [f64x2::ZERO; ROWS * ROWS];
    let mut im = [f64x2::ZERO; ROWS * ROWS];
    let left = rows.row(x).zip(rows.row(x + 1));
    let right = rows.row(y).zip(rows.row(y + 1));
    for (((&ar, &ai), (&br, &bi)), ((&cr, &ci), (&dr, &di))) in left.zip(right) {
        re[0] = re[0] + ar * cr + ai * ci;
        im[0] = im[0] + ai * cr - ar * ci;
        re[1] = re[1] + ar * dr + ai * di;
        im[1] = im[1] + ai * dr - ar * di;
        re[2] = re[2] + br * cr + bi * ci;
        im[2] = im[2] + bi * cr - br * ci;
        re[3] = re[3] + br * dr + bi * di;
        im[3] = im[3] + bi * dr - br * di;
    }
    let sum = |k: usize| Complex64::new(re[k].reduce_add(), im[k].reduce_add());
    [[sum(0), sum(1)], [sum(2), sum(3)]]
}

/// Forward-backward average `(R + J R* J) / 2`, `J` reversing the elements. For arrays that look
/// the same from both ends in element order, such as uniform ones; it halves the variance and
/// separates two coherent sources.
pub fn forward_backward(covariance: ArrayView2<Complex64>) -> Array2<Complex64> {
    let reversed = covariance.slice(s![..;-1, ..;-1]);
    ndarray::Zip::from(covariance).and(reversed).map_collect(|z, r| (z + r.conj()) * 0.5)
}

/// Spatial smoothing (Shan, Wax and Kailath 1985): the mean of the covariances of all subarrays of
/// `length` neighbouring elements of a uniform array, `length` x `length`. It separates as many
/// coherent sources as there are subarrays; of a covariance from [`forward_backward`] it gives
/// forward-backward smoothing, which needs half the subarrays (Pillai and Kwon 1989).
///
/// # Errors
/// [`InputError::Shape`] if the covariance is not square, [`InputError::OutOfRange`] if `length` is
/// not within 1 and the number of elements.
pub fn spatial_smoothing(
    covariance: ArrayView2<Complex64>,
    length: usize,
) -> Result<Array2<Complex64>, SignalError> {
    let elements = covariance.nrows();
    if covariance.ncols() != elements {
        return Err(SignalError::Argument(InputError::Shape {
            what: "covariance".into(),
            expected: "a square matrix".into(),
            given: covariance.shape().to_vec(),
        }));
    }
    check_range("subarray length", length as f64, 1.0, elements as f64)?;
    let subarrays = elements - length + 1;
    let mut smoothed = Array2::zeros((length, length));
    for first in 0..subarrays {
        let last = first + length;
        smoothed += &covariance.slice(s![first..last, first..last]);
    }
    smoothed.mapv_inplace(|z: Complex64| z / subarrays as f64);
    Ok(smoothed)
}

/// Adds `share` of the mean of the diagonal to every entry of the diagonal of a square matrix.
pub fn load_diagonal(covariance: &mut Array2<Complex64>, share: f64) {
    let mut diagonal = covariance.diag_mut();
    let mean = diagonal.iter().map(|z| z.re).sum::<f64>() / diagonal.len().max(1) as f64;
    diagonal.mapv_inplace(|z| z + share * mean);
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::direction::Direction;
    use boresight_core::{Array, Random, steering};
    use boresight_math::linalg::{adjoint, hermitian_eigen};

    fn noise(elements: usize, snapshots: usize) -> Array2<Complex64> {
        let mut random = Random::new(11, 0);
        Array2::from_shape_fn((elements, snapshots), |_| random.complex_normal(1.0))
    }

    /// Covariance of two fully coherent sources at -20 and 25 degrees, without noise.
    fn coherent(elements: usize) -> Array2<Complex64> {
        let array = Array::ula(elements).unwrap();
        let at = |deg: f64| steering::steering_vector(&array, Direction::azimuth(deg.to_radians()));
        let sum = (at(-20.0) + at(25.0)).insert_axis(ndarray::Axis(1));
        sample_covariance(sum.view())
    }

    fn rank(matrix: &Array2<Complex64>) -> usize {
        let values = hermitian_eigen(matrix.view()).unwrap().values;
        values.iter().filter(|&&v| v > 1e-9 * values[0]).count()
    }

    #[test]
    fn equals_the_matrix_product_and_is_exactly_hermitian() {
        for (elements, snapshots) in [(1, 1), (3, 2), (8, 9), (32, 100)] {
            let y = noise(elements, snapshots);
            let r = sample_covariance(y.view());
            let reference = y.dot(&adjoint(y.view())).mapv(|z| z / snapshots as f64);
            assert!((&r - &reference).iter().all(|z| z.norm() < 1e-14 * 8.0));
            assert_eq!(adjoint(r.view()), r);
        }
        assert_eq!(sample_covariance(noise(2, 0).view()), Array2::<Complex64>::zeros((2, 2)));
    }

    #[test]
    fn forward_backward_averaging_is_centro_hermitian_and_keeps_what_already_is() {
        let once = forward_backward(sample_covariance(noise(7, 5).view()).view());
        let reversed = once.slice(s![..;-1, ..;-1]).mapv(|z| z.conj());
        assert_eq!(once, reversed);
        assert_eq!(forward_backward(once.view()), once);
    }

    #[test]
    fn coherent_sources_regain_their_rank() {
        let r = coherent(8);
        assert_eq!(rank(&r), 1);
        assert_eq!(rank(&forward_backward(r.view())), 2);
        assert_eq!(rank(&spatial_smoothing(r.view(), 7).unwrap()), 2);
        assert_eq!(rank(&spatial_smoothing(r.view(), 8).unwrap()), 1);
    }

    #[test]
    fn smoothing_averages_the_subarrays() {
        let r = sample_covariance(noise(5, 6).view());
        let smoothed = spatial_smoothing(r.view(), 4).unwrap();
        let by_hand = (r[[0, 2]] + r[[1, 3]]) / 2.0;
        assert!((smoothed[[0, 2]] - by_hand).norm() < 1e-15);
        for length in [0, 6] {
            let error = spatial_smoothing(r.view(), length).unwrap_err();
            assert!(matches!(error, SignalError::Argument(InputError::OutOfRange { .. })));
        }
        let flat = Array2::zeros((2, 3));
        let error = spatial_smoothing(flat.view(), 1).unwrap_err();
        assert!(matches!(error, SignalError::Argument(InputError::Shape { .. })), "{error}");
    }

    #[test]
    fn loading_raises_every_eigenvalue_by_its_share_of_the_mean() {
        let mut r = sample_covariance(noise(6, 3).view());
        let before = hermitian_eigen(r.view()).unwrap().values;
        load_diagonal(&mut r, 0.25);
        let after = hermitian_eigen(r.view()).unwrap().values;
        let shift = 0.25 * before.sum() / 6.0;
        assert!((after - before - shift).iter().all(|d| d.abs() < 1e-13));
    }
}
