//! What a car records while it drives: radar scans as Doppler point clouds, and its own motion.
//!
//! Frames: the car's is centred on the rear axle, x forward, y left; a radar's has x along its
//! boresight. Angles are counter-clockwise positive, range rates positive when receding, so that a
//! standing target at azimuth `a` seen by a radar that moves with `(vx, vy)` in its own frame has
//! `-range_rate = vx cos a + vy sin a`.

use boresight_options::Described;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// One point of a Doppler point cloud, in the radar's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Azimuth, rad.
    pub azimuth_rad: f32,
    /// Range rate, m/s, positive when receding, not compensated for the car's motion.
    pub range_rate_mps: f32,
    /// Range, m; NaN where the log has none.
    pub range_m: f32,
    /// Radar cross-section, dBsm; NaN where the log has none.
    pub rcs_dbsm: f32,
}

impl Detection {
    /// A point cloud from its columns: azimuths in degrees and range rates, and ranges and cross-sections where they are known.
    /// The columns are as long as the first.
    pub fn of_columns(
        azimuth_deg: &[f64],
        range_rate_mps: &[f64],
        range_m: Option<&[f64]>,
        rcs_dbsm: Option<&[f64]>,
    ) -> Vec<Self> {
        let points = azimuth_deg.iter().zip(range_rate_mps);
        let mut detections: Vec<Self> = points
            .map(|(azimuth, &rate)| Self {
                azimuth_rad: azimuth.to_radians() as f32,
                range_rate_mps: rate as f32,
                range_m: f32::NAN,
                rcs_dbsm: f32::NAN,
            })
            .collect();
        for (detection, &range) in detections.iter_mut().zip(range_m.unwrap_or_default()) {
            detection.range_m = range as f32;
        }
        for (detection, &rcs) in detections.iter_mut().zip(rcs_dbsm.unwrap_or_default()) {
            detection.rcs_dbsm = rcs as f32;
        }
        detections
    }
}

/// The label of a standing object, in the numbers of `RadarScenes`.
pub const STATIC_LABEL: u8 = 11;

/// Detections one radar made at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// Time, s, on the clock of the log.
    pub time_s: f64,
    /// The radar, by its number in the log.
    pub sensor: u8,
    /// The point cloud; may be empty.
    pub detections: Vec<Detection>,
    /// A class for each detection in the numbers of `RadarScenes` ([`STATIC_LABEL`]), where the log
    /// has them; empty otherwise. No estimator reads it.
    pub labels: Vec<u8>,
}

/// Where the car's frame stands on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct Pose {
    /// East, or x of the log's global frame, m.
    pub x_m: f64,
    /// North, or y of the log's global frame, m.
    pub y_m: f64,
    /// Heading, rad, counter-clockwise from x.
    pub yaw_rad: f64,
}

/// The car's motion at one time, as its sensors report it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionSample {
    /// Time, s, on the clock of the log.
    pub time_s: f64,
    /// Yaw rate, rad/s, with whatever bias and scale error the sensor has.
    pub yaw_rate_radps: f64,
    /// Forward speed of the rear axle, m/s, negative in reverse.
    pub speed_mps: Option<f64>,
    /// Position and heading.
    pub pose: Option<Pose>,
}

/// Where a radar sits in the car's frame and which way it looks.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
pub struct Mounting {
    /// Ahead of the rear axle.
    pub x_m: f64,
    /// Left of the centre line.
    pub y_m: f64,
    /// Direction of boresight, counter-clockwise from the car's x.
    pub yaw_rad: f64,
}

/// A radar of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Its number in the log.
    pub id: u8,
    /// Its place and nominal direction, where the log states them.
    pub mounting: Option<Mounting>,
}

/// A recorded or simulated drive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DriveLog {
    /// The radars, by ascending number.
    pub sensors: Vec<Sensor>,
    /// Scans of all radars, in order of time.
    pub scans: Vec<Scan>,
    /// The car's motion, in order of time.
    pub motion: Vec<MotionSample>,
}

/// The four radars of the `RadarScenes` car (Schumann et al. 2021): number and mounting.
pub const RADARSCENES_SENSORS: [(u8, Mounting); 4] = [
    (1, Mounting { x_m: 3.663, y_m: -0.873, yaw_rad: -1.484_185_52 }),
    (2, Mounting { x_m: 3.86, y_m: -0.7, yaw_rad: -0.436_185_662 }),
    (3, Mounting { x_m: 3.86, y_m: 0.7, yaw_rad: 0.436 }),
    (4, Mounting { x_m: 3.663, y_m: 0.873, yaw_rad: 1.484 }),
];

