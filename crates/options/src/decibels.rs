//! Powers that results give in decibels.

use boresight_math::decibels::{power_to_db, powers_to_db};
use serde::{Serialize, Serializer};

/// Power in dB that stays finite (about -3077 dB) where there is none, for plots and JSON.
#[must_use]
pub fn finite_db(power: f64) -> f64 {
    power_to_db(power.max(f64::MIN_POSITIVE))
}

/// Serializes a linear power in dB, as [`finite_db`] makes it; the field is renamed `..._db`.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(power: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    finite_db(*power).serialize(serializer)
}

/// Serializes a linear share in dB; minus infinity for none.
///
/// # Errors
/// Those of the serializer.
pub fn serialize_share<S: Serializer>(share: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    power_to_db(*share).serialize(serializer)
}

/// Serializes a column of linear powers in dB, each as [`finite_db`] makes it, to the last digit.
///
/// # Errors
/// Those of the serializer.
pub fn serialize_each<S: Serializer>(powers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let powers_db: Vec<f64> = powers.iter().copied().map(finite_db).collect();
    super::columns::serialize(&powers_db, serializer)
}

/// Serializes a spectrum's linear powers in dB, many at a time.
///
/// # Errors
/// Those of the serializer.
pub fn serialize_column<S: Serializer>(powers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let positive: Vec<f64> = powers.iter().map(|power| power.max(f64::MIN_POSITIVE)).collect();
    super::columns::serialize(&powers_to_db(&positive), serializer)
}
