//! What is asked of the radars of a car.

use boresight_core::CoreError;

/// At least one radar, and each number once.
///
/// # Errors
/// [`CoreError::Empty`] and [`CoreError::OutOfRange`].
pub(crate) fn check_numbers(sensors: impl Iterator<Item = u8>) -> Result<(), CoreError> {
    let mut seen = [false; 256];
    let mut any = false;
    for sensor in sensors {
        any = true;
        if std::mem::replace(&mut seen[usize::from(sensor)], true) {
            return Err(CoreError::OutOfRange {
                what: "sensor".into(),
                expected: "each radar once".into(),
                given: f64::from(sensor),
            });
        }
    }
    if any {
        return Ok(());
    }
    Err(CoreError::Empty { what: "radars".into(), expected: "at least one radar".into() })
}

/// The place of a radar among those that were named.
///
/// # Errors
/// [`CoreError::OutOfRange`] for another one.
pub(crate) fn place(mut sensors: impl Iterator<Item = u8>, sensor: u8) -> Result<usize, CoreError> {
    sensors.position(|id| id == sensor).ok_or_else(|| CoreError::OutOfRange {
        what: "sensor".into(),
        expected: "a radar that was named".into(),
        given: f64::from(sensor),
    })
}
