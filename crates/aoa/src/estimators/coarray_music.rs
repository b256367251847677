//! MUSIC on the difference co-array (Pal and Vaidyanathan 2010): sparse arrays find more sources than they have elements.
//!
//! For sources that are not correlated with each other, the covariance of two elements depends on their distance alone.
//! Entries of equal distance are averaged, and the distances that occur without a gap make a Toeplitz matrix, as of the
//! covariance of an evenly spaced array of that length. Subspaces go by the size of its eigenvalues, which may be negative
//! (Liu and Vaidyanathan 2015). Coherent sources, as targets in one cell of a single frame are, have to be told apart by
//! other methods.

use crate::checks::{ambiguity, check_array, check_sources, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Warning};
use crate::method::Method;
use crate::model::covariance::CovariancePlan;
use crate::model::subspace::noise_projector;
use crate::options::EstimatorOptions;
use crate::order::counting::Counting;
use crate::plan::Plan;
use crate::spectra::null_spectrum::NullSpectrum;
use crate::suits::longest_lag;
use boresight_core::{Array, Complex64, Direction, Lattice};
use boresight_math::linalg::{hermitian_eigen, least_squares};
use boresight_math::order::descending;
use boresight_math::phasor::cis;
use ndarray::{Array2, Axis};
use std::f64::consts::PI;

const METHOD: Method = Method::CoarrayMusic;

/// Sources are the nulls of the noise subspace of the co-array's covariance, on an array as long as the longest distance up
/// to which all occur.
pub(crate) struct CoarrayMusic {
    lattice: Lattice,
    covariance: CovariancePlan,
    sources: Counting,
    /// Longest lag up to which all occur.
    longest: usize,
    nulls: NullSpectrum,
    false_alarm: f64,
    ambiguity: Option<Warning>,
}

impl CoarrayMusic {
    /// At most as many sources as the longest lag are found.
    ///
    /// # Errors
    /// [`AoaError::Array`] for an array that does not suit; [`AoaError::TooManySources`].
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(METHOD, array, options)?;
        let lattice = array.lattice().ok_or_else(|| AoaError::Array {
            method: METHOD.name(),
            expected: "elements on a grid along y".into(),
            given: "stands on no such grid".into(),
        })?;
        let longest = longest_lag(&lattice);
        check_sources(METHOD, options.sources, longest)?;
        let places: Vec<_> =
            (0..=longest).map(|k| [0.0, lattice.spacing * k as f64, 0.0]).collect();
        // The entries of the covariance are averaged here, and the array need not be even.
        let plain = EstimatorOptions { forward_backward: false, smoothing: None, ..*options };
        Ok(Self {
            covariance: CovariancePlan::new(METHOD, array, &plain)?,
            sources: Counting::new(options),
            nulls: NullSpectrum::new(&Array::new(&places)?, options),
            false_alarm: options.nomp.false_alarm,
            ambiguity: ambiguity(array, options),
            longest,
            lattice,
        })
    }

    /// Mean of the covariance's entries of each lag 0, 1, ..., and their numbers.
    fn lags(&self, covariance: &Array2<Complex64>) -> Vec<Complex64> {
        let indices = &self.lattice.indices;
        let mut lags = vec![(Complex64::ZERO, 0.0); self.longest + 1];
        for (i, row) in covariance.outer_iter().enumerate() {
            for (k, &entry) in row.iter().enumerate() {
                let lag = indices[i].checked_sub(indices[k]).filter(|&lag| lag <= self.longest);
                if let Some(lag) = lag {
                    lags[lag].0 += entry;
                    lags[lag].1 += 1.0;
                }
            }
        }
        lags.into_iter().map(|(sum, count)| sum / count).collect()
    }

    /// Sources of directions, with the powers that fit the lags but the first best, which noise is in; and how many of them
    /// stand out: whose power is more than so many deviations as noise seldom reaches in any of the beams.
    ///
    /// # Errors
    /// Those of [`least_squares`].
    fn fitted(
        &self,
        lags: &[Complex64],
        directions: &[Direction],
    ) -> Result<(Vec<Source>, usize), AoaError> {
        if directions.is_empty() {
            return Ok((vec![], 0));
        }
        let rows = self.longest;
        let mut design = Array2::zeros((rows, directions.len()));
        for ((row, source), wave) in design.indexed_iter_mut() {
            let turn = PI * self.lattice.spacing * directions[source].unit()[1];
            *wave = cis(turn * (row + 1) as f64);
        }
        let seen = Array2::from_shape_fn((rows, 1), |(row, _)| lags[row + 1]);
        let fit = least_squares(design.view(), seen.view())?;
        let power = |source: usize| fit.as_ref().map_or(0.0, |fit| fit[[source, 0]].re.max(0.0));
        let mut misfit = 0.0;
        for (row, lag) in lags[1..].iter().enumerate() {
            let mut left = *lag;
            for source in 0..directions.len() {
                left -= design[[row, source]] * power(source);
            }
            misfit += left.norm_sqr();
        }
        // Each source has a power and an angle, each lag two parts.
        let freedom = (2 * rows).saturating_sub(2 * directions.len()).max(1) as f64;
        let deviation = (misfit / freedom / rows as f64).sqrt();
        let beams = (2 * lags.len()) as f64;
        // What rounding leaves of exact data is no source either.
        let least = deviation * (2.0 * (beams / self.false_alarm).ln()).sqrt() + 1e-12 * lags[0].re;
        let sources: Vec<Source> =
            directions.iter().enumerate().map(|(k, &at)| Source::new(at, power(k))).collect();
        let standing = sources.iter().filter(|source| source.power > least).count();
        Ok((sources, standing))
    }
}

