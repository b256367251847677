//! Range rates beyond the unambiguous one, by hypotheses over the transmitters' phases.
//!
//! Where transmitters take turns, the rate of a bin is known up to `2 max_rate_mps` a fold, and each
//! fold turns the phase from one chirp of a loop to the next by one turn over the chirps of a loop
//! ([`crate::tdm::phase_step_rad`]). Only with the phase of its true fold taken off is the response of
//! a cell that of a few plane waves. For each fold the snapshot is fitted by one and by two waves
//! (maximum likelihood of the first, the second by least squares with it), a wave costing as much
//! as Schwarz's criterion asks of its parameters (1978). What the fits leave over, in noise powers, makes
//! the probability of each fold, all being as likely beforehand. The noise power is that around the
//! cell, or what the best fit leaves over where that is more, so that errors of the array do not
//! pass for certainty.
//!
//! Folds that differ by as many as there are chirps in a loop have the same phases; of these the
//! slowest counts. So rates are told up to those of the chirp interval, and no further. An array
//! on which the step between transmitters looks like an angle (one receiver, transmitters in a row)
//! gives every fold the same fit: the probability then says that nothing is known.
//!
//! All targets of a cell are taken to be in one fold. In binary phase the wrong of two folds swaps two
//! transmitters, which looks the same from where their echoes are in phase or opposite, such as
//! straight ahead.

mod sine_grid;

use crate::binary_phase::hadamard;
use crate::error::SignalError;
use crate::tdm::phase_step_rad;
use boresight_core::correction::Correction;
use boresight_core::limits::check_bytes;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Direction, InputError, Multiplexing};
use boresight_math::error::check_range;
use boresight_math::phasor::cis;
use ndarray::{Array2, ArrayView2};
use sine_grid::SineGrid;
use std::f64::consts::TAU;

/// Largest squared correlation between two waves that are fitted together.
const MOST_ALIKE: f64 = 0.9;

/// A fold with its probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Times `2 max_rate_mps` that the rate is beyond that of its bin.
    pub fold: i32,
    /// Probability among the folds that were tried.
    pub probability: f64,
}

/// A plan for telling folds by one array.
pub struct FoldTest {
    array: Array,
    /// Channel of each element.
    channels: Vec<usize>,
    /// What is known of the errors of all channels.
    correction: Option<Correction>,
    /// Chirps of a loop.
    chirps: usize,
    multiplexing: Multiplexing,
    most_folds: i32,
    grid: SineGrid,
    /// Grid points x channels: responses, by the chirp in the loop and receiver.
    responses: Array2<Complex64>,
}

/// What one or two waves leave over, and how much freedom they leave.
#[derive(Debug, Clone, Copy)]
struct Fit {
    left_over: f64,
    freedom: f64,
    waves: f64,
}

impl FoldTest {
    /// Plans for cells of `transmitters` that take turns in loops, seen by elements that are the
    /// channels `channels` of the cube and have errors that `correction` takes off, with up to `most_folds` to each side.
    ///
    /// # Errors
    /// [`InputError::Shape`] for another number of channels than elements or one that is no multiple
    /// of the transmitters; [`InputError::OutOfRange`] for a channel beyond them or more than 32
    /// folds; [`InputError::TooLarge`] above the limits of the thread.
    pub fn new(
        array: &Array,
        channels: &[usize],
        transmitters: usize,
        multiplexing: Multiplexing,
        most_folds: usize,
        correction: Option<&Correction>,
    ) -> Result<Self, SignalError> {
        check_range("doppler_folds", most_folds as f64, 0.0, 32.0)?;
        let elements = array.len();
        if channels.len() != elements || !elements.is_multiple_of(transmitters.max(1)) {
            return Err(SignalError::Argument(InputError::Shape {
                what: "channels of the folds".into(),
                expected: format!("{elements}, a multiple of {transmitters} transmitters"),
                given: vec![channels.len()],
            }));
        }
        for &channel in channels {
            check_range("channel", channel as f64, 0.0, elements as f64 - 1.0)?;
        }
        let grid = SineGrid::of(array);
        let sizes = [grid.len(), elements];
        check_bytes("responses for folds", &sizes, size_of::<Complex64>())?;
        let mut test = Self {
            array: array.clone(),
            channels: channels.to_vec(),
            correction: correction.cloned(),
            chirps: multiplexing.chirps_per_loop(transmitters),
            multiplexing,
            most_folds: most_folds as i32,
            responses: Array2::zeros((grid.len(), elements)),
            grid,
        };
        for index in 0..test.grid.len() {
            let Some(direction) = test.grid.direction(index, [0.0; 2]) else { continue };
            let response = test.response(direction);
            test.responses.row_mut(index).assign(&ndarray::aview1(&response));
        }
        Ok(test)
    }

