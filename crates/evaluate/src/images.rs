//! Bird's-eye images of the simulated street by several methods, and how much of each is not
//! target.

use crate::EvaluateError;
use boresight_aoa::{BatchEstimate, Estimator, Method, Options, SpectrumKind, WarningCount};
use boresight_core::presets::preset;
use boresight_core::{Array, CoreError, Waveform};
use boresight_image::{
    BirdsEyeView, Gate, Grid, Outside, RangeAzimuthDoppler, RangeAzimuthMap, SpectrumPlan, Target,
    ViewGrid, birds_eye_view,
};
use boresight_neural::Model;
use boresight_pipeline::{Chain, ChainOptions, FrameCells, suited};
use boresight_simulate::{Street, VisibleTarget};
use ndarray::Axis;
use std::f64::consts::FRAC_PI_3;

/// Azimuths of a map.
const AZIMUTHS: usize = 512;

/// What of the estimates goes into an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
    /// Its options, adjusted as the chain does it (see [`suited`]).
    pub options: Options,
    /// What goes into the image.
    pub content: Content,
}

impl Angles {
    /// The spectra of a method under its default options; the sources of one that has no spectra.
    pub fn of(method: Method) -> Self {
        let content =
            if method.requirements().spectrum { Content::Spectra } else { Content::Targets };
        Self { method, options: Options::default(), content }
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

/// The grid of a map: the range bins of a waveform, and 512 azimuths over `field_of_view_rad` to
/// each side.
///
/// # Errors
/// [`CoreError::OutOfRange`] for a field of view beyond 90 deg.
pub fn map_grid(waveform: &Waveform, field_of_view_rad: f64) -> Result<Grid, EvaluateError> {
    let last_m = (waveform.samples - 1) as f64 * waveform.range_resolution_m();
    Ok(Grid::new([0.0, last_m], waveform.samples, field_of_view_rad, AZIMUTHS)?)
}

/// Estimates the angles in the cells of a frame and adds them up to a map; `model` is that of a network.
///
/// # Errors
/// What the method says of array, options and snapshots; [`CoreError::Unknown`] for spectra of a
/// method that has none.
pub fn frame_map(
    cells: &FrameCells,
    array: &Array,
    angles: &Angles,
    model: Option<&Model>,
    grid: Grid,
) -> Result<FrameMap, EvaluateError> {
    let Angles { method, options, content } = angles;
    let mut estimator = match model {
        Some(model) => model.estimator(array, options)?,
        None => Estimator::new(*method, array, &suited(*method, array, options))?,
    };
    let wants_spectra = *content == Content::Spectra;
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
) -> Result<(), EvaluateError> {
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
) -> Result<(), EvaluateError> {
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

/// A frame of one radar of a street.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarFrame {
    /// Index of the radar.
    pub radar: usize,
    /// Its detected cells.
    pub cells: FrameCells,
    /// The points it sees.
    pub targets: Vec<VisibleTarget>,
}

/// A frame of some radars of a street.
#[derive(Debug, Clone, PartialEq)]
pub struct StreetFrames {
    street: Street,
    /// The frames, in the order of the radars asked for.
    pub frames: Vec<RadarFrame>,
}

/// An image of several radars.
#[derive(Debug, Clone, PartialEq)]
pub struct StreetImage {
    /// The bird's-eye view.
    pub view: BirdsEyeView,
    /// What fell beside the radars' maps.
    pub outside: Outside,
    /// Remarks of the estimator, of each radar.
    pub warnings: Vec<WarningCount>,
}

impl StreetFrames {
    /// Simulates one frame of each of `radars` (indices) and detects cells in them.
    ///
    /// # Errors
    /// As [`Street::cube`] and [`Chain::new`].
    pub fn new(
        street: Street,
        radars: &[usize],
        options: &ChainOptions,
    ) -> Result<Self, EvaluateError> {
        let frame = |&radar: &usize| {
            let (cube, targets) = street.cube(radar)?;
            let placed = &street.radars[radar];
            let array = preset(placed.array)?;
            let mut chain = Chain::new(&placed.waveform, array.rx().len(), &array, options)?;
            let cells = chain.cells(cube.index_axis(Axis(0), 0))?;
            Ok(RadarFrame { radar, cells, targets })
        };
        let frames = radars.iter().map(frame).collect::<Result<_, EvaluateError>>()?;
        Ok(Self { street, frames })
    }

    /// The street.
    pub fn street(&self) -> &Street {
        &self.street
    }

    /// The image of all radars.
    ///
    /// # Errors
    /// As [`frame_map`] and [`birds_eye_view`].
    pub fn image(
        &self,
        angles: &Angles,
        model: Option<&Model>,
        grid: ViewGrid,
    ) -> Result<StreetImage, EvaluateError> {
        let (mut maps, mut warnings, mut outside) = (vec![], vec![], Outside::default());
        for frame in &self.frames {
            let radar = &self.street.radars[frame.radar];
            let map_grid = map_grid(&radar.waveform, radar.field_of_view_rad)?;
            let made = frame_map(&frame.cells, &preset(radar.array)?, angles, model, map_grid)?;
            outside.count += made.map.outside.count;
            outside.power += made.map.outside.power;
            warnings.extend(made.warnings);
            maps.push((made.map, radar.mounting));
        }
        let maps: Vec<_> = maps.iter().map(|(map, mounting)| (map, *mounting)).collect();
        Ok(StreetImage { view: birds_eye_view(&maps, grid)?, outside, warnings })
    }

    /// Places of the points that any of the radars sees, x and y in the car's frame, m.
    pub fn targets_m(&self) -> Vec<[f64; 2]> {
        let mut seen = vec![false; self.street.targets.len()];
        for target in self.frames.iter().flat_map(|frame| &frame.targets) {
            seen[target.target] = true;
        }
        let targets = self.street.targets.iter().zip(seen);
        targets.filter_map(|(t, seen)| seen.then_some([t.x_m, t.y_m])).collect()
    }

    /// What the radars cannot resolve: the main lobes of Hann windows and of the array, to their
    /// first nulls, and one cell of the map on top, which is what interpolation adds.
    ///
    /// # Errors
    /// None for the radars of a street.
    pub fn gate(&self) -> Result<Gate, EvaluateError> {
        let radar = &self.street.radars[0];
        let cell = map_grid(&radar.waveform, FRAC_PI_3)?;
        Ok(Gate::Resolution {
            range_m: 2.0 * radar.waveform.range_resolution_m(),
            sine: 2.0 / (preset(radar.array)?.aperture() + 1.0) + cell.sine.step(),
        })
    }
}
