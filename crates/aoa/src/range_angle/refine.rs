//! Gauss-Newton refinement of the ranges and sines of all targets, with amplitudes eliminated.
//!
//! With responses `A`, derivatives `D` (two a target, along range and along sine) and amplitudes
//! `S = A^+ X`, the gradient of `|X - A S|^2` with respect to place `p` of target `i` is
//! `-2 Re sum_l s_il^* d_p^H P x_l`, and its Hessian nearly
//! `2 Re (D^H P D)_pq sum_l s_il^* s_kl`, `P` being the projection away from `A`. Half the noise
//! power over half that Hessian is the Cramer-Rao bound.

use super::LEAST_LEFT;
use super::Place;
use super::atoms::{Atoms, Response, correlate, inner};
use boresight_core::Complex64;
use boresight_math::linalg::Cholesky;
use ndarray::{Array1, Array2, ArrayView3};

/// Minimum fraction of a response's power in the bins that are present.
const LEAST_HELD: f64 = 0.3;
/// Maximum number of step halvings.
const MAX_HALVINGS: usize = 12;

/// Least-squares fit of targets at given places.
pub(super) struct Fit {
    pub places: Vec<Place>,
    /// Targets x chirps.
    pub amplitudes: Array2<Complex64>,
    /// Power not explained by the targets.
    pub residual: f64,
    /// Gradient and Hessian with respect to bin and sine of each target in turn.
    gradient: Array1<f64>,
    hessian: Array2<f64>,
    /// Whether the data determine ranges.
    has_range: bool,
}

/// Result of a refinement.
pub(super) struct Refined {
    pub fit: Fit,
    pub iterations: usize,
    pub converged: bool,
}

/// Data of a region with its response model.
pub(super) struct Model<'a> {
    pub atoms: &'a Atoms,
    /// Bins x elements x chirps, zero where not `held`.
    pub data: ArrayView3<'a, Complex64>,
    pub held: &'a [bool],
    /// Squared sum of the data.
    pub power: f64,
    /// Largest sine to either side.
    pub widest: f64,
}

impl Model<'_> {
    /// Returns the responses along range, zero in missing bins, and along the array.
    pub fn responses(&self, place: Place) -> [Response; 2] {
        let mut range = self.atoms.range(place.bin);
        for (at, _) in self.held.iter().enumerate().filter(|(_, held)| !**held) {
            range.value[at] *= 0.0;
            range.slope[at] *= 0.0;
        }
        [range, self.atoms.array(place.sine)]
    }

    /// Fits amplitudes at the given places. Returns `None` if two places cannot be distinguished or one lies in missing
    /// bins.
    pub fn fit(&self, places: &[Place]) -> Option<Fit> {
        let count = places.len();
        let responses: Vec<_> = places.iter().map(|place| self.responses(*place)).collect();
        // Responses of all targets, then the two derivatives of each target.
        let mut columns: Vec<[&[Complex64]; 2]> = vec![];
        columns.extend(responses.iter().map(|[range, array]| [&range.value[..], &array.value]));
        for [range, array] in &responses {
            columns.push([&range.slope, &array.value]);
            columns.push([&range.value, &array.slope]);
        }
        let product = |i: usize, k: usize| {
            inner(columns[i][0], columns[k][0]) * inner(columns[i][1], columns[k][1])
        };
        let gram = Array2::from_shape_fn((count, count), |(i, k)| product(i, k));
        let factor = Cholesky::new(gram.view()).ok()?;
        let elements = self.atoms.positions.len() as f64;
        for (i, pivot) in factor.diagonal().enumerate() {
            let own = gram[[i, i]].re;
            if own < LEAST_HELD * elements || pivot * pivot < LEAST_LEFT * own {
                return None;
            }
        }
        let chirps = self.data.dim().2;
        let mut received = Array2::zeros((columns.len(), chirps));
        for (column, mut to) in columns.iter().zip(received.rows_mut()) {
            to.assign(&Array1::from_vec(correlate(&self.data, column[0], column[1])));
        }
        let (by_response, by_slope) = received.view().split_at(ndarray::Axis(0), count);
        let mut amplitudes = Array2::zeros((count, chirps));
        let mut explained = 0.0;
        for chirp in 0..chirps {
            let solved = factor.solve(by_response.column(chirp));
            explained += inner(&by_response.column(chirp).to_vec(), &solved.to_vec()).re;
            amplitudes.column_mut(chirp).assign(&solved);
        }
        // Products of derivatives with responses, and their projection on the responses.
        let crossed = Array2::from_shape_fn((2 * count, count), |(p, k)| product(count + p, k));
        let left = &by_slope - &crossed.dot(&amplitudes);
        let made_up: Vec<Array1<Complex64>> = crossed
            .rows()
            .into_iter()
            .map(|row| factor.solve(row.mapv(|z| z.conj()).view()))
            .collect();
        // A single bin does not determine the range within it, so ranges are kept.
        let has_range = self.held.iter().filter(|held| **held).count() > 1;
        let is_free = |p: usize| has_range || p % 2 == 1;
        let gradient = Array1::from_shape_fn(2 * count, |p| {
            if !is_free(p) {
                return 0.0;
            }
            let along = amplitudes.row(p / 2);
            -2.0 * along.iter().zip(left.row(p)).map(|(s, z)| (s.conj() * z).re).sum::<f64>()
        });
        let hessian = Array2::from_shape_fn((2 * count, 2 * count), |(p, q)| {
            if !(is_free(p) && is_free(q)) {
                return if p == q { 1.0 } else { 0.0 };
            }
            let seen: Complex64 = crossed.row(p).iter().zip(&made_up[q]).map(|(c, m)| c * m).sum();
            let apart = product(count + p, count + q) - seen;
            let (one, other) = (amplitudes.row(p / 2), amplitudes.row(q / 2));
            let together: Complex64 = one.iter().zip(&other).map(|(s, t)| s.conj() * t).sum();
            2.0 * (apart * together).re
        });
        let residual = (self.power - explained).max(0.0);
        let places = places.to_vec();
        Some(Fit { places, amplitudes, residual, gradient, hessian, has_range })
    }

    /// Refines places by Gauss-Newton steps until the relative decrease of the residual is at most `tolerance`.
    pub fn refine(&self, places: &[Place], iterations: usize, tolerance: f64) -> Option<Refined> {
        let mut fit = self.fit(places)?;
        for iteration in 0..iterations {
            let Some(step) = fit.step() else {
                return Some(Refined { fit, iterations: iteration, converged: false });
            };
            let mut share = 1.0;
            let better = (0..MAX_HALVINGS).find_map(|_| {
                let moved = self.moved(&fit.places, &step, share);
                share *= 0.5;
                self.fit(&moved).filter(|next| next.residual < fit.residual)
            });
            let Some(better) = better else {
                // No step improves the fit beyond rounding.
                return Some(Refined { fit, iterations: iteration, converged: true });
            };
            let gained = fit.residual - better.residual;
            let ended = gained <= tolerance * better.residual.max(f64::MIN_POSITIVE);
            fit = better;
            if ended {
                return Some(Refined { fit, iterations: iteration + 1, converged: true });
            }
        }
        Some(Refined { fit, iterations, converged: false })
    }

    /// Returns half a range bin and half a beamwidth: the largest step.
    pub fn limits(&self) -> [f64; 2] {
        let reach = self.atoms.positions.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        [0.5, 0.5 / (reach + 0.5)]
    }

    /// Moves places by a fraction of a step, limited to half a bin and half a beamwidth and to the region.
    fn moved(&self, places: &[Place], step: &Array1<f64>, share: f64) -> Vec<Place> {
        let limits = self.limits();
        let longest = (0..step.len()).map(|p| step[p].abs() / limits[p % 2]).fold(1.0, f64::max);
        let share = share / longest;
        let last = self.atoms.bins as f64 - 1.0;
        let moved = places.iter().enumerate().map(|(i, place)| Place {
            bin: (place.bin + share * step[2 * i]).clamp(0.0, last),
            sine: (place.sine + share * step[2 * i + 1]).clamp(-self.widest, self.widest),
        });
        moved.collect()
    }
}

