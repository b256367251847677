//! Trajectories from a radar's motion, and how far they stray; for the TypeScript around this
//! crate, which checks what goes in.

use crate::carry;
use boresight_calibrate::trajectory::{self, TimedMotion};
use boresight_core::describe::{Described, columns};
use boresight_core::drive::Pose;
use boresight_core::drive_columns::DrivePoses;
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Poses of the rear axle at times.
#[derive(Described, Serialize)]
pub struct Trajectory<'a> {
    /// Time of each.
    #[serde(serialize_with = "columns::serialize")]
    time_s: &'a [f64],
    /// The poses.
    #[serde(rename = "..poses")]
    poses: DrivePoses,
}

/// Poses of the rear axle, or null where they do not follow. Yaw rates are empty or one a motion, NaN for
/// what follows from the motion.
#[wasm_bindgen(js_name = integrateMotion)]
pub fn integrate_motion(
    time_s: &[f64],
    vx_mps: &[f64],
    vy_mps: &[f64],
    yaw_rate_degps: &[f64],
    angle_deg: f64,
    x_m: f64,
    y_m: f64,
) -> JsValue {
    let given = |i: usize| yaw_rate_degps.get(i).filter(|rate| rate.is_finite());
    let motions: Vec<_> = time_s
        .iter()
        .zip(vx_mps)
        .zip(vy_mps)
        .enumerate()
        .map(|(i, ((&time_s, &vx), &vy))| TimedMotion {
            time_s,
            velocity_mps: [vx, vy],
            yaw_rate_radps: given(i).map(|rate| rate.to_radians()),
        })
        .collect();
    let poses = trajectory::integrate(&motions, angle_deg.to_radians(), x_m, y_m);
    carry::write(
        &poses
            .map(|poses| Trajectory { time_s, poses: DrivePoses::of(poses.into_iter().map(Some)) }),
    )
}

/// Relative trajectory error of poses `[x, y, yaw (deg), ...]` at the same times, m.
#[wasm_bindgen(js_name = relativeTrajectoryError)]
pub fn relative_trajectory_error(estimated: &[f64], truth: &[f64], segment_m: f64) -> Option<f64> {
    let poses = |numbers: &[f64]| -> Vec<Pose> {
        let pose = |p: &[f64]| Pose { x_m: p[0], y_m: p[1], yaw_rad: p[2].to_radians() };
        numbers.chunks_exact(3).map(pose).collect()
    };
    trajectory::relative_error(&poses(estimated), &poses(truth), segment_m)
}
