//! Asymptotic error of ESPRIT (Rao and Hari 1989), the same for least squares and total least
//! squares.

use crate::bounds::Signals;
use crate::error::AoaError;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Direction};
use boresight_math::linalg::{Cholesky, adjoint, least_squares};
use ndarray::{Array2, s};
use std::f64::consts::PI;

/// Standard deviation, for many snapshots, of the azimuths ESPRIT estimates on a uniform array,
/// rad; infinite where the signals or the directions do not determine them.
///
/// The eigenvalue `l_i` is off by `w_i^H e_i`, with `w_i^H = b_i (J2 - l_i J1)`, `b_i` row `i` of
/// the pseudo-inverse of `J1 A`, `J1` and `J2` selecting all elements but the last and all but the
/// first, and `e_i` the error of the signal subspace in the direction of source `i`. That gives
/// the variance `s |w_i|^2 (P^-1 + s P^-1 (A^H A)^-1 P^-1)_ii / (2 N)` of its phase.
///
/// # Errors
/// As [`crate::bounds::deterministic_bound`], and [`AoaError::Array`] if the array is not uniform.
pub fn esprit_error(
    array: &Array,
    directions: &[Direction],
    signals: &Signals<'_>,
) -> Result<Vec<f64>, AoaError> {
    signals.check(array, directions)?;
    let lattice = array.lattice().filter(|lattice| lattice.is_uniform());
    let Some(lattice) = lattice else {
        return Err(AoaError::Array {
            method: "ESPRIT",
            expected: "elements evenly spaced along y, in order".into(),
            given: "is not evenly spaced".into(),
        });
    };
    let elements = array.len();
    let last = elements - 1;
    let steering = steering_matrix(array, directions);
    let undetermined = vec![f64::INFINITY; directions.len()];
    let front = steering.slice(s![..last, ..]);
    let Some(rows) = least_squares(front, Array2::eye(last).view())? else {
        return Ok(undetermined);
    };
    let gram = adjoint(steering.view()).dot(&steering);
    let (Ok(gram), Ok(power)) = (Cholesky::new(gram.view()), Cholesky::new(signals.covariance))
    else {
        return Ok(undetermined);
    };
    let noise = signals.noise_power;
    let inverse = power.inverse();
    let spread = &inverse + inverse.dot(&gram.inverse()).dot(&inverse).mapv(|z| z * noise);
    let deviation = |(i, direction): (usize, &Direction)| {
        let turn = steering[[1, i]] / steering[[0, i]];
        let weight = |k: usize| {
            let second = if k > 0 { rows[[i, k - 1]] } else { 0.0.into() };
            let first = if k < last { rows[[i, k]] } else { 0.0.into() };
            (second - turn * first).norm_sqr()
        };
        let weights: f64 = (0..elements).map(weight).sum();
        let variance = noise * weights * spread[[i, i]].re / (2.0 * signals.snapshots as f64);
        variance.sqrt() / (PI * lattice.spacing * direction.azimuth_rad.cos())
    };
    Ok(directions.iter().enumerate().map(deviation).collect())
}
