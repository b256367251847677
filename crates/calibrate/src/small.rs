//! Symmetric positive definite systems of a size known to the compiler.

/// Inverse of a symmetric positive definite matrix by Cholesky factorisation; `None` where a pivot
/// is not positive or not finite.
pub(crate) fn inverse<const N: usize>(a: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut l = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let rest: f64 = a[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                if !(rest > 0.0 && rest.is_finite()) {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    let mut result = [[0.0; N]; N];
    for column in 0..N {
        let mut x = [0.0; N];
        for i in 0..N {
            let unit = if i == column { 1.0 } else { 0.0 };
            x[i] = (unit - (0..i).map(|k| l[i][k] * x[k]).sum::<f64>()) / l[i][i];
        }
        for i in (0..N).rev() {
            x[i] = (x[i] - (i + 1..N).map(|k| l[k][i] * x[k]).sum::<f64>()) / l[i][i];
        }
        for i in 0..N {
            result[i][column] = x[i];
        }
    }
    Some(result)
}

/// Matrix times vector.
pub(crate) fn times<const N: usize, const M: usize>(a: &[[f64; M]; N], x: &[f64; M]) -> [f64; N] {
    std::array::from_fn(|i| (0..M).map(|j| a[i][j] * x[j]).sum())
}

/// Adds `weight * x x^T`.
pub(crate) fn add_outer<const N: usize>(a: &mut [[f64; N]; N], x: &[f64; N], weight: f64) {
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
