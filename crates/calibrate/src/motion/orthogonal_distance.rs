//! Orthogonal distance regression: azimuths are noisy as well as range rates.
//!
//! Least squares treats azimuths as exact, which bends the velocity toward zero and, where the
//! detections lie to one side of the direction of travel, turns it. Here every detection has an
//! unknown azimuth error, and `sum (d_i - v . u(a_i + e_i))^2 / sigma_d^2 + e_i^2 / sigma_a^2` is
//! minimised over velocity and errors by Gauss-Newton; the errors are eliminated in closed form
//! (Boggs, Byrd and Schnabel 1987).

use super::Columns;
use super::least_squares::{Fit, ITERATIONS, SETTLED_MPS, inflation};
use crate::symmetric::Symmetric;

/// The fit from a first velocity; `errors` is scratch space and holds the azimuth errors found, rad.
pub(crate) fn fit(
    columns: &Columns,
    inliers: &[u32],
    first: [f64; 2],
    noise: [f64; 2],
    errors: &mut Vec<f64>,
) -> Option<Fit> {
    errors.clear();
    errors.resize(inliers.len(), 0.0);
    let [range_rate_variance, azimuth_variance] = noise.map(|sigma| sigma * sigma);
    let mut velocity = first;
    let mut covariance = Symmetric::default();
    for _ in 0..ITERATIONS {
        let (mut normal, mut right) = (Symmetric::default(), [0.0; 2]);
        for (&i, &error) in inliers.iter().zip(errors.iter()) {
            let line = Line::new(columns.row(i as usize), error, velocity);
            let weight = 1.0 / (range_rate_variance + line.slope.powi(2) * azimuth_variance);
            normal.add(line.cos, line.sin, weight);
            right[0] += weight * line.cos * line.residual;
            right[1] += weight * line.sin * line.residual;
        }
        covariance = normal.inverse()?;
        let step = covariance.times(right);
        for (&i, error) in inliers.iter().zip(errors.iter_mut()) {
            let line = Line::new(columns.row(i as usize), *error, velocity);
            let weight = 1.0 / (range_rate_variance + line.slope.powi(2) * azimuth_variance);
            let left = line.residual - line.cos * step[0] - line.sin * step[1];
            *error = (azimuth_variance * line.slope * weight * left)
                .clamp(-MAX_ERROR_RAD, MAX_ERROR_RAD);
        }
        velocity = [velocity[0] + step[0], velocity[1] + step[1]];
        if step[0].hypot(step[1]) <= SETTLED_MPS {
            break;
        }
    }
    Some((velocity, covariance.scaled(inflation(columns, inliers, velocity, noise))))
}

/// The model of one detection, linear about its azimuth error.
struct Line {
    cos: f64,
    sin: f64,
    /// Change of the predicted approach with azimuth, m/s per rad.
    slope: f64,
    /// What the velocity leaves unexplained at azimuth error 0, on that line, m/s.
    residual: f64,
}

impl Line {
    fn new([cos, sin, approach]: [f64; 3], error: f64, velocity: [f64; 2]) -> Self {
        let (se, ce) = error.sin_cos();
        let (cos, sin) = (cos * ce - sin * se, sin * ce + cos * se);
        let slope = velocity[1] * cos - velocity[0] * sin;
        let predicted = velocity[0] * cos + velocity[1] * sin;
        Self { cos, sin, slope, residual: approach - predicted + slope * error }
    }
}

/// No azimuth error is larger, rad: keeps a wild outlier from turning around.
const MAX_ERROR_RAD: f64 = 0.5;
