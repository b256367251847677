//! Deterministic maximum likelihood by alternating projection (Ziskind and Wax 1988), then
//! Gauss-Newton steps on all directions together.
//!
//! The likelihood is highest where the steering vectors leave the least power `tr(P R)`, `P` being
//! the projection away from them. Given all directions but one, the best grid point for that one
//! maximises `a^H P R P a / a^H P a`: two Hermitian forms over the grid.

use crate::checks::{ambiguity, check_array, check_sources, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::grid::Grid;
use crate::method::Method;
use crate::model::cosines::{Geometry, Point};
use crate::model::covariance::{CovariancePlan, Prepared};
use crate::model::powers::sources_at;
use crate::options::EstimatorOptions;
use crate::order::counting::Counting;
use crate::order::residual_count::ResidualCount;
use crate::plan::Plan;
use crate::refinement::gauss_newton::{Limits, Refined, refine_points};
use crate::spectra::quadratic::QuadraticSpectrum;
use boresight_core::{Array, Complex64};
use boresight_math::linalg::hermitian_eigen;
use ndarray::Array2;

/// Most sources searched for; keeps the search bounded on large arrays.
const MAX_SOURCES: usize = 64;

/// Rounds of alternating projection on the grid; it settles in a few.
const MAX_ROUNDS: usize = 20;

/// Complex multiplications after which no further round is begun.
const MAX_WORK: usize = 4_000_000_000;

/// Share of the power below which nothing but rounding is left.
const EXHAUSTED: f64 = 1e-12;

/// Maximum likelihood prepared for one array and grid.
pub(crate) struct MaximumLikelihood {
    array: Array,
    geometry: Geometry,
    covariance: CovariancePlan,
    spectrum: QuadraticSpectrum,
    wanted: Counting,
    /// Counts sources in a single vector, whose covariance has no eigenvalues to test.
    single: Option<ResidualCount>,
    most: usize,
    limits: Limits,
    /// Largest `|sin(azimuth)|` reported: the field of view and a step of the grid.
    widest: f64,
    ambiguity: Option<Warning>,
}

impl MaximumLikelihood {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        let method = Method::MaximumLikelihood;
        check_array(method, array, options)?;
        let covariance = CovariancePlan::new(method, array, options)?;
        let grid = Grid::new(covariance.array(), options);
        let most = (covariance.array().len() - 1).min(MAX_SOURCES).min(grid.len());
        check_sources(method, options.sources, most)?;
        let geometry = Geometry::new(covariance.array());
        let single = ResidualCount::new(covariance.array(), &geometry, options, most);
        Ok(Self {
            array: array.clone(),
            geometry,
            spectrum: QuadraticSpectrum::new(covariance.array(), &grid),
            covariance,
            wanted: Counting::new(options),
            single: Some(single),
            most,
            limits: Limits { iterations: options.max_iterations, tolerance: options.tolerance },
            widest: options.field_of_view_rad.sin() + 2.0 / options.grid_points as f64,
            ambiguity: ambiguity(array, options),
        })
    }

    /// How many sources to look for in a covariance of mean element power 1.
    fn count(&mut self, prepared: &Prepared) -> Result<usize, AoaError> {
        if let Some(known) = self.wanted.known() {
            return Ok(known);
        }
        let single_vector = prepared.sizes.vectors == 1 && !prepared.sizes.forward_backward;
        if single_vector && !self.wanted.is_auto() {
            return Err(AoaError::Snapshots {
                method: Method::MaximumLikelihood.name(),
                expected:
                    "a number of sources, 'auto', or at least 2 snapshots to count by eigenvalues"
                        .into(),
                given: 1,
            });
        }
        if single_vector && let Some(mut single) = self.single.take() {
            let matrix = &prepared.matrix;
            let count = single.count(1, usize::MAX, |sources| match sources {
                0 => matrix.nrows() as f64,
                _ => self.fit(matrix, sources).1.residual_power,
            });
            self.single = Some(single);
            return Ok(count);
        }
        let values = hermitian_eigen(prepared.matrix.view())?.values;
        Ok(self.wanted.resolve(&values.to_vec(), prepared.sizes, self.most))
    }

    /// The best fit of up to so many sources.
    fn fit(&mut self, matrix: &Array2<Complex64>, sources: usize) -> (Vec<Point>, Refined) {
        let chosen = self.search(matrix, sources);
        let points = chosen.iter().map(|&g| self.geometry.point(self.spectrum.grid().direction(g)));
        let whole = Data::Covariance { matrix: matrix.view(), snapshots: 1 };
        refine_points(&self.geometry, points.collect(), whole, self.limits)
    }

    /// Alternating projection: grid points of up to `count` sources.
    fn search(&mut self, r: &Array2<Complex64>, count: usize) -> Vec<usize> {
        let elements = r.nrows();
        let total: f64 = r.diag().iter().map(|z| z.re).sum();
        let mut chosen: Vec<usize> = Vec::with_capacity(count);
        while chosen.len() < count {
            match self.best(r, &chosen) {
                Some((point, gain)) if gain > EXHAUSTED * total => chosen.push(point),
                _ => break,
            }
        }
        let round = elements.saturating_mul(elements).saturating_mul(chosen.len().pow(2));
        let rounds = if chosen.len() < 2 { 0 } else { MAX_ROUNDS.min(MAX_WORK / round.max(1)) };
        // The last one found is the best beside the others already.
        let mut settled = 1;
        for i in (0..chosen.len()).cycle().take(rounds * chosen.len()) {
            let others: Vec<usize> =
                chosen.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, &g)| g).collect();
            let best = self.best(r, &others).map_or(chosen[i], |(point, _)| point);
            settled = if best == chosen[i] { settled + 1 } else { 1 };
            chosen[i] = best;
            if settled >= chosen.len() {
                break;
            }
        }
        chosen
    }

    /// The grid point that explains most of what the others leave, and how much.
    fn best(&mut self, r: &Array2<Complex64>, others: &[usize]) -> Option<(usize, f64)> {
        let elements = r.nrows() as f64;
        let (numerator, explained) = if others.is_empty() {
            (self.spectrum.evaluate(r.view()), vec![0.0; self.spectrum.grid().len()])
        } else {
            let basis = self.basis(others);
            let (projected, onto) = project(r, &basis);
            (self.spectrum.evaluate(projected.view()), self.spectrum.evaluate(onto.view()))
        };
        let mut best: Option<(usize, f64)> = None;
        for (g, (n, e)) in numerator.iter().zip(&explained).enumerate() {
            // Next to another source there is nothing to divide by.
            if elements - e > 1e-6 * elements {
                let gain = n / (elements - e);
                if best.is_none_or(|(_, most)| gain > most) && gain.is_finite() {
                    best = Some((g, gain));
                }
            }
        }
        best
    }

    /// Orthonormal basis of the steering vectors of grid points, by twice-applied Gram-Schmidt.
    fn basis(&self, points: &[usize]) -> Vec<Vec<Complex64>> {
        let elements = self.geometry.elements();
        let mut columns: Vec<Vec<Complex64>> = Vec::with_capacity(points.len());
        for &g in points {
            let point = self.geometry.point(self.spectrum.grid().direction(g));
            let mut a = self.geometry.steering(point).vector;
            for _ in 0..2 {
                for q in &columns {
                    let along = inner(q, &a);
                    a.iter_mut().zip(q).for_each(|(a, q)| *a -= along * q);
                }
            }
            let norm = inner(&a, &a).re.sqrt();
            if norm > 1e-6 * (elements as f64).sqrt() {
                a.iter_mut().for_each(|z| *z /= norm);
                columns.push(a);
            }
        }
        columns
    }
}

