//! Orthogonal distance regression: azimuths are noisy as well as range rates.
//!
//! Least squares treats azimuths as exact, which bends the velocity toward zero and, where the
//! detections lie to one side of the direction of travel, turns it. Here every detection has an
//! unknown azimuth error, and `sum (d_i - v . u(a_i + e_i))^2 / sigma_d^2 + e_i^2 / sigma_a^2` is
//! minimised over velocity and errors by Gauss-Newton; the errors are eliminated in closed form
//! (Boggs, Byrd and Schnabel 1987).

use super::consensus::Consensus;
use super::least_squares::{Fit, ITERATIONS, SETTLED_MPS, inflation};
use super::{Columns, FrameMotion, MotionPlan};
use crate::error::MountingError;
use crate::frame::FrameInput;
use crate::options::CalibrationOptions;
use crate::symmetric::Symmetric;

/// RANSAC, then orthogonal distance regression.
#[derive(Debug)]
pub(crate) struct OrthogonalDistance {
    consensus: Consensus,
    lines: Vec<Line>,
}

impl OrthogonalDistance {
    pub fn new(options: &CalibrationOptions) -> Self {
        Self { consensus: Consensus::new(options), lines: Vec::new() }
    }
}

impl MotionPlan for OrthogonalDistance {
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, MountingError> {
        let Self { consensus, lines } = self;
        let fit = |columns: &Columns, inliers: &[u32], velocity, noise| {
            fit(columns, inliers, velocity, noise, lines)
        };
        let motion = consensus.estimate_reselecting(frame.detections, weights, fit);
        Ok(FrameMotion::to_judge(motion))
    }
}

/// The fit from a first velocity; `lines` is scratch space.
fn fit(
    columns: &Columns,
    inliers: &[u32],
    first: [f64; 2],
    noise: [f64; 2],
    lines: &mut Vec<Line>,
) -> Option<Fit> {
    let variances = noise.map(|sigma| sigma * sigma);
    let mut velocity = first;
    let mut covariance = Symmetric::default();
    let row = |i: &u32| columns.row(*i as usize);
    lines.clear();
    lines.extend(inliers.iter().map(|i| Line::new(row(i), 0.0, velocity, variances)));
    for _ in 0..ITERATIONS {
        let (mut normal, mut right) = (Symmetric::default(), [0.0; 2]);
        for line in lines.iter() {
            normal.add(line.cos, line.sin, line.weight);
            right[0] += line.weight * line.cos * line.residual;
            right[1] += line.weight * line.sin * line.residual;
        }
        covariance = normal.inverse()?;
        let step = covariance.times(right);
        velocity = [velocity[0] + step[0], velocity[1] + step[1]];
        if step[0].hypot(step[1]) <= SETTLED_MPS {
            break;
        }
        for (i, line) in inliers.iter().zip(lines.iter_mut()) {
            let left = line.residual - line.cos * step[0] - line.sin * step[1];
            let error = variances[1] * line.slope * line.weight * left;
            *line = Line::new(row(i), error, velocity, variances);
        }
    }
    Some((velocity, covariance.scaled(inflation(columns, inliers, velocity, noise))))
}

/// The model of one detection, linear about its azimuth error.
#[derive(Debug, Clone, Copy)]
struct Line {
    cos: f64,
    sin: f64,
    /// Change of the predicted approach with azimuth, m/s per rad.
    slope: f64,
    /// What the velocity leaves unexplained at azimuth error 0, on that line, m/s.
    residual: f64,
    /// Inverse variance of the residual, s^2/m^2.
    weight: f64,
}

impl Line {
    fn new(
        [cos, sin, approach]: [f64; 3],
        error: f64,
        velocity: [f64; 2],
        variances: [f64; 2],
    ) -> Self {
        let error = error.clamp(-MAX_ERROR_RAD, MAX_ERROR_RAD);
        let (se, ce) = error.sin_cos();
        let (cos, sin) = (cos * ce - sin * se, sin * ce + cos * se);
        let slope = velocity[1] * cos - velocity[0] * sin;
        let predicted = velocity[0] * cos + velocity[1] * sin;
        Self {
            cos,
            sin,
            slope,
            residual: approach - predicted + slope * error,
            weight: 1.0 / (variances[0] + slope * slope * variances[1]),
        }
    }
}

/// No azimuth error is larger, rad: keeps a wild outlier from turning around.
const MAX_ERROR_RAD: f64 = 0.5;
