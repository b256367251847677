//! Whether the sources of an estimate stand out of the noise, which `resolved` states.
//!
//! The likelihood ratio of a source at a known direction grows with the share of the residual that it explains beside the
//! other sources. That share is compared with the one that the strongest peak of noise reaches with the false-alarm
//! probability ([`Volumes`]), as NOMP does. Where a number of sources is asked for or counted, all of them have to stand
//! out. Methods that list what they find, sidelobes included, need one that does. The directions are those of the
//! estimate: nothing is refined here.

use crate::data::Data;
use crate::estimate::{Estimate, Warning};
use crate::model::cosines::{Geometry, Point};
use crate::options::EstimatorOptions;
use crate::order::false_alarm::Volumes;
use crate::order::residual_count::{ResidualCount, Threshold};
use crate::refinement::gauss_newton::total_power;
use boresight_core::{Array, Complex64};

/// A source whose steering vector keeps less of its power than this beside the others explains nothing.
const DEPENDENT: f64 = 1e-6;

/// The test of one estimator.
pub(crate) struct Significance {
    geometry: Geometry,
    each: Threshold,
    any: ResidualCount,
    beams: Beams,
}

impl Significance {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Self {
        let geometry = Geometry::new(array);
        let volumes = Volumes::new(array, &geometry, options.elevation_field_of_view_rad);
        Self {
            each: Threshold::new(volumes, &geometry, &options.nomp, options.nomp.false_alarm),
            any: ResidualCount::new(array, &geometry, options, array.len()),
            beams: Beams::default(),
            geometry,
        }
    }

    /// Takes `resolved` back, and says why, where sources do not stand out.
    pub fn apply(&mut self, estimate: &mut Estimate, data: Data<'_>) {
        let found = estimate.sources.len();
        if !estimate.resolved || found == 0 {
            return;
        }
        let total = total_power(data);
        let Self { geometry, each, any, beams } = self;
        let point = |index: usize| geometry.point(*estimate.sources[index].direction);
        let explained = if estimate.expected.is_some() {
            let stands_out = |last: &usize| {
                beams.clear();
                let others = (0..found).filter(|index| index != last);
                let by_others: f64 =
                    others.map(|index| beams.add(geometry, point(index), data)).sum();
                let own = beams.add(geometry, point(*last), data);
                each.is_exceeded(own, total - by_others, total, found - 1, data.snapshots())
            };
            found - (0..found).filter(stands_out).count()
        } else {
            beams.clear();
            let mut left = total;
            let residual = |sources: usize| {
                if let Some(last) = sources.checked_sub(1).filter(|&last| last < found) {
                    left -= beams.add(geometry, point(last), data);
                }
                left
            };
            if any.count(data.snapshots(), 1, residual) > 0 { 0 } else { found }
        };
        if explained > 0 {
            estimate.resolved = false;
            estimate.warnings.push(Warning::Insignificant { explained, found });
        }
    }
}

/// Orthonormal vectors that span the steering vectors of sources, one after another.
#[derive(Default)]
struct Beams {
    basis: Vec<Complex64>,
}

impl Beams {
    fn clear(&mut self) {
        self.basis.clear();
    }