/// `x^H y`.
fn inner(x: &[Complex64], y: &[Complex64]) -> Complex64 {
    x.iter().zip(y).map(|(x, y)| x.conj() * y).sum()
}

/// Lower triangles of `P R P` and of `I - P`, with `P` the projection away from an orthonormal
/// basis `Q`: `P R P = R - H Q^H - Q H^H` with `H = R Q - Q (Q^H R Q) / 2`.
fn project(
    r: &Array2<Complex64>,
    basis: &[Vec<Complex64>],
) -> (Array2<Complex64>, Array2<Complex64>) {
    let seen: Vec<Vec<Complex64>> = basis
        .iter()
        .map(|q| {
            let row =
                |row: ndarray::ArrayView1<Complex64>| row.iter().zip(q).map(|(r, q)| r * q).sum();
            r.rows().into_iter().map(row).collect()
        })
        .collect();
    let mut half = seen.clone();
    for (half, seen) in half.iter_mut().zip(&seen) {
        for q in basis {
            let share = 0.5 * inner(q, seen);
            half.iter_mut().zip(q).for_each(|(h, q)| *h -= share * q);
        }
    }
    let (mut projected, mut onto) = (r.clone(), Array2::zeros(r.dim()));
    for (q, h) in basis.iter().zip(&half) {
        for (k, (mut left, mut gone)) in
            projected.rows_mut().into_iter().zip(onto.rows_mut()).enumerate()
        {
            let pairs = left.iter_mut().zip(gone.iter_mut()).zip(q.iter().zip(h));
            for ((left, gone), (ql, hl)) in pairs.take(k + 1) {
                *left -= h[k] * ql.conj() + q[k] * hl.conj();
                *gone += q[k] * ql.conj();
            }
        }
    }
    (projected, onto)
}

