//! What all frames so far say of the unknowns they share, in constant memory.

use crate::small::{inverse, times};

/// Unknowns: mounting angle (rad), inverse scale, bias times inverse scale (rad/s), slip gradient
/// (rad per m/s^2), delay of the radar (s).
pub(crate) const UNKNOWNS: usize = 5;
const MOMENTS: usize = UNKNOWNS + UNKNOWNS * (UNKNOWNS + 1) / 2;
/// Blocks that the assumption of independent frames is worth in the covariance.
const PRIOR_BLOCKS: f64 = 3.0;

pub(crate) type Vector = [f64; UNKNOWNS];
pub(crate) type Matrix = [[f64; UNKNOWNS]; UNKNOWNS];

/// Normal equations `n x = y` of a prior and of all frames, with the moments of blocks of frames that
/// a covariance robust against correlation between neighbouring frames needs.
///
/// The score of a block at the solution, `y_b - n_b x`, is linear in the block's own sums, so the sum
/// over blocks of its outer product (the middle of the sandwich of Huber 1967 and, for clusters, of
/// Liang and Zeger 1986) follows from the second moments of those sums, whatever `x` turns out to be.
#[derive(Debug, Clone)]
pub(crate) struct Information {
    prior_mean: Vector,
    prior: Vector,
    n: Matrix,
    y: Vector,
    block_n: Matrix,
    block_y: Vector,
    block_frames: usize,
    moments: [[f64; MOMENTS]; MOMENTS],
    blocks: f64,
    x: Vector,
    formal: Matrix,
}

impl Information {
    /// From a prior's means and standard deviations.
    pub(crate) fn new(prior_mean: Vector, prior_sigma: Vector) -> Self {
        let prior = prior_sigma.map(|sigma| 1.0 / (sigma * sigma));
        let mut result = Self {
            prior_mean,
            prior,
            n: [[0.0; UNKNOWNS]; UNKNOWNS],
            y: [0.0; UNKNOWNS],
            block_n: [[0.0; UNKNOWNS]; UNKNOWNS],
            block_y: [0.0; UNKNOWNS],
            block_frames: 0,
            moments: [[0.0; MOMENTS]; MOMENTS],
            blocks: 0.0,
            x: prior_mean,
            formal: [[0.0; UNKNOWNS]; UNKNOWNS],
        };
        for i in 0..UNKNOWNS {
            result.formal[i][i] = prior_sigma[i] * prior_sigma[i];
        }
        result
    }

    /// The estimate.
    pub(crate) fn mean(&self) -> Vector {
        self.x
    }

    /// Covariance of the estimate if frames are independent.
    pub(crate) fn formal(&self) -> &Matrix {
        &self.formal
    }

    /// Adds a frame: its information matrix and score at the present estimate.
    pub(crate) fn add_frame(&mut self, n: &Matrix, score: &Vector) {
        let shifted = times(n, &std::array::from_fn(|i| self.x[i] - self.prior_mean[i]));
        for i in 0..UNKNOWNS {
            self.block_y[i] += score[i] + shifted[i];
            self.y[i] += score[i] + shifted[i];
            for j in 0..UNKNOWNS {
                self.block_n[i][j] += n[i][j];
                self.n[i][j] += n[i][j];
            }
        }
        self.block_frames += 1;
        self.solve();
    }

    /// Sets what is known of the bias from standstill, in the place of its prior.
    pub(crate) fn set_bias(&mut self, mean: f64, sigma: f64) {
        let shift = mean - self.prior_mean[2];
        for i in 0..UNKNOWNS {
            self.y[i] -= self.n[i][2] * shift;
            self.block_y[i] -= self.block_n[i][2] * shift;
        }
        // Past blocks: z = (y, n) becomes (y - n e_2 shift, n), a linear map of their moments.
        for i in 0..UNKNOWNS {
            let from = packed(i, 2);
            for j in 0..MOMENTS {
                self.moments[i][j] -= shift * self.moments[from][j];
            }
        }
        for i in 0..UNKNOWNS {
            let from = packed(i, 2);
            for row in &mut self.moments {
                row[i] -= shift * row[from];
            }
        }
        self.prior_mean[2] = mean;
        self.prior[2] = 1.0 / (sigma * sigma);
        self.solve();
    }

