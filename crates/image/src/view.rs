//! Maps of several radars on the ground around the car.

use crate::axis::Axis;
use crate::error::ImageError;
use crate::splat::RangeAzimuthMap;
use boresight_core::InputError;
use boresight_core::drive::Mounting;
use boresight_core::limits::{check_bytes, check_operations};
use boresight_math::error::{check_finite, check_range};
use ndarray::Array2;

/// Memory of a cell: its power and its radar.
const CELL_BYTES: usize = 5;

/// What a sample of a map costs, in operations.
const SAMPLE_OPERATIONS: f64 = 20.0;

/// Most samples along each side of a cell.
const MAX_SAMPLES: f64 = 16.0;

/// In place of a radar's index: none sees the cell.
pub const NO_RADAR: i8 = -1;

/// Square cells in the car's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewGrid {
    /// Middles of the cells ahead, m.
    pub x_m: Axis,
    /// Middles of the cells to the left, m.
    pub y_m: Axis,
    /// Width of a cell, m.
    pub cell_m: f64,
}

impl ViewGrid {
    /// Cells of width `cell_m` that fill the ground between the edges, to the nearest whole number
    /// of them.
    ///
    /// # Errors
    /// Edges that do not ascend, fewer than two cells a side; [`InputError::TooLarge`].
    pub fn new(x_m: [f64; 2], y_m: [f64; 2], cell_m: f64) -> Result<Self, ImageError> {
        check_range("cell_m", cell_m, 1e-3, 1e3)?;
        let axis = |what, [from, to]: [f64; 2]| {
            let cells = ((to - from) / cell_m).round().clamp(0.0, 1e9) as usize;
            Axis::new(what, from + 0.5 * cell_m, from + (cells as f64 - 0.5) * cell_m, cells)
        };
        let grid = Self { x_m: axis("x_m", x_m)?, y_m: axis("y_m", y_m)?, cell_m };
        check_bytes("the view", &[grid.x_m.len(), grid.y_m.len()], CELL_BYTES)?;
        Ok(grid)
    }
}

/// Power on the ground around the car.
#[derive(Debug, Clone, PartialEq)]
pub struct BirdsEyeView {
    /// Where the cells are.
    pub grid: ViewGrid,
    /// x by y, linear: the maximum over the radars that see the cell; 0 where none does.
    pub power: Array2<f32>,
    /// Index of the radar whose power it is, or [`NO_RADAR`].
    pub radar: Array2<i8>,
    /// The radars.
    pub mountings: Vec<Mounting>,
}

/// Range and sine of azimuth of places on the ground, as a radar sees them.
pub(crate) struct Polar {
    mounting: Mounting,
    sin: f64,
    cos: f64,
}

impl Polar {
    pub fn new(mounting: Mounting) -> Self {
        let (sin, cos) = mounting.yaw_rad.sin_cos();
        Self { mounting, sin, cos }
    }

    /// Range and sine; `None` behind the radar.
    pub fn of(&self, x_m: f64, y_m: f64) -> Option<(f64, f64)> {
        let (dx, dy) = (x_m - self.mounting.x_m, y_m - self.mounting.y_m);
        let ahead = dx * self.cos + dy * self.sin;
        let range_m = (dx * dx + dy * dy).sqrt();
        (ahead > 0.0).then(|| (range_m, (dy * self.cos - dx * self.sin) / range_m))
    }
}

