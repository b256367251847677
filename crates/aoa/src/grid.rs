//! The grid of angles a spectrum is computed on.

use crate::options::EstimatorOptions;
use boresight_core::{Array, Direction, Extent};

/// Azimuths uniform in `u = sin(azimuth)` over `[-1, 1)`, which is where an FFT puts them, crossed
/// with elevations uniform in angle where the array spans an area.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// `sin(azimuth)` of the points inside the field of view, ascending.
    pub sines: Vec<f64>,
    /// Azimuths, rad, ascending.
    pub azimuth_rad: Vec<f64>,
    /// Elevations, rad, ascending.
    pub elevation_rad: Vec<f64>,
    /// Number of points over the whole circle `u` in `[-1, 1)`.
    pub full_points: usize,
    /// Index in the whole circle of the first point inside the field of view.
    pub first: usize,
}

impl Grid {
    /// The grid `options` ask for, for `array`.
    pub fn new(array: &Array, options: &EstimatorOptions) -> Self {
        let full_points = options.grid_points;
        let limit = options.field_of_view_rad.sin();
        let step = 2.0 / full_points as f64;
        let sine = |g: usize| -1.0 + step * g as f64;
        let inside: Vec<usize> =
            (0..full_points).filter(|&g| sine(g).abs() <= limit + 1e-12).collect();
        let sines: Vec<f64> = inside.iter().map(|&g| sine(g)).collect();
        let elevation_rad = if array.extent() == Extent::Area {
            let half = options.elevation_field_of_view_rad;
            let last = (options.elevation_points - 1) as f64;
            (0..options.elevation_points).map(|e| -half + 2.0 * half * e as f64 / last).collect()
        } else {
            vec![0.0]
        };
        Self {
            azimuth_rad: sines.iter().map(|&u| u.asin()).collect(),
            sines,
            elevation_rad,
            full_points,
            first: inside.first().copied().unwrap_or(0),
        }
    }

    /// Number of points.
    #[allow(clippy::len_without_is_empty)] // a grid has at least the point at boresight
    pub fn len(&self) -> usize {
        self.azimuth_rad.len() * self.elevation_rad.len()
    }

    /// Direction of point `index`, elevation-major.
    pub fn direction(&self, index: usize) -> Direction {
        let azimuths = self.azimuth_rad.len();
        Direction::new(self.azimuth_rad[index % azimuths], self.elevation_rad[index / azimuths])
    }
}
