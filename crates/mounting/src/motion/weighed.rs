//! Motion by a network that weighs detections, and by one that smooths what the first makes of several frames.

use super::{FrameMotion, MotionPlan};
use crate::error::MountingError;
use crate::frame::{CarMotion, FrameInput, Motion};
use crate::network::{MotionNetwork, WeighedMotion, WindowFrame};
use crate::options::{CalibrationOptions, MotionMethod};
use std::collections::VecDeque;
use std::sync::Arc;

/// Frames that are smoothed together.
const WINDOW: usize = 8;
/// DeepEgo+ tells the motion of so many frames before the latest.
const DELAY: usize = WINDOW / 2;
/// Frames further apart are not smoothed together, s.
const MAX_GAP_S: f64 = 0.5;
/// Deviation of a velocity from which the detections do not tell it, m/s.
const UNDETERMINED_MPS: f64 = 1.0;

/// DeepEgo's motion of a frame, or DeepEgo+'s of the middle of eight frames: at the ends of a window a smoother errs most.
#[derive(Debug)]
pub(crate) struct Weighed {
    network: Arc<MotionNetwork>,
    options: CalibrationOptions,
    smooths: bool,
    /// The last frames, the latest one last.
    window: VecDeque<Taken>,
}

/// A frame with its own motion.
#[derive(Debug)]
struct Taken {
    car: CarMotion,
    alone: WeighedMotion,
    inliers: usize,
    detections: usize,
}

impl Weighed {
    /// # Errors
    /// As [`needed`].
    pub fn new(
        method: MotionMethod,
        network: Option<&Arc<MotionNetwork>>,
        options: &CalibrationOptions,
    ) -> Result<Self, MountingError> {
        Ok(Self {
            network: needed(method, network)?,
            options: *options,
            smooths: method == MotionMethod::DeepegoPlus,
            window: VecDeque::with_capacity(WINDOW),
        })
    }

    /// A frame of the window and its motion, velocity and covariance: the last frame and its own, or the one [`DELAY`] before and
    /// its smoothed one.
    fn found(&self) -> Option<(&Taken, [f64; 2], [f64; 3])> {
        match self.network.smoothing().filter(|_| self.smooths) {
            Some(network) => {
                let at = self.window.len().checked_sub(1 + DELAY)?;
                let frames: Vec<WindowFrame> = self
                    .window
                    .iter()
                    .map(|taken| WindowFrame { time_s: taken.car.time_s, motion: &taken.alone })
                    .collect();
                let smoothed = network.smooth(&frames).get(at).copied()?;
                Some((self.window.get(at)?, smoothed.velocity_mps, smoothed.covariance))
            }
            None => {
                let last = self.window.back()?;
                Some((last, last.alone.velocity_mps, last.alone.covariance))
            }
        }
    }
}

/// Detections that count as inliers by their weights.
pub(crate) fn inliers(weights: &[f32], options: &CalibrationOptions) -> usize {
    weights.iter().filter(|weight| **weight >= options.inlier_threshold as f32).count()
}

/// A network's motion, its covariance given as xx, xy, yy, if detections tell it.
pub(crate) fn told(
    velocity_mps: [f64; 2],
    [xx, xy, yy]: [f64; 3],
    inliers: usize,
    detections: usize,
    options: &CalibrationOptions,
) -> Option<Motion> {
    let known = (xx + yy).sqrt() < UNDETERMINED_MPS && inliers >= options.min_inliers;
    let covariance = [[xx, xy], [xy, yy]];
    known.then_some(Motion { velocity_mps, covariance, inliers, detections })
}

/// The network of a motion.
///
/// # Errors
/// [`MountingError::NeedsNetwork`] without one, and for DeepEgo+ with one that does not smooth.
pub(crate) fn needed(
    method: MotionMethod,
    network: Option<&Arc<MotionNetwork>>,
) -> Result<Arc<MotionNetwork>, MountingError> {
    let given = match network {
        None => "none",
        Some(network) if method == MotionMethod::DeepegoPlus && network.smoothing().is_none() => {
            "those of deepego"
        }
        Some(network) => return Ok(network.clone()),
    };
    Err(MountingError::NeedsNetwork { motion: method.name(), given })
}

impl MotionPlan for Weighed {
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, MountingError> {
        let mut alone = self.network.single().motion(frame.detections);
        *weights = std::mem::take(&mut alone.weights);
        let inliers = inliers(weights, &self.options);
        let car = frame.car();
        if self.window.back().is_some_and(|last| car.time_s - last.car.time_s > MAX_GAP_S) {
            self.window.clear();
        }
        if self.window.len() == WINDOW || !self.smooths {
            self.window.pop_front();
        }
        self.window.push_back(Taken { car, alone, inliers, detections: frame.detections.len() });
        let found = self.found();
        let motion = found.and_then(|(taken, velocity, covariance)| {
            told(velocity, covariance, taken.inliers, taken.detections, &self.options)
        });
        let earlier = found.map(|(taken, ..)| taken.car);
        Ok(FrameMotion { earlier, ..FrameMotion::to_judge(motion) })
    }

    fn restart(&mut self) {
        self.window.clear();
    }
}