/// Resamples each radar's map onto the ground, bilinearly, and keeps the maximum where radars
/// overlap. A cell is seen if its middle lies within a map. Where a map is finer than the cell,
/// near the radar, the cell takes the mean of samples as close as the map's points (at most 16 a
/// side), so that nothing falls between cells.
///
/// # Errors
/// [`InputError::OutOfRange`] for no or more than 127 radars; [`InputError::NotFinite`] for a
/// mounting that is not finite; [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
pub fn birds_eye_view(
    radars: &[(&RangeAzimuthMap, Mounting)],
    grid: ViewGrid,
) -> Result<BirdsEyeView, ImageError> {
    check_range("radars", radars.len() as f64, 1.0, f64::from(i8::MAX))?;
    let shape = [grid.x_m.len(), grid.y_m.len()];
    let cells = check_bytes("the view", &shape, CELL_BYTES)? as f64;
    check_operations("the view", cells * samples_of_cell(radars, grid) * SAMPLE_OPERATIONS)?;
    let mut view = BirdsEyeView {
        grid,
        power: Array2::zeros(shape),
        radar: Array2::from_elem(shape, NO_RADAR),
        mountings: radars.iter().map(|(_, mounting)| *mounting).collect(),
    };
    for (index, (map, mounting)) in radars.iter().enumerate() {
        let Mounting { x_m, y_m, yaw_rad } = *mounting;
        check_finite("mounting", [x_m, y_m, yaw_rad])?;
        check_shape(map)?;
        let sampler = Sampler { map, polar: Polar::new(*mounting), cell_m: grid.cell_m };
        for (column, x_m) in grid.x_m.values().into_iter().enumerate() {
            for (row, y_m) in grid.y_m.values().into_iter().enumerate() {
                let Some(power) = sampler.cell(x_m, y_m) else { continue };
                let (best, radar) =
                    (&mut view.power[[column, row]], &mut view.radar[[column, row]]);
                if *radar == NO_RADAR || power > *best {
                    (*best, *radar) = (power, index as i8);
                }
            }
        }
    }
    Ok(view)
}

/// Samples that a cell takes of all maps, on average over the ground that maps cover.
fn samples_of_cell(radars: &[(&RangeAzimuthMap, Mounting)], grid: ViewGrid) -> f64 {
    radars
        .iter()
        .map(|(map, _)| {
            let [range, sine] = [map.grid.range_m, map.grid.sine];
            // At half the range most of the ground lies, and finer maps are sampled as they are there.
            let finest_m = range.step().min(0.5 * range.last() * sine.step());
            (grid.cell_m / finest_m).ceil().clamp(1.0, MAX_SAMPLES).powi(2)
        })
        .sum()
}

fn check_shape(map: &RangeAzimuthMap) -> Result<(), InputError> {
    let expected = (map.grid.range_m.len(), map.grid.sine.len());
    if map.power.dim() == expected {
        return Ok(());
    }
    Err(InputError::Shape {
        what: "the map".into(),
        expected: format!("[{}, {}]", expected.0, expected.1),
        given: map.power.shape().to_vec(),
    })
}

/// A map as it lies on the ground.
struct Sampler<'a> {
    map: &'a RangeAzimuthMap,
    polar: Polar,
    cell_m: f64,
}

impl Sampler<'_> {
    /// Power of the cell around a place; `None` if its middle is not seen.
    fn cell(&self, x_m: f64, y_m: f64) -> Option<f32> {
        let (range_m, _) = self.polar.of(x_m, y_m)?;
        let middle = self.sample(x_m, y_m)?;
        let grid = &self.map.grid;
        let finest_m = grid.range_m.step().min(range_m * grid.sine.step());
        let samples = (self.cell_m / finest_m).ceil().clamp(1.0, MAX_SAMPLES) as usize;
        if samples == 1 {
            return Some(middle);
        }
        let place = |k: usize| ((k as f64 + 0.5) / samples as f64 - 0.5) * self.cell_m;
        let (mut sum, mut seen) = (0.0, 0.0);
        for i in 0..samples {
            for k in 0..samples {
                if let Some(power) = self.sample(x_m + place(i), y_m + place(k)) {
                    sum += power;
                    seen += 1.0;
                }
            }
        }
        Some(if seen > 0.0 { sum / seen } else { middle })
    }

    /// Bilinear sample of the map; `None` beside it.
    fn sample(&self, x_m: f64, y_m: f64) -> Option<f32> {
        let (range_m, sine) = self.polar.of(x_m, y_m)?;
        let grid = &self.map.grid;
        let (row, along) = between(grid.range_m, range_m)?;
        let (column, across) = between(grid.sine, sine)?;
        let at = |i: usize, k: usize| self.map.power[[row + i, column + k]];
        let near = at(0, 0) * (1.0 - across) + at(0, 1) * across;
        let far = at(1, 0) * (1.0 - across) + at(1, 1) * across;
        Some(near * (1.0 - along) + far * along)
    }
}

/// The point at or below a value with one above it, and the way from one to the other.
fn between(axis: Axis, value: f64) -> Option<(usize, f32)> {
    let position = axis.position(value);
    let last = (axis.len() - 1) as f64;
    if !(0.0..=last).contains(&position) {
        return None;
    }
    let below = position.floor().min(last - 1.0);
    Some((below as usize, (position - below) as f32))
}
