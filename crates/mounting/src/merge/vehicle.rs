//! All drives of a vehicle at once: its unknowns, what drives differ by, and what each drive counts for, in turns.

use super::elimination::{About, Drive, Effects, Eliminated, Layout, Residual, Solution};
use super::{CAR, CarVector};
use crate::error::MountingError;
use crate::recursive::block::student;
use boresight_core::InputError;
use boresight_math::linalg::small::invert;

/// Drives that what is expected of their differences counts as.
const PRIOR_DRIVES: f64 = 2.0;
/// Standard deviations expected of what drives that share an unknown differ by: of the inverse scale, the bias (rad/s), the slip gradient (rad per
/// m/s^2; a tenth of what cars have) and the delay (s; from 40 to 110 ms were seen of radars of one kind).
const EXPECTED: CarVector = [0.002, 3.5e-4, 4.5e-4, 0.02];
/// What differences begin with, in standard deviations expected: from afar drives that are far off do not lead.
const START: f64 = 10.0;
/// Rounds at most, and the change of the variances at which they end.
pub(super) const ROUNDS: usize = 60;
const SETTLED: f64 = 1e-3;
/// Most that a variance changes by in a round.
const MOST: f64 = 10.0;
/// Student-t weights over those that tell as much as the drives do if their errors are normal: the estimate's efficiency, 0.9259, over the
/// weights' mean, 1.0534.
const NORMAL_WEIGHT: f64 = 0.878_9;
/// One over the mean square of a normal error times its Student-t weight.
const NORMAL_SQUARE: f64 = 1.497_5;

/// The vehicle's equations.
#[derive(Debug)]
pub(super) struct Vehicle {
    pub(super) layout: Layout,
    pub(super) drives: Vec<Drive>,
    /// Prior information on the vehicle's unknowns, and its right-hand side about the reference.
    pub(super) prior: Vec<f64>,
    pub(super) prior_right: Vec<f64>,
    /// Variance that is expected of what a drive's angles are off by.
    pub(super) expected_drive: f64,
}

/// A solution with all that belongs to it, in the unknowns of the equations.
#[derive(Debug)]
pub(super) struct Outcome {
    pub(super) solution: Solution,
    pub(super) effects: Effects,
    /// How each drive lies about the solution.
    pub(super) about: Vec<About>,
    /// Whether the rounds ended before [`ROUNDS`].
    pub(super) converged: bool,
}

/// What the sum over drives says of a variance: the slope of the log-likelihood, its two parts, and its expected curvature.
#[derive(Debug, Clone, Copy, Default)]
struct Scatter {
    squares: f64,
    expected: f64,
    curvature: f64,
}

impl Scatter {
    fn add(&mut self, square: f64, expected: f64) {
        let expected = expected.max(0.0);
        self.squares += square;
        self.expected += expected;
        self.curvature += expected * expected;
    }

    /// The variance after a step of Fisher scoring (restricted likelihood; Patterson and Thompson 1971), with the prior.
    fn step(&self, variance: f64, prior: f64) -> f64 {
        let known = PRIOR_DRIVES / (variance * variance);
        let slope = known * (prior - variance) + self.squares - self.expected;
        let stepped = variance + slope / (known + self.curvature);
        stepped.clamp(variance / MOST, variance * MOST)
    }
}

impl Vehicle {
    /// What drives differ by before they tell.
    pub(super) fn start(&self) -> Effects {
        let radars = self.layout.radar.iter().max().map_or(0, |radar| radar + 1);
        let far = START * START;
        Effects {
            angle: vec![far * self.expected_drive; radars],
            car: EXPECTED.map(|sigma| far * sigma * sigma),
        }
    }

