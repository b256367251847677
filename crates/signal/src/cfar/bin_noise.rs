//! How noise in the bins of a transform is correlated.

use crate::error::SignalError;
use crate::range::MAX_PADDING;
use crate::window::{Window, power_correlation};
use std::f64::consts::PI;

/// Squared correlations below this are taken as none.
const UNCORRELATED: f64 = 1e-5;

/// White noise after a transform of `samples` values under a window to `bins` bins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BinNoise {
    window: Window,
    samples: usize,
    bins: usize,
}

impl BinNoise {
    /// For a window that [`Window::coefficients`] makes of so many samples, zero-padded by a factor.
    pub fn new(window: Window, samples: usize, padding: usize) -> Self {
        Self { window, samples, bins: samples.saturating_mul(padding) }
    }

    /// Correlations of bins 0, 1, 2, ... apart, up to `most`, without their linear phase, which no power depends on:
    /// `sum w^2 cos(2 pi lag n / bins) / sum w^2` with `n` from the middle of the data. Ends where all that follow are
    /// negligible.
    ///
    /// # Errors
    /// As [`Window::coefficients`].
    pub(crate) fn correlations(&self, most: usize) -> Result<Vec<f64>, SignalError> {
        let squares: Vec<f64> =
            self.window.coefficients(self.samples)?.iter().map(|w| w * w).collect();
        let total: f64 = squares.iter().sum();
        let middle = 0.5 * (self.samples as f64 - 1.0);
        // Beyond the main lobes of the longest windows nothing is left but sidelobes of a few thousandths.
        let lobes = 8 * self.bins.div_ceil(self.samples.max(1)).clamp(1, MAX_PADDING);
        let mut all: Vec<f64> = (0..=most.min(lobes))
            .map(|lag| {
                let turn = 2.0 * PI * lag as f64 / self.bins as f64;
                let waves = squares.iter().enumerate();
                waves.map(|(n, w)| w * (turn * (n as f64 - middle)).cos()).sum::<f64>() / total
            })
            .collect();
        while all.last().is_some_and(|r| r * r < UNCORRELATED) {
            all.pop();
        }
        Ok(all)
    }

    /// Neighbouring bins that count as one independent bin: the sum over all lags of the squared correlation. 1 without
    /// window and padding, 1.94 for a long Hann window.
    ///
    /// # Errors
    /// As [`Window::coefficients`].
    pub fn correlated_bins(&self) -> Result<f64, SignalError> {
        Ok(power_correlation(&self.window.coefficients(self.samples)?, self.bins))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_hann_window_correlates_two_neighbours() {
        // Of a long one: 2/3, 1/6 and nothing.
        let noise = BinNoise::new(Window::Hann, 4096, 1);
        let found = noise.correlations(20).unwrap();
        assert_eq!(found.len(), 3);
        for (found, expected) in found.iter().zip([1.0, 2.0 / 3.0, 1.0 / 6.0]) {
            assert!((found - expected).abs() < 1e-3, "{found}");
        }
        let sum = 1.0 + 2.0 * found[1..].iter().map(|r| r * r).sum::<f64>();
        assert!((sum - noise.correlated_bins().unwrap()).abs() < 1e-4);
    }

    #[test]
    fn without_window_and_padding_bins_are_independent() {
        let noise = BinNoise::new(Window::Rectangular, 64, 1);
        assert_eq!(noise.correlations(10).unwrap().len(), 1);
        let padded = BinNoise::new(Window::Rectangular, 64, 2).correlations(10).unwrap();
        assert!((padded[1] - 2.0 / PI).abs() < 1e-3 && padded.len() > 3);
    }
}
