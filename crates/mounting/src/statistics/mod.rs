//! Statistics of a drive log: what its radars, its yaw rate and its speed are like, whoever recorded
//! or simulated them, so that drives can be set side by side.

mod angles;
mod counts;
pub(crate) mod frames;
mod noise;
pub(crate) mod robust;
mod speed;

use crate::error::MountingError;
use boresight_core::{DriveLog, Scan};
use boresight_math::error::check_range;
use boresight_options::{Described, Flat};
use serde::Serialize;
use std::fmt::{Display, Formatter};

/// Statistics of one radar of a log. Numbers that the log does not tell are NaN, and
/// [`Self::untold`] says why.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct SensorStatistics {
    /// The radar, by its number in the log.
    pub sensor: u8,
    /// How often it scans, and how much it detects.
    pub counts: Flat<Counts>,
    /// How its detections scatter.
    pub noise: Flat<Noise>,
    /// What its scans say of its mounting angle.
    pub angles: Flat<Angles>,
    /// Speed of the log over the radar's.
    pub speed_ratio: f64,
    /// What cannot be told, and why.
    pub untold: Vec<Untold>,
}

/// How often a radar scans, and how much it detects.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Counts {
    /// Scans.
    pub scans: u64,
    /// Detections in all of them.
    pub detections: u64,
    /// Median time from scan to scan.
    pub cycle_s: f64,
    /// Standard deviation of it, by the median absolute deviation.
    pub cycle_jitter_s: f64,
    /// Share of cycles longer than 1.5 medians.
    pub lost_share: f64,
    /// Mean number of detections a scan.
    pub mean_count: f64,
    /// Its 5 and 95 % quantiles.
    pub count_range: [f64; 2],
    /// Most detections of a scan.
    pub most: f64,
    /// Least and greatest azimuth.
    pub azimuth_span_rad: [f64; 2],
    /// Share of detections labelled as moving.
    pub moving_share: f64,
}

/// How detections of standing things scatter about the Doppler curve of their scan, in scans faster than
/// 3 m/s. Without labels all detections count as standing.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Noise {
    /// Share with a residual of more than 1 m/s.
    pub outlier_share: f64,
    /// Share with a residual of 0.3 to 1 m/s.
    pub soft_outlier_share: f64,
    /// Standard deviation of range rate at the median speed.
    pub range_rate_sigma_mps: f64,
    /// Standard deviations of azimuth at 0, 30, 50 and 65 deg to either side.
    pub azimuth_sigma_rad: [f64; 4],
}

/// What scans faster than 3 m/s say of the mounting angle, each alone, by RANSAC and least squares.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Angles {
    /// Angle less the one the log states.
    pub offset_rad: f64,
    /// Standard deviation of a scan's angle, by the median absolute deviation, without what slip explains.
    pub scatter_rad: f64,
    /// Median of the standard deviations that equation 3 of Zhu et al. states.
    pub formal_rad: f64,
    /// Standard deviation of the angles' errors, each over the one stated for it.
    pub scatter_over_formal: f64,
    /// Correlation of the errors one second apart.
    pub autocorrelation: f64,
    /// Slip angle of the rear axle over lateral acceleration, outwards, rad/(m/s^2); outside Rust in
    /// degrees.
    pub slip_gradient_rad: f64,
    /// By how much range rates lag the yaw rate.
    pub delay_s: f64,
}

impl Angles {
    fn unknown() -> Self {
        Self {
            offset_rad: f64::NAN,
            scatter_rad: f64::NAN,
            formal_rad: f64::NAN,
            scatter_over_formal: f64::NAN,
            autocorrelation: f64::NAN,
            slip_gradient_rad: f64::NAN,
            delay_s: f64::NAN,
        }
    }
}

/// Rows of the statistics that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Row {
    /// Cycle and its jitter.
    Cycle,
    /// Share labelled moving.
    MovingShare,
    /// Shares of outliers.
    Outliers,
    /// Standard deviations of range rate and azimuth.
    Noise,
    /// Scatter of frames' angles, autocorrelation and slip.
    Angles,
    /// Delay.
    Delay,
    /// Speed of the log over the radar's.
    Speed,
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Cycle => "cycle",
            Self::MovingShare => "moving share",
            Self::Outliers => "outliers",
            Self::Noise => "noise of range rate and azimuth",
            Self::Angles => "scatter of angles, autocorrelation and slip",
            Self::Delay => "delay",
            Self::Speed => "speed of the log over the radar's",
        })
    }
}

/// What a log does not tell.
#[derive(Debug, Clone, PartialEq, Eq, Described, Serialize)]
pub struct Untold {
    /// Which rows.
    pub row: Row,
    /// Why.
    pub why: String,
}

impl Untold {
    fn new(row: Row, why: &str) -> Self {
        Self { row, why: why.into() }
    }
}

/// Statistics of each radar of a log, yaw rate and speed interpolated over gaps of at most `max_gap_s`.
///
/// # Errors
/// [`boresight_core::InputError::OutOfRange`] for a gap that is no positive number.
pub fn log_statistics(
    log: &DriveLog,
    max_gap_s: f64,
) -> Result<Vec<SensorStatistics>, MountingError> {
    check_range("max_gap_s", max_gap_s, f64::MIN_POSITIVE, f64::MAX)?;
    log.sensors
        .iter()
        .map(|sensor| {
            let scans: Vec<&Scan> =
                log.scans.iter().filter(|scan| scan.sensor == sensor.id).collect();
            let mut untold = vec![];
            let counts = counts::counts(&scans, &mut untold);
            let frames = frames::frames(&scans)?;
            let noise = noise::noise(&frames, &mut untold);
            let mounting = sensor.mounting;
            let angles = angles::angles(log, &frames, mounting, max_gap_s, &mut untold);
            let speed_ratio =
                speed::ratio(log, &frames, mounting, angles.delay_s, max_gap_s, &mut untold);
            Ok(SensorStatistics {
                sensor: sensor.id,
                counts: counts.into(),
                noise: noise.into(),
                angles: angles.into(),
                speed_ratio,
                untold,
            })
        })
        .collect()
}
