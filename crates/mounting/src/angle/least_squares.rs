//! Weighted least squares in angle and inverse scale (equations 10 to 13 of Zhu et al.).

use super::account::{Influence, covariance};
use super::{MAX_SINE, Row, Sample, Setting, Solution, rows, wrap};
use crate::symmetric::Symmetric;

/// Angle and inverse scale. Equation 12 is one linearisation at `s' = 1`; it is repeated at the
/// solution until that stays, which makes it exact for any scale. `None` without a frame.
pub(crate) fn solve(samples: &[Sample], setting: &Setting) -> Option<Solution> {
    let (rows, reference, gated) = rows(samples, setting);
    let mut solution = regress(&rows, setting, |row, _| Point {
        weight: row.weight,
        variance: row.variance,
        chi: row.chi,
    })?;
    solution.angle_rad = wrap(reference + solution.angle_rad);
    solution.gated += gated;
    Some(solution)
}

/// A row as one step of the regression takes it.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    /// Weight, in any unit.
    pub weight: f64,
    /// Variance that the row's residual should have.
    pub variance: f64,
    /// Where the arcsine is linearised.
    pub chi: f64,
}

/// Standard deviation of the inverse scale from which it counts as not determined at all: the angle is
/// then found with scale 1, and the scale's possible error of this size goes into its variance.
const UNKNOWN_SCALE_SIGMA: f64 = 0.5;
/// Smallest share of `chi`'s variance that must be more than its noise for a scale to be told from it.
const MIN_RELIABILITY: f64 = 0.5;
const ITERATIONS: usize = 20;
/// A step below this ends the iteration, in rad and of scale 1: no drive tells as much.
const SETTLED: f64 = 1e-10;

/// The share of the variance of `chi` over the frames that its own noise does not explain (the
/// reliability ratio of errors-in-variables models, Fuller 1987).
fn reliability(rows: &[Row]) -> f64 {
    let (mut total, mut mean, mut squares, mut noise) = (0.0, 0.0, 0.0, 0.0);
    for row in rows {
        let weight = 1.0 / row.variance;
        total += weight;
        let difference = row.chi - mean;
        mean += weight / total * difference;
        squares += weight * difference * (row.chi - mean);
        noise += weight * row.chi_variance;
    }
    if squares > 0.0 { 1.0 - noise / squares } else { 0.0 }
}

/// Gauss-Newton on `beta + theta = asin(s' chi)`. The covariance is that of the estimator with these
/// weights given the rows' variances, times the residuals' variance where that exceeds them, plus what
/// the bias adds.
pub(crate) fn regress(
    rows: &[Row],
    setting: &Setting,
    point: impl Fn(&Row, [f64; 2]) -> Point,
) -> Option<Solution> {
    let mut state = start(rows, &point)?;
    if reliability(rows) < MIN_RELIABILITY {
        return fixed_scale(rows, setting, &point);
    }
    for _ in 0..ITERATIONS {
        let (mut normal, mut right) = (Symmetric::default(), [0.0; 2]);
        for row in rows {
            let p = point(row, state);
            let Some(line) = Line::new(row, p, state) else { continue };
            normal.add(1.0, -line.slope, p.weight);
            right[0] += p.weight * line.residual;
            right[1] -= p.weight * line.residual * line.slope;
        }
        let Some(inverse) = normal.inverse() else { return fixed_scale(rows, setting, &point) };
        let step = inverse.times(right);
        state = [state[0] + step[0], state[1] + step[1]];
        if state[1].is_nan() || state[1] <= 0.2 || state[1] >= 5.0 {
            return fixed_scale(rows, setting, &point);
        }
        if step[0].abs() < SETTLED && step[1].abs() < SETTLED {
            break;
        }
    }
    let (mut normal, mut middle) = (Symmetric::default(), Symmetric::default());
    let mut squares = 0.0;
    let mut influences = Vec::with_capacity(rows.len());
    for row in rows {
        let p = point(row, state);
        let Some(line) = Line::new(row, p, state) else { continue };
        normal.add(1.0, -line.slope, p.weight);
        middle.add(1.0, -line.slope, p.weight * p.weight * p.variance);
        squares += line.residual * line.residual / p.variance;
        influences.push(Influence {
            sample: row.sample,
            on: [p.weight, -p.weight * line.slope],
            residual: line.residual,
            lever_s: state[1] * row.lever_s * line.steepness,
        });
    }
    let inverse = normal.inverse()?;
    let used = influences.len();
    for influence in &mut influences {
        influence.on = inverse.times(influence.on);
    }
    let inflation = (squares / used.saturating_sub(2).max(1) as f64).max(1.0);
    let independent = inverse.sandwich(middle).scaled(inflation);
    let covariance = covariance(independent, &influences, &setting.untold(false));
    if covariance.yy.is_nan() || covariance.yy >= UNKNOWN_SCALE_SIGMA.powi(2) {
        return fixed_scale(rows, setting, &point);
    }
    Some(Solution {
        angle_rad: state[0],
        inverse_scale: state[1],
        covariance,
        gated: rows.len() - used,
    })
}

