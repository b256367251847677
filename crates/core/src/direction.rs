//! Directions in the sensor frame.

use boresight_math::error::{InputError, check_range};
use boresight_options::Described;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// A direction seen from the sensor: x forward, y left, z up.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct Direction {
    /// Azimuth, counter-clockwise from boresight (positive to the left).
    #[option(range = -90..=90)]
    pub azimuth_rad: f64,
    /// Elevation, positive upwards.
    #[option(range = -90..=90)]
    pub elevation_rad: f64,
}

impl Direction {
    /// A direction in the horizontal plane.
    pub fn azimuth(azimuth_rad: f64) -> Self {
        Self { azimuth_rad, elevation_rad: 0.0 }
    }

    /// Azimuth and elevation.
    pub fn new(azimuth_rad: f64, elevation_rad: f64) -> Self {
        Self { azimuth_rad, elevation_rad }
    }

    /// Unit vector toward the source: `(cos e cos a, cos e sin a, sin e)`.
    pub fn unit(self) -> [f64; 3] {
        let (sin_a, cos_a) = libm::sincos(self.azimuth_rad);
        let (sin_e, cos_e) = libm::sincos(self.elevation_rad);
        [cos_e * cos_a, cos_e * sin_a, sin_e]
    }

    /// The place at that range, m: x forward, y left, z up.
    pub fn place_m(self, range_m: f64) -> [f64; 3] {
        self.unit().map(|share| range_m * share)
    }

    /// Derivatives of [`Direction::unit`] by azimuth and by elevation.
    pub fn unit_derivatives(self) -> ([f64; 3], [f64; 3]) {
        let (sin_a, cos_a) = libm::sincos(self.azimuth_rad);
        let (sin_e, cos_e) = libm::sincos(self.elevation_rad);
        ([-cos_e * sin_a, cos_e * cos_a, 0.0], [-sin_e * cos_a, -sin_e * sin_a, cos_e])
    }

    /// Checks that both angles are within a quarter turn of boresight.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] otherwise, also for NaN.
    pub fn check(&self) -> Result<(), InputError> {
        check_range("azimuth_rad", self.azimuth_rad, -FRAC_PI_2, FRAC_PI_2)?;
        check_range("elevation_rad", self.elevation_rad, -FRAC_PI_2, FRAC_PI_2)
    }
}
