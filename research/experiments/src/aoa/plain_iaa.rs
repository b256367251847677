//! IAA as a baseline is often implemented: on a grid of whole or half degrees, without interpolation between grid
//! points, without merging coincident elements and without loading (Yardibi et al. 2010).
//!
//! [`boresight_aoa`]'s IAA differs in all four. The difference between the two shows how much of a
//! network's lead over "IAA" comes from the baseline.

use boresight_aoa::{AoaError, Data, Estimate, Method, Plan, Source};
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Direction};
use boresight_math::linalg::{Cholesky, adjoint};
use boresight_math::order::sort_descending;
use ndarray::{Array1, Array2};

/// Iterations.
const ITERATIONS: usize = 15;
/// Largest azimuth of the grid, deg.
const LARGEST_DEG: i32 = 61;

/// Number of grid points, for so many a degree.
pub(crate) const fn points(per_degree: u8) -> usize {
    2 * LARGEST_DEG as usize * per_degree as usize + 1
}

/// Diagonal that keeps the covariance invertible in double precision, relative to its mean diagonal.
const FLOOR: f64 = 1e-12;

/// Plain IAA for one snapshot on one array.
pub(super) struct PlainIaa {
    azimuth_rad: Vec<f64>,
    /// Elements x grid points.
    steering: Array2<Complex64>,
}

impl PlainIaa {
    /// With so many grid points a degree.
    pub fn new(array: &Array, per_degree: u8) -> Self {
        let steps = LARGEST_DEG * i32::from(per_degree);
        let azimuth = |step: i32| (f64::from(step) / f64::from(per_degree)).to_radians();
        let azimuth_rad: Vec<f64> = (-steps..=steps).map(azimuth).collect();
        let directions: Vec<Direction> =
            azimuth_rad.iter().map(|azimuth| Direction::azimuth(*azimuth)).collect();
        Self { steering: steering_matrix(array, &directions), azimuth_rad }
    }

    /// Returns the power at each grid point.
    fn powers(&self, snapshot: &Array1<Complex64>) -> Result<Vec<f64>, AoaError> {
        let (elements, points) = self.steering.dim();
        let conjugate = adjoint(self.steering.view());
        let scale = (elements * elements) as f64;
        let mut powers: Vec<f64> =
            conjugate.dot(snapshot).iter().map(|z| z.norm_sqr() / scale).collect();
        for _ in 0..ITERATIONS {
            let weighted = Array2::from_shape_fn((elements, points), |(k, g)| {
                self.steering[[k, g]] * powers[g]
            });
            let mut covariance = weighted.dot(&conjugate);
            let floor = FLOOR * powers.iter().sum::<f64>();
            covariance.diag_mut().mapv_inplace(|z| z + floor);
            let inverse = Cholesky::new(covariance.view())?.inverse();
            let whitened = conjugate.dot(&inverse);
            let received = whitened.dot(snapshot);
            for (g, power) in powers.iter_mut().enumerate() {
                let response: f64 = whitened
                    .row(g)
                    .iter()
                    .zip(self.steering.column(g))
                    .map(|(w, a)| (w * a).re)
                    .sum();
                *power = received[g].norm_sqr() / (response * response);
            }
        }
        Ok(powers)
    }
}

impl Plan for PlainIaa {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut estimate = Estimate::new(Method::Iaa);
        let Data::Snapshots(snapshots) = data else {
            return Err(AoaError::NeedsSnapshots { method: "plain-iaa" });
        };
        let snapshot = snapshots.column(0).to_owned();
        if snapshot.iter().all(|z| z.norm_sqr() == 0.0) {
            return Ok(estimate);
        }
        let powers = self.powers(&snapshot)?;
        let peaks = (1..powers.len() - 1)
            .filter(|&g| powers[g] > powers[g - 1] && powers[g] >= powers[g + 1])
            .map(|g| Source::new(Direction::azimuth(self.azimuth_rad[g]), powers[g]));
        estimate.sources = peaks.collect();
        sort_descending(&mut estimate.sources, |source| source.power);
        estimate.iterations = ITERATIONS;
        Ok(estimate)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_vector;

    #[test]
    fn targets_on_the_grid_are_found_with_their_powers() {
        let array = preset("lrr48").unwrap();
        let mut snapshot: Array1<Complex64> = Array1::zeros(array.len());
        for (deg, power_db) in [(-20.0f64, 0.0), (15.0, -10.0), (40.0, -5.0)] {
            let response = steering_vector(&array, Direction::azimuth(deg.to_radians()));
            let amplitude = 10f64.powf(power_db / 20.0);
            snapshot.iter_mut().zip(&response).for_each(|(y, a)| *y += a * amplitude);
        }
        let column = snapshot.insert_axis(ndarray::Axis(1));
        for per_degree in [1, 2] {
            let mut plain = PlainIaa::new(&array, per_degree);
            assert_eq!(plain.azimuth_rad.len(), points(per_degree));
            let found = plain.estimate(Data::Snapshots(column.view())).unwrap();
            let strongest: Vec<(i32, i32)> = found.sources[..3]
                .iter()
                .map(|s| {
                    let deg = s.direction.azimuth_rad.to_degrees().round() as i32;
                    (deg, (10.0 * s.power.log10()).round() as i32)
                })
                .collect();
            assert_eq!(strongest, [(-20, 0), (40, -5), (15, -10)]);
        }
    }
}
