//! Motion by a network that weighs detections, and by one that smooths what the first makes of several frames.

use super::{FrameMotion, MotionPlan};
use crate::network::{MotionNetwork, WeighedMotion, WindowFrame};
use crate::{CalibrateError, CalibrationOptions, FrameInput, Motion, MotionMethod};
use std::collections::VecDeque;
use std::sync::Arc;

/// Frames that are smoothed together.
const WINDOW: usize = 8;
/// Frames further apart are not smoothed together, s.
const MAX_GAP_S: f64 = 0.5;
/// Deviation of a velocity from which the detections do not tell it, m/s.
const UNDETERMINED_MPS: f64 = 1.0;

/// DeepEgo's motion of a frame, or DeepEgo+'s of a frame and the seven before.
#[derive(Debug)]
pub(crate) struct Weighed {
    network: Arc<MotionNetwork>,
    options: CalibrationOptions,
    smooths: bool,
    /// Frames with their times, the last one last.
    window: VecDeque<(f64, WeighedMotion)>,
}

impl Weighed {
    /// # Errors
    /// As [`needed`].
    pub fn new(
        method: MotionMethod,
        network: Option<&Arc<MotionNetwork>>,
        options: &CalibrationOptions,
    ) -> Result<Self, CalibrateError> {
        Ok(Self {
            network: needed(method, network)?,
            options: *options,
            smooths: method == MotionMethod::DeepegoPlus,
            window: VecDeque::with_capacity(WINDOW),
        })
    }

    /// The motion of the last frame of the window: smoothed, unless that is its first.
    fn last(&self) -> Option<([f64; 2], [f64; 3])> {
        let (_, alone) = self.window.back()?;
        match self.network.smoothing().filter(|_| self.smooths && self.window.len() > 1) {
            Some(network) => {
                let frames: Vec<WindowFrame> = self
                    .window
                    .iter()
                    .map(|(time_s, motion)| WindowFrame { time_s: *time_s, motion })
                    .collect();
                let smoothed = network.smooth(&frames).pop()?;
                Some((smoothed.velocity_mps, smoothed.covariance))
            }
            None => Some((alone.velocity_mps, alone.covariance)),
        }
    }
}

/// The network of a motion.
///
/// # Errors
/// [`CalibrateError::NeedsNetwork`] without one, and for DeepEgo+ with one that does not smooth.
pub(crate) fn needed(
    method: MotionMethod,
    network: Option<&Arc<MotionNetwork>>,
) -> Result<Arc<MotionNetwork>, CalibrateError> {
    let given = match network {
        None => "none",
        Some(network) if method == MotionMethod::DeepegoPlus && network.smoothing().is_none() => {
            "those of deepego"
        }
        Some(network) => return Ok(network.clone()),
    };
    Err(CalibrateError::NeedsNetwork { motion: method.name(), given })
}

impl MotionPlan for Weighed {
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, CalibrateError> {
        let found = self.network.single().motion(frame.detections);
        weights.clear();
        weights.extend_from_slice(&found.weights);
        let threshold = self.options.inlier_threshold as f32;
        let inliers = weights.iter().filter(|&&weight| weight >= threshold).count();
        if self.window.back().is_some_and(|(time_s, _)| frame.time_s - time_s > MAX_GAP_S) {
            self.window.clear();
        }
        if self.window.len() == WINDOW || !self.smooths {
            self.window.pop_front();
        }
        self.window.push_back((frame.time_s, found));
        let motion = self.last().and_then(|(velocity_mps, [xx, xy, yy])| {
            let known = (xx + yy).sqrt() < UNDETERMINED_MPS && inliers >= self.options.min_inliers;
            known.then_some(Motion {
                velocity_mps,
                covariance: [[xx, xy], [xy, yy]],
                inliers,
                detections: frame.detections.len(),
            })
        });
        Ok(FrameMotion::to_judge(motion))
    }
}
