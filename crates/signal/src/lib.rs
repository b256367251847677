//! Radar signal processing between samples and angles: windows, range-Doppler transforms, clutter
//! removal, CFAR detection, peaks, regions of interest and spatial covariance.
//!
//! Powers are per raw sample: a cell that holds a target has the power one sample of that target
//! has, whatever the windows and the transform lengths.
//!
//! # Example
//!
//! ```
//! use boresight_core::{Complex32, Multiplexing, Sampling, Waveform};
//! use boresight_signal::{RangeDoppler, RangeDopplerOptions};
//! use ndarray::Array4;
//! use std::f32::consts::TAU;
//!
//! let waveform = Waveform {
//!     start_frequency_hz: 77e9,
//!     slope_hz_per_s: 60e12,
//!     sample_rate_hz: 5e6,
//!     sampling: Sampling::Complex,
//!     samples: 64,
//!     adc_start_s: 2e-6,
//!     chirp_interval_s: 60e-6,
//!     transmitters: 1,
//!     loops: 16,
//!     frame_interval_s: 40e-3,
//!     multiplexing: Multiplexing::TimeDivision,
//!     doppler_bands: None,
//! };
//! let mut transform = RangeDoppler::new(&waveform, 1, &RangeDopplerOptions::default())?;
//! let mut map = transform.output();
//!
//! // What stands in range bin 10 gives the same ten turns in each chirp; rate 0 is in the middle.
//! let frame = Array4::from_shape_fn((16, 1, 1, 64), |(.., n)| {
//!     Complex32::cis(TAU * 10.0 * n as f32 / 64.0)
//! });
//! transform.process(frame.view(), &mut map)?;
//! assert!((map.power[[10, 8]] - 1.0).abs() < 1e-4);
//! assert_eq!(transform.rate_mps()[8], 0.0);
//! assert!((transform.range_m()[10] - 10.0 * waveform.range_resolution_m()).abs() < 1e-9);
//! # Ok::<(), boresight_signal::SignalError>(())
//! ```

pub mod binary_phase;
pub mod cfar;
pub mod clutter;
pub mod covariance;
pub mod doppler_division;
pub mod error;
pub mod folds;
pub mod peaks;
pub mod power;
pub mod range;
pub mod range_doppler;
pub mod range_shift;
mod real_range;
pub mod region;
pub mod tdm;
pub mod window;

pub use cfar::{
    BinNoise, CellThreshold, Cfar, CfarAxes, CfarKind, CfarOptions, Detection, ln_incomplete_gamma,
};
pub use clutter::remove_static_clutter;
pub use covariance::{forward_backward, load_diagonal, sample_covariance, spatial_smoothing};
pub use error::SignalError;
pub use folds::{Fold, FoldTest};
pub use peaks::{Peak, Peaks, group_peaks};
pub use power::power_map;
pub use range_doppler::{RangeDoppler, RangeDopplerMap, RangeDopplerOptions};
pub use range_shift::{RangeAugmentation, ShiftedFrame, shift_range};
pub use region::Region;
pub use window::Window;
