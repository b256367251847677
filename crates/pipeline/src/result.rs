//! What the chain gives.

use boresight_core::{Complex64, Remark};
use boresight_options::shaped::ComplexArray;
use boresight_options::{Described, Flat, columns, decibels};
use ndarray::{Array2, Array3};
use serde::{Serialize, Serializer};

/// A target in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct Detection {
    /// Frame, from 0; the first one where frames were combined.
    pub frame: usize,
    /// Range, interpolated between bins and corrected for the range rate.
    pub range_m: f64,
    /// Range rate, positive when receding, interpolated between bins, in its fold.
    pub rate_mps: f64,
    /// Azimuth, positive to the left.
    pub azimuth_rad: f64,
    /// Elevation, positive upwards; 0 where the array does not see it.
    pub elevation_rad: f64,
    /// Place forward of the sensor.
    pub x_m: f64,
    /// Place to its left.
    pub y_m: f64,
    /// Place above it; 0 where the array sees no elevation.
    pub z_m: f64,
    /// Power of one raw sample at one element over full scale (1.0), interpolated between bins.
    #[serde(rename = "power_db", serialize_with = "decibels::serialize")]
    pub power: f64,
    /// Its power in its cell over the noise around the cell.
    #[serde(rename = "snr_db", serialize_with = "decibels::serialize")]
    pub snr: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
    /// Times twice the waveform's largest rate that the rate is beyond that of its bin: 0 where no
    /// other was tried, or none is certain enough.
    pub doppler_fold: i32,
    /// Probability of the likeliest fold among those tried; below 0.99 the rate keeps that of its
    /// bin. Absent where no other was tried.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fold_probability: Option<f64>,
}

/// A cell of the range-Doppler map that stands out of the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectedCell {
    /// Range, m, interpolated between bins and corrected for the range rate.
    pub range_m: f64,
    /// Range rate, m/s, positive when receding, interpolated between bins, in its fold.
    pub rate_mps: f64,
    /// Fold of the rate, as in [`Detection::doppler_fold`].
    pub doppler_fold: i32,
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
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct FrameCells {
    /// The cells, strongest first.
    #[option(described_as = Flat<CellColumns>)]
    #[serde(serialize_with = "as_columns")]
    pub cells: Vec<DetectedCell>,
    /// Cells x elements (x frames where there are several), the transmitters' Doppler phase taken off.
    #[option(described_as = ComplexArray)]
    #[serde(serialize_with = "as_snapshots")]
    pub snapshots: Array3<Complex64>,
    /// What became of cells and samples.
    pub counts: Counts,
}

/// What became of cells and samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize)]
#[option(name = "FrameCounts")]
pub struct Counts {
    /// Cells above their threshold.
    pub cells_over_threshold: usize,
    /// Of these, cells grouped under a stronger neighbour.
    pub grouped: usize,
    /// Of these, echoes of stronger targets in other bands of Doppler division.
    pub other_bands: usize,
    /// Cells whose fold of the range rate is not certain; they keep that of their bin.
    pub undecided_folds: usize,
    /// Cells nearer than 4 range resolutions, where antennas couple, or beyond 0.9 of the unambiguous range, where filters
    /// attenuate; none where the region names a range.
    pub outside_usable_range: usize,
    /// Cells and detections outside the region.
    pub outside_region: usize,
    /// Cells and detections beyond the most to report.
    pub beyond_limit: usize,
    /// Cells in which the method found no angle.
    pub without_angle: usize,
    /// Samples at an end of the converter's range.
    pub clipped_samples: usize,
}

impl Counts {
    /// What a reader should know of them.
    pub(crate) fn remarks(&self, usable_range_m: [f64; 2]) -> Vec<Remark> {
        let [nearest, furthest] = usable_range_m;
        let mut remarks = vec![];
        let mut remark = |count: usize, code: &'static str, text: String| {
            if count > 0 {
                remarks.push(Remark::new(code, text));
            }
        };
        remark(
            self.outside_usable_range,
            "outside-usable-range",
            format!(
                "{} cells nearer than {nearest:.2} m or beyond {furthest:.1} m are left out; a region with a range keeps them",
                self.outside_usable_range
            ),
        );
        remark(
            self.without_angle,
            "cells-without-angle",
            format!("{} cells have no angle", self.without_angle),
        );
        remark(
            self.undecided_folds,
            "undecided-folds",
            format!(
                "{} cells do not tell the fold of their range rate and keep that of their bin",
                self.undecided_folds
            ),
        );
        remarks
    }
}

/// The remark on samples at an end of the converter's range.
pub(crate) fn clipped(samples: usize) -> Option<Remark> {
    let message = format!("{samples} samples are clipped: powers and angles may be wrong");
    (samples > 0).then(|| Remark::new("clipped-samples", message))
}