    /// Begins anew at another angle, keeping what is known of the bias; no frame may have been added.
    pub(crate) fn restart(&mut self, angle_rad: f64, sigma_rad: f64) {
        self.prior_mean[0] = angle_rad;
        self.prior[0] = 1.0 / (sigma_rad * sigma_rad);
        self.solve();
    }

    /// Closes the block of frames that are taken as correlated.
    pub(crate) fn end_block(&mut self) {
        if self.block_frames == 0 {
            return;
        }
        let z = moments_of(&self.block_y, &self.block_n);
        crate::small::add_outer(&mut self.moments, &z, 1.0);
        self.blocks += 1.0;
        self.block_n = [[0.0; UNKNOWNS]; UNKNOWNS];
        self.block_y = [0.0; UNKNOWNS];
        self.block_frames = 0;
    }

    fn solve(&mut self) {
        let mut a = self.n;
        for i in 0..UNKNOWNS {
            a[i][i] += self.prior[i];
        }
        if let Some(formal) = inverse(&a) {
            let step = times(&formal, &self.y);
            self.x = std::array::from_fn(|i| self.prior_mean[i] + step[i]);
            self.formal = formal;
        }
    }

    /// Covariance of the estimate that holds where frames of one block are correlated: a sandwich of
    /// the blocks' scores.
    pub(crate) fn covariance(&self) -> Matrix {
        let mut middle = self.middle(&self.x);
        for i in 0..UNKNOWNS {
            middle[i][i] += self.prior[i];
        }
        let half: Matrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..UNKNOWNS).map(|k| self.formal[i][k] * middle[k][j]).sum())
        });
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..UNKNOWNS).map(|k| half[i][k] * self.formal[k][j]).sum())
        })
    }

    /// Covariance of the frames' score at `x`: that of the blocks, averaged with the information of
    /// independent frames, which counts as three blocks, so that a short drive has a covariance too.
    pub(crate) fn middle(&self, x: &Vector) -> Matrix {
        let mut blocks = self.blocks;
        let mut moments = self.moments;
        if self.block_frames > 0 {
            let z = moments_of(&self.block_y, &self.block_n);
            crate::small::add_outer(&mut moments, &z, 1.0);
            blocks += 1.0;
        }
        let dx: Vector = std::array::from_fn(|i| x[i] - self.prior_mean[i]);
        // Row i of t maps a block's sums to entry i of its score.
        let mut t = [[0.0; MOMENTS]; UNKNOWNS];
        for i in 0..UNKNOWNS {
            t[i][i] = 1.0;
            for j in 0..UNKNOWNS {
                t[i][packed(i, j)] -= dx[j];
            }
        }
        let tm: [[f64; MOMENTS]; UNKNOWNS] = std::array::from_fn(|i| {
            std::array::from_fn(|k| (0..MOMENTS).map(|j| t[i][j] * moments[j][k]).sum())
        });
        // Each unknown that the frames rather than the prior decide takes a degree of freedom.
        let decided: f64 = (0..UNKNOWNS).map(|i| 1.0 - self.formal[i][i] * self.prior[i]).sum();
        let correction = blocks / (blocks - decided).max(1.0);
        let share = blocks / (blocks + PRIOR_BLOCKS);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let scores: f64 = (0..MOMENTS).map(|k| tm[i][k] * t[j][k]).sum();
                share * correction * scores + (1.0 - share) * self.n[i][j]
            })
        })
    }

    /// The frames' information and their score at `x`, without the prior.
    pub(crate) fn score(&self, x: &Vector) -> (Matrix, Vector) {
        let shifted = times(&self.n, &std::array::from_fn(|i| x[i] - self.prior_mean[i]));
        (self.n, std::array::from_fn(|i| self.y[i] - shifted[i]))
    }

    /// Means and inverse variances of the prior.
    pub(crate) fn prior(&self) -> (Vector, Vector) {
        (self.prior_mean, self.prior)
    }
}

/// Place of entry `(i, j)` of a symmetric matrix among the moments.
fn packed(i: usize, j: usize) -> usize {
    let (low, high) = if i < j { (i, j) } else { (j, i) };
    UNKNOWNS + high * (high + 1) / 2 + low
}

