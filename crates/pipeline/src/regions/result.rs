//! What regions give.

use boresight_core::Remark;
use boresight_options::{Described, columns, decibels};
use serde::Serialize;

/// A target in a region.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct RegionTarget {
    /// Range of the bin in which it is strongest, interpolated and corrected for the range rate.
    pub range_m: f64,
    /// Azimuth, positive to the left.
    pub azimuth_rad: f64,
    /// Power of one raw sample at one element over full scale (1.0), of all bins of the region.
    #[serde(rename = "power_db", serialize_with = "decibels::serialize")]
    pub power: f64,
    /// Probability of its direction, where a network gave it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
    /// Standard deviation of the range (Cramer-Rao bound), from joint estimation where the data determine it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_deviation_m: Option<f64>,
    /// Standard deviation of the azimuth (Cramer-Rao bound), from joint estimation where the data determine it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth_deviation_rad: Option<f64>,
}

/// A region of the range spectrum with what was found in it.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct TargetRegion {
    /// Its middle: the strongest range bin.
    pub range_bin: usize,
    /// Range of its strongest peak, interpolated between bins and corrected for the range rate.
    pub range_m: f64,
    /// Range rate of its strongest bin, positive when receding, from the phase between loops; taken off the region.
    pub rate_mps: f64,
    /// Power of its strongest peak: one raw sample at one element over full scale (1.0).
    #[serde(rename = "power_db", serialize_with = "decibels::serialize")]
    pub power: f64,
    /// Over the noise around the peak.
    #[serde(rename = "snr_db", serialize_with = "decibels::serialize")]
    pub snr: f64,
    /// Peaks over range that belong to it.
    pub peaks: usize,
    /// Direction of its echoes together, from the phase between neighbouring elements; of an array that is not evenly
    /// spaced, by the conventional beamformer.
    pub coarse_azimuth_rad: f64,
    /// Whether it was turned so that this direction is boresight.
    pub rotated: bool,
    /// Targets counted.
    pub sources: usize,
    /// Probability of 0, 1 and 2 targets, each by itself; empty for joint estimation.
    #[serde(serialize_with = "columns::serialize")]
    pub probability: Vec<f64>,
    /// Targets, strongest first.
    pub targets: Vec<RegionTarget>,
}

/// What became of cells, peaks and targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize)]
pub struct RegionCounts {
    /// Range bins above their threshold.
    pub cells_over_threshold: usize,
    /// Of these, bins grouped under a stronger neighbour.
    pub grouped: usize,
    /// Peaks and targets outside the limits.
    pub outside_region: usize,
    /// Peaks inside the region of a stronger one.
    pub joined: usize,
    /// Regions beyond the most to report.
    pub beyond_limit: usize,
    /// Regions in which no target was counted.
    pub without_target: usize,
    /// Targets beyond 90 deg, which a turned region can give.
    pub beyond_horizon: usize,
    /// Samples at an end of the converter's range.
    pub clipped_samples: usize,
}

/// Regions of one frame.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct RegionFrame {
    /// Frame, from 0.
    pub frame: usize,
    /// Range of each range bin.
    #[serde(serialize_with = "columns::serialize")]
    pub range_m: Vec<f64>,
    /// Power over range: mean over elements and chirps, of what detection saw.
    #[serde(serialize_with = "columns::serialize")]
    pub range_profile_db: Vec<f64>,
    /// Regions, strongest peak first.
    pub regions: Vec<TargetRegion>,
    /// What became of cells, peaks and targets.
    pub counts: RegionCounts,
    /// Remarks of the estimators, each kind once.
    pub warnings: Vec<Remark>,
}
