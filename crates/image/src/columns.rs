//! Maps and views as columns of numbers, which cost a program in another language little.

use crate::splat::{Outside, RangeAzimuthMap};
use crate::view::{BirdsEyeView, NO_RADAR};
use boresight_core::drive::Mounting;
use boresight_options::{Described, columns};
use ndarray::Array2;
use serde::Serialize;

/// Power over range and azimuth: what the cells' targets or spectra add up to.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "RangeAzimuthMap")]
pub struct MapColumns<'a> {
    /// Ranges, ascending.
    #[serde(serialize_with = "columns::serialize")]
    pub range_m: Vec<f64>,
    /// Azimuths, ascending, evenly spaced in their sine.
    #[serde(serialize_with = "columns::serialize")]
    pub azimuth_rad: Vec<f64>,
    /// Linear, azimuths fastest.
    #[option(described_as = Vec<f32>)]
    #[serde(serialize_with = "columns::serialize_array")]
    pub power: &'a Array2<f32>,
    /// Ranges, then azimuths.
    #[option(typescript = "[ranges: number, azimuths: number]")]
    pub shape: [usize; 2],
    /// What fell off the grid.
    pub outside: Outside,
}

/// Maps of one or several radars on the ground around the car.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "BirdsEyeView")]
pub struct ViewColumns<'a> {
    /// Middles of the cells ahead.
    #[serde(serialize_with = "columns::serialize")]
    pub x_m: Vec<f64>,
    /// Middles of the cells to the left.
    #[serde(serialize_with = "columns::serialize")]
    pub y_m: Vec<f64>,
    /// Linear, y fastest: the maximum over the radars that see the cell, 0 where none does.
    #[option(described_as = Vec<f32>)]
    #[serde(serialize_with = "columns::serialize_array")]
    pub power: &'a Array2<f32>,
    /// 1 where a radar sees the cell.
    #[serde(serialize_with = "columns::serialize")]
    pub seen: Vec<u8>,
    /// Index of the radar whose power it is; -1 where none sees it.
    #[option(described_as = Vec<i8>)]
    #[serde(serialize_with = "columns::serialize_array")]
    pub radar: &'a Array2<i8>,
    /// Cells ahead, then cells to the left.
    #[option(typescript = "[x: number, y: number]")]
    pub shape: [usize; 2],
    /// Width of a cell.
    pub cell_m: f64,
    /// Of each radar.
    pub mountings: &'a [Mounting],
}

impl RangeAzimuthMap {
    /// The same as columns.
    #[must_use]
    pub fn columns(&self) -> MapColumns<'_> {
        MapColumns {
            range_m: self.grid.range_m.values(),
            azimuth_rad: self.grid.azimuth_rad(),
            power: &self.power,
            shape: self.power.dim().into(),
            outside: self.outside,
        }
    }
}

impl BirdsEyeView {
    /// The same as columns.
    #[must_use]
    pub fn columns(&self) -> ViewColumns<'_> {
        ViewColumns {
            x_m: self.grid.x_m.values(),
            y_m: self.grid.y_m.values(),
            power: &self.power,
            seen: self.radar.iter().map(|&radar| u8::from(radar != NO_RADAR)).collect(),
            radar: &self.radar,
            shape: self.power.dim().into(),
            cell_m: self.grid.cell_m,
            mountings: &self.mountings,
        }
    }
}
