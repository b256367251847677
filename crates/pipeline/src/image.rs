//! From the cells of a frame to a range-azimuth map.

use crate::beam::suited;
use crate::error::PipelineError;
use crate::options::ChainOptions;
use crate::result::{Detection, FrameCells};
use boresight_aoa::{
    BatchEstimate, Estimator, EstimatorOptions, Method, Source, SpectrumKind, WarningCount,
};
use boresight_core::{Array, InputError, Waveform};
use boresight_image::{
    Grid, GridOptions, RangeAzimuthDoppler, RangeAzimuthMap, SpectrumPlan, Target,
};
use boresight_options::Described;
use boresight_signal::{CfarKind, CfarOptions};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_3;

/// Azimuths of a map.
const AZIMUTHS: usize = 512;

/// Half width of the field of view of a map.
const FIELD_OF_VIEW_RAD: f64 = FRAC_PI_3;

/// What of the estimates goes into an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[option(name = "ImageFrom")]
#[serde(rename_all = "kebab-case")]
pub enum Content {
    /// The sources found in each cell.
    Targets,
    /// The spectrum of each cell.
    #[default]
    Spectra,
}

impl Content {
    /// What images of several methods are made of so that like stands beside like: spectra if all
    /// methods have them, targets otherwise.
    pub fn of_all(methods: &[Method]) -> Self {
        let have = methods.iter().all(|method| method.requirements().spectrum);
        if have { Self::Spectra } else { Self::Targets }
    }
}

/// How the angles of an image are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angles {
    /// The method.
    pub method: Method,
    /// Its options.
    pub options: EstimatorOptions,
    /// What goes into the image.
    pub content: Content,
}

impl Angles {
    /// The spectra of a method under its default options; the sources of one that has no spectra.
    pub fn of(method: Method) -> Self {
        let content = Content::of_all(&[method]);
        Self { method, options: EstimatorOptions::default(), content }
    }

    /// The options adjusted as the chain does it (see [`suited`]).
    pub fn suited(&self, array: &Array) -> EstimatorOptions {
        suited(self.method, array, &self.options)
    }
}

/// A map of a frame and what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameMap {
    /// The map.
    pub map: RangeAzimuthMap,
    /// The targets in it; none of a map of spectra.
    pub targets: Vec<Target>,
    /// Remarks of the estimator.
    pub warnings: Vec<WarningCount>,
}

/// Options of the chain for images, which take every detected cell instead of one a peak, and noise
/// from all training cells: what a strong reflector drowns is seldom a reflector of its own, and
/// would double the cells to estimate angles in.
pub fn chain_options() -> ChainOptions {
    ChainOptions {
        cfar: CfarOptions { kind: CfarKind::CellAveraging, ..CfarOptions::default() },
        peak_grouping: false,
        max_detections: 4096,
        ..ChainOptions::default()
    }
}

/// The grid of a map unless another is asked for: the range bins of a waveform, and 512 azimuths
/// over 60 deg to each side.
pub fn map_grid(waveform: &Waveform) -> GridOptions {
    GridOptions {
        range_m: [0.0, (waveform.range_bins() - 1) as f64 * waveform.range_resolution_m()],
        ranges: waveform.range_bins(),
        field_of_view_rad: FIELD_OF_VIEW_RAD,
        azimuths: AZIMUTHS,
    }
}

/// Estimates the angles in the cells of a frame and adds them up to a map.
///
/// # Errors
/// What the method says of the snapshots; [`InputError::Incompatible`] for spectra of a method that has none.
pub fn frame_map(
    cells: &FrameCells,
    estimator: &mut Estimator,
    content: Content,
    grid: Grid,
) -> Result<FrameMap, PipelineError> {
    let wants_spectra = content == Content::Spectra;
    let estimates = estimator.estimate_batch(cells.snapshots.view(), wants_spectra)?;
    let (map, targets) = match content {
        Content::Targets => {
            let targets = sources(cells, &estimates);
            (target_map(&targets, grid)?, targets)
        }
        Content::Spectra => (spectrum_map(cells, &estimates, grid)?, vec![]),
    };
    Ok(FrameMap { map, targets, warnings: estimates.warnings })
}

/// Adds targets up to a map.
///
/// # Errors
/// As [`RangeAzimuthDoppler::add_target`].
pub fn target_map(targets: &[Target], grid: Grid) -> Result<RangeAzimuthMap, PipelineError> {
    let mut image = RangeAzimuthDoppler::new(grid, None)?;
    for target in targets {
        image.add_target(target)?;
    }
    Ok(image.to_map())
}

/// Detections of the chain as targets of an image.
pub fn detected_targets(detections: &[Detection]) -> Vec<Target> {
    let target = |detection: &Detection| Target {
        range_m: detection.range_m,
        rate_mps: detection.rate_mps,
        azimuth_rad: detection.azimuth_rad,
        power: detection.power,
        confidence: 1.0,
    };
    detections.iter().map(target).collect()
}

/// The sources found in each cell.
fn sources(cells: &FrameCells, estimates: &BatchEstimate) -> Vec<Target> {
    let target = |(source, &cell): (&Source, &u32)| {
        let cell = &cells.cells[cell as usize];
        Target {
            range_m: cell.range_m,
            rate_mps: cell.rate_mps,
            azimuth_rad: source.direction.azimuth_rad,
            power: source.power,
            confidence: source.confidence.unwrap_or(1.0),
        }
    };
    estimates.sources.iter().zip(&estimates.cell).map(target).collect()
}

fn spectrum_map(
    cells: &FrameCells,
    estimates: &BatchEstimate,
    grid: Grid,
) -> Result<RangeAzimuthMap, PipelineError> {
    let mut image = RangeAzimuthDoppler::new(grid, None)?;
    if cells.cells.is_empty() {
        return Ok(image.to_map());
    }
    let spectra = estimates.spectra.as_ref().ok_or_else(|| InputError::Incompatible {
        what: "spectrum".into(),
        expected: "targets for this method".into(),
        given: estimates.method.name().into(),
    })?;
    let plan = SpectrumPlan::new(&spectra.azimuth_rad, &image.grid)?;
    let each = spectra.values.len() / cells.cells.len();
    for (cell, power) in cells.cells.iter().zip(spectra.values.chunks_exact(each)) {
        // A pseudo-spectrum tells angles only; its peak is given the power of the cell.
        let level = match spectra.kind {
            SpectrumKind::Power => None,
            SpectrumKind::Pseudo => Some(cell.power),
        };
        image.add_spectrum(&plan, cell.range_m, cell.rate_mps, power, level)?;
    }
    Ok(image.to_map())
}
