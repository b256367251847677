//! Grids as users ask for them.

use crate::error::ImageError;
use crate::splat::Grid;
use crate::view::ViewGrid;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Grid of a range-azimuth map.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[option(name = "MapGrid")]
pub struct GridOptions {
    /// First and last range.
    #[option(range = 0..=1_000_000)]
    pub range_m: [f64; 2],
    /// Points in range.
    #[option(range = 2..=16_384)]
    pub ranges: usize,
    /// Half width of the field of view.
    #[option(range = 0.1..=90)]
    pub field_of_view_rad: f64,
    /// Points in azimuth, uniform in its sine.
    #[option(range = 2..=16_384)]
    pub azimuths: usize,
}

impl Grid {
    /// The grid of these options.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn of(options: &GridOptions) -> Result<Self, ImageError> {
        let GridOptions { range_m, ranges, field_of_view_rad, azimuths } = *options;
        Self::new(range_m, ranges, field_of_view_rad, azimuths)
    }
}

/// Grid of a bird's-eye view in the car's frame.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[option(name = "ViewGrid")]
#[serde(default)]
pub struct ViewGridOptions {
    /// Edges ahead (positive) and behind.
    #[option(default = [-20.0, 80.0])]
    pub x_m: [f64; 2],
    /// Edges right (negative) and left.
    #[option(default = [-25.0, 25.0])]
    pub y_m: [f64; 2],
    /// Width of a cell, and so of a pixel.
    #[option(default = 0.2, range = 0.001..=1000)]
    pub cell_m: f64,
}

impl ViewGrid {
    /// The grid of these options.
    ///
    /// # Errors
    /// As [`ViewGrid::new`].
    pub fn of(options: &ViewGridOptions) -> Result<Self, ImageError> {
        Self::new(options.x_m, options.y_m, options.cell_m)
    }
}
