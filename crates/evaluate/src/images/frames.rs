//! Bird's-eye images of the simulated street by several methods, and how much of each is not
//! target.

use crate::EvaluateError;
use boresight_aoa::{Estimator, WarningCount};
use boresight_core::Array;
use boresight_core::presets::preset;
use boresight_image::{BirdsEyeView, Gate, Grid, GridOptions, Outside, ViewGrid, birds_eye_view};
use boresight_neural::Model;
use boresight_pipeline::image::{Angles, frame_map, map_grid};
use boresight_pipeline::{Chain, ChainOptions, FrameCells};
use boresight_simulate::{Street, VisibleTarget};
use ndarray::Axis;

/// The estimator of an image's angles; `model` is that of a network.
fn estimator(
    angles: &Angles,
    array: &Array,
    model: Option<&Model>,
) -> Result<Estimator, EvaluateError> {
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
            let field_of_view_rad = radar.field_of_view_rad;
            let map_grid =
                Grid::of(&GridOptions { field_of_view_rad, ..map_grid(&radar.waveform) })?;
            let mut estimator = estimator(angles, &preset(radar.array)?, model)?;
            let made = frame_map(&frame.cells, &mut estimator, angles.content, map_grid)?;
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
        let cell = Grid::of(&map_grid(&radar.waveform))?;
        Ok(Gate::Resolution {
            range_m: 2.0 * radar.waveform.range_resolution_m(),
            sine: 2.0 / (preset(radar.array)?.aperture() + 1.0) + cell.sine.step(),
        })
    }
}
