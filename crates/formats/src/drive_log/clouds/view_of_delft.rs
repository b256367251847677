//! Frames of the View-of-Delft data set: `NUMBER.bin`, seven `f32` a point, little endian: x, y, z (m, in the radar's frame), cross-section, range
//! rate, range rate with the car's motion taken out (not used), and which scan the point is of: 0 the frame's own, -1 the one before, and so on.
//!
//! Frames follow the lidar at 10 Hz, each with the radar's scan nearest in time (of some 13 a second, up to 40 ms away), so that
//! times are those of the frames' numbers. Points of earlier scans, in the sets of three and five scans, belong to frames before and are left out.
//! Where the radar sits on the car is not stated.
//!
//! `pose/NUMBER.json` has three lines, each an object of one transformation, 4 x 4 in rows, from the camera to a frame of the ground; read is
//! `odomToCamera`. The camera looks along its z axis, which is taken as the car's heading. It is not at the rear axle, so that yaw rate and
//! speed along the heading are taken from it, and no pose.

use super::poses::TimedPose;
use crate::drive_log::report::{DropReason, ReadReport};
use crate::error::FormatError;
use boresight_core::drive::{Detection, Pose};
use serde::Deserialize;
use std::io::Read;

/// Numbers of a point, and their bytes.
const NUMBERS: usize = 7;
const POINT_BYTES: usize = 4 * NUMBERS;
/// Time from frame to frame, ns.
const FRAME_NS: i128 = 100_000_000;
/// A pose takes less than a kilobyte.
const MOST_POSE_BYTES: u64 = 1 << 16;

/// The number of a frame in a file's name of an ending.
pub(super) fn frame_of(path: &str, ending: &str) -> Option<u64> {
    let stem = super::base(path).strip_suffix(ending)?;
    let is_number = (4..=9).contains(&stem.len()) && stem.bytes().all(|byte| byte.is_ascii_digit());
    stem.parse().ok().filter(|_| is_number)
}

pub(super) fn stamp_ns(path: &str) -> Result<i128, FormatError> {
    let frame = frame_of(path, ".bin").ok_or_else(|| FormatError::NoDriveLog {
        expected: "the number of its frame as name, as in 00549.bin".into(),
        given: super::base(path).chars().take(60).collect(),
    })?;
    Ok(i128::from(frame) * FRAME_NS)
}

pub(super) fn points(bytes: &[u8], report: &mut ReadReport) -> Result<Vec<Detection>, FormatError> {
    let (points, rest) = bytes.as_chunks::<POINT_BYTES>();
    let wrong = |offset, what: &str, expected: &str, given: String| FormatError::Binary {
        format: "View-of-Delft",
        offset,
        what: what.into(),
        expected: expected.into(),
        given,
    };
    if !rest.is_empty() {
        let given = format!("{} bytes", bytes.len());
        return Err(wrong(bytes.len() - rest.len(), "the points", "28 bytes each", given));
    }
    let mut detections = vec![];
    for (i, point) in points.iter().enumerate() {
        report.detections += 1;
        let number = |k: usize| {
            let mut word = [0; 4];
            word.copy_from_slice(&point[4 * k..4 * k + 4]);
            f64::from(f32::from_le_bytes(word))
        };
        let scan = number(6);
        // Of other files of seven numbers a point: they are none of these.
        if !(-100.0..=0.0).contains(&scan) || scan.fract() != 0.0 {
            let expected = "0 or a whole number below";
            return Err(wrong(
                POINT_BYTES * i + 24,
                "the scan of a point",
                expected,
                scan.to_string(),
            ));
        }
        if scan != 0.0 {
            report.drop(DropReason::EarlierScan);
        } else if let Some(detection) =
            super::points::detection([0, 1, 2].map(number), number(4), number(3))
        {
            report.incomplete += u64::from(detection.rcs_dbsm.is_nan());
            detections.push(detection);
        } else {
            report.drop(DropReason::NotFinite);
        }
    }
    Ok(detections)
}

#[derive(Deserialize)]
struct PoseLine {
    #[serde(rename = "odomToCamera")]
    odom_to_camera: Option<[f64; 16]>,
}

pub(super) fn pose(frame: u64, source: impl Read) -> Result<TimedPose, FormatError> {
    let wrong = |given: String| FormatError::Json {
        file: "pose of a frame",
        expected: "lines of JSON, one with 16 numbers as odomToCamera",
        given,
    };
    let mut text = String::new();
    let read = source.take(MOST_POSE_BYTES).read_to_string(&mut text);
    read.map_err(|error| wrong(error.to_string()))?;
    let lines = serde_json::Deserializer::from_str(&text).into_iter::<PoseLine>();
    for line in lines {
        let line = line.map_err(|error| wrong(error.to_string()))?;
        if let Some(matrix) = line.odom_to_camera {
            let yaw_rad = matrix[6].atan2(matrix[2]);
            let pose = Pose { x_m: matrix[3], y_m: matrix[7], yaw_rad };
            return Ok(TimedPose { stamp_ns: i128::from(frame) * FRAME_NS, pose });
        }
    }
    Err(wrong("none".into()))
}
