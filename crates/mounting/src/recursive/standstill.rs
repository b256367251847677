//! Whether the car stands, and what that tells of the yaw rate.

use super::tracked::SpeedEvidence;
use super::{BiasSums, Recursive};
use crate::frame::Motion;

/// Measured speed below which a car may stand, m/s, and below which it does, if its radar does not say otherwise.
const STANDSTILL_MPS: [f64; 2] = [0.5, 0.05];

impl Recursive {
    /// Most of what the radar sees is at rest relative to it, or the car's own sensors say that it stands; the car does not
    /// turn, and it was not driving a moment ago.
    pub(super) fn stands(
        &self,
        measured: f64,
        at_rest: f64,
        evidence: Option<&SpeedEvidence>,
    ) -> bool {
        let turning = (measured - self.bias_mean().unwrap_or(0.0)).abs();
        let slow = |most: f64| evidence.is_some_and(|speed| speed.mps.abs() < most);
        let share = if slow(STANDSTILL_MPS[1]) { 0.25 } else { 0.6 };
        self.cloud.len() >= self.limits.min_inliers
            && at_rest >= share
            && (evidence.is_none() || slow(STANDSTILL_MPS[0]))
            && self.state.speed.is_none_or(|speed| speed.mps.abs() < 1.0)
            && turning < 0.02
    }

    /// The motion of a radar that stands, which is none: a trajectory without these frames would run
    /// on through the stop at the speed before it.
    pub(super) fn at_rest(&self, detections: usize, share: f64) -> Motion {
        let inliers = (share * self.cloud.len() as f64).round();
        // That of a mean over azimuths all around, of which each component has half.
        let variance = 2.0 * self.limits.range_rate_sigma_mps.powi(2) / inliers.max(1.0);
        Motion {
            velocity_mps: [0.0; 2],
            covariance: [[variance, 0.0], [0.0, variance]],
            inliers: inliers as usize,
            detections,
        }
    }

    pub(super) fn bias_mean(&self) -> Option<f64> {
        let BiasSums { count, sum, .. } = self.state.bias_sums;
        (count >= 1.0).then(|| sum / count)
    }

    /// Equation 5 of Zhu et al., with the prior as one more observation of its own standard deviation.
    pub(super) fn learn_bias(&mut self, measured: f64) {
        let sums = &mut self.state.bias_sums;
        sums.count += 1.0;
        sums.sum += measured;
        sums.squares += measured * measured;
        let BiasSums { count, sum, squares } = *sums;
        // Samples of one second are not independent: ten count as one.
        if count < 10.0 {
            return;
        }
        let mean = sum / count;
        let variance = (squares / count - mean * mean).max(1e-10);
        let prior = 1.0 / self.options.bias_sigma_radps.powi(2);
        let information = count / 10.0 / variance;
        let mean = mean * information / (information + prior);
        let sigma = 1.0 / (information + prior).sqrt();
        self.state.before.set_bias(mean, sigma);
        self.state.now.set_bias(mean, sigma);
    }
}
