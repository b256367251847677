//! Some seconds of frames, whose errors are taken as correlated.

use super::information::{Matrix, UNKNOWNS, Vector};
use boresight_math::linalg::small::add_outer;
use serde::{Deserialize, Serialize};

/// A block lasts as long at least, s, and goes as far, m: what errs is in the scene, and a slow car has the same one before it for longer.
const BLOCK_S: f64 = 5.0;
const BLOCK_M: f64 = 50.0;
/// Frames further apart say nothing of the way between them, s.
const GAP_S: f64 = 1.0;
/// A block ends early with this many frames: memory is bounded whatever the rate.
const MAX_FRAMES: usize = 512;
/// Degrees of freedom of the frames' Student-t weights.
const FREEDOM: f64 = 4.0;
const ROUNDS: usize = 8;
/// Residuals count up to so many deviations where their correlation is judged.
const BOUND: f64 = 3.0;
/// Variance of frames beyond their own where it is not learnt, rad^2 (0.2 deg).
const SCATTER: f64 = 1.2e-5;
/// Frames that count as one observation where no block's error is told from them.
const CORRELATED: f64 = 10.0;
/// Frames, of something more than a second, whose mean tells how far neighbours err alike.
const NEIGHBOURS: usize = 16;

/// One frame's equation `value = row . (x - reference) + noise`, where the row's first entry is 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    pub(crate) row: Vector,
    pub(crate) value: f64,
    /// Variance by the frame's own account, rad^2.
    pub(crate) variance: f64,
    /// What the yaw rate turns the radar's motion by, with scale 1 and the slip expected, rad, and the angle less its reference that the frame
    /// then has, rad.
    pub(crate) turn: f64,
    pub(crate) angle: f64,
}

/// How far a block has come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Extent {
    start_s: f64,
    last_s: f64,
    driven_s: f64,
    way_m: f64,
    frames: usize,
}

impl Extent {
    /// The time driven in this block, s, where a frame at a time, s, begins another; otherwise the frame is in this one. A block is bounded in
    /// frames, whatever their rate.
    pub(crate) fn ends_before(&mut self, time_s: f64, speed_mps: f64) -> Option<f64> {
        let full = self.frames > 0
            && ((time_s - self.start_s >= BLOCK_S && self.way_m >= BLOCK_M)
                || self.frames >= MAX_FRAMES);
        let ended = full.then_some(self.driven_s);
        if full || self.frames == 0 {
            *self = Self { start_s: time_s, last_s: time_s, ..Self::default() };
        }
        let step_s = time_s - self.last_s;
        if step_s <= GAP_S {
            self.driven_s += step_s;
            self.way_m += speed_mps.abs() * step_s;
        }
        self.last_s = time_s;
        self.frames += 1;
        ended
    }
}

/// Frames of the block that is not complete yet.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Block {
    extent: Extent,
    rows: Vec<Row>,
}

/// What a block comes to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sum {
    n: Matrix,
    y: Vector,
    frames: usize,
    /// Mean square of the residuals beyond the frames' own variances, rad^2.
    pub(crate) excess: f64,
    /// How many frames count as one that is independent of the others, by the scatter of means over [`NEIGHBOURS`] frames; `None` where the
    /// block is too short to tell.
    pub(crate) correlated: Option<f64>,
}

/// How frames of a block scatter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Scatter {
    /// Variance beyond their own, rad^2.
    pub(crate) excess: f64,
    /// How many frames count as one; less than one by chance, where frames are independent, counts as one.
    pub(crate) correlated: f64,
}

impl Block {
    /// The time driven in it, s, where a frame at a time, s, begins another block, for which [`Self::clear`] makes room.
    pub(crate) fn ends_before(&mut self, time_s: f64, speed_mps: f64) -> Option<f64> {
        self.extent.ends_before(time_s, speed_mps)
    }

    /// Whether a block could have become so.
    pub(crate) fn is_sound(&self) -> bool {
        self.rows.len() <= MAX_FRAMES
            && self.rows.iter().all(|row| row.variance > 0.0 && row.value.is_finite())
    }

    pub(crate) fn add(&mut self, row: Row) {
        self.rows.push(row);
    }

    pub(crate) fn clear(&mut self) {
        self.rows.clear();
    }

    /// Sums of the frames with Student-t weights (Lange, Little and Taylor 1989) about the angle that they agree on by themselves, so
    /// that an angle that has changed is seen. `x` has the other unknowns less their reference.
    pub(crate) fn sum(&self, x: &Vector, Scatter { excess, correlated }: Scatter) -> Sum {
        let correlated = correlated.max(1.0);
        let residual =
            |row: &Row| row.value - (1..UNKNOWNS).map(|i| row.row[i] * x[i]).sum::<f64>();
        let mut level = median(self.rows.iter().map(residual).collect());
        for _ in 0..ROUNDS {
            let (mut sum, mut total) = (0.0, 0.0);
            for row in &self.rows {
                let variance = row.variance + excess;
                let residual = residual(row);
                let weight = student((residual - level).powi(2) / variance) / variance;
                sum += weight * residual;
                total += weight;
            }
            level = if total > 0.0 { sum / total } else { level };
        }
        let mut result = Sum {
            n: [[0.0; UNKNOWNS]; UNKNOWNS],
            y: [0.0; UNKNOWNS],
            frames: self.rows.len(),
            excess: 0.0,
            correlated: self
                .correlation(|row| (residual(row) - level) / (row.variance + excess).sqrt()),
        };
        let mut squares = 0.0;
        for row in &self.rows {
            let variance = row.variance + excess;
            let square = (residual(row) - level).powi(2);
            let student = student(square / variance);
            let weight = student / (variance * correlated);
            add_outer(&mut result.n, &row.row, weight);
            for i in 0..UNKNOWNS {
                result.y[i] += weight * row.row[i] * row.value;
            }
            squares += student * square - row.variance;
        }
        result.excess = squares / (self.rows.len() as f64 - 1.0).max(1.0);
        result
    }

