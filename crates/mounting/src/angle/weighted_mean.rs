//! Mean of the frames' angles, scale taken as 1: weighted (Kellner et al. 2015) or not (Zhu et al.'s equation 8).

use super::account::{Influence, covariance};
use super::{Row, Sample, Setting, Solution, rows, wrap};
use crate::options::FrameWeights;
use crate::symmetric::Symmetric;

/// The mean with the weights that the options name; `None` without a frame.
pub(crate) fn solve(samples: &[Sample], setting: &Setting) -> Option<Solution> {
    let (rows, reference, gated) = rows(samples, setting);
    let weight = |row: &Row| match setting.options.frame_weights {
        FrameWeights::Direction => 1.0 / row.variance,
        FrameWeights::Motion => row.weight,
        FrameWeights::Equal => 1.0,
    };
    let total: f64 = rows.iter().map(weight).sum();
    if rows.is_empty() || !total.is_finite() {
        return None;
    }
    let angle = |row: &Row| row.chi.asin() - row.beta;
    let offset = rows.iter().map(|row| weight(row) * angle(row)).sum::<f64>() / total;
    let influences: Vec<Influence> = rows
        .iter()
        .map(|row| Influence {
            sample: row.sample,
            on: [weight(row) / total, 0.0],
            residual: angle(row) - offset,
            lever_s: row.lever_s / (1.0 - row.chi * row.chi).sqrt(),
        })
        .collect();
    // The frames' own variances times the scatter where that exceeds them.
    let (mut own, mut squares) = (0.0, 0.0);
    for (row, influence) in rows.iter().zip(&influences) {
        own += influence.on[0].powi(2) * row.variance;
        squares += influence.residual.powi(2) / row.variance;
    }
    let inflation = (squares / (rows.len() - 1).max(1) as f64).max(1.0);
    let independent = Symmetric { xx: inflation * own, xy: 0.0, yy: 0.0 };
    Some(Solution {
        angle_rad: wrap(reference + offset),
        inverse_scale: 1.0,
        covariance: covariance(independent, &influences, &setting.untold(true)),
        gated,
    })
}
