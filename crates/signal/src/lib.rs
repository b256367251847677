//! Radar signal processing between samples and angles: windows, range-Doppler transforms, clutter
//! removal, CFAR detection, peaks, regions of interest and spatial covariance.
//!
//! Powers are per raw sample: a cell that holds a target has the power one sample of that target
//! has, whatever the windows and the transform lengths.

pub mod covariance;
pub mod error;

pub use covariance::{forward_backward, load_diagonal, sample_covariance, spatial_smoothing};
pub use error::SignalError;
