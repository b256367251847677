//! Trajectories from a radar's motion, and how far they stray; for the TypeScript around this
//! crate, which checks what goes in.

use crate::carry;
use boresight_core::drive::{DriveLog, MotionSample, Pose};
use boresight_core::drive_columns::DrivePoses;
use boresight_mounting::trajectory::{self, TimedMotion};
use boresight_options::{Described, Flat, columns};
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
    poses: Flat<DrivePoses>,
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
    carry::write(&poses.map(|poses| Trajectory {
        time_s,
        poses: DrivePoses::of(poses.into_iter().map(Some)).into(),
    }))
}

/// Longest gap of a true trajectory that is bridged, s.
const TRUTH_GAP_S: f64 = 1.0;

/// Relative trajectory error of poses `[x, y, yaw (deg), ...]` at times, m, where they and the true ones are known.
#[wasm_bindgen(js_name = relativeTrajectoryError)]
pub fn relative_trajectory_error(
    times_s: &[f64],
    estimated: &[f64],
    true_times_s: &[f64],
    truth: &[f64],
    segment_m: f64,
) -> Option<f64> {
    let motion = true_times_s.iter().zip(poses(truth)).map(|(&time_s, pose)| MotionSample {
        time_s,
        yaw_rate_radps: f64::NAN,
        speed_mps: None,
        pose,
    });
    let log = DriveLog { motion: motion.collect(), ..DriveLog::default() };
    let both = times_s.iter().zip(poses(estimated));
    let known = both.filter_map(|(&time_s, pose)| Some((pose?, log.pose_at(time_s, TRUTH_GAP_S)?)));
    trajectory::relative_error(known, segment_m)
}

/// Poses of which all numbers are known.
fn poses(numbers: &[f64]) -> impl Iterator<Item = Option<Pose>> {
    numbers.chunks_exact(3).map(|p| {
        let pose = Pose { x_m: p[0], y_m: p[1], yaw_rad: p[2].to_radians() };
        p.iter().all(|number| number.is_finite()).then_some(pose)
    })
}
