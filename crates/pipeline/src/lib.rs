//! From raw FMCW frames to detections with angles: range and Doppler transforms, constant
//! false-alarm rate detection, peak grouping, compensation of the transmitters' turns, and an
//! angle estimate for each cell found.
//!
//! [`Chain::new`] plans for one waveform, array and set of options; [`Chain::process`] takes one
//! frame, [`Chain::each`] all frames of a [`FrameSource`] one by one, and [`Chain::combine`] all of
//! them together, which suits scenes that do not move. [`image::frame_map`] makes a range-azimuth map of a frame's cells.

mod beam;
mod capture;
mod chain;
mod error;
pub mod image;
mod options;
mod result;
mod source;

pub use beam::suited;
pub use chain::Chain;
pub use error::PipelineError;
pub use options::{AngleOptions, ChainOptions, usable_range_m};
pub use result::{Counts, DetectedCell, Detection, FrameCells, FrameResult, Remark};
pub use source::{CubeFrames, Frame, FrameSource, Progress};