/// One row, linear about a state.
struct Line {
    /// Change of `asin(s' chi)` with `s'`.
    slope: f64,
    /// Change of `asin` with its argument.
    steepness: f64,
    /// `asin(s' chi) - beta - theta`.
    residual: f64,
}

impl Line {
    fn new(row: &Row, point: Point, [angle, inverse_scale]: [f64; 2]) -> Option<Self> {
        let sine = inverse_scale * point.chi;
        if sine.abs() > MAX_SINE.midpoint(1.0) {
            return None;
        }
        let steepness = 1.0 / (1.0 - sine * sine).sqrt();
        let slope = point.chi * steepness;
        // Extrapolated on the line from where it was linearised to the chi measured.
        let residual =
            sine.asin() + inverse_scale * steepness * (row.chi - point.chi) - row.beta - angle;
        Some(Self { slope, steepness, residual })
    }
}

/// Weighted mean with scale 1.
fn start(rows: &[Row], point: &impl Fn(&Row, [f64; 2]) -> Point) -> Option<[f64; 2]> {
    let mut sums = [0.0; 2];
    for row in rows {
        let weight = point(row, [0.0, 1.0]).weight;
        sums[0] += weight;
        sums[1] += weight * (row.chi.asin() - row.beta);
    }
    (sums[0] > 0.0 && sums[0].is_finite()).then(|| [sums[1] / sums[0], 1.0])
}

/// The angle where the scale cannot be told: scale 1 with infinite variance, and in the angle's
/// variance what a scale in error by [`UNKNOWN_SCALE_SIGMA`] would do.
fn fixed_scale(
    rows: &[Row],
    setting: &Setting,
    point: &impl Fn(&Row, [f64; 2]) -> Point,
) -> Option<Solution> {
    let state = start(rows, point)?;
    let (mut total, mut middle, mut squares, mut slope) = (0.0, 0.0, 0.0, 0.0);
    let mut influences = Vec::with_capacity(rows.len());
    for row in rows {
        let p = point(row, [state[0], 1.0]);
        let p = Point { chi: row.chi, ..p };
        let Some(line) = Line::new(row, p, state) else { continue };
        total += p.weight;
        middle += p.weight * p.weight * p.variance;
        squares += line.residual * line.residual / p.variance;
        slope += p.weight * line.slope;
        influences.push(Influence {
            sample: row.sample,
            on: [p.weight, 0.0],
            residual: line.residual,
            lever_s: row.lever_s * line.steepness,
        });
    }
    for influence in &mut influences {
        influence.on[0] /= total;
    }
    let inflation = (squares / rows.len().saturating_sub(1).max(1) as f64).max(1.0);
    let independent = Symmetric { xx: inflation * middle / (total * total), xy: 0.0, yy: 0.0 };
    let mut covariance = covariance(independent, &influences, &setting.untold(false));
    covariance.xx += (slope / total * UNKNOWN_SCALE_SIGMA).powi(2);
    Some(Solution {
        angle_rad: state[0],
        inverse_scale: 1.0,
        covariance: Symmetric { xy: 0.0, yy: f64::INFINITY, ..covariance },
        gated: 0,
    })
}
