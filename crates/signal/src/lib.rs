//! Radar signal processing between samples and angles: windows, range-Doppler transforms, clutter
//! removal, CFAR detection, peaks, regions of interest and spatial covariance.
//!
//! Powers are per raw sample: a cell that holds a target has the power one sample of that target
//! has, whatever the windows and the transform lengths.

pub mod cfar;
pub mod clutter;
pub mod covariance;
pub mod error;
pub mod peaks;
pub mod power;
pub mod range;
pub mod range_doppler;
pub mod region;
pub mod tdm;
pub mod window;

pub use cfar::{Cfar, CfarAxes, CfarKind, CfarOptions, Detection};
pub use clutter::remove_static_clutter;
pub use covariance::{forward_backward, load_diagonal, sample_covariance, spatial_smoothing};
pub use error::SignalError;
pub use peaks::{Peak, Peaks, group_peaks};
pub use power::power_map;
pub use range_doppler::{RangeDoppler, RangeDopplerMap, RangeDopplerOptions};
pub use region::Region;
pub use window::Window;
