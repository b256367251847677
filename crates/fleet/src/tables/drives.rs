//! The table of drives.

use super::column::{Column, Of, write};
use crate::error::FleetError;
use crate::fleet::{Drive, DriveAngle, Fleet, Vehicle, VehicleRadar};
use std::io::Write;

/// A radar in a drive, or a drive that no radar's angle is known of.
pub struct DriveRow<'a> {
    vehicle: &'a Vehicle,
    drive: &'a Drive,
    seen: Option<(&'a VehicleRadar, &'a DriveAngle)>,
}

impl DriveRow<'_> {
    fn of<T>(&self, value: impl Fn(&DriveAngle) -> T) -> Option<T> {
        self.seen.map(|(_, angle)| value(angle))
    }
}

/// An angle in degrees; none where there is none.
pub(super) fn degrees(angle_rad: f64) -> Option<f64> {
    finite(angle_rad.to_degrees())
}

pub(super) fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}

/// Milliseconds since 1970; none of a time that they cannot tell.
fn milliseconds(time_s: f64) -> Option<i64> {
    let time_ms = (1e3 * time_s).round();
    (time_ms.abs() < i64::MAX as f64).then_some(time_ms as i64)
}

macro_rules! columns {
    ($row:ident => $($name:literal $kind:ident $doc:literal $value:expr;)*) => {
        vec![$(Column { name: $name, doc: $doc, of: Of::$kind(|$row| $value) },)*]
    };
}
pub(super) use columns;

/// The columns, in order.
#[must_use]
pub fn drive_columns<'a>() -> Vec<Column<DriveRow<'a>>> {
    columns! { row =>
    "vehicle" Text "The vehicle." Some(row.vehicle.name.clone());
    "drive" Text "The drive." Some(row.drive.name.clone());
    "path" Text "Where the log was." Some(row.drive.path.clone());
    "time" Time "When the drive began, UTC." row.drive.time_s.and_then(milliseconds);
    "at" Number "Its place in time: days since the vehicle's first drive, or drives." finite(row.drive.at);
    "duration_s" Number "From its first scan to its last." finite(row.drive.duration_s);
    "sensor" Whole "Number of the radar; null, as is all of the angle, where the drive has none." row.seen.map(|(radar, _)| i64::from(radar.sensor));
    "angle_deg" Number "The angle by this drive alone." row.of(|angle| angle.angle_rad).and_then(degrees);
    "sigma_deg" Number "Its standard deviation; null where the drive says nothing." row.of(|angle| angle.sigma_rad).and_then(degrees);
    "fitted_deg" Number "The angle that the vehicle's history has at this drive." row.of(|angle| angle.fitted_rad).and_then(degrees);
    "converged" Truth "Whether the drive's angle had settled." row.of(|angle| angle.converged);
    "outlying" Truth "Whether it is further from the history than chance has it." row.of(|angle| angle.outlying);
    "warnings" Text "Codes of its warnings, with commas between." row.of(|angle| angle.warnings.join(","));
    "scale" Number "Scale of the yaw rate, where each drive has its own." row.drive.own.scale.and_then(finite);
    "scale_sigma" Number "Its standard deviation." row.drive.own.scale_sigma.and_then(finite);
    "bias_degps" Number "Bias of the yaw rate, where each drive has its own." row.drive.own.bias_radps.and_then(degrees);
    "bias_sigma_degps" Number "Its standard deviation." row.drive.own.bias_sigma_radps.and_then(degrees);
    "slip_gradient_deg" Number "Slip gradient, deg/(m/s^2), where each drive has its own." row.drive.own.slip_gradient_rad.and_then(degrees);
    "slip_gradient_sigma_deg" Number "Its standard deviation." row.drive.own.slip_gradient_sigma_rad.and_then(degrees);
    "delay_s" Number "Delay of the radars, where each drive has its own." row.drive.own.delay_s.and_then(finite);
    "delay_sigma_s" Number "Its standard deviation." row.drive.own.delay_sigma_s.and_then(finite);
    }
}

/// Writes a row a drive and radar, by vehicle, radar and drive, and after those a row a drive of the vehicle without a radar.
///
/// # Errors
/// [`FleetError::Table`].
pub fn write_drives(fleet: &Fleet, out: impl Write + Send) -> Result<(), FleetError> {
    let rows = fleet.vehicles.iter().flat_map(|vehicle| {
        let seen = vehicle.radars.iter().flat_map(move |radar| {
            radar.drives.iter().filter_map(move |angle| {
                let drive = vehicle.drives.get(angle.drive)?;
                Some(DriveRow { vehicle, drive, seen: Some((radar, angle)) })
            })
        });
        seen.chain(unseen(vehicle).map(move |drive| DriveRow { vehicle, drive, seen: None }))
    });
    write(&drive_columns(), "drives", rows, out)
}

/// Drives of a vehicle without an angle of any radar.
fn unseen(vehicle: &Vehicle) -> impl Iterator<Item = &Drive> {
    let mut seen = vec![false; vehicle.drives.len()];
    for angle in vehicle.radars.iter().flat_map(|radar| &radar.drives) {
        if let Some(seen) = seen.get_mut(angle.drive) {
            *seen = true;
        }
    }
    vehicle.drives.iter().zip(seen).filter_map(|(drive, seen)| (!seen).then_some(drive))
}
