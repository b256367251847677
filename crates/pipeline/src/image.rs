//! From the cells of a frame to a range-azimuth map.

use crate::{ChainOptions, FrameCells, PipelineError, suited};
use boresight_aoa::{
    BatchEstimate, Estimator, EstimatorOptions, Method, SpectrumKind, WarningCount,
};
use boresight_core::describe::Described;
use boresight_core::{Array, CoreError, Waveform};
use boresight_image::{
    Grid, GridOptions, RangeAzimuthDoppler, RangeAzimuthMap, SpectrumPlan, Target,
};
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
        let content =
            if method.requirements().spectrum { Content::Spectra } else { Content::Targets };
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
    /// Remarks of the estimator.
    pub warnings: Vec<WarningCount>,
}

/// Options of the chain for images, which take every detected cell instead of one a peak.
pub fn chain_options() -> ChainOptions {
    ChainOptions { peak_grouping: false, max_detections: 4096, ..ChainOptions::default() }
}

/// The grid of a map unless another is asked for: the range bins of a waveform, and 512 azimuths
/// over 60 deg to each side.
pub fn map_grid(waveform: &Waveform) -> GridOptions {
    GridOptions {
        range_m: [0.0, (waveform.samples - 1) as f64 * waveform.range_resolution_m()],
        ranges: waveform.samples,
        field_of_view_rad: FIELD_OF_VIEW_RAD,
        azimuths: AZIMUTHS,
    }
}

/// Estimates the angles in the cells of a frame and adds them up to a map.
///
/// # Errors
/// What the method says of the snapshots; [`CoreError::Unknown`] for spectra of a method that has none.
pub fn frame_map(
    cells: &FrameCells,
    estimator: &mut Estimator,
    content: Content,
    grid: Grid,
) -> Result<FrameMap, PipelineError> {
    let wants_spectra = content == Content::Spectra;
    let estimates = estimator.estimate_batch(cells.snapshots.view(), wants_spectra)?;
    let mut image = RangeAzimuthDoppler::new(grid, None)?;
    match content {
        Content::Targets => add_sources(&mut image, cells, &estimates)?,
        Content::Spectra => add_spectra(&mut image, cells, &estimates)?,
    }
    Ok(FrameMap { map: image.to_map(), warnings: estimates.warnings })
}

fn add_sources(
    image: &mut RangeAzimuthDoppler,
    cells: &FrameCells,
    estimates: &BatchEstimate,
) -> Result<(), PipelineError> {
    for (source, &cell) in estimates.sources.iter().zip(&estimates.cell) {
        let cell = &cells.cells[cell as usize];
        image.add_target(&Target {
            range_m: cell.range_m,
            rate_mps: cell.rate_mps,
            azimuth_rad: source.direction.azimuth_rad,
            power: source.power,
            confidence: source.confidence.unwrap_or(1.0),
        })?;
    }
    Ok(())
}

fn add_spectra(
    image: &mut RangeAzimuthDoppler,
    cells: &FrameCells,
    estimates: &BatchEstimate,
) -> Result<(), PipelineError> {
    if cells.cells.is_empty() {
        return Ok(());
    }
    let spectra = estimates.spectra.as_ref().ok_or_else(|| CoreError::Unknown {
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
    Ok(())
}