impl FrameResult {
    /// Counts clipped samples, and remarks on them.
    pub(crate) fn set_clipped(&mut self, samples: usize) {
        self.counts.clipped_samples = samples;
        self.warnings.extend(clipped(samples));
    }
}

/// Result of one frame, or of several combined.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct FrameResult {
    /// Frame, from 0; the first one where frames were combined.
    pub frame: usize,
    /// Frames that went in.
    pub frames: usize,
    /// Whether an array's calibration was applied.
    pub calibrated: bool,
    /// Range of each range bin.
    #[serde(serialize_with = "columns::serialize")]
    pub range_m: Vec<f64>,
    /// Range rate of each Doppler bin, ascending.
    #[serde(serialize_with = "columns::serialize")]
    pub rate_mps: Vec<f64>,
    /// Largest range rate of either sign that detections tell from others: that of the Doppler
    /// bins, or more where folds are told.
    pub unambiguous_rate_mps: f64,
    /// Power over range: mean over channels, sum over Doppler.
    #[serde(serialize_with = "columns::serialize")]
    pub range_profile_db: Vec<f64>,
    /// Power over range and Doppler: mean over channels.
    #[option(described_as = Flat<RangeDopplerMap<'static>>)]
    #[serde(serialize_with = "with_shape")]
    pub range_doppler_db: Array2<f32>,
    /// Detections, strongest first.
    pub detections: Vec<Detection>,
    /// What became of cells and samples.
    pub counts: Counts,
    /// Remarks of the estimator, each kind once, and of the chain.
    pub warnings: Vec<Remark>,
}

/// A map with its shape.
#[derive(Described, Serialize)]
struct RangeDopplerMap<'a> {
    /// Power over range and Doppler (Doppler fastest): mean over channels.
    #[option(described_as = Vec<f32>)]
    #[serde(serialize_with = "columns::serialize_array")]
    range_doppler_db: &'a Array2<f32>,
    /// Range bins, then Doppler bins.
    #[option(typescript = "[range: number, doppler: number]")]
    shape: [usize; 2],
}

fn with_shape<S: Serializer>(map: &Array2<f32>, serializer: S) -> Result<S::Ok, S::Error> {
    Flat(RangeDopplerMap { range_doppler_db: map, shape: map.dim().into() }).serialize(serializer)
}

/// Cells as columns.
#[derive(Described, Serialize)]
struct CellColumns {
    /// Range of each cell, interpolated between bins and corrected for the range rate.
    #[serde(serialize_with = "columns::serialize")]
    range_m: Vec<f64>,
    /// Range rate of each, positive when receding, interpolated between bins.
    #[serde(serialize_with = "columns::serialize")]
    rate_mps: Vec<f64>,
    /// Times twice the waveform's largest rate that each is beyond that of its bin.
    #[serde(serialize_with = "columns::serialize")]
    doppler_fold: Vec<i8>,
    /// Power of each: one raw sample at one element over full scale (1.0).
    #[serde(rename = "power_db", serialize_with = "decibels::serialize_each")]
    power: Vec<f64>,
    /// Over the noise around the cell.
    #[serde(rename = "snr_db", serialize_with = "decibels::serialize_each")]
    snr: Vec<f64>,
    /// Range bin of each.
    #[serde(serialize_with = "columns::serialize")]
    range_bin: Vec<u32>,
    /// Doppler bin of each.
    #[serde(serialize_with = "columns::serialize")]
    doppler_bin: Vec<u32>,
}

fn as_columns<S: Serializer>(cells: &[DetectedCell], serializer: S) -> Result<S::Ok, S::Error> {
    let column = |of: fn(&DetectedCell) -> f64| cells.iter().map(of).collect();
    let bins = |of: fn(&DetectedCell) -> usize| cells.iter().map(|cell| of(cell) as u32).collect();
    let columns = CellColumns {
        range_m: column(|cell| cell.range_m),
        rate_mps: column(|cell| cell.rate_mps),
        // At most 32.
        doppler_fold: cells.iter().map(|cell| cell.doppler_fold as i8).collect(),
        power: column(|cell| cell.power),
        snr: column(|cell| cell.snr),
        range_bin: bins(|cell| cell.range_bin),
        doppler_bin: bins(|cell| cell.doppler_bin),
    };
    Flat(columns).serialize(serializer)
}

/// Snapshots of one frame lose the axis of frames.
fn as_snapshots<S: Serializer>(all: &Array3<Complex64>, serializer: S) -> Result<S::Ok, S::Error> {
    let mut snapshots = ComplexArray::from(all);
    if snapshots.shape.last() == Some(&1) {
        snapshots.shape.pop();
    }
    snapshots.serialize(serializer)
}