    /// The mean power, summed over elements, that a further source explains.
    fn add(&mut self, geometry: &Geometry, at: Point, data: Data<'_>) -> f64 {
        let elements = geometry.elements();
        let before = self.basis.len();
        geometry.extend_by_steering(at, &mut self.basis);
        let (others, own) = self.basis.split_at_mut(before);
        // Twice, as rounding leaves parts of the others where vectors are nearly dependent.
        for _ in 0..2 {
            for other in others.chunks_exact(elements) {
                let along: Complex64 = other.iter().zip(&*own).map(|(q, a)| q.conj() * a).sum();
                own.iter_mut().zip(other).for_each(|(a, q)| *a -= along * q);
            }
        }
        let norm = own.iter().map(|a| a.norm_sqr()).sum::<f64>();
        if norm < DEPENDENT * elements as f64 {
            self.basis.truncate(before);
            return 0.0;
        }
        let scale = 1.0 / norm.sqrt();
        own.iter_mut().for_each(|a| *a *= scale);
        match data {
            Data::Snapshots(y) => {
                let beam = |column: ndarray::ArrayView1<'_, Complex64>| {
                    let along = own.iter().zip(column).map(|(q, y)| q.conj() * y);
                    along.sum::<Complex64>().norm_sqr()
                };
                y.columns().into_iter().map(beam).sum::<f64>() / y.ncols() as f64
            }
            Data::Covariance { matrix, .. } => {
                let row = |(row, q): (ndarray::ArrayView1<'_, Complex64>, &Complex64)| {
                    let seen: Complex64 = row.iter().zip(&*own).map(|(r, q)| r * q).sum();
                    (q.conj() * seen).re
                };
                matrix.rows().into_iter().zip(&*own).map(row).sum()
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::estimator::Estimator;
    use crate::method::Method;
    use crate::options::SourceCount;
    use crate::size::sized;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_matrix;
    use boresight_core::{Direction, Random};
    use boresight_math::linalg::adjoint;
    use ndarray::Array2;

    /// Snapshots of targets at these azimuths (deg), of power 1 at random phases, in noise of power 1 / `snr`.
    fn scene(
        array: &Array,
        at_deg: &[f64],
        snr: f64,
        snapshots: usize,
        random: &mut Random,
    ) -> Array2<Complex64> {
        let at: Vec<_> = at_deg.iter().map(|d| Direction::azimuth(d.to_radians())).collect();
        let phases = Array2::from_shape_fn((at.len(), snapshots), |_| random.complex_normal(1.0));
        let noise =
            Array2::from_shape_fn((array.len(), snapshots), |_| random.complex_normal(1.0 / snr));
        steering_matrix(array, &at).dot(&phases.mapv(|z| z / z.norm())) + noise
    }

    fn options(sources: usize) -> EstimatorOptions {
        EstimatorOptions { sources: SourceCount::Known(sources), ..EstimatorOptions::default() }
    }

    /// Methods that take these snapshots on an evenly spaced array.
    fn methods(snapshots: usize) -> Vec<Method> {
        let suits = |method: &Method| {
            let needs = method.requirements();
            !needs.network
                && needs.min_snapshots <= snapshots
                && needs.max_snapshots.is_none_or(|most| snapshots <= most)
        };
        Method::ALL.into_iter().filter(suits).collect()
    }

    /// Most of so many trials where a share is expected: four standard deviations beyond.
    fn most(share: f64, trials: usize) -> usize {
        let expected = share * trials as f64;
        (expected + 4.0 * (expected * (1.0 - share)).sqrt()) as usize
    }

    #[test]
    fn noise_is_not_resolved() {
        let array = preset("ula16").unwrap();
        for snapshots in [1, 16] {
            for method in methods(snapshots) {
                let mut estimator = Estimator::new(method, &array, &options(1)).unwrap();
                let mut random = Random::new(38, snapshots as u64);
                let trials = sized(400, 100);
                let resolved = (0..trials).filter(|_| {
                    let y = scene(&array, &[], 1.0, snapshots, &mut random);
                    let estimate = estimator.estimate(Data::Snapshots(y.view())).unwrap();
                    assert_eq!(
                        estimate.resolved,
                        estimate.warnings.iter().all(|warning| {
                            !matches!(warning, Warning::Insignificant { .. } | Warning::NoSources)
                        })
                    );
                    estimate.resolved
                });
                let resolved = resolved.count();
                let most = most(0.015, trials);
                assert!(resolved <= most, "{} of {trials}, {}", resolved, method.name());
            }
        }
    }

    #[test]
    fn targets_are_resolved_and_a_phantom_beside_one_is_not() {
        let array = preset("ula16").unwrap();
        for snapshots in [1, 16] {
            for method in methods(snapshots) {
                let mut random = Random::new(39, snapshots as u64);
                let mut two = Estimator::new(method, &array, &options(2)).unwrap();
                let trials = sized(100, 25);
                let (mut found, mut phantoms) = (0, 0);
                for _ in 0..trials {
                    let mut resolved = |at: &[f64]| {
                        let y = scene(&array, at, 100.0, snapshots, &mut random);
                        two.estimate(Data::Snapshots(y.view())).unwrap().resolved
                    };
                    found += usize::from(resolved(&[-15.0, 20.0]));
                    phantoms += usize::from(resolved(&[10.0]));
                }
                let name = method.name();
                assert!(trials - found <= most(0.002, trials), "{name}, {snapshots}: {found}");
                if method.requirements().source_count {
                    assert!(phantoms <= most(0.015, trials), "{name}, {snapshots}: {phantoms}");
                }
            }
        }
    }

    #[test]
    fn several_equal_targets_are_resolved_by_methods_that_list() {
        let array = preset("ula16").unwrap();
        let mut random = Random::new(40, 0);
        for method in [Method::Bartlett, Method::Capon, Method::Iaa] {
            let mut estimator = Estimator::new(method, &array, &options(1)).unwrap();
            for _ in 0..50 {
                let y = scene(&array, &[-45.0, -15.0, 12.0, 40.0], 1000.0, 1, &mut random);
                let estimate = estimator.estimate(Data::Snapshots(y.view())).unwrap();
                assert!(estimate.resolved, "{} {estimate:?}", method.name());
            }
        }
    }

    #[test]
    fn a_covariance_of_one_source_resolves_no_second() {
        let array = preset("ula8").unwrap();
        let mut random = Random::new(41, 0);
        let y = scene(&array, &[12.0], 1e30, 1, &mut random);
        let matrix = y.dot(&adjoint(y.view()));
        for method in [Method::Music, Method::MinNorm, Method::Esprit, Method::RootMusic] {
            for (sources, expected) in [(1, true), (2, false), (3, false)] {
                let mut estimator = Estimator::new(method, &array, &options(sources)).unwrap();
                let data = Data::Covariance { matrix: matrix.view(), snapshots: 50 };
                let estimate = estimator.estimate(data).unwrap();
                assert_eq!(estimate.resolved, expected, "{} {estimate:?}", method.name());
            }
        }
    }

    #[test]
    fn known_noise_power_tells_where_few_elements_cannot() {
        let array = Array::ula(2).unwrap();
        let mut random = Random::new(42, 0);
        let y = scene(&array, &[12.0], 1000.0, 1, &mut random);
        let resolved = |noise_power| {
            let mut options = options(1);
            options.nomp.noise_power = noise_power;
            let mut estimator = Estimator::new(Method::Bartlett, &array, &options).unwrap();
            estimator.estimate(Data::Snapshots(y.view())).unwrap().resolved
        };
        assert!(!resolved(None));
        assert!(resolved(Some(1e-3)));
        assert!(!resolved(Some(1.0)));
    }

    #[test]
    fn many_snapshots_take_no_longer() {
        let array = preset("ula8").unwrap();
        let y = scene(&array, &[12.0], 10.0, 1, &mut Random::new(43, 0));
        let matrix = y.dot(&adjoint(y.view()));
        let data = Data::Covariance { matrix: matrix.view(), snapshots: usize::MAX };
        let mut estimator = Estimator::new(Method::Bartlett, &array, &options(1)).unwrap();
        assert!(estimator.estimate(data).unwrap().resolved);
    }
}
