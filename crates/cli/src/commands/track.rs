//! The car's way as a radar saw it, held against the poses of the log.

use boresight_core::drive::{DriveLog, Pose};
use boresight_mounting::trajectory::{TimedMotion, integrate, relative_error};
use boresight_mounting::{CalibrationOptions, FrameOutcome};

/// The radar's motion and the car's logged pose, frame by frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Track {
    motions: Vec<TimedMotion>,
    logged: Vec<Option<Pose>>,
}

impl Track {
    /// Takes a frame, if its motion is known.
    pub(super) fn add(
        &mut self,
        log: &DriveLog,
        options: &CalibrationOptions,
        outcome: &FrameOutcome,
    ) {
        let Some(motion) = outcome.motion else { return };
        let motion = TimedMotion {
            time_s: outcome.time_s,
            velocity_mps: motion.velocity_mps,
            yaw_rate_radps: None,
        };
        self.push(log, options, motion);
    }

    /// Takes a motion.
    pub(super) fn push(
        &mut self,
        log: &DriveLog,
        options: &CalibrationOptions,
        motion: TimedMotion,
    ) {
        self.logged.push(log.pose_at(motion.time_s, options.max_gap_s));
        self.motions.push(motion);
    }

    fn poses(&self, angle_rad: f64, options: &CalibrationOptions) -> Option<Vec<Pose>> {
        integrate(&self.motions, angle_rad, options.x_m, options.y_m)
    }

    /// Relative error of the trajectory with an angle over segments of a length, m; `None` without poses or a trajectory, or
    /// where the car drove less than a segment.
    pub(super) fn error_m(
        &self,
        angle_rad: f64,
        options: &CalibrationOptions,
        segment_m: f64,
    ) -> Option<f64> {
        let poses = self.poses(angle_rad, options)?;
        let known = poses
            .into_iter()
            .zip(&self.logged)
            .filter_map(|(pose, logged)| Some((pose, (*logged)?)));
        relative_error(known, segment_m)
    }

    /// The trajectory with an angle as CSV, from the origin along x, and beside it the logged one,
    /// moved to where the first has its first logged pose.
    pub(super) fn csv(&self, angle_rad: f64, options: &CalibrationOptions) -> Option<String> {
        let poses = self.poses(angle_rad, options).filter(|poses| !poses.is_empty())?;
        let anchor = poses.iter().zip(&self.logged).find_map(|(a, b)| Some((*a, (*b)?)));
        let mut text = "time_s,x_m,y_m,yaw_deg".to_owned();
        if anchor.is_some() {
            text += ",logged_x_m,logged_y_m,logged_yaw_deg";
        }
        text.push('\n');
        for ((motion, pose), logged) in self.motions.iter().zip(poses).zip(&self.logged) {
            text += &format!("{:.6},{}", motion.time_s, fields(pose));
            text += &match (anchor, logged) {
                (Some((to, from)), Some(logged)) => {
                    format!(",{}", fields(moved(*logged, from, to)))
                }
                (Some(_), None) => ",,,".into(),
                (None, _) => String::new(),
            };
            text.push('\n');
        }
        Some(text)
    }
}

fn fields(pose: Pose) -> String {
    format!("{:.4},{:.4},{:.5}", pose.x_m, pose.y_m, pose.yaw_rad.to_degrees())
}

/// A pose by the motion of the plane that takes `from` to `to`.
fn moved(pose: Pose, from: Pose, to: Pose) -> Pose {
    let turn = to.yaw_rad - from.yaw_rad;
    let (sin, cos) = turn.sin_cos();
    let (x, y) = (pose.x_m - from.x_m, pose.y_m - from.y_m);
    Pose {
        x_m: to.x_m + cos * x - sin * y,
        y_m: to.y_m + sin * x + cos * y,
        yaw_rad: pose.yaw_rad + turn,
    }
}
