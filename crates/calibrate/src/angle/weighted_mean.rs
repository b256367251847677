//! Weighted mean of the frames' angles, scale taken as 1 (Kellner et al. 2015; Zhu et al.'s equation 8 has no weights).

use super::{ASSUMED_SCALE_SIGMA, Row, Sample, Setting, Solution, rows, wrap};
use crate::symmetric::Symmetric;

/// The mean, weighted by the inverse variance of each frame's direction; `None` without a frame.
pub(crate) fn solve(samples: &[Sample], setting: &Setting) -> Option<Solution> {
    let (rows, reference, gated) = rows(samples, setting);
    let (offset, variance) = mean(&rows, 1.0)?;
    let pull: f64 = weighted(&rows, |row| row.lever_s / (1.0 - row.chi * row.chi).sqrt());
    let stretch: f64 = weighted(&rows, |row| row.chi / (1.0 - row.chi * row.chi).sqrt());
    Some(Solution {
        angle_rad: wrap(reference + offset),
        inverse_scale: 1.0,
        covariance: Symmetric {
            xx: variance
                + (pull * setting.bias_sigma_radps).powi(2)
                + (stretch * ASSUMED_SCALE_SIGMA).powi(2),
            xy: 0.0,
            yy: 0.0,
        },
        gated,
    })
}

/// Weighted mean of something over the rows.
fn weighted(rows: &[Row], value: impl Fn(&Row) -> f64) -> f64 {
    let total: f64 = rows.iter().map(|row| 1.0 / row.variance).sum();
    rows.iter().map(|row| value(row) / row.variance).sum::<f64>() / total
}

/// Mean of `asin(s' chi) - beta` over the rows, and its variance, from the frames' own variances
/// times the scatter where that exceeds them.
fn mean(rows: &[Row], inverse_scale: f64) -> Option<(f64, f64)> {
    let total: f64 = rows.iter().map(|row| 1.0 / row.variance).sum();
    if rows.is_empty() || !total.is_finite() {
        return None;
    }
    let angle = |row: &Row| (inverse_scale * row.chi).asin() - row.beta;
    let offset = weighted(rows, angle);
    let squares: f64 = rows.iter().map(|row| (angle(row) - offset).powi(2) / row.variance).sum();
    let inflation = (squares / (rows.len() - 1).max(1) as f64).max(1.0);
    Some((offset, inflation / total))
}
