//! What all blocks of frames so far say of the unknowns they share, in constant memory.
//!
//! Errors of real drives last for seconds, so that a frame more is not an observation more. All frames of a block therefore
//! share an error of the angle, which is eliminated from the block's equations. How large that error is, and how much of it
//! lasts from block to block, is learnt from the scatter of the blocks about the solution, beginning with what real drives have.

use super::block::{Sum, student};
use boresight_math::linalg::small::{add_outer, inverse, times};
use serde::{Deserialize, Serialize};

/// Unknowns: mounting angle (rad), inverse scale, bias times inverse scale (rad/s), slip gradient
/// (rad per m/s^2), delay of the radar (s).
pub(crate) const UNKNOWNS: usize = 5;
/// Place of the delay among them.
pub(crate) const DELAY: usize = 4;
/// The error that a block's frames share is never taken as less than a twentieth of that expected.
const LEAST_LASTING: f64 = 0.05;
/// Blocks that this prior knowledge counts as.
pub(crate) const PRIOR_BLOCKS: f64 = 2.0;
/// Correlation of neighbouring blocks beyond which they are not believed to be: it would be a drift.
pub(crate) const MAX_CORRELATION: f64 = 0.8;

pub(crate) type Vector = [f64; UNKNOWNS];
pub(crate) type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];
/// A block's residual as a linear function of the unknowns: constant and slopes.
type Residual = [f64; UNKNOWNS + 1];
type Moments = [[f64; UNKNOWNS + 1]; UNKNOWNS + 1];

/// Normal equations `n (x - reference) = y` of all blocks, with a prior, and second moments of the blocks' residuals, from which
/// their scatter about any solution follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Information {
    reference: Vector,
    prior_mean: Vector,
    /// Inverse variances.
    prior: Vector,
    n: Matrix,
    y: Vector,
    /// Of residuals, of residuals over their expected deviation, and of the latter with those of the block before.
    plain: Moments,
    scaled: Moments,
    lagged: Moments,
    last: Residual,
    blocks: f64,
    /// Sum of the blocks' own variances, rad^2.
    own: f64,
    /// Variance of the error that a block's frames share before anything is known of it, rad^2.
    expected_lasting: f64,
    design_effect: f64,
    x: Vector,
    covariance: Matrix,
}

impl Information {
    /// From a prior's means and standard deviations, and that of the error which a block's frames share, rad.
    pub(crate) fn new(prior_mean: Vector, prior_sigma: Vector, lasting_rad: f64) -> Self {
        let zero = [[0.0; UNKNOWNS + 1]; UNKNOWNS + 1];
        let mut result = Self {
            reference: prior_mean,
            prior_mean,
            prior: prior_sigma.map(|sigma| 1.0 / (sigma * sigma)),
            n: [[0.0; UNKNOWNS]; UNKNOWNS],
            y: [0.0; UNKNOWNS],
            plain: zero,
            scaled: zero,
            lagged: zero,
            last: [0.0; UNKNOWNS + 1],
            blocks: 0.0,
            own: 0.0,
            expected_lasting: lasting_rad * lasting_rad,
            design_effect: 1.0,
            x: prior_mean,
            covariance: [[0.0; UNKNOWNS]; UNKNOWNS],
        };
        result.solve();
        result
    }

    /// The estimate.
    pub(crate) fn mean(&self) -> Vector {
        self.x
    }

    /// Its covariance.
    pub(crate) fn covariance(&self) -> &Matrix {
        &self.covariance
    }

    /// What blocks' equations are written about: their observations are of the unknowns less these.
    pub(crate) fn reference(&self) -> &Vector {
        &self.reference
    }

    /// Means and inverse variances of the prior.
    pub(crate) fn prior(&self) -> (&Vector, &Vector) {
        (&self.prior_mean, &self.prior)
    }

    /// Blocks added and not forgotten.
    pub(crate) fn blocks(&self) -> f64 {
        self.blocks
    }

    /// Variance of the error that a block's frames share, rad^2.
    pub(crate) fn lasting(&self) -> f64 {
        let prior = self.expected_lasting;
        let learnt = PRIOR_BLOCKS * prior + self.scatter(&self.plain) - self.own;
        let freedom = PRIOR_BLOCKS + (self.blocks - self.decided()).max(0.0);
        (learnt / freedom).max(LEAST_LASTING * LEAST_LASTING * prior)
    }

