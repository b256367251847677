//! Weighted orthogonal distance regression: `chi` is noisy as well as `beta`.

use super::least_squares::{Point, regress};
use super::{MAX_SINE, Row, Sample, Setting, Solution, rows, wrap};

/// Angle and inverse scale with each frame's `chi` free within its own noise; `None` without a frame.
pub(crate) fn solve(samples: &[Sample], setting: &Setting) -> Option<Solution> {
    let (rows, reference, gated) = rows(samples, setting);
    let mut solution = regress(&rows, setting, nearest)?;
    solution.angle_rad = wrap(reference + solution.angle_rad);
    solution.gated += gated;
    Some(solution)
}

/// The point of the curve `beta = asin(s' chi) - theta` nearest to a row in units of its noises, by
/// Gauss-Newton from the row itself.
fn nearest(row: &Row, [angle, inverse_scale]: [f64; 2]) -> Point {
    let mut error = 0.0;
    let mut variance = row.variance;
    let limit = MAX_SINE / inverse_scale.abs();
    for _ in 0..STEPS {
        let chi = (row.chi + error).clamp(-limit, limit);
        let sine = inverse_scale * chi;
        let gradient = inverse_scale / (1.0 - sine * sine).sqrt();
        variance = row.variance + gradient * gradient * row.chi_variance;
        let left = sine.asin() - row.beta - angle - gradient * (chi - row.chi);
        let next = -left * gradient * row.chi_variance / variance;
        let settled = (next - error).abs() < SETTLED;
        error = next;
        if settled {
            break;
        }
    }
    Point { weight: 1.0 / variance, variance, chi: (row.chi + error).clamp(-limit, limit) }
}

/// Gauss-Newton converges fast: noises are small beside the curvature.
const STEPS: usize = 3;
/// A change of `chi` below this ends it: its noise is 10,000 times more.
const SETTLED: f64 = 1e-8;
