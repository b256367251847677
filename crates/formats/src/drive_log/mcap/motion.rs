//! The car's motion, from `nav_msgs/Odometry`, `geometry_msgs/TwistStamped` and
//! `TwistWithCovarianceStamped`, `sensor_msgs/Imu`, and others with a speed and a yaw rate of these names.

use crate::ros::{Definitions, Value};
use boresight_core::drive::{DriveLog, MotionSample, Pose};

/// Longest gap that the speed is interpolated over where it is from another topic than the yaw rate, s.
const MAX_GAP_S: f64 = 0.25;

/// Where speed, rate of turn and pose stand in a message.
pub(super) struct MotionPaths {
    speed: Option<Vec<usize>>,
    rates: Option<[Vec<usize>; 3]>,
    rate: Option<Vec<usize>>,
    pose: Option<[Vec<usize>; 6]>,
}

/// What one message says of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MotionRow {
    pub speed_mps: Option<f64>,
    /// About the axes of the frame it is told in.
    pub rates_radps: [f64; 3],
    pub pose: Option<Pose>,
}

/// A topic with motion, its rows with their times in order.
pub(super) struct MotionTopic<'a> {
    pub rows: Vec<(f64, &'a MotionRow)>,
    /// From the axes the rates are about to the car's z.
    pub upwards: [f64; 3],
    pub has_speed: bool,
}

impl MotionPaths {
    /// Of a message that has a yaw rate, or a speed.
    pub fn of(definitions: &Definitions) -> Option<Self> {
        let path = |name: &str| definitions.path(0, name);
        // Without a time of its own a twist is a command.
        path("header.stamp")?;
        let twist = ["twist.twist", "twist"].into_iter().find(|twist| {
            path(twist).is_some_and(|_| path(&format!("{twist}.linear.x")).is_some())
        });
        let three = |of: &str| {
            Some([path(&format!("{of}.x"))?, path(&format!("{of}.y"))?, path(&format!("{of}.z"))?])
        };
        let speed = twist
            .and_then(|twist| path(&format!("{twist}.linear.x")))
            .or_else(|| path("longitudinal_velocity"));
        let rates = twist
            .and_then(|twist| three(&format!("{twist}.angular")))
            .or_else(|| three("angular_velocity"));
        let rate = path("heading_rate");
        let pose = (|| {
            let [x, y, _] = three("pose.pose.position")?;
            let turn = |name: &str| path(&format!("pose.pose.orientation.{name}"));
            Some([x, y, turn("x")?, turn("y")?, turn("z")?, turn("w")?])
        })();
        let any = rates.is_some() || rate.is_some();
        any.then_some(Self { speed, rates, rate, pose })
    }

    pub fn has_pose(&self) -> bool {
        self.pose.is_some()
    }

    pub fn has_speed(&self) -> bool {
        self.speed.is_some()
    }

    /// What it is used for, in words.
    pub fn words(&self) -> &'static str {
        match (&self.speed, &self.pose) {
            (Some(_), Some(_)) => "speed, yaw rate and pose",
            (Some(_), None) => "speed and yaw rate",
            _ => "yaw rate",
        }
    }

    pub fn read(&self, message: &Value<'_>) -> MotionRow {
        let number = |path: &[usize]| message.number(path).unwrap_or(f64::NAN);
        let rates_radps = match (&self.rates, &self.rate) {
            (Some([x, y, z]), _) => [x, y, z].map(|path| number(path)),
            (None, Some(rate)) => [0.0, 0.0, number(rate)],
            (None, None) => [f64::NAN; 3],
        };
        let pose = self.pose.as_ref().map(|paths| {
            let [x_m, y_m, x, y, z, w] = paths.each_ref().map(|path| number(path));
            let yaw_rad = (2.0 * (x * y + z * w)).atan2(w * w + x * x - y * y - z * z);
            Pose { x_m, y_m, yaw_rad }
        });
        MotionRow { speed_mps: self.speed.as_ref().map(|path| number(path)), rates_radps, pose }
    }
}

impl MotionTopic<'_> {
    /// Its rows as samples: those that are no finite numbers too.
    fn samples(&self) -> impl Iterator<Item = MotionSample> {
        self.rows.iter().map(|(time_s, row)| MotionSample {
            time_s: *time_s,
            // What does not point upwards may be unknown.
            yaw_rate_radps: row
                .rates_radps
                .iter()
                .zip(self.upwards)
                .filter(|(_, up)| *up != 0.0)
                .map(|(rate, up)| rate * up)
                .sum(),
            speed_mps: row.speed_mps,
            pose: row.pose,
        })
    }

    /// The samples of the log: those of the topic, or with speed and pose from `speeds` at the times of
    /// this one's yaw rates.
    pub fn joined(&self, speeds: Option<&MotionTopic<'_>>) -> Vec<MotionSample> {
        let Some(speeds) = speeds else { return self.samples().collect() };
        let mut motion: Vec<_> = speeds.samples().filter(is_finite_beside_rate).collect();
        motion.dedup_by_key(|sample| sample.time_s);
        let log = DriveLog { motion, ..DriveLog::default() };
        let at = |sample: MotionSample| MotionSample {
            speed_mps: log.speed_at(sample.time_s, MAX_GAP_S),
            pose: log.pose_at(sample.time_s, MAX_GAP_S),
            ..sample
        };
        self.samples().map(at).collect()
    }
}

fn is_finite_beside_rate(sample: &MotionSample) -> bool {
    let pose = sample.pose.is_none_or(|p| (p.x_m + p.y_m + p.yaw_rad).is_finite());
    sample.speed_mps.is_none_or(f64::is_finite) && pose
}