impl Fit {
    /// Fit without targets.
    pub fn of_nothing(power: f64) -> Self {
        Self {
            places: vec![],
            amplitudes: Array2::zeros((0, 1)),
            residual: power,
            gradient: Array1::zeros(0),
            hessian: Array2::zeros((0, 0)),
            has_range: false,
        }
    }

    fn step(&self) -> Option<Array1<f64>> {
        let factor = self.factor()?;
        let step = factor.solve(self.gradient.mapv(|g| Complex64::new(-g, 0.0)).view());
        Some(step.mapv(|z| z.re)).filter(|step| step.iter().all(|x| x.is_finite()))
    }

    fn factor(&self) -> Option<Cholesky> {
        let size = self.hessian.nrows();
        // Keeps a target of zero amplitude in place.
        let loaded = Array2::from_shape_fn((size, size), |(p, q)| {
            let load = if p == q { 1.0 + 1e-12 } else { 1.0 };
            Complex64::new(self.hessian[[p, q]] * load, 0.0)
        });
        Cholesky::new(loaded.view()).ok()
    }

    /// Whether the standard deviations of all places are at most half of the limits. They are larger for two targets
    /// that noise does not resolve, whose amplitudes would cancel each other.
    pub fn is_determined(&self, noise_power: f64, limits: [f64; 2]) -> bool {
        self.deviations(noise_power).is_some_and(|all| {
            all.iter().all(|(bin, sine)| {
                bin.unwrap_or_default() <= 0.5 * limits[0] && *sine <= 0.5 * limits[1]
            })
        })
    }

    /// Returns the standard deviations of bin and sine of each target (Cramer-Rao bound). The first is `None` if the data
    /// do not determine ranges.
    pub fn deviations(&self, noise_power: f64) -> Option<Vec<(Option<f64>, f64)>> {
        let inverse = self.factor()?.inverse();
        let deviation = |p: usize| (noise_power * inverse[[p, p]].re).max(0.0).sqrt();
        let bin = |i: usize| self.has_range.then(|| deviation(2 * i));
        Some((0..self.places.len()).map(|i| (bin(i), deviation(2 * i + 1))).collect())
    }
}
