//! Weighted mean of the frames' angles, scale taken as 1 (Kellner et al. 2015; Zhu et al.'s equation 8 has no weights).

use super::account::{Influence, covariance};
use super::{Sample, Setting, Solution, rows, wrap};
use crate::symmetric::Symmetric;

/// The mean, weighted by the inverse variance of each frame's direction; `None` without a frame.
pub(crate) fn solve(samples: &[Sample], setting: &Setting) -> Option<Solution> {
    let (rows, reference, gated) = rows(samples, setting);
    let total: f64 = rows.iter().map(|row| 1.0 / row.variance).sum();
    if rows.is_empty() || !total.is_finite() {
        return None;
    }
    let angle = |chi: f64, beta: f64| chi.asin() - beta;
    let offset =
        rows.iter().map(|row| angle(row.chi, row.beta) / row.variance).sum::<f64>() / total;
    let influences: Vec<Influence> = rows
        .iter()
        .map(|row| Influence {
            sample: row.sample,
            on: [1.0 / row.variance / total, 0.0],
            residual: angle(row.chi, row.beta) - offset,
            lever_s: row.lever_s / (1.0 - row.chi * row.chi).sqrt(),
        })
        .collect();
    // The frames' own variances times the scatter where that exceeds them.
    let squares: f64 =
        rows.iter().zip(&influences).map(|(row, i)| i.residual.powi(2) / row.variance).sum();
    let inflation = (squares / (rows.len() - 1).max(1) as f64).max(1.0);
    let independent = Symmetric { xx: inflation / total, xy: 0.0, yy: 0.0 };
    Some(Solution {
        angle_rad: wrap(reference + offset),
        inverse_scale: 1.0,
        covariance: covariance(independent, &influences, &setting.untold(true)),
        gated,
    })
}
