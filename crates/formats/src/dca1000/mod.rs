//! Raw samples of Texas Instruments' boards as their capture cards record them: the DCA1000 of boards with two lanes
//! and with four, and the cascade of four chips. [`Layout`] says where samples stand, [`ReadingOptions`] overrides
//! what the configuration says of that, [`Evidence`] is what the samples themselves tell, and [`Settled`] brings all
//! that together. [`write()`] is the inverse.

pub mod cascade;
mod evidence;
pub(crate) mod layout;
pub mod parts;
mod reading;
mod settled;
mod write;

pub use evidence::{BeatSides, Evidence};
use layout::Plan;
pub use layout::{CASCADE_RECEIVERS, Layout};
pub use reading::{IqOrder, Lanes, ReadingOptions};
pub use settled::Settled;
pub use write::write;

use crate::error::FormatError;
use crate::mmwave_cfg::RadarConfig;
use boresight_core::{Complex32, Remark, Sampling};
use boresight_math::error::check_range;
use ndarray::Array4;
use std::ops::Range;

/// A capture laid over its bytes; frames are decoded one at a time.
#[derive(Debug, Clone)]
pub struct Capture<'a> {
    bytes: &'a [u8],
    shape: [usize; 4],
    plan: Plan,
    full_scale: i32,
    q_first: bool,
    frame_bytes: usize,
    /// Where the samples of the sub-frame stand in the bytes of a frame.
    part: Range<usize>,
    remarks: Vec<Remark>,
}

/// One frame of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RawFrame {
    /// Loops x chirps of a loop x receivers x samples; full scale is 1. The imaginary parts of real samples are 0.
    pub samples: Array4<Complex32>,
    /// Samples whose I or Q stands at either end of the converter's range.
    pub clipped: usize,
}

impl<'a> Capture<'a> {
    /// Lays a configuration over the bytes of a capture.
    ///
    /// # Errors
    /// [`FormatError::NoWholeFrame`] when there is not one whole frame;
    /// [`FormatError::Layout`] for an odd number of complex samples a chirp over two lanes, and for receivers that the
    /// layout has not got.
    pub fn new(bytes: &'a [u8], config: &RadarConfig) -> Result<Self, FormatError> {
        let waveform = &config.waveform;
        let shape =
            [waveform.loops, waveform.chirps_per_loop(), config.receivers.len(), waveform.samples];
        config.check_layout()?;
        let expected = config.frame_bytes();
        let frame_bytes = usize::try_from(expected).unwrap_or(usize::MAX);
        if expected == 0 || bytes.len() < frame_bytes {
            return Err(FormatError::NoWholeFrame {
                expected,
                given: bytes.len() as u64,
                layout: layout_of(config, shape),
            });
        }
        // Not beyond the bytes of a frame, which are there.
        let part = config.sub_frame_bytes();
        let mut capture = Self {
            bytes,
            shape,
            plan: config.plan(),
            full_scale: config.adc.full_scale(),
            q_first: config.adc.q_first,
            frame_bytes,
            part: part.start as usize..part.end as usize,
            remarks: vec![],
        };
        capture.remark_on_size(config);
        Ok(capture)
    }

    fn remark_on_size(&mut self, config: &RadarConfig) {
        let (frames, trailing) = (self.frames(), self.trailing_bytes());
        if trailing > 0 {
            let message = format!(
                "{trailing} bytes follow the last whole frame: the capture holds {} bytes, \
                 {frames} frames take {}; it was cut short, or recorded with another configuration",
                self.bytes.len(),
                frames * self.frame_bytes
            );
            self.remarks.push(Remark::new("trailing-bytes", message));
        }
        if let Some(expected) = config.frames.filter(|&expected| expected != frames) {
            let message =
                format!("the configuration asks for {expected} frames; {frames} are there");
            self.remarks.push(Remark::new("frame-count", message));
        }
    }

    /// Number of whole frames.
    pub fn frames(&self) -> usize {
        self.bytes.len() / self.frame_bytes
    }

    /// Bytes after the last whole frame.
    pub fn trailing_bytes(&self) -> usize {
        self.bytes.len() % self.frame_bytes
    }

    /// Loops, chirps of a loop, receivers and samples of a frame.
    pub fn shape(&self) -> [usize; 4] {
        self.shape
    }

    /// What is odd about the capture's size.
    pub fn remarks(&self) -> &[Remark] {
        &self.remarks
    }

    /// Decodes frame `index`, counted from 0.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] for an index beyond the last whole frame.
    pub fn frame(&self, index: usize) -> Result<RawFrame, FormatError> {
        check_range("frame", index as f64, 0.0, (self.frames() - 1) as f64)?;
        let start = index * self.frame_bytes;
        let bytes = &self.bytes[start + self.part.start..start + self.part.end];
        let words = bytes.as_chunks::<2>().0;
        let word = |k: usize| i32::from(i16::from_le_bytes(words[k]));
        let scale = 1.0 / self.full_scale as f32;
        let (low, high) = (-self.full_scale, self.full_scale - 1);
        let real = self.plan.sampling == Sampling::Real;
        let mut clipped = 0;
        let mut samples = vec![Complex32::default(); self.shape.iter().product()];
        self.plan.each(|place, [first, second]| {
            let (first, second) = (word(first), word(second));
            let (i, q) = if self.q_first { (second, first) } else { (first, second) };
            clipped += usize::from([i, q].iter().any(|&v| v <= low || v >= high));
            let q = if real { 0.0 } else { q as f32 * scale };
            samples[place] = Complex32::new(i as f32 * scale, q);
        });
        let given = samples.len();
        let [loops, tx, rx, count] = self.shape;
        let samples = Array4::from_shape_vec((loops, tx, rx, count), samples).map_err(|_| {
            FormatError::Layout {
                what: "samples of a frame",
                expected: (loops * tx * rx * count).to_string(),
                given: given.to_string(),
            }
        })?;
        Ok(RawFrame { samples, clipped })
    }
}

/// What a frame is made of, in words.
fn layout_of(config: &RadarConfig, [loops, chirps, receivers, samples]: [usize; 4]) -> String {
    if config.sub_frames.len() > 1 {
        return format!("{} sub-frames", config.sub_frames.len());
    }
    let receivers = if config.adc.layout == Layout::FourLane { 4 } else { receivers };
    let bytes = match config.waveform.sampling {
        Sampling::Complex => 4,
        Sampling::Real => 2,
    };
    format!(
        "{loops} loops x {chirps} chirps x {receivers} receivers x {samples} samples x {bytes} bytes"
    )
}

#[cfg(test)]
mod tests;