impl Plan for MaximumLikelihood {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut prepared = self.covariance.prepare(data)?;
        let mut warnings: Vec<Warning> = self.ambiguity.iter().cloned().collect();
        if prepared.power <= f64::MIN_POSITIVE {
            return Ok(conclude(Method::MaximumLikelihood, vec![], None, None, 0, warnings));
        }
        let power = prepared.power;
        prepared.matrix.mapv_inplace(|z| z / power);
        let count = self.count(&prepared)?;
        let (points, outcome) = self.fit(&prepared.matrix, count);
        let iterations = outcome.iterations;
        if !points.is_empty() && !outcome.converged {
            warnings.push(Warning::NotConverged { iterations });
        }
        let directions: Vec<_> = points
            .iter()
            .map(|&p| self.geometry.direction(p))
            .filter(|at| at.azimuth_rad.sin().abs() <= self.widest)
            .collect();
        let sources = sources_at(&self.array, &directions, data);
        let method = Method::MaximumLikelihood;
        Ok(conclude(method, sources, Some(count), None, iterations, warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::SourceCount;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_matrix;
    use boresight_core::{Direction, Random};

    fn known(sources: usize) -> EstimatorOptions {
        EstimatorOptions { sources: SourceCount::Known(sources), ..EstimatorOptions::default() }
    }

    #[test]
    fn coherent_sources_of_one_snapshot_are_found_exactly() {
        let truth = [(-0.31, 0.1), (0.02, -0.05), (0.4, 0.2)];
        for name in ["ula10", "lrr48", "awr1843"] {
            let array = preset(name).unwrap();
            let flat = name != "awr1843";
            let wanted: Vec<Direction> =
                truth.iter().map(|&(a, e)| Direction::new(a, if flat { 0.0 } else { e })).collect();
            let s = ndarray::array![
                [Complex64::new(1.0, 0.0)],
                [Complex64::new(0.0, 0.7)],
                [Complex64::new(-0.5, 0.0)]
            ];
            let y = steering_matrix(&array, &wanted).dot(&s);
            let options = EstimatorOptions { grid_points: 256, elevation_points: 31, ..known(3) };
            let mut plan = MaximumLikelihood::new(&array, &options).unwrap();
            let result = plan.estimate(Data::Snapshots(y.view())).unwrap();
            assert!(result.resolved && result.warnings.is_empty(), "{name} {result:?}");
            for (source, (wanted, s)) in result.sources.iter().zip(wanted.iter().zip(&s)) {
                let at = source.direction;
                assert!((at.azimuth_rad - wanted.azimuth_rad).abs() < 1e-5, "{name} {result:?}");
                assert!((at.elevation_rad - wanted.elevation_rad).abs() < 1e-5, "{name}");
                assert!((source.amplitude.unwrap() - s).norm() < 1e-4, "{name}");
            }
        }
    }

    #[test]
    fn a_known_number_beyond_what_is_there_is_unresolved() {
        let array = Array::ula(6).unwrap();
        let y = steering_matrix(&array, &[Direction::azimuth(0.25f64.asin())])
            .dot(&ndarray::array![[Complex64::new(1.0, 0.0)]]);
        let mut plan = MaximumLikelihood::new(&array, &known(2)).unwrap();
        let result = plan.estimate(Data::Snapshots(y.view())).unwrap();
        assert!(!result.resolved);
        assert!(result.warnings.contains(&Warning::Unresolved { expected: 2, found: 1 }));
        let silence = Array2::zeros((6, 3));
        let result = plan.estimate(Data::Snapshots(silence.view())).unwrap();
        assert_eq!(result.warnings, [Warning::NoSources]);
        let too_many = MaximumLikelihood::new(&array, &known(6));
        assert!(matches!(too_many.err(), Some(AoaError::TooManySources { most: 5, given: 6, .. })));
    }

    #[test]
    fn snapshots_and_their_covariance_give_the_same_angles() {
        let array = preset("ula8").unwrap();
        let mut random = Random::new(61, 0);
        let at = [Direction::azimuth(-0.1), Direction::azimuth(0.15)];
        let s = Array2::from_shape_fn((2, 40), |_| random.complex_normal(1.0));
        let y = steering_matrix(&array, &at).dot(&s)
            + Array2::from_shape_fn((8, 40), |_| random.complex_normal(0.01));
        let r = boresight_signal::sample_covariance(y.view());
        let options = EstimatorOptions { sources: SourceCount::Mdl, ..EstimatorOptions::default() };
        let mut plan = MaximumLikelihood::new(&array, &options).unwrap();
        let one = plan.estimate(Data::Snapshots(y.view())).unwrap();
        let other = plan.estimate(Data::Covariance { matrix: r.view(), snapshots: 40 }).unwrap();
        assert_eq!(one.sources.len(), 2);
        for (a, b) in one.sources.iter().zip(&other.sources) {
            assert!((a.direction.azimuth_rad - b.direction.azimuth_rad).abs() < 1e-9);
        }
    }
}
