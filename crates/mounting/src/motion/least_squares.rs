//! Least squares for the velocity, plain and weighted by each detection's noise.

use super::Columns;
use crate::symmetric::Symmetric;

/// A velocity (m/s) and its covariance.
pub(crate) type Fit = ([f64; 2], Symmetric);

/// Least squares on the given detections with the covariance of equation 3,
/// `e'e / (L - 2) (A'A)^-1`, the residuals' standard deviation taken as `least` (m/s) at least. Two detections leave no residual: their covariance is infinite, hence
/// `None`; so do azimuths that do not span a plane.
pub(crate) fn plain(columns: &Columns, inliers: &[u32], least: f64) -> Option<Fit> {
    let velocity = solve(columns, inliers)?;
    if inliers.len() < 3 {
        return None;
    }
    let (mut normal, mut squares) = (Symmetric::default(), 0.0);
    for &i in inliers {
        let [cos, sin, approach] = columns.row(i as usize);
        let residual = approach - velocity[0] * cos - velocity[1] * sin;
        normal.add(cos, sin, 1.0);
        squares += residual * residual;
    }
    let variance = (squares / (inliers.len() - 2) as f64).max(least * least);
    Some((velocity, normal.inverse()?.scaled(variance)))
}

/// The velocity alone.
pub(crate) fn solve(columns: &Columns, inliers: &[u32]) -> Option<[f64; 2]> {
    let (mut normal, mut right) = (Symmetric::default(), [0.0; 2]);
    for &i in inliers {
        let [cos, sin, approach] = columns.row(i as usize);
        normal.add(cos, sin, 1.0);
        right[0] += cos * approach;
        right[1] += sin * approach;
    }
    Some(normal.inverse()?.times(right))
}

/// Variance of a detection's residual: range rate and, through the slope of the Doppler curve,
/// azimuth: `sigma_d^2 + (|V| sin(a - beta))^2 sigma_a^2`.
pub(crate) fn residual_variance(velocity: [f64; 2], cos: f64, sin: f64, noise: [f64; 2]) -> f64 {
    let slope = velocity[1] * cos - velocity[0] * sin;
    noise[0] * noise[0] + (slope * noise[1]).powi(2)
}

/// Least squares with weights [`residual_variance`]`^-1`, from a first velocity, weights renewed until
/// they settle. The covariance is `(A'WA)^-1`, times the residuals' variance where that exceeds what
/// the noises explain.
pub(crate) fn weighted(
    columns: &Columns,
    inliers: &[u32],
    first: [f64; 2],
    noise: [f64; 2],
) -> Option<Fit> {
    let mut velocity = first;
    let mut covariance = Symmetric::default();
    for _ in 0..ITERATIONS {
        let (mut normal, mut right) = (Symmetric::default(), [0.0; 2]);
        for &i in inliers {
            let [cos, sin, approach] = columns.row(i as usize);
            let weight = 1.0 / residual_variance(velocity, cos, sin, noise);
            normal.add(cos, sin, weight);
            right[0] += weight * cos * approach;
            right[1] += weight * sin * approach;
        }
        covariance = normal.inverse()?;
        let next = covariance.times(right);
        let step = (next[0] - velocity[0]).hypot(next[1] - velocity[1]);
        velocity = next;
        if step <= SETTLED_MPS {
            break;
        }
    }
    Some((velocity, covariance.scaled(inflation(columns, inliers, velocity, noise))))
}

/// Variance of the normalised residuals where it exceeds 1, otherwise 1.
pub(crate) fn inflation(
    columns: &Columns,
    inliers: &[u32],
    velocity: [f64; 2],
    noise: [f64; 2],
) -> f64 {
    let squares: f64 = inliers
        .iter()
        .map(|&i| {
            let [cos, sin, approach] = columns.row(i as usize);
            let residual = approach - velocity[0] * cos - velocity[1] * sin;
            residual * residual / residual_variance(velocity, cos, sin, noise)
        })
        .sum();
    (squares / inliers.len().saturating_sub(2).max(1) as f64).max(1.0)
}

/// The detections whose residual is below `limit` standard deviations of their own noise.
pub(crate) fn select(
    columns: &Columns,
    velocity: [f64; 2],
    noise: [f64; 2],
    limit: f64,
    inliers: &mut Vec<u32>,
) {
    inliers.clear();
    inliers.resize(columns.finite.len(), 0);
    // Each is written, and stays if it agrees: a branch would be mispredicted at every moving body.
    let mut agreeing = 0;
    for &i in &columns.finite {
        let [cos, sin, approach] = columns.row(i as usize);
        let residual = approach - velocity[0] * cos - velocity[1] * sin;
        let variance = residual_variance(velocity, cos, sin, noise);
        inliers[agreeing] = i;
        agreeing += usize::from(residual * residual < limit * limit * variance);
    }
    inliers.truncate(agreeing);
}

/// Most renewals of the weights.
pub(crate) const ITERATIONS: usize = 8;
/// A step below this ends the iteration, m/s: what is left is less still, and noise is 1000 times more.
pub(crate) const SETTLED_MPS: f64 = 1e-6;