    /// Folds to tell apart: 1 where nothing can be asked.
    pub fn hypotheses(&self) -> usize {
        (2 * self.most_folds as usize + 1).min(self.chirps)
    }

    /// The fold of a cell with the largest probability. `snapshots` has channels x snapshots as
    /// measured, without compensation; `doppler_bin` is where the peak lies between the bins;
    /// `noise_power` is that of one channel in the cell, or 0.
    ///
    /// # Errors
    /// [`InputError::Shape`] for snapshots of another number of channels.
    pub fn decide(
        &self,
        snapshots: ArrayView2<'_, Complex64>,
        doppler_bin: f64,
        dopplers: usize,
        noise_power: f64,
    ) -> Result<Fold, SignalError> {
        if snapshots.nrows() != self.channels.len() {
            return Err(SignalError::Argument(InputError::Shape {
                what: "snapshots".into(),
                expected: format!("{} channels", self.channels.len()),
                given: snapshots.shape().to_vec(),
            }));
        }
        let folds = self.folds(doppler_bin, dopplers);
        let beams = self.beams(snapshots);
        let fits: Vec<[Fit; 2]> = folds
            .iter()
            .map(|&fold| {
                let step = phase_step_rad(doppler_bin, dopplers, self.chirps, fold);
                self.fit(snapshots, &beams, step)
            })
            .collect();
        // The floor of the noise is what the best fit leaves over.
        let left = fits.iter().flatten().filter(|fit| fit.freedom > 0.0);
        let floor = left.map(|fit| fit.left_over / fit.freedom).fold(f64::INFINITY, f64::min);
        let floor = if floor.is_finite() { floor } else { 0.0 };
        let noise = noise_power.max(floor).max(f64::MIN_POSITIVE);
        let price = 0.5 * self.parameters() * (2.0 * snapshots.len() as f64).ln();
        let costs = fits.iter().map(|fits| {
            let cost = |fit: &Fit| fit.left_over / noise + price * fit.waves;
            fits.iter().filter(|fit| fit.freedom > 0.0).map(cost).fold(f64::INFINITY, f64::min)
        });
        let costs: Vec<f64> = costs.collect();
        let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
        if !least.is_finite() {
            return Ok(Fold { fold: 0, probability: 1.0 / folds.len() as f64 });
        }
        let weights: Vec<f64> = costs.iter().map(|cost| libm::exp(least - cost)).collect();
        // Of equals, the slowest: folds ascend with their speed.
        let best = costs.iter().position(|&cost| cost <= least).unwrap_or_default();
        let all: f64 = weights.iter().sum();
        Ok(Fold { fold: folds[best], probability: weights[best] / all })
    }

    /// The slowest fold of each that phases can tell, ascending in speed.
    fn folds(&self, doppler_bin: f64, dopplers: usize) -> Vec<i32> {
        let turns = phase_step_rad(doppler_bin, dopplers, 1, 0) / TAU;
        let mut folds: Vec<i32> = (-self.most_folds..=self.most_folds).collect();
        let speed = |fold: &i32| (f64::from(*fold) + turns).abs();
        boresight_math::order::sort_ascending(&mut folds, speed);
        let chirps = self.chirps as i32;
        let mut told: Vec<i32> = vec![];
        for fold in folds {
            if told.iter().all(|known| (known - fold).rem_euclid(chirps) != 0) {
                told.push(fold);
            }
        }
        told
    }

    /// Real parameters of a wave: amplitude, phase and its sines.
    fn parameters(&self) -> f64 {
        2.0 + self.grid.dimensions()
    }

    /// Response by the chirp in the loop and receiver, of what stands.
    fn response(&self, direction: Direction) -> Vec<Complex64> {
        let mut response = vec![Complex64::ZERO; self.channels.len()];
        let steering = steering_vector(&self.array, direction);
        let elements = self.array.channels().iter().zip(steering);
        for (&channel, (&element, z)) in self.channels.iter().zip(elements) {
            response[channel] = if self.array.is_inverted(element) { -z } else { z };
        }
        if let Some(correction) = &self.correction {
            correction.undo(&mut response);
        }
        if self.multiplexing == Multiplexing::BinaryPhase {
            hadamard(&mut response, self.chirps);
        }
        response
    }