    /// How many blocks count as one that is independent of the others.
    pub(crate) fn design_effect(&self) -> f64 {
        self.design_effect
    }

    fn learn_design_effect(&mut self) {
        let squares = self.scatter(&self.scaled);
        let correlation =
            (self.scatter(&self.lagged) / (squares + PRIOR_BLOCKS)).clamp(0.0, MAX_CORRELATION);
        let freedom = PRIOR_BLOCKS + (self.blocks - self.decided()).max(0.0);
        // What is told within blocks, scale, slip and delay, is no better known where blocks agree more closely than expected.
        self.design_effect = ((PRIOR_BLOCKS + squares) / freedom * (1.0 + correlation)
            / (1.0 - correlation))
            .max(1.0);
    }

    /// Whether its numbers are such as blocks lead to.
    pub(crate) fn is_sound(&self) -> bool {
        let finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        finite(self.x.as_slice())
            && finite(self.reference.as_slice())
            && finite(self.prior_mean.as_slice())
            && self.prior.iter().all(|weight| *weight > 0.0 && weight.is_finite())
            && self.design_effect > 0.0
            && self.expected_lasting > 0.0
            && (0..UNKNOWNS).all(|i| self.covariance[i][i] > 0.0 && finite(&self.covariance[i]))
            && finite(self.n.as_flattened())
            && finite(self.y.as_slice())
    }

    /// Adds a block.
    pub(crate) fn add(&mut self, block: &Sum) {
        let lasting = self.lasting();
        self.gather(block, lasting);
        let residual = block.residual();
        // A block of few frames says little of the scatter: it counts as that share of one.
        let own = block.own_variance();
        let share = lasting / (lasting + own);
        add_outer(&mut self.plain, &residual, share);
        self.own += share * own;
        let deviation = (lasting + own).sqrt();
        let scaled = residual.map(|entry| entry * share.sqrt() / deviation);
        add_outer(&mut self.scaled, &scaled, 1.0);
        for i in 0..=UNKNOWNS {
            for j in 0..=UNKNOWNS {
                self.lagged[i][j] += 0.5 * (scaled[i] * self.last[j] + self.last[i] * scaled[j]);
            }
        }
        self.last = scaled;
        self.blocks += share;
        self.solve();
        self.learn_design_effect();
        self.solve();
    }

    /// Adds a block's equations, with a weight that falls where it lies far off all before.
    fn gather(&mut self, block: &Sum, lasting: f64) {
        let x: Vector = std::array::from_fn(|i| self.x[i] - self.reference[i]);
        let variance = lasting + block.own_variance() + self.covariance[0][0];
        let weight = student(block.residual_at(&x).powi(2) / variance);
        let (n, y) = block.with_lasting(lasting);
        for i in 0..UNKNOWNS {
            self.y[i] += weight * y[i];
            for j in 0..UNKNOWNS {
                self.n[i][j] += weight * n[i][j];
            }
        }
    }

    /// The same with a block that is not complete yet.
    pub(crate) fn with(&self, block: &Sum) -> Self {
        let mut result = *self;
        if block.frames() > 0 {
            result.gather(block, self.lasting());
            result.solve();
        }
        result
    }

    /// Expects a block that agrees with all that is known: what it adds to the covariance, nothing to the estimate or the scatter.
    pub(crate) fn expect(&mut self, block: &Sum) {
        let (n, _) = block.with_lasting(self.lasting());
        let x: Vector = std::array::from_fn(|i| self.x[i] - self.reference[i]);
        let y = times(&n, &x);
        for i in 0..UNKNOWNS {
            self.y[i] += y[i];
            for j in 0..UNKNOWNS {
                self.n[i][j] += n[i][j];
            }
        }
        self.solve();
    }

    /// Lets all blocks so far count for a share of what they did.
    pub(crate) fn forget(&mut self, share: f64) {
        let scale = |moments: &mut Moments| {
            for entry in moments.iter_mut().flatten() {
                *entry *= share;
            }
        };
        scale(&mut self.plain);
        scale(&mut self.scaled);
        scale(&mut self.lagged);
        for i in 0..UNKNOWNS {
            self.y[i] *= share;
            for j in 0..UNKNOWNS {
                self.n[i][j] *= share;
            }
        }
        self.blocks *= share;
        self.own *= share;
    }

