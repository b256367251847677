//! Range transform: samples of each chirp to range bins.

use crate::cfar::BinNoise;
use crate::error::SignalError;
use crate::window::{Window, noise_bandwidth_bins};
use boresight_core::units::SPEED_OF_LIGHT_MPS;
use boresight_core::{Complex32, Waveform};
use boresight_math::error::check_range;
use boresight_math::fft::Transforms;
use rustfft::Fft;
use std::sync::Arc;

/// Longest padding, as a multiple of the data.
pub(crate) const MAX_PADDING: usize = 64;

/// A windowed, optionally zero-padded FFT over many rows, scaled so that a tone in the middle of a
/// bin keeps its amplitude.
pub(crate) struct RowTransform {
    /// Window times scale.
    pub weights: Vec<f32>,
    pub noise_bandwidth_bins: f64,
    /// What white noise becomes in its bins.
    pub noise: BinNoise,
    fft: Arc<dyn Fft<f32>>,
    scratch: Vec<Complex32>,
}

impl RowTransform {
    /// Rows of `length` values to `length * padding` bins.
    pub fn new(window: Window, length: usize, padding: usize) -> Result<Self, SignalError> {
        check_range("padding", padding as f64, 1.0, MAX_PADDING as f64)?;
        let coefficients = window.coefficients(length)?;
        let scale = 1.0 / coefficients.iter().sum::<f64>();
        let fft = f32::plan_forward(length * padding);
        Ok(Self {
            weights: coefficients.iter().map(|w| (w * scale) as f32).collect(),
            noise_bandwidth_bins: noise_bandwidth_bins(&coefficients),
            noise: BinNoise::new(window, length, padding),
            scratch: vec![Complex32::default(); fft.get_inplace_scratch_len()],
            fft,
        })
    }

    pub fn bins(&self) -> usize {
        self.fft.len()
    }

    /// Transforms each of the rows of [`RowTransform::bins`] values, which are weighted already.
    pub fn transform(&mut self, rows: &mut [Complex32]) {
        self.fft.process_with_scratch(rows, &mut self.scratch);
    }
}

/// Range of each bin of a range transform of `bins` bins, m, over the band of beat frequencies
/// ([`Waveform::beat_band_hz`]): all bins of complex samples, the half of real ones.
pub fn range_axis_m(waveform: &Waveform, bins: usize) -> Vec<f64> {
    (0..bins).map(|k| range_of_bin_m(waveform, bins, k as f64)).collect()
}

/// Range of a bin that need not be whole, m.
pub fn range_of_bin_m(waveform: &Waveform, bins: usize, bin: f64) -> f64 {
    let beat_hz = bin * waveform.beat_band_hz() / bins as f64;
    beat_hz * SPEED_OF_LIGHT_MPS / (2.0 * waveform.slope_hz_per_s)
}

/// How much further than it is a target with `rate_mps` appears, m: its Doppler frequency adds to
/// the beat frequency, as `fc rate / slope`.
pub fn range_doppler_coupling_m(waveform: &Waveform, rate_mps: f64) -> f64 {
    waveform.centre_frequency_hz() * rate_mps / waveform.slope_hz_per_s
}
