//! What is asked of the radars of a car.

use boresight_core::InputError;

/// At least one radar, and each number once.
///
/// # Errors
/// [`InputError::Empty`] and [`InputError::OutOfRange`].
pub(crate) fn check_numbers(sensors: impl Iterator<Item = u8>) -> Result<(), InputError> {
    let mut seen = [false; 256];
    let mut any = false;
    for sensor in sensors {
        any = true;
        if std::mem::replace(&mut seen[usize::from(sensor)], true) {
            return Err(InputError::OutOfRange {
                what: "sensor".into(),
                expected: "each radar once".into(),
                given: f64::from(sensor),
            });
        }
    }
    if any {
        return Ok(());
    }
    Err(InputError::Empty { what: "radars".into(), expected: "at least one radar".into() })
}

/// The place of a radar among those that were named.
///
/// # Errors
/// [`InputError::OutOfRange`] for another one.
pub(crate) fn place(
    mut sensors: impl Iterator<Item = u8>,
    sensor: u8,
) -> Result<usize, InputError> {
    sensors.position(|id| id == sensor).ok_or_else(|| InputError::OutOfRange {
        what: "sensor".into(),
        expected: "a radar that was named".into(),
        given: f64::from(sensor),
    })
}
