//! What one frame's motion says of the unknowns that all frames share.

use super::block::Row;
use super::information::Vector;
use super::tracked::Prediction;
use crate::angle::{MAX_SINE, wrap};
use crate::frame::Polar;
use std::f64::consts::PI;

/// Noise of the yaw rate, rad/s, beside its bias and scale.
const YAW_RATE_NOISE_RADPS: f64 = 0.0035;

/// A frame's equation and what it is about.
pub(crate) struct Equation {
    pub(crate) row: Row,
    /// Angle of this frame less the present one, rad.
    pub(crate) innovation: f64,
}

impl Equation {
    /// `theta = asin(w (x_s - kappa v^2) / |V|) - beta` (equation 7 of Zhu et al., with the slip of the rear axle), or
    /// `pi - asin(...) - beta` in reverse, linear in the unknowns about `x`; in the angle it is exact. `None` where the car
    /// turns more tightly than the model allows for.
    pub(crate) fn new(
        motion: &Polar,
        speed_mps: f64,
        prediction: &Prediction,
        x: &Vector,
        reference: &Vector,
    ) -> Option<Self> {
        let sine = prediction.lateral(speed_mps) / motion.speed_mps;
        let untold = motion.direction_variance.is_nan() || motion.direction_variance <= 0.0;
        if sine.is_nan() || sine.abs() > MAX_SINE || untold {
            return None;
        }
        let forward = speed_mps >= 0.0;
        let direction = if forward { sine.asin() } else { PI - sine.asin() };
        let steepness = 1.0 / (motion.speed_mps * (1.0 - sine * sine).sqrt());
        let steepness = if forward { steepness } else { -steepness };
        let lever = prediction.lever(speed_mps);
        let row = [
            1.0,
            -steepness * lever * prediction.reading_radps,
            steepness * lever,
            steepness * prediction.yaw_rate_radps * speed_mps * speed_mps,
            steepness * lever * x[1] * prediction.change,
        ];
        let innovation = wrap(direction - motion.direction_rad - x[0]);
        let known: f64 = (0..row.len()).map(|i| row[i] * (x[i] - reference[i])).sum();
        let variance =
            motion.direction_variance + (steepness * lever * YAW_RATE_NOISE_RADPS).powi(2);
        let value = innovation + known;
        let expected = prediction.x_m - reference[3] * speed_mps * speed_mps;
        let turn = (prediction.reading_radps * expected / motion.speed_mps).clamp(-1.0, 1.0).asin();
        let turn = if forward { turn } else { -turn };
        let angle = innovation + x[0] - reference[0] + turn
            - wrap(direction - if forward { 0.0 } else { PI });
        (value.is_finite() && variance.is_finite())
            .then_some(Self { row: Row { row, value, variance, turn, angle }, innovation })
    }
}
