//! The radar's own motion from one Doppler point cloud.
//!
//! A static point at azimuth `a` has `-range_rate = vx cos a + vy sin a` (equation 2 of Zhu et al. with
//! their Doppler as the range rate; their text has it positive towards the radar, where the sign would be the other).
//! `ransac` finds the points that agree on one motion; `least_squares` and
//! `orthogonal_distance` make the most of them.

mod consensus;
pub(crate) mod least_squares;
pub(crate) mod orthogonal_distance;
pub(crate) mod plan;
pub(crate) mod prepare;
pub(crate) mod ransac;
mod search;
pub(crate) mod weighed;
mod weighted_least_squares;

pub use plan::{FrameMotion, MotionPlan};

use crate::error::MountingError;
use crate::frame::{FrameInput, Motion};
use crate::intake::{self, Screened};
use crate::options::{CalibrationOptions, MotionMethod};
use boresight_core::{Detection, InputError};
use prepare::prepare;
use wide::f32x4;

/// Detections as columns, filled up to whole lanes: what the sums and counts run over.
#[derive(Debug, Clone, Default)]
pub(crate) struct Columns {
    /// Cosine of azimuth.
    pub cos: Vec<f32>,
    /// Sine of azimuth.
    pub sin: Vec<f32>,
    /// Minus range rate, m/s; NaN where the detection is not valid or there is none, so that it agrees with nothing.
    pub approach: Vec<f32>,
    /// Positions of the valid detections.
    pub finite: Vec<u32>,
}

impl Columns {
    fn load(&mut self, detections: &[Detection]) {
        let padded = detections.len().next_multiple_of(LANES);
        for (column, padding) in
            [(&mut self.cos, 0.0), (&mut self.sin, 0.0), (&mut self.approach, f32::NAN)]
        {
            column.clear();
            column.resize(padded, padding);
        }
        self.finite.clear();
        // Azimuths stand in the place of their cosines first.
        let rows = detections.iter().zip(&mut self.cos).zip(&mut self.approach);
        for (i, ((d, azimuth), approach)) in rows.enumerate() {
            if intake::is_valid(d) {
                (*azimuth, *approach) = (d.azimuth_rad, -d.range_rate_mps);
                self.finite.push(i as u32);
            }
        }
        let lanes = self.cos.as_chunks_mut::<LANES>().0.iter_mut();
        for (cos, sin) in lanes.zip(self.sin.as_chunks_mut::<LANES>().0) {
            let (sines, cosines) = f32x4::from(*cos).sin_cos();
            (*cos, *sin) = (cosines.to_array(), sines.to_array());
        }
    }

    /// Cosine, sine and minus range rate of a detection.
    pub fn row(&self, i: usize) -> [f64; 3] {
        [f64::from(self.cos[i]), f64::from(self.sin[i]), f64::from(self.approach[i])]
    }
}

/// Azimuths whose sines are computed at once.
const LANES: usize = 4;

/// Estimates the motion from single frames, reusing its buffers.
#[derive(Debug)]
pub struct MotionEstimator {
    plan: Box<dyn MotionPlan>,
    weights: Vec<f32>,
}

impl MotionEstimator {
    /// An estimator with the thresholds, noises and seed of the options.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`]; [`InputError::Incompatible`] for [`MotionMethod::Tracked`], which
    /// needs more than one frame: ask a [`crate::Calibrator`] for it; [`MountingError::NeedsNetwork`] for networks.
    pub fn new(options: &CalibrationOptions, method: MotionMethod) -> Result<Self, MountingError> {
        options.validate()?;
        if method == MotionMethod::Tracked {
            return Err(InputError::Incompatible {
                what: "motion".into(),
                expected:
                    "ransac, weighted-least-squares or orthogonal-distance for a single frame"
                        .into(),
                given: method.name().into(),
            }
            .into());
        }
        Ok(Self { plan: prepare(method, options, None)?, weights: Vec::new() })
    }

    /// The motion, with covariance (equation 3 for least squares; the noise model's, inflated by the
    /// residuals where they exceed it, for the weighted methods). `None` where fewer than
    /// `min_inliers` detections agree, or their azimuths do not span a plane.
    pub fn estimate(&mut self, detections: &[Detection]) -> Option<Motion> {
        let screened = Screened::new(detections);
        let frame = FrameInput {
            time_s: 0.0,
            detections: &screened.detections,
            yaw_rate_radps: None,
            speed_mps: None,
        };
        let found = self.plan.estimate(frame, &mut self.weights);
        screened.spread(&mut self.weights);
        found.ok()?.motion
    }

    /// For each detection of the last frame, whether it was taken as static (1) or not (0).
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }
}
