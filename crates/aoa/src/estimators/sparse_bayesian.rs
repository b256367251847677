//! Off-grid sparse Bayesian learning (Yang, Xie and Zhang 2013).
//!
//! Every grid point has a source of unknown power `alpha`, displaced by an unknown offset `beta` of
//! at most half a grid step: `y_n = sum_g phi_g s_gn + noise`, `phi = a + beta b` with `b` the
//! derivative of `a` by the sine. Powers, offsets and noise power are learnt by expectation
//! maximisation.
//!
//! All posterior moments follow from the inverse of the K x K covariance
//! `C = sigma^2 I + Phi diag(alpha) Phi^H` (Woodbury): `mu = alpha phi^H C^-1 y`, variance
//! `alpha (1 - alpha phi^H C^-1 phi)`, residual `sigma^2 C^-1 y`. Offsets differ from zero at no more than
//! `K - 1` points, so that `C` is that of the plain grid plus a few products, and sums over the
//! grid are transforms on a lattice.
//!
//! A source between two grid points is shared by both for many iterations, and the offsets remove
//! only part of the grid's error in that time; [`crate::refinement::gauss_newton::refine`] takes the directions
//! to the maximum of the likelihood.

use crate::checks::{ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Spectrum, SpectrumKind, Warning};
use crate::estimators::iaa::fourier::{LagTransforms, LatticeFourier};
use crate::estimators::iaa::inverse::hermitian_inverse;
use crate::grid::Grid;
use crate::method::Method;
use crate::model::cosines::Geometry;
use crate::model::normalised::Normalised;
use crate::model::powers::sources_at;
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use crate::spectra::dense_grid::DenseGrid;
use crate::spectra::peaks::{PeakFinder, wrap};
use crate::spectra::quadratic::QuadraticSpectrum;
use boresight_core::{Array, Complex64, Direction, Lattice};
use boresight_math::linalg::{Cholesky, adjoint, hermitian_eigen};
use boresight_math::order::sort_descending;
use ndarray::{Array1, Array2};
use std::f64::consts::FRAC_PI_2;

/// Rate of the exponential prior on powers, and shape and rate of the gamma prior on the noise
/// precision, as in the paper's simulations, for data of mean element power 1.
const RHO: f64 = 0.01;
const SHAPE: f64 = 1e-4;
const RATE: f64 = 1e-4;

/// Noise power that learning starts from, and the least it may come to.
const FIRST_NOISE: f64 = 0.01;
const LEAST_NOISE: f64 = 1e-11;

/// Sparse Bayesian learning prepared for one array and grid.
pub(crate) struct SparseBayesian {
    array: Array,
    geometry: Geometry,
    /// The whole circle of azimuths, and the field of view in it.
    whole: Grid,
    grid: Grid,
    model: Model,
    finder: PeakFinder,
    iterations: usize,
    tolerance: f64,
    ambiguity: Option<Warning>,
    period: Option<f64>,
}

/// Sums over the plain grid.
enum Model {
    Lattice {
        lattice: Lattice,
        fourier: LatticeFourier<f64>,
        lags: Vec<Complex64>,
        spectrum: Box<QuadraticSpectrum>,
    },
    Dense(DenseGrid),
}

impl Model {
    /// Lower triangle of `A diag(power) A^H`.
    fn covariance(&mut self, power: &[f64]) -> Array2<Complex64> {
        match self {
            Self::Lattice { lattice, fourier, lags, .. } => {
                fourier.lags(power, lags);
                let n = &lattice.indices;
                Array2::from_shape_fn((n.len(), n.len()), |(k, l)| {
                    if n[k] >= n[l] { lags[n[k] - n[l]] } else { lags[n[l] - n[k]].conj() }
                })
            }
            Self::Dense(grid) => grid.covariance(power),
        }
    }

    /// `a^H M a` at every point.
    fn quadratic(&mut self, form: &Array2<Complex64>) -> Vec<f64> {
        match self {
            Self::Lattice { spectrum, .. } => spectrum.evaluate(form.view()),
            Self::Dense(grid) => grid.quadratic(form),
        }
    }
}

