//! RANSAC, then least squares weighted by each detection's noise.

use super::consensus::Consensus;
use super::least_squares::weighted;
use super::{FrameMotion, MotionPlan};
use crate::error::MountingError;
use crate::frame::FrameInput;
use crate::options::CalibrationOptions;

/// RANSAC, then least squares weighted by each detection's noise.
#[derive(Debug)]
pub(crate) struct WeightedLeastSquares {
    consensus: Consensus,
}

impl WeightedLeastSquares {
    pub fn new(options: &CalibrationOptions) -> Self {
        Self { consensus: Consensus::new(options) }
    }
}

impl MotionPlan for WeightedLeastSquares {
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, MountingError> {
        let motion = self.consensus.estimate_reselecting(frame.detections, weights, weighted);
        Ok(FrameMotion::to_judge(motion))
    }
}