impl DriveLog {
    /// Yaw rate at a time by linear interpolation between the neighbouring samples; `None` before
    /// the first, after the last, and in gaps longer than `max_gap_s`.
    pub fn yaw_rate_at(&self, time_s: f64, max_gap_s: f64) -> Option<f64> {
        self.around(time_s, max_gap_s)?.mix(|at| Some(self.motion[at].yaw_rate_radps))
    }

    /// Forward speed at a time, as [`Self::yaw_rate_at`].
    pub fn speed_at(&self, time_s: f64, max_gap_s: f64) -> Option<f64> {
        self.around(time_s, max_gap_s)?.mix(|at| self.motion[at].speed_mps)
    }

    /// Pose at a time, as [`Self::yaw_rate_at`]; the heading turns the shorter way.
    pub fn pose_at(&self, time_s: f64, max_gap_s: f64) -> Option<Pose> {
        let around = self.around(time_s, max_gap_s)?;
        let pose = |at: usize| self.motion[at].pose;
        let (a, b) = (pose(around.previous)?, pose(around.next)?);
        let turn = b.yaw_rad - a.yaw_rad;
        Some(Pose {
            x_m: around.mix(|at| pose(at).map(|pose| pose.x_m))?,
            y_m: around.mix(|at| pose(at).map(|pose| pose.y_m))?,
            yaw_rad: a.yaw_rad + around.share * (turn - TAU * (turn / TAU).round()),
        })
    }

    fn around(&self, time_s: f64, max_gap_s: f64) -> Option<Neighbours> {
        neighbours(&self.motion, |sample| sample.time_s, time_s, max_gap_s)
    }
}

/// The value at a time by linear interpolation, of values at times in order; `None` before the first, after the last, in
/// gaps longer than `max_gap_s`, and where there is no value for a neighbouring time.
pub fn interpolated(times_s: &[f64], values: &[f64], time_s: f64, max_gap_s: f64) -> Option<f64> {
    let at = neighbours(times_s, |time_s| *time_s, time_s, max_gap_s)?;
    at.mix(|index| values.get(index).copied())
}

/// The entries before and after a time, and its share of the way between them.
struct Neighbours {
    previous: usize,
    next: usize,
    share: f64,
}

fn neighbours<T>(
    entries: &[T],
    time_of: impl Fn(&T) -> f64,
    time_s: f64,
    max_gap_s: f64,
) -> Option<Neighbours> {
    let next = entries.partition_point(|entry| time_of(entry) < time_s);
    let after = time_of(entries.get(next)?);
    if after == time_s {
        return Some(Neighbours { previous: next, next, share: 0.0 });
    }
    let previous = next.checked_sub(1)?;
    let before = time_of(&entries[previous]);
    let gap = after - before;
    (gap <= max_gap_s).then(|| Neighbours { previous, next, share: (time_s - before) / gap })
}

impl Neighbours {
    fn mix(&self, value: impl Fn(usize) -> Option<f64>) -> Option<f64> {
        Some(value(self.previous)? * (1.0 - self.share) + value(self.next)? * self.share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(times: &[f64]) -> DriveLog {
        let motion = times
            .iter()
            .map(|&time_s| MotionSample {
                time_s,
                yaw_rate_radps: 2.0 * time_s,
                speed_mps: Some(time_s + 1.0),
                pose: None,
            })
            .collect();
        DriveLog { motion, ..DriveLog::default() }
    }

    #[test]
    fn interpolation_is_exact_on_a_line_and_stops_at_gaps_and_ends() {
        let log = log(&[0.0, 1.0, 4.0]);
        assert_eq!(log.yaw_rate_at(0.25, 1.5), Some(0.5));
        assert_eq!(log.speed_at(1.0, 1.5), Some(2.0));
        assert_eq!(log.yaw_rate_at(2.0, 1.5), None);
        assert_eq!(log.yaw_rate_at(-0.1, 1.5), None);
        assert_eq!(log.yaw_rate_at(4.1, 1.5), None);
        assert_eq!(DriveLog::default().yaw_rate_at(0.0, 1.0), None);
    }

    #[test]
    fn headings_turn_the_shorter_way_and_poses_may_be_missing() {
        let mut log = log(&[0.0, 1.0, 2.0]);
        let pose = |x_m: f64, yaw_rad: f64| Some(Pose { x_m, y_m: -x_m, yaw_rad });
        (log.motion[0].pose, log.motion[1].pose) = (pose(1.0, 3.0), pose(3.0, -3.0));
        let between = log.pose_at(0.25, 1.0).unwrap();
        assert_eq!((between.x_m, between.y_m), (1.5, -1.5));
        assert!((between.yaw_rad - (3.0 + 0.25 * (TAU - 6.0))).abs() < 1e-15);
        assert_eq!(log.pose_at(1.0, 1.0), pose(3.0, -3.0));
        assert_eq!(log.pose_at(1.5, 1.0), None);
        assert_eq!(log.pose_at(0.5, 0.9), None);
    }
}
