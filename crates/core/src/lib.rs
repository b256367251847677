//! Foundation of Boresight: units, geometry, antenna arrays, steering vectors, waveforms, dense
//! complex linear algebra, seeded random numbers and the error types everything else builds on.
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
//! # Ok::<(), boresight_core::CoreError>(())
//! ```

// What `Described` derives names the crate from outside.
#[allow(unused_extern_crates)]
extern crate self as boresight_core;

pub mod array;
pub mod calibration;
pub mod correction;
pub mod describe;
pub mod direction;
pub mod drive;
pub mod drive_columns;
pub mod error;
pub mod fft;
pub mod geometry;
pub mod imperfections;
pub mod lattice;
pub mod limits;
pub mod linalg;
pub mod multiplexing;
pub mod order;
pub mod presets;
pub mod progress;
pub mod random;
pub mod resolution;
pub mod response;
pub mod steering;
pub mod units;
pub mod waveform;

pub use array::{Array, Channel, Extent};
pub use calibration::{ArrayCalibration, CalibrationMethod, ChannelCalibration, NotIdentifiable};
pub use describe::Remark;
pub use direction::Direction;
pub use drive::{Detection, DriveLog, MotionSample, Mounting, Pose, Scan, Sensor};
pub use error::{CoreError, Details, Diagnose};
pub use geometry::Geometry;
pub use imperfections::Imperfections;
pub use lattice::Lattice;
pub use limits::Limits;
pub use multiplexing::Multiplexing;
pub use num_complex::{Complex32, Complex64};
pub use progress::Progress;
pub use random::Random;
pub use waveform::{Sampling, Waveform, WaveformSummary};