    /// Begins anew with the angle, which has changed, and keeps what is known of the other unknowns and of the scatter.
    pub(crate) fn reset_angle(&mut self, angle_rad: f64, sigma_rad: f64) {
        let (lasting, known) = (self.lasting(), self.covariance);
        let mut prior_mean = self.x;
        prior_mean[0] = angle_rad;
        let mut sigma: Vector = std::array::from_fn(|i| known[i][i].sqrt());
        sigma[0] = sigma_rad;
        let reference = self.reference;
        *self = Self::new(prior_mean, sigma, self.expected_lasting.sqrt());
        self.reference = reference;
        // What was learnt of the scatter, as that many blocks.
        self.plain[0][0] = PRIOR_BLOCKS * lasting;
        self.blocks = PRIOR_BLOCKS;
        self.scaled[0][0] = PRIOR_BLOCKS;
    }

    /// Forgets what is known of an unknown, which has another value from now on, and gives it a prior. What is known of the others
    /// stays: the unknown is eliminated from the equations.
    pub(crate) fn release(&mut self, at: usize, mean: f64, sigma: f64) {
        let temper = self.design_effect;
        let pivot = self.n[at][at] + temper * self.prior[at];
        let row = self.n[at];
        let right =
            self.y[at] + temper * self.prior[at] * (self.prior_mean[at] - self.reference[at]);
        for i in 0..UNKNOWNS {
            self.y[i] -= row[i] * right / pivot;
            for j in 0..UNKNOWNS {
                self.n[i][j] -= row[i] * row[j] / pivot;
            }
        }
        self.y[at] = 0.0;
        for i in 0..UNKNOWNS {
            (self.n[at][i], self.n[i][at]) = (0.0, 0.0);
        }
        // Residuals of the blocks so far are those at the value that the unknown had.
        let had = self.reference[at] - self.x[at];
        for moments in [&mut self.plain, &mut self.scaled, &mut self.lagged] {
            for i in 0..=UNKNOWNS {
                moments[0][i] += had * moments[at + 1][i];
            }
            for row in moments.iter_mut() {
                row[0] += had * row[at + 1];
                row[at + 1] = 0.0;
            }
            moments[at + 1] = [0.0; UNKNOWNS + 1];
        }
        self.last = [0.0; UNKNOWNS + 1];
        (self.prior_mean[at], self.prior[at]) = (mean, 1.0 / (sigma * sigma));
        self.solve();
    }

    /// Sets what is known of the bias from standstill, in the place of its prior.
    pub(crate) fn set_bias(&mut self, mean: f64, sigma: f64) {
        self.prior_mean[2] = mean;
        self.prior[2] = 1.0 / (sigma * sigma);
        self.solve();
    }

    /// Takes over what another has learnt of the bias from standstill.
    pub(crate) fn take_bias(&mut self, other: &Self) {
        self.prior_mean[2] = other.prior_mean[2];
        self.prior[2] = other.prior[2];
        self.solve();
    }

    /// The blocks' information about the reference, tempered, without the prior.
    pub(crate) fn tempered(&self) -> (Matrix, Vector) {
        let share = 1.0 / self.design_effect;
        (self.n.map(|row| row.map(|entry| share * entry)), self.y.map(|entry| share * entry))
    }

    fn solve(&mut self) {
        let (mut a, mut right) = self.tempered();
        for i in 0..UNKNOWNS {
            a[i][i] += self.prior[i];
            right[i] += self.prior[i] * (self.prior_mean[i] - self.reference[i]);
        }
        if let Some(covariance) = inverse(&a) {
            let step = times(&covariance, &right);
            self.x = std::array::from_fn(|i| self.reference[i] + step[i]);
            self.covariance = covariance;
        }
    }

    /// Unknowns that the blocks rather than the prior decide.
    fn decided(&self) -> f64 {
        (0..UNKNOWNS).map(|i| 1.0 - self.covariance[i][i] * self.prior[i]).sum::<f64>().max(0.0)
    }

    /// Sum of squares of residuals at the estimate, by their moments.
    fn scatter(&self, moments: &Moments) -> f64 {
        let t: Residual = std::array::from_fn(|i| match i {
            0 => 1.0,
            i => self.reference[i - 1] - self.x[i - 1],
        });
        let half = times(moments, &t);
        (0..=UNKNOWNS).map(|i| t[i] * half[i]).sum()
    }
}
