//! What the records of a fleet come to.

use boresight_options::Described;
use serde::Serialize;

/// A fleet's drives, put together.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
pub struct Fleet {
    /// What became of the logs.
    pub logs: LogCounts,
    /// Why logs failed, the most frequent first.
    pub failures: Vec<FailureCount>,
    /// The vehicles, by name.
    pub vehicles: Vec<Vehicle>,
    /// Radars by their number, and how the vehicles' lie about each other.
    pub radars: Vec<FleetRadar>,
}

/// What became of the logs; every one is counted once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize)]
#[option(name = "FleetLogCounts")]
pub struct LogCounts {
    /// Logs of the plan, or without a plan those with a record.
    pub planned: u64,
    /// Calibrated.
    pub done: u64,
    /// Failed.
    pub failed: u64,
    /// Planned and without a record.
    pub missing: u64,
    /// Logs with a record that are not in the plan, left out.
    pub foreign: u64,
}

/// Logs that failed for one reason.
#[derive(Debug, Clone, PartialEq, Eq, Default, Described, Serialize)]
#[option(name = "FleetFailureCount")]
pub struct FailureCount {
    /// Code of the error.
    pub code: String,
    /// How many.
    pub count: u64,
    /// The message of the first, by path.
    pub message: String,
    /// Its path.
    pub path: String,
}

/// A vehicle.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetVehicle")]
pub struct Vehicle {
    /// Its name.
    pub name: String,
    /// Its drives, in their order.
    pub drives: Vec<Drive>,
    /// Whether drives are placed by their times, in days; otherwise by their order, one drive apart.
    pub timed: bool,
    /// Its radars, by number.
    pub radars: Vec<VehicleRadar>,
    /// What its drives share beside the angles; none where no drive could tell.
    pub shared: Option<CarValues>,
}

/// A drive of a vehicle.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetDrive")]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// Where the log was.
    pub path: String,
    /// When it began, s since 1970, where that is known.
    pub time_s: Option<f64>,
    /// Its place in time: days since the vehicle's first drive, or drives.
    pub at: f64,
    /// From its first scan to its last.
    pub duration_s: f64,
    /// What this drive has of its own, by the joint estimate; what drives share is with the vehicle.
    pub own: CarValues,
}

/// A radar of a vehicle over its drives.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetVehicleRadar")]
pub struct VehicleRadar {
    /// Its number.
    pub sensor: u8,
    /// The angle that it should be mounted at, as the last drive that says so does.
    pub nominal_rad: Option<f64>,
    /// The angle now: that at the last drive, after the last knock.
    pub angle_rad: f64,
    /// Its standard deviation; infinite where no drive tells.
    pub sigma_rad: f64,
    /// Where the angle comes from.
    pub source: AngleSource,
    /// Whether it is where it should be; none without a nominal angle.
    pub alignment: Option<boresight_mounting::Alignment>,
    /// Each drive's own angle.
    pub drives: Vec<DriveAngle>,
    /// When the angle changed at once.
    pub knocks: Vec<Knock>,
    /// How the angle drifts; none where it does not by more than chance.
    pub drift: Option<Drift>,
    /// Factor on the drives' stated deviations that their scatter speaks for.
    pub scatter: f64,
    /// How far this vehicle is from the others, in deviations, where it is further than chance has it; none otherwise.
    pub outlying: Option<f64>,
}

/// Where an angle comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[option(name = "FleetAngleSource")]
pub enum AngleSource {
    /// The drives' angles over time.
    #[default]
    History,
    /// The joint estimate of all drives of the vehicle.
    Joint,
}

/// The angle by one drive.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetDriveAngle")]
pub struct DriveAngle {
    /// Which drive of the vehicle, from 0.
    pub drive: usize,
    /// The angle.
    pub angle_rad: f64,
    /// Its standard deviation; infinite where the drive says nothing.
    pub sigma_rad: f64,
    /// The angle that the history has at this drive.
    pub fitted_rad: f64,
    /// Whether it had settled.
    pub converged: bool,
    /// Whether it is further from the history than chance has it.
    pub outlying: bool,
    /// Codes of its warnings.
    pub warnings: Vec<String>,
}

/// A change of the angle from one drive to the next.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetKnock")]
pub struct Knock {
    /// The first drive after it, from 0.
    pub drive: usize,
    /// Place in time of the drive before, days or drives.
    pub after: f64,
    /// Place in time of that drive.
    pub before: f64,
    /// By how much the angle changed.
    pub step_rad: f64,
    /// Its standard deviation.
    pub sigma_rad: f64,
}

/// A steady change of the angle.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetDrift")]
pub struct Drift {
    /// Change a day, or a drive where drives have no times.
    pub rate_rad: f64,
    /// Its standard deviation.
    pub sigma_rad: f64,
}

/// Unknowns of a car beside the angles, by the joint estimate; none of those that belong elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize)]
#[option(name = "FleetCarValues")]
pub struct CarValues {
    /// Scale factor of the yaw rate (measured over true).
    pub scale: Option<f64>,
    /// Its standard deviation.
    pub scale_sigma: Option<f64>,
    /// Bias of the yaw rate.
    pub bias_radps: Option<f64>,
    /// Its standard deviation.
    pub bias_sigma_radps: Option<f64>,
    /// Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees.
    pub slip_gradient_rad: Option<f64>,
    /// Its standard deviation.
    pub slip_gradient_sigma_rad: Option<f64>,
    /// How long before its time stamp a scan was measured.
    pub delay_s: Option<f64>,
    /// Its standard deviation.
    pub delay_sigma_s: Option<f64>,
}

/// A radar of the fleet's vehicles.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
pub struct FleetRadar {
    /// Its number.
    pub sensor: u8,
    /// Vehicles whose angle off nominal (or where none states a nominal one, angle) is known.
    pub vehicles: u64,
    /// Centre of the vehicles' angles off nominal.
    pub centre_rad: f64,
    /// Their spread, beyond what their deviations have.
    pub spread_rad: f64,
    /// Deviations from which a vehicle is called outlying.
    pub threshold: f64,
    /// Names of the vehicles beyond it.
    pub outlying: Vec<String>,
}
