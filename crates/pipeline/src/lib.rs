//! From raw FMCW frames to detections with angles: range and Doppler transforms, constant
//! false-alarm rate detection, peak grouping, compensation of the transmitters' turns, and an
//! angle estimate for each cell found.
//!
//! [`Chain::new`] plans for one waveform, array and set of options; [`Chain::process`] takes one
//! frame, [`Chain::each`] all frames of a [`FrameSource`] one by one, and [`Chain::combine`] all of
//! them together, which suits scenes that do not move. [`image::frame_map`] makes a range-azimuth
//! map of a frame's cells, and [`array_calibration::calibrate_array`] finds what the array's channels have that
//! its plan has not.
//!
//! # Example
//!
//! ```
//! use boresight_core::Direction;
//! use boresight_core::presets::preset;
//! use boresight_pipeline::{Chain, ChainOptions};
//! use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube, waveform_awr1642};
//!
//! let (waveform, array) = (waveform_awr1642(), preset("awr1642")?);
//! let target = CubeTarget {
//!     range_m: 5.0,
//!     rate_mps: -1.0,
//!     direction: Direction::azimuth(20_f64.to_radians()).into(),
//!     power_db: 0.0,
//!     phase_rad: None,
//! };
//! let frames = simulate_cube(&waveform, &array, &[target], &CubeOptions::default())?;
//!
//! let mut chain = Chain::new(&waveform, array.rx().len(), &array, &ChainOptions::default())?;
//! let result = chain.process(frames.index_axis(ndarray::Axis(0), 0))?;
//! let [found] = &result.detections[..] else { panic!("{:?}", result.detections) };
//! assert!((found.range_m - target.range_m).abs() < waveform.range_resolution_m());
//! assert!((found.rate_mps - target.rate_mps).abs() < waveform.rate_resolution_mps());
//! assert!((found.azimuth_rad - target.direction.azimuth_rad).abs() < 1_f64.to_radians());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod array_calibration;
mod beam;
mod capture;
mod chain;
mod decoding;
mod error;
mod explain;
mod folds;
pub mod image;
mod options;
pub mod regions;
mod result;
mod source;

pub use beam::suited;
pub use chain::Chain;
pub use error::PipelineError;
pub use explain::{CellExplanation, Verdict};
pub use options::{AngleOptions, ChainOptions, usable_range_m};
pub use regions::RegionChain;
pub use result::{Counts, DetectedCell, Detection, FrameCells, FrameResult};
pub use source::{CubeFrames, Frame, FrameSource};
