//! What calibration gives.

use boresight_core::{ArrayCalibration, Direction, Remark};
use boresight_options::{Described, Flat, decibels};
use serde::Serialize;

/// Cells of data not used, as the plan has them and once calibrated.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct CalibrationCheck {
    /// Frames it was made from.
    pub frames: usize,
    /// Over all cells, as the plan has them.
    pub before: CheckFigures,
    /// Once calibrated.
    pub after: CheckFigures,
    /// The cells.
    pub cells: Vec<CheckedCell>,
}

/// How far cells are from one plane wave each.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize)]
pub struct CheckFigures {
    /// Root mean square of the phase that is left.
    pub residual_phase_rad: f64,
    /// Root mean square of the gain that is left.
    pub residual_gain_db: f64,
    /// Power that is left over that of the cells.
    pub residual_db: f64,
    /// Highest sidelobe of the conventional beam over its peak, in the cell where it is highest.
    pub sidelobe_db: f64,
}

/// One cell.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct CheckedCell {
    /// Its range.
    pub range_m: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
    /// Azimuth as the plan has it.
    pub azimuth_before_rad: f64,
    /// Azimuth once calibrated.
    pub azimuth_rad: f64,
    /// Elevation once calibrated; 0 where the array does not see it.
    pub elevation_rad: f64,
    /// As the plan has it.
    pub before: CheckFigures,
    /// Once calibrated.
    pub after: CheckFigures,
}

/// A calibration, and what it was made of.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "ArrayCalibrationResult")]
pub struct CalibrationResult {
    /// The calibration.
    pub calibration: ArrayCalibration,
    /// The cells, in the order they were given in.
    pub cells: Vec<UsedCell>,
    /// How it does on data that it was not made from; absent where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub check: Option<CalibrationCheck>,
    /// Each cell under a calibration from the others; absent for fewer than three.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_out: Option<CheckFigures>,
    /// What a reader should know.
    pub warnings: Vec<Remark>,
}

/// A cell that was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
#[option(name = "CalibrationCell")]
pub struct UsedCell {
    /// Its range.
    pub range_m: f64,
    /// Its range rate, positive when receding.
    pub rate_mps: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
    /// Power of its target in all snapshots over the noise of one.
    #[serde(rename = "snr_db", serialize_with = "decibels::serialize")]
    pub snr: f64,
    /// Where its target is: as given, or as found with the calibration.
    pub direction: Flat<Direction>,
    /// Power left once one plane wave is fitted, over that of the cell.
    #[serde(rename = "residual_db", serialize_with = "decibels::serialize")]
    pub residual: f64,
    /// Whether it was used.
    pub state: CellUse,
}

/// What became of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CellUse {
    /// It was used.
    Used,
    /// Its target is too weak.
    Weak,
    /// Its snapshots do not lie on one line: several targets with phases of their own.
    SeveralTargets,
    /// One plane wave does not fit it under the errors that all cells share.
    DoesNotFit,
}
