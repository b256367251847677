//! Physical constants and conversions between linear and logarithmic scales.

/// Speed of light in vacuum, metres per second.
pub const SPEED_OF_LIGHT_MPS: f64 = 299_792_458.0;

/// Power ratio to decibels: `10 log10(power)`. Zero gives negative infinity.
pub fn power_to_db(power: f64) -> f64 {
    10.0 * power.log10()
}

/// Decibels to a power ratio.
pub fn db_to_power(db: f64) -> f64 {
    libm::pow(10.0, db / 10.0)
}

/// Decibels to an amplitude ratio: `10^(db / 20)`.
pub fn db_to_amplitude(db: f64) -> f64 {
    libm::pow(10.0, db / 20.0)
}

/// Amplitude ratio to decibels: `20 log10(|amplitude|)`.
pub fn amplitude_to_db(amplitude: f64) -> f64 {
    20.0 * amplitude.log10()
}
