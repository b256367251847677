//! What an array looks like to its users.

use crate::array::{Array, Channel, Extent, Position};
use crate::resolution::resolution_rad;
use boresight_options::Described;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// Where the elements of an array are, and what follows from that.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "ArrayGeometry")]
pub struct Geometry {
    /// Elements, half wavelengths: x forward, y left, z up.
    pub positions: Vec<Position>,
    /// Transmitters, half wavelengths.
    pub tx: Vec<Position>,
    /// Receivers, half wavelengths.
    pub rx: Vec<Position>,
    /// Transmitter and receiver of each element.
    pub channels: Vec<Channel>,
    /// Length along y, half wavelengths.
    pub aperture: f64,
    /// Which angles it can tell apart.
    pub extent: Extent,
    /// Whether the elements are evenly spaced along y, in order.
    pub uniform: bool,
    /// Half width of the sector without grating lobes; 90 deg where there are none.
    pub unambiguous_rad: f64,
    /// Where the beam at boresight has its first null: from there on two equal targets are told
    /// apart; 90 deg where it has none.
    pub resolution_rad: f64,
}

impl From<&Array> for Geometry {
    fn from(array: &Array) -> Self {
        Self {
            positions: array.positions().to_vec(),
            tx: array.tx().to_vec(),
            rx: array.rx().to_vec(),
            channels: array.channels().to_vec(),
            aperture: array.aperture(),
            extent: array.extent(),
            uniform: array.is_uniform(),
            unambiguous_rad: array
                .lattice()
                .map_or(FRAC_PI_2, |lattice| lattice.unambiguous_sine().asin()),
            resolution_rad: resolution_rad(array),
        }
    }
}