    /// How much more means over neighbouring frames scatter than if frames were independent, of residuals about the block's level in units of
    /// their deviations.
    fn correlation(&self, residual: impl Fn(&Row) -> f64) -> Option<f64> {
        let groups = self.rows.len() / NEIGHBOURS;
        if groups < 3 {
            return None;
        }
        let (mut of_means, mut of_frames) = (0.0, 0.0);
        for group in self.rows.chunks_exact(NEIGHBOURS) {
            let bounded = |row: &Row| residual(row).clamp(-BOUND, BOUND);
            of_means += group.iter().map(bounded).sum::<f64>().powi(2);
            of_frames += group.iter().map(|row| bounded(row).powi(2)).sum::<f64>();
        }
        // About the mean of the block, means over a share of it scatter by that share less.
        let left = 1.0 - 1.0 / groups as f64;
        (of_frames > 0.0).then(|| (of_means / (left * of_frames)).min(NEIGHBOURS as f64))
    }
}

/// Regression, within blocks, of the frames' angles on what the yaw rate does to them: the inverse scale by the frames alone, whatever
/// it and the angle are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct FreeScale {
    /// Sums of squares of one, of products of both and of squares of the other, about the means of blocks.
    xx: f64,
    xy: f64,
    yy: f64,
    freedom: f64,
}

impl std::ops::AddAssign for FreeScale {
    fn add_assign(&mut self, other: Self) {
        self.xx += other.xx;
        self.xy += other.xy;
        self.yy += other.yy;
        self.freedom += other.freedom;
    }
}

impl FreeScale {
    /// Adds a block.
    pub(crate) fn add(&mut self, block: &Block) {
        let points =
            block.rows.iter().map(|row| (row.turn, row.angle, 1.0 / (row.variance + SCATTER)));
        let (mut total, mut means) = (0.0, [0.0; 2]);
        for (x, y, weight) in points.clone() {
            total += weight;
            means[0] += weight * x;
            means[1] += weight * y;
        }
        let means = means.map(|mean| mean / total);
        for (x, y, weight) in points {
            let [x, y] = [x - means[0], y - means[1]];
            self.xx += weight * x * x;
            self.xy += weight * x * y;
            self.yy += weight * y * y;
        }
        self.freedom += (block.rows.len() as f64 - 1.0).max(0.0);
    }

    /// Inverse scale and its standard deviation, if so many frames as are correlated count as one.
    pub(crate) fn estimate(&self) -> Option<(f64, f64)> {
        let slope = self.xy / self.xx;
        let rest = (self.yy - slope * self.xy).max(0.0) / (self.freedom / CORRELATED - 1.0);
        let sigma = (rest / self.xx).sqrt();
        (slope.is_finite() && sigma.is_finite() && self.freedom > 2.0 * CORRELATED)
            .then_some((1.0 - slope, sigma))
    }
}

impl Sum {
    pub(crate) fn frames(&self) -> usize {
        self.frames
    }

    pub(crate) fn is_sound(&self) -> bool {
        self.n[0][0] > 0.0
            && self.excess.is_finite()
            && self.correlated.is_none_or(f64::is_finite)
            && self.n.as_flattened().iter().chain(&self.y).all(|number| number.is_finite())
    }

    /// Variance of the block's angle if its frames are independent, rad^2.
    pub(crate) fn own_variance(&self) -> f64 {
        1.0 / self.n[0][0]
    }

    /// Normal equations with the error eliminated that all frames of the block share, of variance `lasting`.
    pub(crate) fn with_lasting(&self, lasting: f64) -> (Matrix, Vector) {
        let share = 1.0 / (self.n[0][0] + 1.0 / lasting);
        let (mut n, mut y) = (self.n, self.y);
        for i in 0..UNKNOWNS {
            y[i] -= share * self.n[i][0] * self.y[0];
            for j in 0..UNKNOWNS {
                n[i][j] -= share * self.n[i][0] * self.n[0][j];
            }
        }
        (n, y)
    }

    /// The block's residual as a function of the unknowns less their reference: constant and slopes, rad.
    pub(crate) fn residual(&self) -> [f64; UNKNOWNS + 1] {
        let scale = 1.0 / self.n[0][0];
        std::array::from_fn(|i| match i {
            0 => scale * self.y[0],
            i => scale * self.n[0][i - 1],
        })
    }

    /// The residual at a state less the reference, rad.
    pub(crate) fn residual_at(&self, x: &Vector) -> f64 {
        let residual = self.residual();
        residual[0] - (0..UNKNOWNS).map(|i| residual[i + 1] * x[i]).sum::<f64>()
    }
}

/// Weight of an observation by its squared residual over its variance.
pub(crate) fn student(normalised: f64) -> f64 {
    (FREEDOM + 1.0) / (FREEDOM + normalised)
}

fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