/// What is learnt.
struct State {
    alpha: Vec<f64>,
    noise: f64,
    /// Points with an offset, ascending, and their offsets.
    active: Vec<usize>,
    offsets: Vec<f64>,
}

impl SparseBayesian {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::SparseBayesian, array, options)?;
        let grid = Grid::new(array, options);
        let whole =
            Grid::new(array, &EstimatorOptions { field_of_view_rad: FRAC_PI_2, ..*options });
        let lattice = array.lattice();
        let period = lattice.as_ref().map(|l| 2.0 / l.spacing).filter(|&p| p < 2.0 - 1e-9);
        let model = match lattice {
            Some(lattice) => {
                let span = lattice.span();
                Model::Lattice {
                    fourier: LatticeFourier::new(whole.full_points, lattice.spacing, span),
                    lags: vec![Complex64::ZERO; span],
                    lattice,
                    spectrum: Box::new(QuadraticSpectrum::new(array, &whole)),
                }
            }
            None => {
                let directions = (0..whole.len()).map(|g| whole.direction(g)).collect();
                Model::Dense(DenseGrid::new(array, directions))
            }
        };
        Ok(Self {
            array: array.clone(),
            geometry: Geometry::new(array),
            finder: PeakFinder::new(array, &grid, options),
            whole,
            grid,
            model,
            iterations: options.max_iterations,
            tolerance: options.tolerance,
            ambiguity: ambiguity(array, options),
            period,
        })
    }

    /// Steering vectors and their derivatives by the sine at grid points, as columns.
    fn columns(&self, points: &[usize]) -> (Array2<Complex64>, Array2<Complex64>) {
        let size = (self.geometry.elements(), points.len());
        let (mut a, mut b) = (Array2::zeros(size), Array2::zeros(size));
        for (i, &g) in points.iter().enumerate() {
            let steering = self.geometry.steering([self.whole.sines[g], 0.0]);
            for (k, z) in steering.vector.iter().enumerate() {
                a[[k, i]] = *z;
                b[[k, i]] = z * Complex64::new(0.0, steering.slopes[k][0]);
            }
        }
        (a, b)
    }

    fn start(&mut self, y: &Array2<Complex64>) -> State {
        let elements = y.nrows() as f64;
        let r = y.dot(&adjoint(y.view()));
        let power = self.model.quadratic(&r);
        let alpha = power.iter().map(|p| p.max(0.0).sqrt() / elements).collect();
        State { alpha, noise: FIRST_NOISE, active: Vec::new(), offsets: Vec::new() }
    }

    /// One round of expectation maximisation on data `y` that stands for `snapshots`; the relative
    /// change of the powers, or nothing if the covariance has become singular.
    fn learn(&mut self, state: &mut State, y: &Array2<Complex64>, snapshots: f64) -> Option<f64> {
        let elements = y.nrows() as f64;
        let (a, b) = self.columns(&state.active);
        let offsets = Array1::from(state.offsets.clone());
        let phi = &a + &scaled(&b, &offsets);
        let powers: Array1<f64> = state.active.iter().map(|&g| state.alpha[g]).collect();
        let mut plain = state.alpha.clone();
        state.active.iter().for_each(|&g| plain[g] = 0.0);
        let mut c = self.model.covariance(&plain);
        c += &scaled(&phi, &powers).dot(&adjoint(phi.view()));
        c.diag_mut().iter_mut().for_each(|d| *d += state.noise);
        let inverse = hermitian_inverse(&c)?;
        let z = inverse.dot(y);
        let seen = z.dot(&adjoint(z.view()));
        let mut response = self.model.quadratic(&seen);
        let mut share = self.model.quadratic(&inverse);
        let weighted = inverse.dot(&phi);
        for (i, &g) in state.active.iter().enumerate() {
            response[g] = adjoint_product(&phi, i, &seen.dot(&phi.column(i))).re;
            share[g] = adjoint_product(&phi, i, &weighted.column(i).to_owned()).re;
        }
        let before = state.alpha.clone();
        let (mut change, mut size, mut shares) = (0.0, 0.0, 0.0);
        for ((alpha, response), share) in state.alpha.iter_mut().zip(&response).zip(&share) {
            let share = (*alpha * share).clamp(0.0, 1.0);
            shares += share;
            let energy = (*alpha * *alpha * response).max(0.0) + snapshots * *alpha * (1.0 - share);
            let root = (snapshots * snapshots + 4.0 * RHO * energy).sqrt();
            let next = 2.0 * energy / (root + snapshots);
            change += (next - *alpha).powi(2);
            size += *alpha * *alpha;
            *alpha = next;
        }
        let noise = state.noise;
        let error = noise * noise * z.iter().map(|z| z.norm_sqr()).sum::<f64>();
        state.noise = ((error + snapshots * noise * shares + RATE)
            / (snapshots * elements + SHAPE - 1.0))
            .max(LEAST_NOISE);
        let old = Old { b, offsets, powers, phi, z, inverse, noise, snapshots };
        self.displace(state, &before, &old);
        Some((change / size.max(f64::MIN_POSITIVE)).sqrt())
    }

    /// Chooses the highest peaks and minimises the expected misfit over their offsets.
    fn displace(&self, state: &mut State, before: &[f64], old: &Old) {
        let active = highest_peaks(&state.alpha, self.geometry.elements() - 1);
        let (a, b) = self.columns(&active);
        let known: Array1<f64> = active
            .iter()
            .map(|g| state.active.binary_search(g).map_or(0.0, |i| old.offsets[i]))
            .collect();
        let phi = &a + &scaled(&b, &known);
        let alpha: Array1<f64> = active.iter().map(|&g| before[g]).collect();
        let weighted = old.inverse.dot(&phi);
        let adjoint_phi = adjoint(phi.view());
        // Posterior mean and covariance of the active points.
        let mu = scaled(&old.z.t().dot(&phi.mapv(|z| z.conj())), &alpha).reversed_axes();
        let cross = adjoint_phi.dot(&weighted);
        let mut second = mu.dot(&adjoint(mu.view()));
        for ((i, k), s) in second.indexed_iter_mut() {
            let prior = if i == k { alpha[i] } else { 0.0 };
            *s += (Complex64::from(prior) - cross[[i, k]] * alpha[i] * alpha[k]) * old.snapshots;
        }
        let adjoint_b = adjoint(b.view());
        let gram = adjoint_b.dot(&b);
        let p =
            Array2::from_shape_fn(gram.dim(), |(i, k)| (gram[[i, k]].conj() * second[[i, k]]).re);
        // What the plain grid leaves of the data: the residual, and the part that was displaced.
        let moved = scaled(&old.b, &(&old.offsets * &old.powers));
        let old_adjoint = adjoint(old.phi.view());
        let left = old.z.mapv(|z| z * old.noise) + moved.dot(&old_adjoint.dot(&old.z));
        // A Sigma on the active columns, over alpha.
        let spread =
            &a - &phi + weighted.mapv(|z| z * old.noise) + moved.dot(&old_adjoint.dot(&weighted));
        let toward = adjoint_b.dot(&left);
        let v: Vec<f64> = (0..active.len())
            .map(|i| {
                let pull: Complex64 =
                    mu.row(i).iter().zip(toward.row(i)).map(|(m, t)| m.conj() * t).sum();
                let bias = adjoint_product(&b, i, &spread.column(i).to_owned()).re * alpha[i];
                pull.re - old.snapshots * bias
            })
            .collect();
        let half = 1.0 / self.whole.full_points as f64;
        let solved = Cholesky::new(p.mapv(Complex64::from).view())
            .map(|f| f.solve(v.iter().map(|&x| Complex64::from(x)).collect::<Array1<_>>().view()));
        state.offsets = (0..active.len())
            .map(|i| {
                let own = v[i] / p[[i, i]].max(f64::MIN_POSITIVE);
                let joint = solved.as_ref().map_or(own, |s| s[i].re);
                if joint.is_finite() { joint.clamp(-half, half) } else { 0.0 }
            })
            .collect();
        state.active = active;
    }

    /// Directions of the peaks, displaced by their offsets, and the spectrum of powers.
    fn read_out(&self, state: &State, scale: impl Fn(f64) -> f64) -> (Vec<Direction>, Vec<f64>) {
        let inside = self.grid.first..self.grid.first + self.grid.sines.len();
        let values: Vec<f64> = state.alpha[inside].iter().map(|&p| scale(p)).collect();
        let directions = self
            .finder
            .find(&self.grid, &values)
            .iter()
            .map(|peak| {
                let g = self.grid.first + peak.index;
                let offset = state.active.binary_search(&g).map_or(0.0, |i| state.offsets[i]);
                let sine = self.whole.sines[g] + offset;
                let sine = self.period.map_or(sine, |period| wrap(sine, period));
                Direction::azimuth(sine.clamp(-1.0, 1.0).asin())
            })
            .collect();
        (directions, values)
    }
}

