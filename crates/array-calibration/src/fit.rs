//! Channels' factors and cells' directions by alternating least squares.

use crate::cells::Cell;
use crate::orthonormal::orthonormal;
use crate::plane_wave::{Cosines, PlaneWaves};
use boresight_core::{Array, Complex64, InputError};
use boresight_math::phasor::cis;
use std::f64::consts::PI;

/// Most rounds of alternation.
const ROUNDS: usize = 400;

/// Change of the misfit, as a share of it, below which alternation ends.
const SETTLED: f64 = 1e-10;

/// Cells whose own phases are tried as those of the channels.
const STARTS: usize = 3;

/// Least magnitude of a channel's factor: a dead channel must not make others infinite.
const DEAD: f64 = 1e-3;

/// What a cell brings to the fit.
#[derive(Debug, Clone)]
pub(crate) struct Seen {
    pub signal: Vec<Complex64>,
    /// Variance of noise in each channel.
    pub variance: f64,
    pub known: Option<Cosines>,
}

impl Seen {
    pub fn of(cell: &Cell, waves: &PlaneWaves) -> Self {
        Self {
            signal: cell.signal.clone(),
            variance: cell.variance(),
            known: cell.direction.map(|direction| waves.cosines(direction)),
        }
    }
}

/// What is fitted.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    /// Gain and phase of each channel.
    pub factors: Vec<Complex64>,
    /// Displacement of each channel along y and z, half wavelengths.
    pub moved: Vec<[f64; 2]>,
    /// Of each cell.
    pub directions: Vec<Cosines>,
    pub amplitudes: Vec<Complex64>,
    /// Power left of each cell over its own.
    pub residuals: Vec<f64>,
}

/// Cells seen by an array.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub waves: PlaneWaves,
    pub seen: Vec<Seen>,
}

impl Fit {
    pub fn new(array: &Array, cells: &[&Cell]) -> Result<Self, InputError> {
        let waves = PlaneWaves::new(array);
        if let Some(cell) = cells.iter().find(|cell| cell.signal.len() != array.len()) {
            return Err(InputError::Shape {
                what: "snapshots".into(),
                expected: format!("[{}, snapshots], all channels of the array", array.len()),
                given: vec![cell.signal.len()],
            });
        }
        let seen = cells.iter().map(|cell| Seen::of(cell, &waves)).collect();
        Ok(Self { waves, seen })
    }

    /// Whether some cell's direction is known.
    pub fn any_known(&self) -> bool {
        self.seen.iter().any(|cell| cell.known.is_some())
    }

    /// The best fit under weights, from several starts: the plan, and what each of the heaviest cells would be if it
    /// alone were right.
    pub fn best_of_starts(&self, weights: &[f64]) -> Fitted {
        let ones = vec![Complex64::ONE; self.waves.positions.len()];
        let order = boresight_math::order::descending(weights.iter().copied());
        let own = order.iter().take(STARTS).map(|&index| self.own(index));
        let fits = std::iter::once(ones).chain(own).map(|start| self.settle(start, weights));
        let cost =
            |fit: &Fitted| fit.residuals.iter().zip(weights).map(|(e, w)| w * e).sum::<f64>();
        let better = |best: Option<(f64, Fitted)>, fit: Fitted| {
            let cost = cost(&fit);
            match best {
                // A start that ends as well as the plan does not replace it.
                Some((least, kept)) if cost >= least * (1.0 - 1e-6) => Some((least, kept)),
                _ => Some((cost, fit)),
            }
        };
        let best = fits.fold(None, better);
        best.map_or_else(|| self.settle(vec![], weights), |(_, fit)| fit)
    }

    /// The factors under which one cell fits exactly.
    fn own(&self, index: usize) -> Vec<Complex64> {
        let Seen { signal, known, .. } = &self.seen[index];
        let response = self.waves.response(known.unwrap_or([0.0; 2]));
        signal.iter().zip(&response).map(|(v, a)| v * a.conj()).collect()
    }

