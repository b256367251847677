//! The format of a set of data: a folder of three files, little-endian, version 1.
//!
//! `frames.bin` has 28 bytes a frame, in windows of [`WINDOW`](super::WINDOW) frames:
//!
//! | bytes | number | what |
//! |---|---|---|
//! | 0..4 | `u32` | number of the drive |
//! | 4..12 | 2 `f32` | velocity of the radar in its own frame, along boresight and to its left, m/s |
//! | 12..16 | `f32` | yaw rate, rad/s |
//! | 16..20 | `f32` | time since the window's frame before, 0 in the first, s |
//! | 20..22 | `u16` | detections |
//! | 22..24 | `u16` | how many of them come from movers |
//! | 24..26 | `i16` | direction that the radar looks in, left of the car's, 1e-4 rad |
//! | 26 | `u8` | roads, by their place in [`Scenario::ALL`](crate::Scenario::ALL) |
//! | 27 | `u8` | [`Condition`](super::Condition) |
//!
//! `detections.bin` has 8 bytes a detection, those of a frame after those of the frame before:
//!
//! | bytes | number | what |
//! |---|---|---|
//! | 0..2 | `i16` | azimuth, to the left, 5e-5 rad |
//! | 2..4 | `i16` | range rate, positive where it grows, 5 mm/s |
//! | 4..6 | `u16` | range, 1 cm |
//! | 6 | `i8` | cross-section, 0.5 dBsm |
//! | 7 | `u8` | 1 where it comes from a moving road user |
//!
//! `dataset.json` has `format`, `version`, counts and how it was made. Numbers out of range are the largest or smallest there are.
//! `research/training/boresight_training/drives/dataset.py` reads it.

use super::{Frame, Window};
use crate::drive::Scenario;
use boresight_core::drive::Detection;

/// What `dataset.json` says of itself.
pub const FORMAT: &str = "boresight-drive-dataset";
/// The version of the format.
pub const VERSION: u32 = 1;

/// Bytes of a frame and of a detection.
pub const FRAME_BYTES: usize = 28;
/// See [`FRAME_BYTES`].
pub const DETECTION_BYTES: usize = 8;

/// Steps of the whole numbers: rad, m/s, m, dBsm, and rad of the direction.
const AZIMUTH_RAD: f64 = 5e-5;
const RANGE_RATE_MPS: f64 = 0.005;
const RANGE_M: f64 = 0.01;
const RCS_DBSM: f64 = 0.5;
const DIRECTION_RAD: f64 = 1e-4;

/// Appends a window to the bytes of both files.
pub fn append(window: &Window, frames: &mut Vec<u8>, detections: &mut Vec<u8>) {
    let scenario = Scenario::ALL.iter().position(|kind| *kind == window.scenario).unwrap_or(0);
    for frame in &window.frames {
        let moving = frame.detections.iter().filter(|(_, moving)| *moving).count();
        frames.extend((window.drive as u32).to_le_bytes());
        for number in
            [frame.velocity_mps[0], frame.velocity_mps[1], frame.yaw_rate_radps, frame.dt_s]
        {
            frames.extend((number as f32).to_le_bytes());
        }
        frames.extend((frame.detections.len() as u16).to_le_bytes());
        frames.extend((moving as u16).to_le_bytes());
        frames.extend(((window.yaw_rad / DIRECTION_RAD).round() as i16).to_le_bytes());
        frames.extend([scenario as u8, window.condition as u8]);
        append_detections(frame, detections);
    }
}

fn append_detections(frame: &Frame, bytes: &mut Vec<u8>) {
    for &(Detection { azimuth_rad, range_rate_mps, range_m, rcs_dbsm }, moving) in &frame.detections
    {
        // A cast of a number out of range gives the nearest.
        let steps = |number: f32, step: f64| (f64::from(number) / step).round();
        bytes.extend((steps(azimuth_rad, AZIMUTH_RAD) as i16).to_le_bytes());
        bytes.extend((steps(range_rate_mps, RANGE_RATE_MPS) as i16).to_le_bytes());
        bytes.extend((steps(range_m, RANGE_M) as u16).to_le_bytes());
        bytes.extend((steps(rcs_dbsm, RCS_DBSM) as i8).to_le_bytes());
        bytes.push(u8::from(moving));
    }
}