fn moments_of(y: &Vector, n: &Matrix) -> [f64; MOMENTS] {
    let mut z = [0.0; MOMENTS];
    z[..UNKNOWNS].copy_from_slice(y);
    for i in 0..UNKNOWNS {
        for j in 0..=i {
            z[packed(i, j)] = n[i][j];
        }
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Random;

    const SIGMA: Vector = [10.0; UNKNOWNS];

    fn frame(random: &mut Random, truth: &Vector, at: &Vector, noise: f64) -> (Matrix, Vector) {
        let row: Vector = std::array::from_fn(|_| random.normal());
        let residual = (0..UNKNOWNS).map(|i| row[i] * (truth[i] - at[i])).sum::<f64>() + noise;
        let mut n = [[0.0; UNKNOWNS]; UNKNOWNS];
        crate::small::add_outer(&mut n, &row, 1.0);
        (n, row.map(|r| r * residual))
    }

    #[test]
    fn noise_free_frames_give_the_truth_wherever_they_are_linearised() {
        let truth = [0.3, 1.1, -0.2, 0.05, 0.4];
        let mut information = Information::new([0.0, 1.0, 0.0, 0.0, 0.0], [1e6; UNKNOWNS]);
        let mut random = Random::new(1, 0);
        for _ in 0..50 {
            let (n, score) = frame(&mut random, &truth, &information.mean(), 0.0);
            information.add_frame(&n, &score);
        }
        for i in 0..UNKNOWNS {
            assert!((information.mean()[i] - truth[i]).abs() < 1e-9);
        }
    }

    #[test]
    fn the_sandwich_sees_correlation_that_the_formal_covariance_does_not() {
        // Frames of a block share their noise: the variance is that of one frame a block.
        let (mut squares, mut formal, mut robust) = (0.0, 0.0, 0.0);
        let trials = 300;
        for trial in 0..trials {
            let mut random = Random::new(2, trial);
            let mut information = Information::new([0.0; UNKNOWNS], SIGMA);
            for _ in 0..40 {
                let noise = random.normal();
                for _ in 0..10 {
                    let mut n = [[0.0; UNKNOWNS]; UNKNOWNS];
                    n[0][0] = 1.0;
                    let mut score = [0.0; UNKNOWNS];
                    score[0] = noise - information.mean()[0];
                    information.add_frame(&n, &score);
                }
                information.end_block();
            }
            squares += information.mean()[0].powi(2);
            formal += information.formal()[0][0];
            robust += information.covariance()[0][0];
        }
        // A variance from 300 trials is good to 8 % (one standard error); the three extra blocks of
        // the shrinkage take 6 % off.
        assert!(squares / formal > 7.0, "{}", squares / formal);
        assert!((squares / robust - 1.0).abs() < 0.3, "{}", squares / robust);
    }

    #[test]
    fn a_bias_that_becomes_known_later_leaves_the_scores_consistent() {
        let build = |early: bool| {
            let mut random = Random::new(3, 0);
            let mut information = Information::new([0.0; UNKNOWNS], SIGMA);
            if early {
                information.set_bias(0.2, 0.1);
            }
            for index in 0..60 {
                let (n, score) = frame(
                    &mut random,
                    &[0.1, 0.2, 0.3, 0.4, 0.5],
                    &[0.0; UNKNOWNS],
                    0.01 * f64::from(index % 7),
                );
                // The frame is linear: move its score from the origin to the present estimate.
                let moved = times(&n, &information.mean());
                information.add_frame(&n, &std::array::from_fn(|i| score[i] - moved[i]));
                if index % 10 == 9 {
                    information.end_block();
                }
            }
            if !early {
                information.set_bias(0.2, 0.1);
            }
            information
        };
        let (early, late) = (build(true), build(false));
        for i in 0..UNKNOWNS {
            assert!((early.mean()[i] - late.mean()[i]).abs() < 1e-10);
            for j in 0..UNKNOWNS {
                assert!((early.covariance()[i][j] - late.covariance()[i][j]).abs() < 1e-10);
            }
        }
    }
}