    /// The solution with these differences and the drives' weights as they are.
    pub(super) fn solve(&self, effects: &Effects) -> Result<Solution, MountingError> {
        let size = self.layout.size();
        let mut right = self.prior_right.clone();
        let mut total = vec![0.0; size * size];
        for (i, known) in self.prior.iter().enumerate() {
            total[i * size + i] = *known;
        }
        for index in 0..self.drives.len() {
            self.eliminated(index, effects)?.add_to(&mut total, &mut right);
        }
        let (mut factor, mut covariance) = (vec![0.0; size * size], vec![0.0; size * size]);
        let solved = invert(&total, size, &mut factor, &mut covariance);
        let row = |i: usize| &covariance[i * size..(i + 1) * size];
        let x: Vec<f64> =
            (0..size).map(|i| row(i).iter().zip(&right).map(|(c, y)| c * y).sum()).collect();
        if !solved || x.iter().chain(&covariance).any(|number| !number.is_finite()) {
            let least = (0..size).map(|i| total[i * size + i]).fold(f64::INFINITY, f64::min);
            return Err(InputError::OutOfRange {
                what: "information of all drives together".into(),
                expected: "a matrix that can be inverted".into(),
                given: least,
            }
            .into());
        }
        Ok(Solution { x, covariance })
    }

    /// Solves for the vehicle and what drives differ by in turns, until neither changes.
    pub(super) fn settle(&mut self) -> Result<Outcome, MountingError> {
        let mut effects = self.start();
        let mut converged = false;
        for _ in 0..ROUNDS {
            let solution = self.solve(&effects)?;
            let next = self.weigh(&solution, &effects)?;
            let before = effects.angle.iter().chain(&effects.car);
            let after = next.angle.iter().chain(&next.car);
            converged = before.zip(after).all(|(a, b)| (a - b).abs() <= SETTLED * a);
            effects = next;
            if converged {
                break;
            }
        }
        let solution = self.solve(&effects)?;
        let about = self.about(&solution, &effects)?;
        Ok(Outcome { solution, effects, about, converged })
    }

    /// How each drive lies about a solution.
    pub(super) fn about(
        &self,
        solution: &Solution,
        effects: &Effects,
    ) -> Result<Vec<About>, MountingError> {
        let each = |index| Ok(self.eliminated(index, effects)?.about(solution));
        (0..self.drives.len()).map(each).collect()
    }

    /// Sets the drives' weights by their residuals, and returns the differences that their scatter speaks for.
    fn weigh(&mut self, solution: &Solution, effects: &Effects) -> Result<Effects, MountingError> {
        let mut angle = vec![Scatter::default(); effects.angle.len()];
        let mut car = [Scatter::default(); CAR];
        for index in 0..self.drives.len() {
            let about = self.eliminated(index, effects)?.about(solution);
            let parts = &mut self.drives[index].parts;
            for (part, told) in parts.iter_mut().zip(&about.parts).filter(|(p, _)| p.tells()) {
                let Residual { residual, variance, fitted, .. } = *told;
                let square = residual * residual;
                let weight = student((square + fitted) / variance);
                part.weight = NORMAL_WEIGHT * weight;
                let scaled = NORMAL_SQUARE * weight * weight * square / (variance * variance);
                let expected = (1.0 - fitted / variance) / variance;
                angle[self.layout.radar[part.angle]].add(scaled, expected);
            }
            for (i, scatter) in car.iter_mut().enumerate() {
                let variance = effects.car[i];
                let (deviation, rest) = (about.deviation[i], about.deviation_variance[i]);
                let square = (deviation / variance).powi(2);
                scatter.add(square, (1.0 - rest / variance) / variance);
            }
        }
        let stepped =
            |(scatter, variance): (&Scatter, &f64)| scatter.step(*variance, self.expected_drive);
        Ok(Effects {
            angle: angle.iter().zip(&effects.angle).map(stepped).collect(),
            car: std::array::from_fn(|i| {
                if self.layout.shared[i] {
                    car[i].step(effects.car[i], EXPECTED[i] * EXPECTED[i])
                } else {
                    effects.car[i]
                }
            }),
        })
    }

    fn eliminated<'a>(
        &'a self,
        index: usize,
        effects: &Effects,
    ) -> Result<Eliminated<'a>, MountingError> {
        Eliminated::new(&self.drives[index], &self.layout, effects).ok_or_else(|| unsound(index))
    }
}

/// Equations that are not those of any observations.
pub(super) fn unsound(drive: usize) -> MountingError {
    MountingError::UnsoundEquations {
        drive,
        expected: "those of observations: finite, with a matrix that is positive semidefinite",
        given: "others",
    }
}