impl Plan for CoarrayMusic {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let prepared = self.covariance.prepare(data)?;
        let warnings: Vec<Warning> = self.ambiguity.iter().cloned().collect();
        let lags = self.lags(&prepared.matrix);
        let size = self.longest + 1;
        let toeplitz = Array2::from_shape_fn((size, size), |(i, k)| match i.checked_sub(k) {
            Some(lag) => lags[lag],
            None => lags[k - i].conj(),
        });
        let eigen = hermitian_eigen(toeplitz.view())?;
        let count = match self.sources.known() {
            _ if prepared.power <= 0.0 => 0,
            Some(known) => known,
            None => {
                // The eigenvalues of the elements' own covariance have a known distribution in noise.
                let own = hermitian_eigen(prepared.matrix.view())?.values.to_vec();
                self.sources.resolve(&own, prepared.sizes, self.longest.min(own.len() - 1))
            }
        };
        let order = descending(eigen.values.iter().map(|value| value.abs()));
        let basis = eigen.vectors.select(Axis(1), &order[..count]);
        let projector = noise_projector(&basis);
        let (spectrum, directions) = self.nulls.search(projector.view(), count);
        let (sources, standing) = self.fitted(&lags, &directions)?;
        let found = sources.len();
        let mut estimate = conclude(METHOD, sources, Some(count), Some(spectrum), 0, warnings);
        if estimate.resolved && standing < found {
            estimate.resolved = false;
            estimate.warnings.push(Warning::Insignificant { explained: found - standing, found });
        }
        Ok(estimate)
    }

    fn tests_sources(&self) -> bool {
        true
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::estimator::Estimator;
    use crate::options::SourceCount;
    use boresight_core::Random;
    use boresight_core::steering::steering_matrix;
    use boresight_math::linalg::adjoint;
    use ndarray::Array1;

    fn sparse(places: &[f64]) -> Array {
        Array::new(&places.iter().map(|&y| [0.0, y, 0.0]).collect::<Vec<_>>()).unwrap()
    }

    fn at(sines: &[f64]) -> Vec<Direction> {
        sines.iter().map(|u| Direction::azimuth(u.asin())).collect()
    }

    fn options(sources: SourceCount) -> EstimatorOptions {
        EstimatorOptions { sources, ..EstimatorOptions::default() }
    }

    fn known(sources: usize) -> EstimatorOptions {
        options(SourceCount::Known(sources))
    }

    /// Snapshots of uncorrelated sources of power 1 in noise of that power.
    fn snapshots(
        array: &Array,
        directions: &[Direction],
        noise: f64,
        count: usize,
        seed: u64,
    ) -> Array2<Complex64> {
        let mut random = Random::new(seed, 0);
        let mut white = |rows: usize, power: f64| {
            Array2::from_shape_fn((rows, count), |_| random.complex_normal(power))
        };
        let signals = white(directions.len(), 1.0);
        steering_matrix(array, directions).dot(&signals) + white(array.len(), noise)
    }

    #[test]
    fn lags_without_gap_are_found() {
        // A minimum-redundancy array and a nested one (Pal and Vaidyanathan 2010, two levels of three elements).
        for (places, longest) in [
            (&[0.0, 1.0, 4.0, 7.0, 9.0][..], 9),
            (&[1.0, 2.0, 3.0, 4.0, 8.0, 12.0][..], 11),
            (&[0.0, 1.0, 2.0, 3.0][..], 3),
            (&[0.0, 1.0, 2.0, 9.0][..], 2),
        ] {
            assert_eq!(longest_lag(&sparse(places).lattice().unwrap()), longest, "{places:?}");
        }
    }

    #[test]
    fn an_exact_covariance_gives_more_sources_than_elements() {
        let array = sparse(&[0.0, 1.0, 4.0, 7.0, 9.0]);
        let truth = [-0.85, -0.5, -0.22, 0.05, 0.3, 0.62, 0.9];
        let powers = [1.0, 0.5, 2.0, 1.0, 0.7, 1.0, 1.5];
        let a = steering_matrix(&array, &at(&truth));
        let weights = Array2::from_diag(&Array1::from_iter(powers.map(|p| Complex64::new(p, 0.0))));
        let mut matrix = a.dot(&weights).dot(&adjoint(a.view()));
        matrix.diag_mut().mapv_inplace(|z| z + 0.1);
        let mut estimator = Estimator::new(METHOD, &array, &known(7)).unwrap();
        let data = Data::Covariance { matrix: matrix.view(), snapshots: 1000 };
        let estimate = estimator.estimate(data).unwrap();
        assert!(estimate.resolved, "{:?}", estimate.warnings);
        for (u, power) in truth.iter().zip(powers) {
            let near = |s: &&Source| (s.direction.azimuth_rad.sin() - u).abs() < 1e-4;
            let source = estimate.sources.iter().find(near).unwrap();
            assert!((source.power / power - 1.0).abs() < 1e-3, "{u}: {source:?}");
        }
    }

    /// Five elements, seven sources, 500 snapshots at 10 dB each: all within a third of the co-array's beam.
    #[test]
    fn sampled_covariances_give_them_too() {
        let array = sparse(&[0.0, 1.0, 4.0, 7.0, 9.0]);
        let truth = [-0.85, -0.55, -0.25, 0.05, 0.35, 0.65, 0.9];
        let mut estimator = Estimator::new(METHOD, &array, &known(7)).unwrap();
        let right = (0..50).filter(|&seed| {
            let y = snapshots(&array, &at(&truth), 0.1, 500, seed);
            let estimate = estimator.estimate(Data::Snapshots(y.view())).unwrap();
            let found = |u: &f64| {
                let away = |s: &Source| (s.direction.azimuth_rad.sin() - u).abs();
                estimate.sources.iter().any(|s| away(s) < 0.07)
            };
            truth.iter().all(found)
        });
        let right = right.count();
        assert!(right >= 48, "{right} of 50");
    }

    #[test]
    fn noise_and_phantoms_are_not_resolved() {
        let array = sparse(&[0.0, 1.0, 4.0, 7.0, 9.0]);
        let mut resolved = [0, 0, 0];
        for seed in 0..200 {
            for (counted, (sources, truth)) in
                resolved.iter_mut().zip([(1, &[][..]), (2, &[0.3][..]), (2, &[-0.3, 0.4][..])])
            {
                let mut estimator = Estimator::new(METHOD, &array, &known(sources)).unwrap();
                let y = snapshots(&array, &at(truth), 0.1, 100, seed);
                let estimate = estimator.estimate(Data::Snapshots(y.view())).unwrap();
                *counted += usize::from(estimate.resolved);
            }
        }
        let [noise, phantom, both] = resolved;
        assert!(noise <= 6 && phantom <= 10 && both >= 198, "{resolved:?}");
    }

    #[test]
    fn sources_are_counted_up_to_the_elements() {
        let array = sparse(&[0.0, 1.0, 4.0, 7.0, 9.0]);
        let mut estimator = Estimator::new(METHOD, &array, &options(SourceCount::Auto)).unwrap();
        let y = snapshots(&array, &at(&[-0.4, 0.1, 0.6]), 0.01, 200, 5);
        let estimate = estimator.estimate(Data::Snapshots(y.view())).unwrap();
        assert!(estimate.resolved && estimate.sources.len() == 3, "{estimate:?}");
        let gaps = sparse(&[0.0, 2.0, 5.0, 12.0]);
        let error = Estimator::new(METHOD, &gaps, &known(1)).err().unwrap();
        assert!(matches!(error, AoaError::Array { .. }), "{error}");
        let many = Estimator::new(METHOD, &array, &known(10)).err().unwrap();
        assert!(matches!(many, AoaError::TooManySources { most: 9, given: 10, .. }), "{many}");
    }
}
