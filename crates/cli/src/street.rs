//! A frame of the simulated street, its images, and how much of each is not target.

use crate::error::CliError;
use boresight_aoa::{Estimator, WarningCount};
use boresight_core::Array;
use boresight_core::presets::preset;
use boresight_core::resolution::resolution_rad;
use boresight_image::{
    BirdsEyeView, Gate, Grid, GridOptions, HiddenMeasure, Outside, PointMeasure, RadarPoints,
    SidelobeMeasure, Target, ViewGrid, birds_eye_view, hidden_measure, point_measure,
    sidelobe_measure,
};
use boresight_neural::Model;
use boresight_pipeline::image::{
    Angles, Content, FrameMap, chain_options, detected_targets, frame_map, map_grid, target_map,
};
use boresight_pipeline::{Chain, ChainOptions, FrameCells};
use boresight_simulate::{Street, VisibleTarget};
use ndarray::Axis;

/// Name of the ordinary chain among methods.
pub const CHAIN: &str = "chain";

/// What makes an image.
#[derive(Clone, Copy)]
pub enum Maker<'a> {
    /// A method in every detected cell; `model` is that of a network.
    Cells {
        /// The method and what goes into the image.
        angles: &'a Angles,
        /// The network.
        model: Option<&'a Model>,
    },
    /// The chain as its defaults are, whose detections a radar gives out as its point cloud: peaks
    /// of range and Doppler, and of the conventional beam in each.
    Chain,
}

impl Maker<'_> {
    /// What goes into the image.
    pub fn content(&self) -> Content {
        match self {
            Self::Cells { angles, .. } => angles.content,
            Self::Chain => Content::Targets,
        }
    }
}

/// The estimator of an image's angles; `model` is that of a network.
fn estimator(angles: &Angles, array: &Array, model: Option<&Model>) -> Result<Estimator, CliError> {
    Ok(match model {
        Some(model) => model.estimator(array, &angles.options)?,
        None => Estimator::new(angles.method, array, &angles.suited(array))?,
    })
}

/// A frame of one radar of a street.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarFrame {
    /// Index of the radar.
    pub radar: usize,
    /// Its detected cells.
    pub cells: FrameCells,
    /// Detections of the chain as its defaults are.
    pub detections: Vec<Target>,
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
    /// The targets on each radar's map; none of an image of spectra.
    pub points: Option<Vec<RadarPoints>>,
    /// What fell beside the radars' maps.
    pub outside: Outside,
    /// Remarks of the estimator, of each radar.
    pub warnings: Vec<WarningCount>,
}

/// How much of an image is not target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageFigures {
    /// Of the view.
    pub sidelobes: SidelobeMeasure,
    /// What of the view is behind walls.
    pub behind_walls: HiddenMeasure,
    /// Of the points, where the image is made of them; hidden ones are behind walls.
    pub points: Option<PointMeasure>,
}

impl StreetFrames {
    /// Simulates one frame of each of `radars` (indices) and detects cells in them.
    ///
    /// # Errors
    /// As [`Street::cube`] and [`Chain::new`].
    pub fn new(street: Street, radars: &[usize]) -> Result<Self, CliError> {
        let frame = |&radar: &usize| {
            let (cube, targets) = street.cube(radar)?;
            let placed = &street.radars[radar];
            let array = preset(placed.array)?;
            let chain = |options: &ChainOptions| {
                Chain::new(&placed.waveform, array.rx().len(), &array, options)
            };
            let samples = cube.index_axis(Axis(0), 0);
            let images = chain_options();
            let cells = chain(&images)?.cells(samples)?;
            // Of the same cells, one a peak.
            let peaks = ChainOptions { cfar: images.cfar, ..ChainOptions::default() };
            let detections = chain(&peaks)?.process(samples)?.detections;
            Ok(RadarFrame { radar, cells, detections: detected_targets(&detections), targets })
        };
        let frames = radars.iter().map(frame).collect::<Result<_, CliError>>()?;
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
    pub fn image(&self, maker: &Maker, grid: ViewGrid) -> Result<StreetImage, CliError> {
        let (mut maps, mut warnings, mut outside) = (vec![], vec![], Outside::default());
        let mut points = vec![];
        for frame in &self.frames {
            let radar = &self.street.radars[frame.radar];
            let field_of_view_rad = radar.field_of_view_rad;
            let map_grid =
                Grid::of(&GridOptions { field_of_view_rad, ..map_grid(&radar.waveform) })?;
            let FrameMap { map, targets, warnings: remarks } = match maker {
                Maker::Cells { angles, model } => {
                    let mut estimator = estimator(angles, &preset(radar.array)?, *model)?;
                    frame_map(&frame.cells, &mut estimator, angles.content, map_grid)?
                }
                Maker::Chain => {
                    let targets = frame.detections.clone();
                    let map = target_map(&targets, map_grid)?;
                    FrameMap { map, targets, warnings: vec![] }
                }
            };
            outside.count += map.outside.count;
            outside.power += map.outside.power;
            warnings.extend(remarks);
            maps.push((map, radar.mounting));
            let on_map = targets.into_iter().filter(|target| is_on(&map_grid, target)).collect();
            points.push(RadarPoints { mounting: radar.mounting, points: on_map });
        }
        let maps: Vec<_> = maps.iter().map(|(map, mounting)| (map, *mounting)).collect();
        let points = (maker.content() == Content::Targets).then_some(points);
        Ok(StreetImage { view: birds_eye_view(&maps, grid)?, points, outside, warnings })
    }

    /// Measures an image of these frames against the points that any of the radars sees, with
    /// [`StreetFrames::gate`].
    ///
    /// # Errors
    /// None for images of these frames.
    pub fn figures(&self, image: &StreetImage) -> Result<ImageFigures, CliError> {
        let (targets, gate) = (self.targets_m(), self.gate()?);
        let is_behind_wall = |radar: usize, place: [f64; 2]| {
            let mounting = self.street.radars[self.frames[radar].radar].mounting;
            self.street.is_behind_wall([mounting.x_m, mounting.y_m], place)
        };
        let points = image.points.as_ref();
        let measured = points.map(|points| point_measure(points, &targets, gate, is_behind_wall));
        Ok(ImageFigures {
            sidelobes: sidelobe_measure(&image.view, &targets, gate)?,
            behind_walls: hidden_measure(&image.view, &targets, gate, is_behind_wall)?,
            points: measured.transpose()?,
        })
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
    pub fn gate(&self) -> Result<Gate, CliError> {
        let radar = &self.street.radars[0];
        let cell = Grid::of(&map_grid(&radar.waveform))?;
        Ok(Gate::Resolution {
            range_m: 2.0 * radar.waveform.range_resolution_m(),
            sine: resolution_rad(&preset(radar.array)?).sin() + cell.sine.step(),
        })
    }
}

/// Whether a map shows a target.
fn is_on(grid: &Grid, target: &Target) -> bool {
    let Grid { range_m, sine } = grid;
    (range_m.first()..=range_m.last()).contains(&target.range_m)
        && target.azimuth_rad.abs() <= sine.last().asin()
}
