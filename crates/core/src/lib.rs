//! The radar domain: antenna arrays, steering vectors, waveforms, geometry, drives and array calibrations.
//!
//! Conventions (stated in full in `docs/conventions.md`): SI units and radians, with the unit in
//! the name; the sensor frame has x forward, y left and z up; azimuth is counter-clockwise
//! positive; range rate is positive when receding; antenna positions are in half wavelengths.
//!
//! # Example
//!
//! ```
//! use boresight_core::steering::steering_vector;
//! use boresight_core::{Array, Direction};
//!
//! // A wave from 30 deg on the left turns the phase by half of pi from one element to the next.
//! let array = Array::ula(8)?;
//! let response = steering_vector(&array, Direction::azimuth(30_f64.to_radians()));
//! let turn = (response[1] / response[0]).arg();
//! assert!((turn - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
//! # Ok::<(), boresight_core::InputError>(())
//! ```

pub mod array;
pub mod calibration;
pub mod correction;
pub mod direction;
pub mod drive;
pub mod drive_columns;
pub mod geometry;
pub mod imperfections;
pub mod lattice;
pub mod limits;
pub mod multiplexing;

pub mod presets;
pub mod progress;
pub mod resolution;
pub mod response;
pub mod steering;
pub mod units;
pub mod waveform;

pub use boresight_math::{Details, Diagnose, InputError, Random};
pub use boresight_options::{Flat, Remark};

pub use array::{Array, Channel, Extent};
pub use calibration::{ArrayCalibration, CalibrationMethod, ChannelCalibration, NotIdentifiable};
pub use direction::Direction;
pub use drive::{Detection, DriveLog, MotionSample, Mounting, Pose, Scan, Sensor};
pub use geometry::Geometry;
pub use imperfections::Imperfections;
pub use lattice::Lattice;
pub use limits::Limits;
pub use multiplexing::Multiplexing;
pub use num_complex::{Complex32, Complex64};
pub use progress::Progress;
pub use waveform::{Sampling, Waveform, WaveformSummary};
