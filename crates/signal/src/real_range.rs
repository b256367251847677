//! Range transform of real samples.

use crate::cfar::BinNoise;
use crate::error::SignalError;
use crate::range::MAX_PADDING;
use crate::window::{Window, noise_bandwidth_bins};
use boresight_core::{Complex32, InputError};
use boresight_math::error::check_range;
use boresight_math::fft::RealFft;
use ndarray::ArrayView1;
use std::f64::consts::SQRT_2;

/// A windowed, optionally zero-padded transform of real samples to the half of their spectrum with
/// positive beat frequencies. The other half is its mirror image and is left out, as is the bin at half the sample
/// rate. A tone in the middle of a bin has the power of its samples: `A^2 / 2` for `A cos`, half of it from the image.
pub(crate) struct RealRangeTransform {
    /// Window times scale.
    weights: Vec<f32>,
    pub noise_bandwidth_bins: f64,
    /// What white noise becomes in its bins.
    pub noise: BinNoise,
    fft: RealFft<f32>,
    values: Vec<f32>,
    spectrum: Vec<Complex32>,
}

impl RealRangeTransform {
    /// Rows of `length` values, an even number, to `length * padding / 2` bins.
    pub fn new(window: Window, length: usize, padding: usize) -> Result<Self, SignalError> {
        check_range("padding", padding as f64, 1.0, MAX_PADDING as f64)?;
        let coefficients = window.coefficients(length)?;
        let scale = SQRT_2 / coefficients.iter().sum::<f64>();
        let fft = RealFft::new(length * padding);
        Ok(Self {
            weights: coefficients.iter().map(|w| (w * scale) as f32).collect(),
            noise_bandwidth_bins: noise_bandwidth_bins(&coefficients),
            noise: BinNoise::new(window, length, padding),
            values: vec![0.0; length * padding],
            spectrum: vec![Complex32::default(); fft.bins()],
            fft,
        })
    }

    /// Bins from zero to below half the sample rate.
    pub fn bins(&self) -> usize {
        self.values.len() / 2
    }

    /// Transforms a chirp into a row of [`RealRangeTransform::bins`] values.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a sample with an imaginary part.
    pub fn transform(
        &mut self,
        chirp: ArrayView1<Complex32>,
        row: &mut [Complex32],
    ) -> Result<(), SignalError> {
        for ((value, sample), &weight) in self.values.iter_mut().zip(chirp).zip(&self.weights) {
            if sample.im != 0.0 {
                return Err(SignalError::Argument(InputError::OutOfRange {
                    what: "imaginary part of a sample".into(),
                    expected: "0, since the waveform's sampling is real".into(),
                    given: sample.im.into(),
                }));
            }
            *value = sample.re * weight;
        }
        self.fft.forward(&self.values, &mut self.spectrum);
        row.iter_mut().zip(&self.spectrum).for_each(|(bin, &value)| *bin = value);
        Ok(())
    }
}
