//! Where frames come from.

use crate::error::PipelineError;
use boresight_core::{Complex32, InputError};
use boresight_math::error::check_range;
use ndarray::{Array4, ArrayView5, Axis};

/// One frame of raw samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Loops x transmitters x receivers x samples; full scale is 1.
    pub samples: Array4<Complex32>,
    /// Samples at an end of the converter's range.
    pub clipped: usize,
}

/// A capture of frames that can be read in any order, several times.
pub trait FrameSource {
    /// What can go wrong in reading.
    type Error: From<PipelineError>;

    /// Number of frames.
    fn frames(&self) -> usize;

    /// Frame `index`, from 0.
    ///
    /// # Errors
    /// What reading gives, also for an index beyond the last frame.
    fn frame(&self, index: usize) -> Result<Frame, Self::Error>;
}

/// Frames in memory: frames x loops x transmitters x receivers x samples.
#[derive(Debug, Clone, Copy)]
pub struct CubeFrames<'a>(pub ArrayView5<'a, Complex32>);

impl FrameSource for CubeFrames<'_> {
    type Error = PipelineError;

    fn frames(&self) -> usize {
        self.0.len_of(Axis(0))
    }

    fn frame(&self, index: usize) -> Result<Frame, PipelineError> {
        if self.frames() == 0 {
            let what = "frames".into();
            return Err(InputError::Empty { what, expected: "at least one".into() }.into());
        }
        check_range("frame", index as f64, 0.0, (self.frames() - 1) as f64)?;
        Ok(Frame { samples: self.0.index_axis(Axis(0), index).to_owned(), clipped: 0 })
    }
}
