//! RANSAC (Fischler and Bolles 1981) for the motion, as in Kellner et al. 2013: two detections make a
//! hypothesis, the one most detections agree with wins, least squares on those refines it.

use super::consensus::Consensus;
use super::{FrameMotion, MotionPlan, least_squares};
use crate::error::MountingError;
use crate::frame::{FrameInput, Motion};
use crate::options::CalibrationOptions;
use boresight_core::Detection;

/// Residuals are believed down to this share of the noise expected: few detections agree more closely by
/// chance, copies of two do so for certain.
const LEAST_NOISE: f64 = 0.1;

/// RANSAC, then least squares on the inliers.
#[derive(Debug, Clone)]
pub(crate) struct Ransac {
    consensus: Consensus,
    /// Standard deviation that residuals are taken to have at least, m/s.
    least_mps: f64,
}

impl Ransac {
    pub fn new(options: &CalibrationOptions) -> Self {
        let least_mps = LEAST_NOISE * options.range_rate_sigma_mps;
        Self { consensus: Consensus::new(options), least_mps }
    }

    /// Draws for the frame of this number, whatever frames came before.
    pub fn draw_for(&mut self, frame: u64) {
        self.consensus.draw_for(frame);
    }

    /// The motion in a frame; needs its detections alone.
    pub fn motion(&mut self, detections: &[Detection], weights: &mut Vec<f32>) -> Option<Motion> {
        self.consensus.estimate(detections, weights, |columns, inliers, _| {
            least_squares::plain(columns, inliers, self.least_mps)
        })
    }
}

impl MotionPlan for Ransac {
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, MountingError> {
        Ok(FrameMotion::to_judge(self.motion(frame.detections, weights)))
    }
}
