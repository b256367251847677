//! Options of the chain.

use crate::error::PipelineError;
use boresight_aoa::{Method, Options};
use boresight_core::Waveform;
use boresight_core::error::check_range;
use boresight_signal::{CfarAxes, CfarOptions, RangeDopplerOptions, Region};

/// Bins at zero range that the coupling from transmitters to receivers fills: the main lobe of the
/// usual windows and as much again.
const COUPLING_BINS: f64 = 4.0;

/// Share of the sample rate within which the receivers' filters are flat; beat frequencies above
/// it, which include negative ones, are attenuated or folded.
const USABLE_BAND: f64 = 0.9;

/// The range from beyond antenna coupling to the end of the receivers' band, m: 4 range resolutions
/// to 0.9 of the unambiguous range.
pub fn usable_range_m(waveform: &Waveform) -> [f64; 2] {
    [COUPLING_BINS * waveform.range_resolution_m(), USABLE_BAND * waveform.max_range_m()]
}

/// How frames become detections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainOptions {
    /// Windows, padding and clutter removal of the transforms.
    pub range_doppler: RangeDopplerOptions,
    /// Detection. Guard and training cells are counted in cells of unpadded transforms; the number
    /// of looks and the correlation of cells follow from the array and the windows and are set by
    /// the chain.
    pub cfar: CfarOptions,
    /// Keep one detection a peak.
    pub peak_grouping: bool,
    /// Limits outside which detections are dropped, and counted. Where it names no range, that is
    /// [`usable_range_m`].
    pub region: Region,
    /// Method of angle estimation.
    pub method: Method,
    /// Its options. For the conventional beamformer and Capon's the dynamic range is at most that
    /// between main lobe and sidelobes of the array less 6 dB; Capon's is loaded by 0.1 of the
    /// mean element power where no loading is asked for.
    pub angle: Options,
    /// Most detections a frame; the strongest are kept.
    pub max_detections: usize,
    /// Most threads that estimate angles; 1 where there are none, as in WebAssembly.
    pub threads: usize,
}

impl Default for ChainOptions {
    /// Hann windows without padding; cell averaging along range, because in a scene that stands
    /// still all power lies at zero Doppler and a window across it would see no noise like the
    /// cell's own; guard cells that cover the main lobe; the conventional beamformer, which needs
    /// no more than one snapshot.
    fn default() -> Self {
        Self {
            range_doppler: RangeDopplerOptions::default(),
            cfar: CfarOptions {
                axes: CfarAxes::Range,
                guard: [4, 2],
                training: [8, 4],
                ..CfarOptions::default()
            },
            peak_grouping: true,
            region: Region::default(),
            method: Method::Bartlett,
            angle: Options::default(),
            max_detections: 256,
            threads: 1,
        }
    }
}

impl ChainOptions {
    /// Checks the options that no single step checks.
    ///
    /// # Errors
    /// [`boresight_core::CoreError::OutOfRange`] naming the option.
    pub fn check(&self) -> Result<(), PipelineError> {
        self.region.check()?;
        self.angle.check()?;
        Ok(check_range("max_detections", self.max_detections as f64, 1.0, 65_536.0)?)
    }
}
