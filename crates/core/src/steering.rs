//! Steering vectors: the response of an array to a plane wave.

use crate::array::Array;
use crate::direction::Direction;
use boresight_math::phasor::cis;
use ndarray::{Array1, Array2};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Response of each element to a wave from `direction`: `a_k = exp(j pi p_k . u)`, with `p_k` in
/// half wavelengths and `u` the unit vector toward the source.
pub fn steering_vector(array: &Array, direction: Direction) -> Array1<Complex64> {
    let u = direction.unit();
    array.positions().iter().map(|p| cis(PI * dot(p, &u))).collect()
}

/// Steering vectors of several directions as the columns of an elements x directions matrix.
pub fn steering_matrix(array: &Array, directions: &[Direction]) -> Array2<Complex64> {
    let mut matrix = Array2::zeros((array.len(), directions.len()));
    for (mut column, &direction) in matrix.columns_mut().into_iter().zip(directions) {
        column.assign(&steering_vector(array, direction));
    }
    matrix
}

/// Derivatives of [`steering_vector`] by azimuth and by elevation, per radian.
pub fn steering_derivatives(
    array: &Array,
    direction: Direction,
) -> (Array1<Complex64>, Array1<Complex64>) {
    let u = direction.unit();
    let (by_azimuth, by_elevation) = direction.unit_derivatives();
    let slope = |d: &[f64; 3]| -> Array1<Complex64> {
        array
            .positions()
            .iter()
            .map(|p| cis(PI * dot(p, &u)) * Complex64::new(0.0, PI * dot(p, d)))
            .collect()
    };
    (slope(&by_azimuth), slope(&by_elevation))
}

fn dot(p: &[f64; 3], q: &[f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets::preset;

    #[test]
    fn a_wave_from_the_left_leads_on_elements_to_the_left() {
        let array = Array::ula(3).unwrap();
        let a = steering_vector(&array, Direction::azimuth(30.0_f64.to_radians()));
        assert!((a[1] - Complex64::new(0.0, 1.0)).norm() < 1e-12);
        assert!((a[2] - Complex64::new(-1.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let array = preset("awr1843").unwrap();
        let at = Direction::new(0.3, -0.2);
        let (by_azimuth, by_elevation) = steering_derivatives(&array, at);
        let h = 1e-6;
        let difference = |da: f64, de: f64| {
            let move_by = |s: f64| {
                steering_vector(
                    &array,
                    Direction::new(at.azimuth_rad + s * da, at.elevation_rad + s * de),
                )
            };
            (move_by(h) - move_by(-h)).mapv(|z| z / (2.0 * h))
        };
        for (exact, numeric) in
            [(by_azimuth, difference(1.0, 0.0)), (by_elevation, difference(0.0, 1.0))]
        {
            assert!((exact - numeric).iter().all(|z| z.norm() < 1e-7));
        }
    }
}
