//! Options of regions.

use crate::error::PipelineError;
use boresight_options::{Described, Flat, Naming, check};
use boresight_signal::region::RegionOptions;
use boresight_signal::{CfarOptions, Region, Window};
use serde::{Deserialize, Serialize};

/// When a region is turned to its coarse angle, so that what was made for a sector about boresight applies anywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rotation {
    /// Never, as in the paper.
    Never,
    /// Where the coarse angle lies outside the sector.
    #[default]
    Outside,
    /// Always.
    Always,
}

/// How frames become regions, and these targets.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct RegionChainOptions {
    /// Range bins and chirps of a region.
    pub size: Flat<RegionOptions>,
    /// Range bins on each side of a region's middle that count; bins beyond are set to zero, and peaks there begin
    /// regions of their own. All that the region holds if absent.
    pub reach_bins: Option<usize>,
    /// Window over the samples of a chirp for detection.
    pub range_window: Window,
    /// Window over the samples of a chirp for what networks take; they were trained without.
    #[option(default = Window::Rectangular)]
    pub region_window: Window,
    /// Diagonal loading of the covariance that targets are counted in, as a share of the mean element power. Arrays
    /// that differ from their drawing need it, since a network trained on exact ones takes the difference for a target.
    #[option(range = 0..=1e6)]
    pub count_loading: f64,
    /// Detection on the power over range, mean over elements and chirps. Training cells always lie along range.
    pub cfar: CfarOptions,
    /// Limits outside which peaks make no region; the angle's hold for targets. Where they name no range, that is from
    /// 4 range resolutions to 0.9 of the unambiguous range.
    pub region: Region,
    /// Whether regions are turned to their coarse angle.
    pub rotation: Rotation,
    /// Half width of the sector about boresight in which a region is not turned unless it always is.
    #[option(default = 10.5_f64.to_radians(), range = 0..=90)]
    pub sector_rad: f64,
    /// Refine the angles on the matched model, beyond whole degrees; those that noise explains are dropped.
    pub refine: bool,
    /// Probability that noise alone adds a target to a region (joint estimation).
    #[option(default = 1e-2, range = 1e-12..=0.5)]
    pub false_alarm: f64,
    /// Power of unknown array errors relative to each target, which joint estimation does not report as further targets.
    /// Gain errors of 1 dB and phase errors of 10 deg give -13.6. Default: the residual of the array's calibration, or none.
    #[option(range = -100..=0)]
    pub mismatch_db: Option<f64>,
    /// Most regions a frame; those with the strongest peaks are kept.
    #[option(default = 32, range = 1..=1024)]
    pub max_regions: usize,
}

impl RegionChainOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] naming the option.
    pub fn check(&self) -> Result<(), PipelineError> {
        self.region.check()?;
        Ok(check(self, Naming::Rust)?)
    }
}
