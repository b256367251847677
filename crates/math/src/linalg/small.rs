//! Small real matrices on the stack, without allocation: inverses of symmetric positive definite
//! matrices, products and outer products. Larger and complex ones are in [`super::Cholesky`].

/// Inverse of a symmetric positive definite matrix by Cholesky factorisation; `None` where a pivot
/// is not positive or not finite.
pub fn inverse<const N: usize>(a: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let (mut l, mut result) = ([[0.0; N]; N], [[0.0; N]; N]);
    invert(a.as_flattened(), N, l.as_flattened_mut(), result.as_flattened_mut()).then_some(result)
}

/// Inverse of a symmetric positive definite matrix of `n` rows, stored row by row. `l` and `result` are
/// zero at first and receive the factor and the inverse. Returns whether there is an inverse.
#[inline]
pub fn invert(a: &[f64], n: usize, l: &mut [f64], result: &mut [f64]) -> bool {
    for i in 0..n {
        for j in 0..=i {
            let rest: f64 = a[i * n + j] - (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum::<f64>();
            if i == j {
                if !(rest > 0.0 && rest.is_finite()) {
                    return false;
                }
                l[i * n + i] = rest.sqrt();
            } else {
                l[i * n + j] = rest / l[j * n + j];
            }
        }
    }
    for column in 0..n {
        for i in 0..n {
            let unit = if i == column { 1.0 } else { 0.0 };
            let known = (0..i).map(|k| l[i * n + k] * result[k * n + column]).sum::<f64>();
            result[i * n + column] = (unit - known) / l[i * n + i];
        }
        for i in (0..n).rev() {
            let known = (i + 1..n).map(|k| l[k * n + i] * result[k * n + column]).sum::<f64>();
            result[i * n + column] = (result[i * n + column] - known) / l[i * n + i];
        }
    }
    true
}

/// Scalar product.
pub fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}

/// Matrix times vector.
pub fn times<const N: usize, const M: usize>(a: &[[f64; M]; N], x: &[f64; M]) -> [f64; N] {
    std::array::from_fn(|i| dot(&a[i], x))
}

/// Adds `weight * x x^T`.
pub fn add_outer<const N: usize>(a: &mut [[f64; N]; N], x: &[f64; N], weight: f64) {
    for i in 0..N {
        for j in 0..N {
            a[i][j] += weight * x[i] * x[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_matrix_is_identity() {
        let a = [[4.0, 1.0, 0.5], [1.0, 3.0, -0.7], [0.5, -0.7, 2.0]];
        let b = inverse(&a).unwrap();
        for i in 0..3 {
            let row = times(&a, &[b[0][i], b[1][i], b[2][i]]);
            for (j, value) in row.into_iter().enumerate() {
                assert!((value - if i == j { 1.0 } else { 0.0 }).abs() < 1e-14);
            }
        }
        assert!(inverse(&[[1.0, 2.0], [2.0, 1.0]]).is_none());
        assert!(inverse(&[[f64::NAN]]).is_none());
    }
}
