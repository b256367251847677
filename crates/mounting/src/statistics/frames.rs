//! The motion of a radar in each of its scans, and what is left of its detections.

use crate::error::MountingError;
use crate::frame::Motion;
use crate::intake;
use crate::motion::MotionEstimator;
use crate::options::{CalibrationOptions, MotionMethod};
use boresight_core::{Detection, Scan};

use boresight_core::drive::STATIC_LABEL;

/// Slower scans say little of angles and residuals, m/s.
const MIN_SPEED_MPS: f64 = 3.0;

/// A scan in which the radar's motion was found.
pub(crate) struct Frame<'a> {
    pub(crate) scan: &'a Scan,
    pub(crate) motion: Motion,
}

/// What the Doppler curve leaves of a detection.
pub(crate) struct Residual {
    /// Azimuth, rad.
    pub(crate) azimuth_rad: f64,
    /// Minus range rate less the curve's, m/s.
    pub(crate) residual_mps: f64,
    /// Change of the curve with azimuth, m/s a radian.
    pub(crate) slope_mps: f64,
}

/// The scans in which RANSAC and least squares (equation 3 of Zhu et al.) find a motion faster than
/// 3 m/s.
pub(crate) fn frames<'a>(scans: &[&'a Scan]) -> Result<Vec<Frame<'a>>, MountingError> {
    let options = CalibrationOptions::default();
    let mut estimator = MotionEstimator::new(&options, MotionMethod::Ransac)?;
    Ok(scans
        .iter()
        .filter_map(|&scan| {
            let motion = estimator.estimate(&scan.detections)?;
            let [vx, vy] = motion.velocity_mps;
            (vx.hypot(vy) > MIN_SPEED_MPS).then_some(Frame { scan, motion })
        })
        .collect())
}

impl Frame<'_> {
    /// Speed of the radar, m/s.
    pub(crate) fn speed_mps(&self) -> f64 {
        self.motion.velocity_mps[0].hypot(self.motion.velocity_mps[1])
    }

    /// Residuals of the valid detections labelled static; of all valid ones, where there are no labels.
    pub(crate) fn residuals(&self) -> impl Iterator<Item = Residual> {
        let [vx, vy] = self.motion.velocity_mps;
        let labels = &self.scan.labels;
        self.scan
            .detections
            .iter()
            .enumerate()
            .filter(|(i, _)| labels.get(*i).is_none_or(|label| *label == STATIC_LABEL))
            .filter(|(_, detection)| intake::is_valid(detection))
            .map(move |(_, detection)| residual(detection, vx, vy))
    }
}

fn residual(detection: &Detection, vx: f64, vy: f64) -> Residual {
    let azimuth_rad = f64::from(detection.azimuth_rad);
    let (sin, cos) = azimuth_rad.sin_cos();
    Residual {
        azimuth_rad,
        residual_mps: -f64::from(detection.range_rate_mps) - vx * cos - vy * sin,
        slope_mps: vy * cos - vx * sin,
    }
}
