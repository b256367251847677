//! Options of array calibration.

use boresight_core::Direction;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// What is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CalibrationModel {
    /// Gain and phase of each channel.
    #[default]
    Channels,
    /// These, and where each element is, along the axes the array spans; from targets at several angles.
    Positions,
    /// Gain and phase, and coupling between all channels; from targets at as many known angles as
    /// there are channels.
    Coupling,
}

/// A target to calibrate by.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct Reflector {
    /// Its range: the strongest cell within two range resolutions is taken.
    #[option(range = 0..=1e6, required)]
    pub range_m: f64,
    /// Its azimuth, positive to the left; unknown where absent.
    #[option(range = -90..=90)]
    pub azimuth_rad: Option<f64>,
    /// Its elevation, positive upwards; counts with an azimuth.
    #[option(range = -90..=90)]
    pub elevation_rad: f64,
}

impl Reflector {
    /// Its direction where that is known.
    pub fn direction(&self) -> Option<Direction> {
        self.azimuth_rad.map(|azimuth_rad| Direction::new(azimuth_rad, self.elevation_rad))
    }
}

/// How an array is calibrated.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[option(name = "ArrayCalibrationOptions")]
#[serde(default)]
pub struct CalibrationOptions {
    /// What is estimated.
    pub model: CalibrationModel,
    /// Targets to calibrate by; all strong cells where none are named.
    #[option(default = vec![])]
    pub reflectors: Vec<Reflector>,
    /// Whether the ranges of the reflectors are exact, so that what measured ranges are too long by
    /// can be told.
    pub range_bias: bool,
    /// Least power of a cell's target in all of its snapshots, over the noise of one.
    #[option(default = 15.0, range = -300..=300)]
    pub min_snr_db: f64,
    /// Most cells; the strongest are taken.
    #[option(default = 64, range = 1..=4096)]
    pub max_cells: usize,
    /// Greatest power that may be left of a cell once one plane wave is fitted, over that of the
    /// cell. Others hold several targets or reflections, and are left out.
    #[option(default = -12.0, range = -100..=0)]
    pub max_residual_db: f64,
}
