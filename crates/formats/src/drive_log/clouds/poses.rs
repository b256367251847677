//! The car's motion by its poses.

use crate::drive_log::report::{DropReason, ReadReport};
use boresight_core::Remark;
use boresight_core::drive::{MotionSample, Pose};
use std::f64::consts::TAU;

/// Poses nearer to the one before than this are left out, ns: their differences are noise.
const LEAST_APART_NS: i128 = 45_000_000;
/// Poses further apart say nothing of the way between, ns.
const MOST_APART_NS: i128 = 500_000_000;

/// A pose at a time, ns.
#[derive(Debug, Clone, Copy)]
pub(super) struct TimedPose {
    pub(super) stamp_ns: i128,
    pub(super) pose: Pose,
}

/// Samples from poses in any order, 45 ms apart at least: the yaw rate and the speed along the heading by the difference of the poses before
/// and after, at the ends of a stretch that of the last two. Poses further than 0.5 s from both neighbours tell no motion.
/// `is_car` says that the poses are the rear axle's, and to be kept.
pub(super) fn motion(
    mut poses: Vec<TimedPose>,
    is_car: bool,
    seconds: impl Fn(i128) -> f64,
    report: &mut ReadReport,
) -> Vec<MotionSample> {
    report.motion += poses.len() as u64;
    poses.retain(|timed| {
        let Pose { x_m, y_m, yaw_rad } = timed.pose;
        let finite = (x_m + y_m + yaw_rad).is_finite();
        if !finite {
            report.drop(DropReason::MotionNotFinite);
        }
        finite
    });
    boresight_math::order::sort_by(&mut poses, |a, b| a.stamp_ns.cmp(&b.stamp_ns));
    let mut kept: Vec<TimedPose> = vec![];
    for timed in poses {
        let near = kept.last().is_some_and(|last| timed.stamp_ns - last.stamp_ns < LEAST_APART_NS);
        if near {
            report.drop(DropReason::MotionDuplicate);
        } else {
            kept.push(timed);
        }
    }
    let mut samples = vec![];
    for (i, timed) in kept.iter().enumerate() {
        let near = |other: Option<&TimedPose>| {
            other.copied().filter(|other| (other.stamp_ns - timed.stamp_ns).abs() <= MOST_APART_NS)
        };
        let before = near(i.checked_sub(1).and_then(|i| kept.get(i)));
        let after = near(kept.get(i + 1));
        let (from, to) = (before.unwrap_or(*timed), after.unwrap_or(*timed));
        if from.stamp_ns == to.stamp_ns {
            report.drop(DropReason::MotionAlone);
            continue;
        }
        let apart_s = (to.stamp_ns - from.stamp_ns) as f64 / 1e9;
        let turn = to.pose.yaw_rad - from.pose.yaw_rad;
        let turn = turn - TAU * (turn / TAU).round();
        let (sin, cos) = (from.pose.yaw_rad + turn / 2.0).sin_cos();
        let way = [to.pose.x_m - from.pose.x_m, to.pose.y_m - from.pose.y_m];
        samples.push(MotionSample {
            time_s: seconds(timed.stamp_ns),
            yaw_rate_radps: turn / apart_s,
            speed_mps: Some((way[0] * cos + way[1] * sin) / apart_s),
            pose: is_car.then_some(timed.pose),
        });
    }
    if !samples.is_empty() {
        report.remarks.push(Remark::new(
            "differentiated-poses",
            "yaw rate and speed are differences of the poses over their times",
        ));
    }
    samples
}
