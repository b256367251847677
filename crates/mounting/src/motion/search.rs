//! The search of RANSAC (Fischler and Bolles 1981): the velocity that most detections agree with.

use super::{Columns, least_squares};
use boresight_core::Random;

/// Draws are bounded by this whatever share of inliers is asked for.
const MAX_DRAWS: usize = 400;
/// Up to this many detections all pairs are tried instead of drawn (45 pairs).
const ALL_PAIRS: usize = 10;
/// Pairs whose azimuths differ by less than 0.6 deg say nothing of the velocity across.
const MIN_SINE: f32 = 0.01;
/// A hypothesis that is faster than this is none, m/s.
const MAX_SPEED_MPS: f32 = 150.0;
/// Rounds of least squares and selection after the search.
const REFINEMENTS: usize = 6;

/// What the search needs to know.
pub(crate) struct Search {
    /// Residual below which a detection agrees, m/s.
    pub residual_mps: f64,
    /// Probability of drawing two inliers at least once.
    pub confidence: f64,
    /// Smallest share of inliers that is looked for.
    pub min_share: f64,
}

impl Search {
    /// Draws needed so that with the confidence asked for one pair is of inliers, at their share:
    /// `log(1 - p) / log(1 - share^2)`.
    pub fn draws(&self, share: f64) -> usize {
        let miss = (-(share * share)).ln_1p();
        if miss == 0.0 {
            return MAX_DRAWS;
        }
        let needed = (-self.confidence).ln_1p() / miss;
        if needed >= MAX_DRAWS as f64 { MAX_DRAWS } else { (needed.ceil() as usize).max(1) }
    }

    /// Finds the velocity and its inliers; `None` where no two detections make one.
    pub fn run(
        &self,
        columns: &Columns,
        random: &mut Random,
        inliers: &mut Vec<u32>,
    ) -> Option<[f64; 2]> {
        let finite = &columns.finite;
        let n = finite.len();
        let limit = self.residual_mps as f32;
        let mut best = (0usize, [0.0f32; 2]);
        let mut consider = |i: u32, j: u32| -> Option<usize> {
            let velocity = hypothesis(columns, i as usize, j as usize)?;
            let count = agreeing(columns, velocity, limit);
            (count > best.0).then(|| {
                best = (count, velocity);
                count
            })
        };
        if n <= ALL_PAIRS {
            for i in 0..n {
                for j in 0..i {
                    consider(finite[i], finite[j]);
                }
            }
        } else {
            let mut draws = self.draws(self.min_share);
            let mut draw = 0;
            while draw < draws {
                // One number of 64 bits makes both indices, the second never the first.
                let bits = random.bits();
                let i = (((bits >> 32) * n as u64) >> 32) as usize;
                let other = (((bits & 0xffff_ffff) * (n as u64 - 1)) >> 32) as usize;
                let j = if other >= i { other + 1 } else { other };
                if let Some(count) = consider(finite[i], finite[j]) {
                    draws = draws.min(self.draws(count as f64 / n as f64));
                }
                draw += 1;
            }
        }
        let (count, velocity) = best;
        if count < 2 {
            return None;
        }
        self.refine(columns, velocity.map(f64::from), inliers)
    }

    /// Least squares on the inliers, selected again until they stay the same.
    fn refine(
        &self,
        columns: &Columns,
        first: [f64; 2],
        inliers: &mut Vec<u32>,
    ) -> Option<[f64; 2]> {
        let exact = [self.residual_mps, 0.0];
        let mut velocity = first;
        let mut before = Vec::with_capacity(columns.finite.len());
        least_squares::select(columns, velocity, exact, 1.0, inliers);
        for _ in 0..REFINEMENTS {
            velocity = least_squares::solve(columns, inliers)?;
            std::mem::swap(&mut before, inliers);
            least_squares::select(columns, velocity, exact, 1.0, inliers);
            if inliers.iter().eq(&before) {
                break;
            }
        }
        (inliers.len() >= 2).then_some(velocity)
    }
}

/// The velocity two detections agree on.
fn hypothesis(columns: &Columns, i: usize, j: usize) -> Option<[f32; 2]> {
    let (ci, si, di) = (columns.cos[i], columns.sin[i], columns.approach[i]);
    let (cj, sj, dj) = (columns.cos[j], columns.sin[j], columns.approach[j]);
    let determinant = ci * sj - si * cj;
    if determinant.abs() < MIN_SINE {
        return None;
    }
    let velocity = [(di * sj - dj * si) / determinant, (dj * ci - di * cj) / determinant];
    (velocity[0].abs() < MAX_SPEED_MPS && velocity[1].abs() < MAX_SPEED_MPS).then_some(velocity)
}

/// Number of detections that agree with a velocity; the loop has no branch, so that it is vectorised.
fn agreeing(columns: &Columns, [vx, vy]: [f32; 2], limit: f32) -> usize {
    let rows = columns.cos.iter().zip(&columns.sin).zip(&columns.approach);
    let count: i32 = rows
        .map(|((&cos, &sin), &approach)| i32::from((approach - vx * cos - vy * sin).abs() < limit))
        .sum();
    count as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_follow_from_share_and_confidence() {
        let search = Search { residual_mps: 0.3, confidence: 0.99, min_share: 0.3 };
        // The table of Fischler and Bolles' formula for pairs: 5 % and 50 % outliers take 2 and 17.
        assert_eq!(search.draws(0.95), 2);
        assert_eq!(search.draws(0.5), 17);
        assert_eq!(search.draws(1.0), 1);
        assert_eq!(search.draws(0.0), MAX_DRAWS);
        assert_eq!(search.draws(1e-9), MAX_DRAWS);
    }
}
