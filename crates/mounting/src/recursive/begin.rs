//! Before there is an angle to be led by: a vote of frames by themselves.

use super::tracked::SpeedEvidence;
use super::vote::Vote;
use super::{Recursive, prior};
use crate::angle::wrap;
use crate::frame::{FrameInput, FrameOutcome, Verdict};

/// Frames in vain after which the nominal angle is doubted.
const MISSES: usize = 50;
/// A frame that votes knows its angle to this, rad (5 deg).
const VOTE_RAD: f64 = 0.09;

impl Recursive {
    /// Before there is an angle: a frame's own motion, and its vote.
    pub(super) fn begin(
        &mut self,
        frame: &FrameInput,
        measured: f64,
        evidence: Option<&SpeedEvidence>,
        outcome: &mut FrameOutcome,
    ) -> Verdict {
        let Some(motion) = self.motion_alone(frame.detections) else { return Verdict::Sparse };
        outcome.weights.copy_from_slice(&self.alone_weights);
        outcome.motion = Some(motion);
        let polar = motion.polar();
        let speed = polar.speed_mps;
        if speed < self.options.min_speed_mps {
            return Verdict::Slow;
        }
        let [x_m, y_m] = [self.options.x_m, self.options.y_m];
        let rate = measured - self.state.now.mean()[2];
        let sine = rate * x_m / speed;
        let share = motion.inliers as f64 / motion.detections.max(1) as f64;
        if sine.abs() >= 1.0
            || share < self.options.inlier_ratio_threshold
            || polar.direction_variance.is_nan()
            || polar.direction_variance >= VOTE_RAD * VOTE_RAD
        {
            return Verdict::Sparse;
        }
        let along = speed * (1.0 - sine * sine).sqrt();
        if evidence
            .is_some_and(|e| e.rules_out(along + rate * y_m) && e.rules_out(-along + rate * y_m))
        {
            return Verdict::OffSpeed;
        }
        let mut angle = wrap(sine.asin() - polar.direction_rad);
        // In reverse the radar moves the other way, and its place turns it the other way.
        let backwards = wrap(-sine.asin() - polar.direction_rad - std::f64::consts::PI);
        let reversing = match (evidence, self.options.nominal_rad) {
            (Some(evidence), _) => evidence.mps < 0.0,
            (_, Some(nominal)) => wrap(backwards - nominal).abs() < wrap(angle - nominal).abs(),
            _ => false,
        };
        if reversing {
            angle = backwards;
        }
        if let Some(vote) = &mut self.state.vote {
            vote.add(angle, share.min(1.0));
            if let Some(angle) = vote.settled() {
                self.state.vote = None;
                let known = self.state.now;
                self.state.now = prior(angle, &self.options);
                self.state.now.take_bias(&known);
                self.state.before = self.state.now;
            }
        }
        Verdict::Sparse
    }

    /// Frames that fit no speed, one after the other before any has been used, say that the nominal
    /// angle is not where to begin.
    pub(super) fn miss(&mut self) {
        self.state.misses += 1;
        if self.state.counts.used == 0 && self.state.misses >= MISSES && self.state.vote.is_none() {
            self.state.vote = Some(Vote::new());
            self.state.misses = 0;
        }
    }
}
