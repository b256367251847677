//! Data scaled to order one, so that powers neither overflow nor vanish.

use crate::data::SILENCE;
use crate::estimate::Source;
use boresight_core::Complex64;
use ndarray::{Array2, ArrayView2};

/// Snapshots whose largest part is 1, and what they were divided by.
pub(crate) struct Normalised {
    pub snapshots: Array2<Complex64>,
    scale: f64,
}

impl Normalised {
    /// Nothing for silence.
    pub fn new(y: ArrayView2<Complex64>) -> Option<Self> {
        let scale = scale_of(y)?;
        Some(Self { snapshots: y.mapv(|z| z / scale), scale })
    }

    /// A power of the data as given, in that of the normalised.
    pub fn power_in(&self, power: f64) -> f64 {
        power / self.scale / self.scale
    }

    /// A power of the normalised data in that of the data as given.
    pub fn power_out(&self, power: f64) -> f64 {
        power_out(power, self.scale)
    }

    /// A source of the normalised data in the unit of the data as given.
    pub fn source_out(&self, source: Source) -> Source {
        Source {
            power: self.power_out(source.power),
            amplitude: source.amplitude.map(|s| s * self.scale),
            ..source
        }
    }
}

/// The largest real or imaginary part; nothing for silence.
pub(crate) fn scale_of(y: ArrayView2<Complex64>) -> Option<f64> {
    let largest = y.iter().map(|z| z.re.abs().max(z.im.abs())).fold(0.0, f64::max);
    (largest > SILENCE).then_some(largest)
}

/// `power scale^2`, at most the largest finite number.
pub(crate) fn power_out(power: f64, scale: f64) -> f64 {
    (power * scale * scale).min(f64::MAX)
}