    /// Products of grid responses and snapshots, apart by the chirp in the loop: (snapshots x grid
    /// points) x chirps.
    fn beams(&self, snapshots: ArrayView2<'_, Complex64>) -> Array2<Complex64> {
        let points = self.grid.len();
        let receivers = self.channels.len() / self.chirps;
        let mut beams = Array2::zeros((snapshots.ncols() * points, self.chirps));
        for (n, snapshot) in snapshots.columns().into_iter().enumerate() {
            let snapshot = snapshot.to_vec();
            for (g, response) in self.responses.rows().into_iter().enumerate() {
                let mut row = beams.row_mut(n * points + g);
                for (k, beam) in row.iter_mut().enumerate() {
                    let part = k * receivers..(k + 1) * receivers;
                    let parts = part.map(|at| response[at].conj() * snapshot[at]);
                    *beam = parts.sum();
                }
            }
        }
        beams
    }

    /// One and two waves in snapshots whose phase from chirp to chirp is taken off.
    fn fit(
        &self,
        snapshots: ArrayView2<'_, Complex64>,
        beams: &Array2<Complex64>,
        phase_step_rad: f64,
    ) -> [Fit; 2] {
        let points = self.grid.len();
        let count = snapshots.ncols();
        let receivers = self.channels.len() / self.chirps;
        let turns: Vec<Complex64> =
            (0..self.chirps).map(|k| cis(-phase_step_rad * k as f64)).collect();
        let still = Array2::from_shape_fn(snapshots.dim(), |(at, n)| {
            snapshots[[at, n]] * turns[at / receivers]
        });
        let beams: Vec<Complex64> = beams
            .rows()
            .into_iter()
            .map(|row| row.iter().zip(&turns).map(|(beam, turn)| beam * turn).sum())
            .collect();
        let energy: f64 = still.iter().map(|z| z.norm_sqr()).sum();
        let norm = |response: &[Complex64]| response.iter().map(|z| z.norm_sqr()).sum::<f64>();
        let product = |response: &[Complex64], n: usize| -> Complex64 {
            response.iter().zip(still.column(n)).map(|(a, y)| a.conj() * y).sum()
        };
        // Channels x snapshots are complex numbers, of which a wave takes an amplitude a snapshot,
        // and its sines.
        let freedom = |waves: f64| {
            (snapshots.len() as f64) - waves * (count as f64 + 0.5 * self.grid.dimensions())
        };
        let first =
            self.highest(|g| (0..count).map(|n| beams[n * points + g].norm_sqr()).sum::<f64>());
        let size = norm(&first);
        let amplitudes: Vec<Complex64> = (0..count).map(|n| product(&first, n)).collect();
        let gathered: f64 = amplitudes.iter().map(|z| z.norm_sqr()).sum::<f64>() / size;
        let left_over = (energy - gathered).max(0.0);
        let one = Fit { left_over, freedom: freedom(1.0), waves: 1.0 };
        // What a wave gathers of the rest, together with the first.
        let rest = |cross: Complex64, size_2: f64, of: &dyn Fn(usize) -> Complex64| {
            let unlike = 1.0 - cross.norm_sqr() / (size * size_2);
            if unlike < 1.0 - MOST_ALIKE {
                return 0.0;
            }
            let power = |n: usize| (of(n) - cross * amplitudes[n] / size).norm_sqr();
            (0..count).map(power).sum::<f64>() / (size_2 * unlike)
        };
        let cross_with = |response: &[Complex64]| -> Complex64 {
            response.iter().zip(&first).map(|(b, a)| b.conj() * a).sum()
        };
        let second = self.highest(|g| {
            let response = self.responses.row(g);
            let Some(response) = response.as_slice() else { return 0.0 };
            rest(cross_with(response), norm(response), &|n| beams[n * points + g])
        });
        let gathered = rest(cross_with(&second), norm(&second), &|n| product(&second, n));
        let left_over = (left_over - gathered).max(0.0);
        [one, Fit { left_over, freedom: freedom(2.0), waves: 2.0 }]
    }

    /// The response at the highest point of a spectrum over the grid, between its points.
    fn highest(&self, spectrum: impl Fn(usize) -> f64) -> Vec<Complex64> {
        let values: Vec<f64> = (0..self.grid.len()).map(spectrum).collect();
        let best = (0..values.len()).fold(0, |b, g| if values[g] > values[b] { g } else { b });
        let offset = self.grid.vertex(&values, best);
        let direction = self.grid.direction(best, offset).unwrap_or_default();
        self.response(direction)
    }
}

#[cfg(test)]
mod tests;