impl SparseBayesian {
    fn spectrum(&self, values: Vec<f64>) -> Spectrum {
        Spectrum {
            azimuth_rad: self.grid.azimuth_rad.clone(),
            elevation_rad: self.grid.elevation_rad.clone(),
            values,
            kind: SpectrumKind::Power,
        }
    }
}

/// What the expectation step of a round leaves for its offsets.
struct Old {
    b: Array2<Complex64>,
    offsets: Array1<f64>,
    powers: Array1<f64>,
    phi: Array2<Complex64>,
    /// `C^-1 y`.
    z: Array2<Complex64>,
    inverse: Array2<Complex64>,
    noise: f64,
    snapshots: f64,
}

/// Columns times real factors.
fn scaled(columns: &Array2<Complex64>, factors: &Array1<f64>) -> Array2<Complex64> {
    columns * &factors.mapv(Complex64::from)
}

/// Column `i` adjoint, times `x`.
fn adjoint_product(columns: &Array2<Complex64>, i: usize, x: &Array1<Complex64>) -> Complex64 {
    columns.column(i).iter().zip(x).map(|(c, x)| c.conj() * x).sum()
}

/// The highest `most` local maxima on the circle of grid points, ascending.
fn highest_peaks(alpha: &[f64], most: usize) -> Vec<usize> {
    let n = alpha.len();
    let mut peaks: Vec<usize> = (0..n)
        .filter(|&g| alpha[g] > alpha[(g + n - 1) % n] && alpha[g] >= alpha[(g + 1) % n])
        .collect();
    sort_descending(&mut peaks, |&g| alpha[g]);
    peaks.truncate(most);
    boresight_math::order::sort_by(&mut peaks, Ord::cmp);
    peaks
}

