//! Options of the chain.

use crate::error::PipelineError;
use boresight_aoa::{EstimatorOptions, Method};
use boresight_core::Waveform;
use boresight_options::{Described, Flat, Naming, check};
use boresight_signal::{CfarOptions, RangeDopplerOptions, Region};
use serde::{Deserialize, Serialize};

/// Bins at zero range that the coupling from transmitters to receivers fills: the main lobe of the
/// usual windows and as much again.
const COUPLING_BINS: f64 = 4.0;

/// Share of the band of beat frequencies within which the receivers' filters are flat; those above
/// it, which of complex samples include negative ones, are attenuated or folded.
const USABLE_BAND: f64 = 0.9;

/// The range from beyond antenna coupling to the end of the receivers' band, m: 4 range resolutions
/// to 0.9 of the unambiguous range.
pub fn usable_range_m(waveform: &Waveform) -> [f64; 2] {
    [COUPLING_BINS * waveform.range_resolution_m(), USABLE_BAND * waveform.max_range_m()]
}

/// Angle estimation in each cell, on the chain's array.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct AngleOptions {
    /// Method of angle estimation.
    #[option(default = Method::Bartlett)]
    pub method: Method,
    /// Its options. For the conventional beamformer and Capon's the dynamic range is at most that
    /// between main lobe and sidelobes of the array less 6 dB; Capon's is loaded by 0.1 of the
    /// mean element power where no loading is asked for.
    pub options: Flat<EstimatorOptions>,
}

/// How frames become detections.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ChainOptions {
    /// Windows, padding and clutter removal of the transforms.
    pub range_doppler: Flat<RangeDopplerOptions>,
    /// Detection. Guard and training cells are counted in cells of unpadded transforms.
    pub cfar: CfarOptions,
    /// Keep one detection a peak: of adjacent cells over the threshold, the strongest.
    #[option(default = true)]
    pub peak_grouping: bool,
    /// Limits outside which detections are dropped, and counted. Where it names no range, that is
    /// from 4 range resolutions to 0.9 of the unambiguous range.
    pub region: Region,
    /// Most folds of the range rate to each side that are tried where transmitters take turns:
    /// rates beyond the unambiguous one, told by the transmitters' phases. 0 takes every rate for
    /// that of its bin.
    #[option(default = 0, range = 0..=32)]
    pub doppler_folds: usize,
    /// Angle estimation.
    pub angle: AngleOptions,
    /// Most detections a frame; the strongest are kept.
    #[option(default = 256, range = 1..=65_536)]
    pub max_detections: usize,
    /// Most threads that estimate angles; 1 where there are none, as in WebAssembly.
    #[option(default = 1)]
    #[serde(skip)]
    pub threads: usize,
}

impl ChainOptions {
    /// Checks the options that no single step checks.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] naming the option.
    pub fn check(&self) -> Result<(), PipelineError> {
        self.region.check()?;
        self.angle.options.0.check()?;
        Ok(check(self, Naming::Rust)?)
    }
}
