//! Powers and amplitudes of sources whose directions are known.

use crate::data::Data;
use crate::estimate::Source;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Direction};
use boresight_math::linalg::{adjoint, least_squares};
use ndarray::ArrayView2;

/// Sources at `directions`, with the amplitude (one snapshot) or power (several snapshots, or a
/// covariance) that fits the data best in the least-squares sense: `s = A^+ y`, or the diagonal of
/// `A^+ R A^+^H`. The power contains the noise that falls into the fit, about the noise power over
/// the number of elements. Where the directions are too many or too close to tell apart, each
/// power is that of a beam steered there, `a^H R a / K^2`, and there is no amplitude.
pub fn sources_at(array: &Array, directions: &[Direction], data: Data<'_>) -> Vec<Source> {
    if directions.is_empty() {
        return Vec::new();
    }
    let steering = steering_matrix(array, directions);
    // s = A^+ y for the columns of y; at beams where there is no A^+.
    let few = directions.len() <= array.len();
    let fit = |y: ArrayView2<Complex64>| {
        few.then(|| least_squares(steering.view(), y).ok().flatten()).flatten()
    };
    let beams = |y: ArrayView2<Complex64>| {
        adjoint(steering.view()).dot(&y).mapv(|z| z / array.len() as f64)
    };
    let (powers, amplitudes): (Vec<f64>, Option<Vec<Complex64>>) = match data {
        Data::Snapshots(y) => {
            let fitted = fit(y);
            let single = fitted.is_some() && y.ncols() == 1;
            let signals = fitted.unwrap_or_else(|| beams(y));
            let count = y.ncols() as f64;
            let power = |row: ndarray::ArrayView1<Complex64>| {
                row.iter().map(|z| z.norm_sqr()).sum::<f64>() / count
            };
            (
                signals.rows().into_iter().map(power).collect(),
                single.then(|| signals.column(0).to_vec()),
            )
        }
        Data::Covariance { matrix, .. } => {
            // A^+ R A^+^H from the left, then from the right.
            let half = fit(matrix).unwrap_or_else(|| beams(matrix));
            let half = adjoint(half.view());
            let whole = fit(half.view()).unwrap_or_else(|| beams(half.view()));
            (whole.diag().iter().map(|z| z.re.max(0.0)).collect(), None)
        }
    };
    directions
        .iter()
        .zip(&powers)
        .enumerate()
        .map(|(i, (&direction, &power))| Source {
            amplitude: amplitudes.as_ref().map(|s| s[i]),
            ..Source::new(direction, power)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::steering::steering_vector;

    #[test]
    fn a_single_snapshot_gives_amplitudes_and_its_covariance_the_same_powers() {
        let array = Array::ula(8).unwrap();
        let at = [Direction::azimuth(-0.2), Direction::azimuth(0.15)];
        let s = [Complex64::new(1.0, -0.5), Complex64::new(0.0, 0.3)];
        let y = steering_vector(&array, at[0]) * s[0] + steering_vector(&array, at[1]) * s[1];
        let y = y.insert_axis(ndarray::Axis(1));
        let found = sources_at(&array, &at, Data::Snapshots(y.view()));
        let r = y.dot(&adjoint(y.view()));
        let data = Data::Covariance { matrix: r.view(), snapshots: 1 };
        let again = sources_at(&array, &at, data);
        for i in 0..2 {
            assert!((found[i].amplitude.unwrap() - s[i]).norm() < 1e-12);
            assert!((found[i].power - s[i].norm_sqr()).abs() < 1e-12);
            assert!((again[i].power - s[i].norm_sqr()).abs() < 1e-12);
            assert!(again[i].amplitude.is_none());
        }
    }

    #[test]
    fn coinciding_directions_get_beam_powers() {
        let array = Array::ula(4).unwrap();
        let at = [Direction::azimuth(0.1); 2];
        let y = steering_vector(&array, at[0]).insert_axis(ndarray::Axis(1));
        let found = sources_at(&array, &at, Data::Snapshots(y.view()));
        assert!(found.iter().all(|s| (s.power - 1.0).abs() < 1e-12 && s.amplitude.is_none()));
        assert!(sources_at(&array, &[], Data::Snapshots(y.view())).is_empty());
    }
}