/// At most as many vectors as elements with the same `Y Y^H`.
fn condensed(y: Array2<Complex64>) -> Result<Array2<Complex64>, AoaError> {
    if y.ncols() <= y.nrows() {
        return Ok(y);
    }
    let eigen = hermitian_eigen(y.dot(&adjoint(y.view())).view())?;
    Ok(scaled(&eigen.vectors, &eigen.values.mapv(|v| v.max(0.0).sqrt())))
}

impl Plan for SparseBayesian {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let method = Method::SparseBayesian;
        let Data::Snapshots(y) = data else {
            return Err(AoaError::NeedsSnapshots { method: method.name() });
        };
        let mut warnings: Vec<Warning> = self.ambiguity.iter().cloned().collect();
        let Some(normalised) = Normalised::new(y) else {
            let silent = self.spectrum(vec![0.0; self.grid.len()]);
            return Ok(conclude(method, vec![], None, Some(silent), 0, warnings));
        };
        let whole = &normalised.snapshots;
        let mean = whole.iter().map(|z| z.norm_sqr()).sum::<f64>() / whole.len() as f64;
        let snapshots = whole.ncols() as f64;
        let y = condensed(whole.mapv(|z| z / mean.sqrt()))?;
        let mut state = self.start(&y);
        let first = snapshots.sqrt();
        state.alpha.iter_mut().for_each(|a| *a /= first);
        let mut iterations = 0;
        let mut converged = false;
        while iterations < self.iterations && !converged {
            iterations += 1;
            match self.learn(&mut state, &y, snapshots) {
                Some(change) => converged = change < self.tolerance,
                None => break,
            }
        }
        if !converged {
            warnings.push(Warning::NotConverged { iterations });
        }
        let (directions, values) =
            self.read_out(&state, |power| normalised.power_out(power * mean));
        let sources = sources_at(&self.array, &directions, Data::Snapshots(whole.view()))
            .into_iter()
            .map(|source| normalised.source_out(source))
            .collect();
        Ok(conclude(method, sources, None, Some(self.spectrum(values)), iterations, warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Random;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_matrix;

    fn scene(array: &Array, sines: &[f64], snapshots: usize, noise: f64) -> Array2<Complex64> {
        let mut random = Random::new(81, snapshots as u64);
        let at: Vec<Direction> = sines.iter().map(|u| Direction::azimuth(u.asin())).collect();
        let s = Array2::from_shape_fn((at.len(), snapshots), |_| {
            boresight_math::phasor::cis(random.phase())
        });
        let n = Array2::from_shape_fn((array.len(), snapshots), |_| random.complex_normal(noise));
        steering_matrix(array, &at).dot(&s) + n
    }

    #[test]
    fn sources_between_grid_points_are_found_there() {
        let solid: Vec<[f64; 3]> =
            (0..10).map(|k| [0.1 * k as f64, 1.07 * k as f64, 0.0]).collect();
        for array in [preset("ula16").unwrap(), Array::new(&solid).unwrap()] {
            // 0.4 and -0.3 steps off the grid of 1 / 32.
            let sines = [(-6.0 + 0.4) / 32.0, (9.0 - 0.3) / 32.0];
            let y = scene(&array, &sines, 20, 1e-3);
            let options = EstimatorOptions {
                grid_points: 64,
                tolerance: 1e-4,
                ..EstimatorOptions::default()
            };
            let mut plan = SparseBayesian::new(&array, &options).unwrap();
            let result = plan.estimate(Data::Snapshots(y.view())).unwrap();
            let mut found: Vec<f64> =
                result.sources.iter().take(2).map(|s| s.direction.azimuth_rad.sin()).collect();
            found.sort_by(f64::total_cmp);
            for (found, wanted) in found.iter().zip(sines) {
                // What a neighbour on the grid explains the offset need not: a fraction of a step
                // is left, as in a plain implementation of the paper.
                assert!((found - wanted).abs() < 0.4 / 32.0, "{found} {wanted}");
            }
            assert!(result.sources.iter().take(2).all(|s| (s.power - 1.0).abs() < 0.05));
        }
    }

    #[test]
    fn silence_single_snapshots_and_wrong_data() {
        let array = preset("ula8").unwrap();
        let options =
            EstimatorOptions { grid_points: 64, max_iterations: 5, ..EstimatorOptions::default() };
        let mut plan = SparseBayesian::new(&array, &options).unwrap();
        let silence = Array2::zeros((8, 2));
        let result = plan.estimate(Data::Snapshots(silence.view())).unwrap();
        assert_eq!(result.warnings, [Warning::NoSources]);
        let y = scene(&array, &[0.25], 1, 0.0);
        let result = plan.estimate(Data::Snapshots(y.view())).unwrap();
        assert!((result.sources[0].direction.azimuth_rad.sin() - 0.25).abs() < 1e-2);
        assert!(result.warnings.contains(&Warning::NotConverged { iterations: 5 }));
        let r = Array2::eye(8);
        let refused = plan.estimate(Data::Covariance { matrix: r.view(), snapshots: 3 });
        assert!(matches!(refused, Err(AoaError::NeedsSnapshots { .. })));
    }
}
