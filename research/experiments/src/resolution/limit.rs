//! Beam width and statistical resolution limit.

use boresight_aoa::AoaError;
use boresight_aoa::bounds::{Signals, deterministic_bound, uncorrelated};
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Direction};
use boresight_math::decibels::db_to_power;

/// Width of the beam of the whole array at half power, in sine of azimuth.
pub fn beam_width(array: &Array) -> f64 {
    let gain = |sine: f64| {
        let beam = steering_vector(array, Direction::azimuth(sine.asin()));
        (beam.iter().sum::<Complex64>() / beam.len() as f64).norm_sqr()
    };
    let step = 1e-2 / array.aperture().max(1.0);
    let mut high = step;
    while gain(high) > 0.5 && high + step < 1.0 {
        high += step;
    }
    let mut low = high - step;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if gain(middle) > 0.5 { low = middle } else { high = middle }
    }
    2.0 * high
}

/// Standard deviation, in sine of azimuth, of the separation of two targets of power 1 around boresight, at the
/// Cramer-Rao bound with their phases averaged out of its information; infinite where there is none.
///
/// # Errors
/// Those of [`deterministic_bound`].
pub fn separation_sigma(
    array: &Array,
    separation: f64,
    snr_db: f64,
    snapshots: usize,
) -> Result<f64, AoaError> {
    let sine = 0.5 * separation;
    let truth = [-sine, sine].map(|sine| Direction::azimuth(sine.asin()));
    let power = uncorrelated(&[1.0, 1.0]);
    let signals =
        Signals { covariance: power.view(), noise_power: db_to_power(-snr_db), snapshots };
    let c = deterministic_bound(array, &truth, &signals)?.covariance;
    let variance = c[[0, 0]] + c[[1, 1]] - c[[0, 1]] - c[[1, 0]];
    Ok(variance.sqrt() * (1.0 - sine * sine).sqrt())
}

/// Statistical resolution limit (Smith 2005): the separation, in sine of azimuth, that equals its own
/// standard deviation at the bound. Searched up to `largest`; nothing if it is beyond.
///
/// # Errors
/// Those of [`deterministic_bound`].
pub fn resolution_limit(
    array: &Array,
    snr_db: f64,
    snapshots: usize,
    largest: f64,
) -> Result<Option<f64>, AoaError> {
    let resolved = |separation: f64| {
        separation_sigma(array, separation, snr_db, snapshots).map(|sigma| sigma <= separation)
    };
    let (mut low, mut high) = (1e-4 * largest, largest);
    if !resolved(high)? {
        return Ok(None);
    }
    for _ in 0..50 {
        let middle = (low * high).sqrt();
        if resolved(middle)? { high = middle } else { low = middle }
    }
    Ok(Some(high))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_beam_of_a_long_line_is_0_886_of_wavelength_over_length() {
        let array = Array::ula(64).unwrap();
        assert!((beam_width(&array) * 64.0 / 2.0 - 0.8859).abs() < 1e-3);
    }

    /// Near each other, the deviation of the separation grows with the inverse of its own size: the limit
    /// falls with the fourth root of the signal-to-noise ratio and the number of snapshots (Smith 2005).
    #[test]
    fn the_limit_falls_with_the_fourth_root_of_the_signal() {
        let array = Array::ula(8).unwrap();
        let limit =
            |snr_db, snapshots| resolution_limit(&array, snr_db, snapshots, 0.5).unwrap().unwrap();
        let of_far = limit(50.0, 1);
        assert!((limit(40.0, 1) / of_far / 10_f64.powf(0.25) - 1.0).abs() < 0.02);
        assert!((limit(40.0, 10) / of_far - 1.0).abs() < 1e-6);
        assert!(resolution_limit(&array, -40.0, 1, 0.5).unwrap().is_none());
        let sigma = separation_sigma(&array, of_far, 50.0, 1).unwrap();
        assert!((sigma / of_far - 1.0).abs() < 1e-6);
    }
}
