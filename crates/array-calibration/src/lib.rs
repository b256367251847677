//! What a real array's channels have that its plan has not: gain, phase, position and coupling, from
//! targets at known directions and from ordinary captures.
//!
//! A cell that holds one target gives one vector over the channels, `b C diag(g exp(j phi)) a(u)`: its
//! amplitude `b`, the channels' gain and phase, the response `a` to a plane wave from `u`. [`calibrate`]
//! fits all cells together, by alternating least squares (Weiss and Friedlander 1989, Paulraj and Kailath
//! 1985) that end in Gauss-Newton steps. Where no direction is known, a phase that rises linearly over
//! the array cannot be told from a turn of all targets; of all that fit, the calibration nearest to the
//! plan is taken. Whatever else the cells do not determine follows from the rank of the Fisher
//! information and is said in the result.
//!
//! # Example
//!
//! ```
//! use boresight_array_calibration::{Cell, CalibrationOptions, calibrate};
//! use boresight_core::presets::preset;
//! use boresight_core::steering::steering_vector;
//! use boresight_math::decibels::db_to_amplitude;
//! use boresight_core::{Complex64, Direction};
//! use ndarray::Axis;
//!
//! // Two reflectors, and a second channel that is 3 dB down.
//! let array = preset("awr1642")?;
//! let cells: Vec<Cell> = [-20.0_f64, 15.0]
//!     .iter()
//!     .map(|azimuth| {
//!         let mut seen = steering_vector(&array, Direction::azimuth(azimuth.to_radians()));
//!         seen[1] *= Complex64::from(db_to_amplitude(-3.0));
//!         Cell::of(seen.insert_axis(Axis(1)).view(), 1e-3)
//!     })
//!     .collect::<Result<_, _>>()?;
//! let found = calibrate(&array, &cells, &CalibrationOptions::default())?;
//! let gain = |k: usize| found.calibration.channels[k].gain_db;
//! assert!((gain(1) - gain(0) + 3.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cells;
mod check;
mod coupling;
mod error;
mod fit;
mod identifiable;
mod options;
mod orthonormal;
mod plane_wave;
mod positions;
mod result;
mod robust;
mod self_calibration;
mod steering_table;

pub use cells::Cell;
pub use check::{check, leave_one_out};
pub use error::ArrayCalibrationError;
pub use options::{CalibrationModel, CalibrationOptions, Reflector};
pub use result::{
    CalibrationCheck, CalibrationResult, CellUse, CheckFigures, CheckedCell, UsedCell,
};
pub use self_calibration::calibrate;
pub use steering_table::SteeringTable;
