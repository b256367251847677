//! Detections and motion samples from numbers, as both kinds of tables make them.

use super::report::{DropReason, ReadReport};
use crate::error::FormatError;
use boresight_core::drive::{Detection, MotionSample};

/// Adds a sample if its numbers are finite and its time is new; `place` says where it stands.
pub(crate) fn push(
    samples: &mut Vec<MotionSample>,
    report: &mut ReadReport,
    sample: MotionSample,
    place: impl FnOnce() -> String,
) -> Result<(), FormatError> {
    report.motion += 1;
    let pose = sample.pose.is_none_or(|p| (p.x_m + p.y_m + p.yaw_rad).is_finite());
    let speed = sample.speed_mps.is_none_or(f64::is_finite);
    if !(sample.time_s.is_finite() && sample.yaw_rate_radps.is_finite() && speed && pose) {
        report.drop(DropReason::MotionNotFinite);
        return Ok(());
    }
    if let Some(previous) = samples.last().map(|s| s.time_s) {
        if sample.time_s < previous {
            return Err(FormatError::TimeBackwards {
                place: place(),
                previous,
                given: sample.time_s,
            });
        }
        if sample.time_s == previous {
            report.drop(DropReason::MotionDuplicate);
            return Ok(());
        }
    }
    samples.push(sample);
    Ok(())
}

/// A detection, `None` if its azimuth or range rate is no finite number; a range or cross-section
/// that is none counts as not given.
pub(crate) fn detection(
    azimuth_rad: f64,
    range_rate_mps: f64,
    range_m: f64,
    rcs_dbsm: f64,
) -> Option<Detection> {
    let finite = |number: f64| Some(number as f32).filter(|n| n.is_finite());
    Some(Detection {
        azimuth_rad: finite(azimuth_rad)?,
        range_rate_mps: finite(range_rate_mps)?,
        range_m: finite(range_m).unwrap_or(f32::NAN),
        rcs_dbsm: finite(rcs_dbsm).unwrap_or(f32::NAN),
    })
}
