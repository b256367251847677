//! Physical constants.

/// Speed of light in vacuum, metres per second.
pub const SPEED_OF_LIGHT_MPS: f64 = 299_792_458.0;
