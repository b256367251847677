//! The speed of the log beside that of the radar.

use super::frames::Frame;
use super::robust::median;
use super::{Row, Untold};
use boresight_core::{DriveLog, Mounting};

/// Slower scans do not count, m/s.
const MIN_SPEED_MPS: f64 = 5.0;

/// Fewest scans.
const LEAST_FRAMES: usize = 50;

/// Median of the log's speed over the radar's own at the rear axle, range rates looked up
/// `delay_s` before their stamp; NaN where it cannot be told.
pub(super) fn ratio(
    log: &DriveLog,
    frames: &[Frame],
    mounting: Option<Mounting>,
    delay_s: f64,
    max_gap_s: f64,
    untold: &mut Vec<Untold>,
) -> f64 {
    if log.motion.iter().all(|sample| sample.speed_mps.is_none()) {
        untold.push(Untold::new(Row::Speed, "the log has no speed"));
        return f64::NAN;
    }
    let Some(mounting) = mounting else {
        untold.push(Untold::new(Row::Speed, "the log does not state where the radar sits"));
        return f64::NAN;
    };
    let delay_s = if delay_s.is_finite() { delay_s } else { 0.0 };
    let ratios: Vec<f64> = frames
        .iter()
        .filter_map(|frame| {
            let time_s = frame.scan.time_s - delay_s;
            let speed = log.speed_at(time_s, max_gap_s)?;
            let yaw_rate = log.yaw_rate_at(time_s, max_gap_s)?;
            // The radar's speed is the least sensitive to its angle.
            let lateral = yaw_rate * mounting.x_m;
            let forward = (frame.speed_mps().powi(2) - lateral * lateral).max(0.0).sqrt();
            let own = forward * speed.signum() + yaw_rate * mounting.y_m;
            (speed.abs() > MIN_SPEED_MPS && own.abs() > MIN_SPEED_MPS).then_some(speed / own)
        })
        .collect();
    if ratios.len() < LEAST_FRAMES {
        untold.push(Untold::new(Row::Speed, "fewer than 50 scans at more than 5 m/s have a speed"));
        return f64::NAN;
    }
    median(&ratios)
}
