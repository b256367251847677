//! What the chain gives.

use boresight_core::Complex64;
use ndarray::{Array2, Array3};

/// A target in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Frame, from 0; the first one where frames were combined.
    pub frame: usize,
    /// Range, m, interpolated between bins and corrected for the range rate.
    pub range_m: f64,
    /// Range rate, m/s, positive when receding, interpolated between bins.
    pub rate_mps: f64,
    /// Azimuth, rad, positive to the left.
    pub azimuth_rad: f64,
    /// Elevation, rad, positive upwards; 0 where the array does not see it.
    pub elevation_rad: f64,
    /// Power of one raw sample at one element, interpolated between bins; 1 is full scale.
    pub power: f64,
    /// Its power in its cell over the noise around the cell, linear.
    pub snr: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
}

/// A cell of the range-Doppler map that stands out of the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectedCell {
    /// Range, m, interpolated between bins and corrected for the range rate.
    pub range_m: f64,
    /// Range rate, m/s, positive when receding, interpolated between bins.
    pub rate_mps: f64,
    /// Power of one raw sample at one element (mean over channels), interpolated between bins; 1
    /// is full scale.
    pub power: f64,
    /// Power of the cell over the noise around it, linear.
    pub snr: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
}

/// Detected cells of a frame, or of several combined, with what estimators take.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameCells {
    /// The cells, strongest first.
    pub cells: Vec<DetectedCell>,
    /// Cells x elements x frames, the transmitters' Doppler phase taken off.
    pub snapshots: Array3<Complex64>,
    /// What became of cells and samples.
    pub counts: Counts,
}

/// What became of cells and samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Cells above their threshold.
    pub cells_over_threshold: usize,
    /// Of these, cells grouped under a stronger neighbour.
    pub grouped: usize,
    /// Cells and detections outside the region.
    pub outside_region: usize,
    /// Cells and detections beyond the most to report.
    pub beyond_limit: usize,
    /// Cells in which the method found no angle.
    pub without_angle: usize,
    /// Samples at an end of the converter's range.
    pub clipped_samples: usize,
}

/// Something a reader of the result should know; not an error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// A stable name in kebab case.
    pub code: &'static str,
    /// What it says.
    pub message: String,
}

/// Result of one frame, or of several combined.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameResult {
    /// Frame, from 0; the first one where frames were combined.
    pub frame: usize,
    /// Frames that went in.
    pub frames: usize,
    /// Range of each range bin, m.
    pub range_m: Vec<f64>,
    /// Range rate of each Doppler bin, m/s, ascending.
    pub rate_mps: Vec<f64>,
    /// Power over range, dB: mean over channels, sum over Doppler.
    pub range_profile_db: Vec<f64>,
    /// Power over range and Doppler, dB: mean over channels.
    pub range_doppler_db: Array2<f32>,
    /// Detections, strongest first.
    pub detections: Vec<Detection>,
    /// What became of cells and samples.
    pub counts: Counts,
    /// Remarks of the estimator, each kind once, and of the chain.
    pub warnings: Vec<Remark>,
}
