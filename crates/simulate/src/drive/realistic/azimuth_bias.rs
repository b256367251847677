//! Azimuth bias of a radar behind its bumper: a smooth random curve, the same in every drive.

use super::model;
use boresight_core::Random;
use std::f64::consts::SQRT_2;

/// Distance between the points of a curve, rad: 0.5 deg.
const STEP_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// Points over the field of view.
const POINTS: usize = 281;

/// Cosines in the sum.
const TERMS: usize = 16;

/// Measured less true azimuth against azimuth.
#[derive(Debug, Clone)]
pub(crate) struct AzimuthBias {
    curve_rad: Vec<f64>,
}

fn azimuth_of(index: usize) -> f64 {
    (index as f64 - 0.5 * (POINTS - 1) as f64) * STEP_RAD
}

impl AzimuthBias {
    /// A sum of cosines of random phase with normally distributed frequencies: a Gaussian process of
    /// covariance `sigma^2 exp(-d^2 / (2 correlation^2))` (Rahimi and Recht 2007). Its mean
    /// is taken away, since that is a mounting angle.
    pub(crate) fn new(random: &mut Random) -> Self {
        let terms: Vec<(f64, f64)> = (0..TERMS)
            .map(|_| (random.normal() / model::BIAS_CORRELATION_RAD, random.phase()))
            .collect();
        let scale = model::BIAS_SIGMA_RAD * SQRT_2 / (TERMS as f64).sqrt();
        let mut curve_rad: Vec<f64> = (0..POINTS)
            .map(|i| {
                let azimuth = azimuth_of(i);
                scale * terms.iter().map(|(k, phase)| libm::cos(k * azimuth + phase)).sum::<f64>()
            })
            .collect();
        let mean = mean_within(&curve_rad, |x| x);
        let [from, to] = model::BIAS_EDGE_RAD;
        for (i, value) in curve_rad.iter_mut().enumerate() {
            let share = ((azimuth_of(i).abs() - from) / (to - from)).clamp(0.0, 1.0);
            *value = (*value - mean) * (1.0 + (model::BIAS_EDGE_FACTOR - 1.0) * share);
        }
        Self { curve_rad }
    }

    /// The bias at an azimuth, rad.
    pub(crate) fn at(&self, azimuth_rad: f64) -> f64 {
        let place = (azimuth_rad / STEP_RAD + 0.5 * (POINTS - 1) as f64).max(0.0);
        let i = (place as usize).min(POINTS - 2);
        let share = (place - i as f64).min(1.0);
        self.curve_rad[i] + (self.curve_rad[i + 1] - self.curve_rad[i]) * share
    }

    /// Root mean square within 55 deg, rad.
    pub(crate) fn rms_rad(&self) -> f64 {
        mean_within(&self.curve_rad, |x| x * x).sqrt()
    }
}

fn mean_within(curve_rad: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, value) in curve_rad.iter().enumerate() {
        if azimuth_of(i).abs() <= model::BIAS_WITHIN_RAD {
            sum += of(*value);
            count += 1.0;
        }
    }
    sum / count
}
