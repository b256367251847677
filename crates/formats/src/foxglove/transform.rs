//! Where radars are on the car, and the car in the world.

use super::messages::{FrameTransform, Quaternion, Time, Vector3};
use super::{CAR, WORLD, frame_id};
use boresight_core::drive::{Mounting, Pose};

/// A radar on the car; none unless all its numbers are finite.
#[must_use]
pub fn of_radar(sensor: u8, mounting: &Mounting, time_ns: u64) -> Option<FrameTransform> {
    let Mounting { x_m, y_m, yaw_rad } = *mounting;
    transform(CAR.into(), frame_id(sensor), [x_m, y_m, yaw_rad], time_ns)
}

/// The car in the world; none unless all its numbers are finite.
#[must_use]
pub fn of_car(pose: &Pose, time_ns: u64) -> Option<FrameTransform> {
    transform(WORLD.into(), CAR.into(), [pose.x_m, pose.y_m, pose.yaw_rad], time_ns)
}

fn transform(
    parent_frame_id: String,
    child_frame_id: String,
    [x, y, yaw_rad]: [f64; 3],
    time_ns: u64,
) -> Option<FrameTransform> {
    (x.is_finite() && y.is_finite() && yaw_rad.is_finite()).then(|| FrameTransform {
        timestamp: Time::from(time_ns),
        parent_frame_id,
        child_frame_id,
        translation: Vector3 { x, y, z: 0.0 },
        rotation: Quaternion::yaw(yaw_rad),
    })
}
