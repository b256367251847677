//! The table of radars.

use super::column::{Column, Of, write};
use super::drives::{columns, degrees, finite};
use crate::error::FleetError;
use crate::fleet::{Fleet, Vehicle, VehicleRadar};
use boresight_options::Named;
use std::io::Write;

/// A radar of a vehicle.
pub struct RadarRow<'a> {
    vehicle: &'a Vehicle,
    radar: &'a VehicleRadar,
}

/// The columns, in order.
#[must_use]
pub fn radar_columns<'a>() -> Vec<Column<RadarRow<'a>>> {
    columns! { row =>
    "vehicle" Text "The vehicle." Some(row.vehicle.name.clone());
    "sensor" Whole "Number of the radar." Some(i64::from(row.radar.sensor));
    "drives" Whole "Drives that saw it." Some(row.radar.drives.len() as i64);
    "nominal_deg" Number "The angle that it should be mounted at." row.radar.nominal_rad.and_then(degrees);
    "angle_deg" Number "The angle now." degrees(row.radar.angle_rad);
    "sigma_deg" Number "Its standard deviation; null where no drive tells." degrees(row.radar.sigma_rad);
    "source" Text "Where the angle comes from: joint or history." Some(row.radar.source.name().into());
    "alignment" Text "Whether it is where it should be: aligned, misaligned, undecided; null without a nominal angle." row.radar.alignment.map(|of| of.name().into());
    "knocks" Whole "How often the angle changed at once." Some(row.radar.knocks.len() as i64);
    "last_knock_at" Number "Place in time of the first drive after the last knock, days or drives." row.radar.knocks.last().and_then(|knock| finite(knock.before));
    "last_step_deg" Number "By how much that changed the angle." row.radar.knocks.last().and_then(|knock| degrees(knock.step_rad));
    "last_step_sigma_deg" Number "Its standard deviation." row.radar.knocks.last().and_then(|knock| degrees(knock.sigma_rad));
    "drift_deg" Number "Drift a day, or a drive where drives have no times; null where there is none beyond chance." row.radar.drift.and_then(|drift| degrees(drift.rate_rad));
    "drift_sigma_deg" Number "Its standard deviation." row.radar.drift.and_then(|drift| degrees(drift.sigma_rad));
    "timed" Truth "Whether places in time are days." Some(row.vehicle.timed);
    "scatter" Number "Factor on the drives' deviations that their scatter speaks for." finite(row.radar.scatter);
    "outlying" Number "How far the vehicle is from the others, in deviations; null where no further than chance has it." row.radar.outlying.and_then(finite);
    "scale" Number "Scale of the yaw rate, shared by the vehicle's drives." row.vehicle.shared.and_then(|of| of.scale).and_then(finite);
    "scale_sigma" Number "Its standard deviation." row.vehicle.shared.and_then(|of| of.scale_sigma).and_then(finite);
    "bias_degps" Number "Bias of the yaw rate, shared by the vehicle's drives." row.vehicle.shared.and_then(|of| of.bias_radps).and_then(degrees);
    "bias_sigma_degps" Number "Its standard deviation." row.vehicle.shared.and_then(|of| of.bias_sigma_radps).and_then(degrees);
    "slip_gradient_deg" Number "Slip gradient, deg/(m/s^2), shared by the vehicle's drives." row.vehicle.shared.and_then(|of| of.slip_gradient_rad).and_then(degrees);
    "slip_gradient_sigma_deg" Number "Its standard deviation." row.vehicle.shared.and_then(|of| of.slip_gradient_sigma_rad).and_then(degrees);
    "delay_s" Number "Delay of the radars, shared by the vehicle's drives." row.vehicle.shared.and_then(|of| of.delay_s).and_then(finite);
    "delay_sigma_s" Number "Its standard deviation." row.vehicle.shared.and_then(|of| of.delay_sigma_s).and_then(finite);
    }
}

/// Writes a row a vehicle and radar.
///
/// # Errors
/// [`FleetError::Table`].
pub fn write_radars(fleet: &Fleet, out: impl Write + Send) -> Result<(), FleetError> {
    let rows = fleet
        .vehicles
        .iter()
        .flat_map(|vehicle| vehicle.radars.iter().map(move |radar| RadarRow { vehicle, radar }));
    write(&radar_columns(), "radars", rows, out)
}