    /// Alternates between cells and channels until nothing changes.
    pub fn settle(&self, start: Vec<Complex64>, weights: &[f64]) -> Fitted {
        let channels = self.waves.positions.len();
        let mut fit = Fitted {
            factors: if start.len() == channels { start } else { vec![Complex64::ONE; channels] },
            moved: vec![[0.0; 2]; channels],
            directions: vec![],
            amplitudes: vec![],
            residuals: vec![],
        };
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            self.fit_cells(&mut fit);
            let cost: f64 = fit.residuals.iter().zip(weights).map(|(e, w)| w * e).sum();
            if before - cost <= SETTLED * cost {
                break;
            }
            before = cost;
            self.fit_factors(&mut fit, weights);
            self.centre(&mut fit);
        }
        self.fit_cells(&mut fit);
        fit
    }

    /// Response of the displaced channels, without factors.
    pub fn response(&self, fit: &Fitted, u: Cosines) -> Vec<Complex64> {
        let plane = self.waves.response(u);
        let turn = |(a, d): (&Complex64, &[f64; 2])| a * cis(PI * (d[0] * u[0] + d[1] * u[1]));
        plane.iter().zip(&fit.moved).map(turn).collect()
    }

    /// Direction, amplitude and misfit of each cell.
    pub fn fit_cells(&self, fit: &mut Fitted) {
        let still = fit.moved.iter().all(|d| *d == [0.0; 2]);
        let cells: Vec<_> = self
            .seen
            .iter()
            .map(|cell| {
                let direction = cell.known.unwrap_or_else(|| {
                    let first = self.waves.fitted(&cell.signal, &fit.factors);
                    if still { first } else { self.refitted(fit, &cell.signal, first) }
                });
                let response = self.response(fit, direction);
                let model: Vec<Complex64> =
                    response.iter().zip(&fit.factors).map(|(a, g)| a * g).collect();
                let (amplitude, residual) = amplitude(&model, &cell.signal);
                (direction, amplitude, residual)
            })
            .collect();
        fit.directions = cells.iter().map(|cell| cell.0).collect();
        fit.amplitudes = cells.iter().map(|cell| cell.1).collect();
        fit.residuals = cells.iter().map(|cell| cell.2).collect();
    }

    /// A direction once more, with displacements taken as phases at the last one.
    fn refitted(&self, fit: &Fitted, signal: &[Complex64], mut u: Cosines) -> Cosines {
        for _ in 0..6 {
            let factors: Vec<Complex64> = fit
                .factors
                .iter()
                .zip(&fit.moved)
                .map(|(g, d)| g * cis(PI * (d[0] * u[0] + d[1] * u[1])))
                .collect();
            let next = self.waves.fitted(signal, &factors);
            let step = (next[0] - u[0]).hypot(next[1] - u[1]);
            u = next;
            if step < 1e-12 {
                break;
            }
        }
        u
    }

    fn fit_factors(&self, fit: &mut Fitted, weights: &[f64]) {
        let channels = fit.factors.len();
        let mut sums = vec![(Complex64::ZERO, 0.0); channels];
        for (index, cell) in self.seen.iter().enumerate() {
            let response = self.response(fit, fit.directions[index]);
            let (weight, amplitude) = (weights[index], fit.amplitudes[index]);
            for (k, (sum, power)) in sums.iter_mut().enumerate() {
                let model = response[k] * amplitude;
                *sum += model.conj() * cell.signal[k] * weight;
                *power += weight * model.norm_sqr();
            }
        }
        for (factor, (sum, power)) in fit.factors.iter_mut().zip(sums) {
            if power > 0.0 {
                *factor = sum / power;
            }
        }
    }

    /// Of all factors that fit alike, those nearest to the plan: without gain and phase in common and,
    /// where no direction is known, without a phase that a turn of all targets makes up for.
    fn centre(&self, fit: &mut Fitted) {
        for factor in &mut fit.factors {
            let size = factor.norm();
            if size.is_nan() || size < DEAD {
                *factor = Complex64::from(DEAD);
            }
        }
        let turn = if self.any_known() {
            [0.0; 2]
        } else {
            let unit: Vec<Complex64> = fit.factors.iter().map(|g| g / g.norm()).collect();
            self.waves.fitted(&unit, &vec![Complex64::ONE; unit.len()])
        };
        let response = self.waves.response(turn);
        let turned: Vec<Complex64> =
            fit.factors.iter().zip(&response).map(|(g, a)| g * a.conj()).collect();
        let mean: Complex64 = turned.iter().map(|g| g / g.norm()).sum();
        let common = if mean.norm() > 0.0 { mean / mean.norm() } else { Complex64::ONE };
        let mut phases: Vec<f64> = turned.iter().map(|g| (g * common.conj()).arg()).collect();
        let columns = self.common_phases(turn, !self.any_known());
        remove(&mut phases, &columns);
        let mean_log = turned.iter().map(|g| g.norm().ln()).sum::<f64>() / turned.len() as f64;
        for ((factor, g), phase) in fit.factors.iter_mut().zip(&turned).zip(phases) {
            *factor = cis(phase) * (g.norm().ln() - mean_log).exp();
        }
    }

    /// Phases over the channels that do not count: a constant and, if asked for, what a turn makes.
    pub fn common_phases(&self, u: Cosines, with_turn: bool) -> Vec<Vec<f64>> {
        let channels = self.waves.positions.len();
        let mut columns = vec![vec![1.0; channels]];
        if with_turn {
            for &axis in &self.waves.axes {
                columns.push((0..channels).map(|k| self.waves.slope(k, u, axis)).collect());
            }
        }
        columns
    }
}

/// The amplitude of a model in a signal, and the power left over that of the signal.
pub(crate) fn amplitude(model: &[Complex64], signal: &[Complex64]) -> (Complex64, f64) {
    let power: f64 = model.iter().map(Complex64::norm_sqr).sum();
    let along: Complex64 = model.iter().zip(signal).map(|(m, v)| m.conj() * v).sum();
    let amplitude = if power > 0.0 { along / power } else { Complex64::ZERO };
    let total: f64 = signal.iter().map(Complex64::norm_sqr).sum();
    let left: f64 = model.iter().zip(signal).map(|(m, v)| (v - amplitude * m).norm_sqr()).sum();
    (amplitude, if total > 0.0 { left / total } else { 1.0 })
}

/// Takes off what lies along columns.
pub(crate) fn remove(values: &mut [f64], columns: &[Vec<f64>]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    for known in orthonormal(columns, dot) {
        let along = dot(&known, values);
        values.iter_mut().zip(&known).for_each(|(x, y)| *x -= along * y);
    }
}
