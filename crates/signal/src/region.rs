//! Regions of interest: limits on detections, and the part of a data cube around a target.

use crate::error::SignalError;
use crate::range::RowTransform;
use crate::window::Window;
use boresight_core::{Complex32, Complex64, Direction, InputError};
use boresight_math::error::check_range;
use boresight_math::order::descending;
use boresight_options::Described;
use ndarray::{Array2, Array3, Array4, ArrayView2, ArrayView3, ArrayView4};
use serde::{Deserialize, Serialize};

/// Limits, both ends inside; absent ones hold nothing back.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct Region {
    /// Least and greatest range.
    pub range_m: Option<[f64; 2]>,
    /// Least and greatest range rate.
    pub rate_mps: Option<[f64; 2]>,
    /// Least and greatest azimuth.
    #[option(range = -90..=90)]
    pub azimuth_rad: Option<[f64; 2]>,
    /// Least and greatest elevation; arrays that see none have all at 0.
    #[option(range = -90..=90)]
    pub elevation_rad: Option<[f64; 2]>,
    /// Least and greatest height over the sensor (z).
    pub height_m: Option<[f64; 2]>,
}

impl Region {
    /// Checks that no limit is NaN and each least one is not above its greatest. Infinite limits
    /// are fine.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] naming the limit.
    pub fn check(&self) -> Result<(), SignalError> {
        for (what, limits) in [
            ("range_m", self.range_m),
            ("rate_mps", self.rate_mps),
            ("azimuth_rad", self.azimuth_rad),
            ("elevation_rad", self.elevation_rad),
            ("height_m", self.height_m),
        ] {
            if let Some([least, greatest]) = limits
                && (least.is_nan() || greatest.is_nan() || least > greatest)
            {
                return Err(SignalError::Argument(InputError::OutOfRange {
                    what: format!("region.{what}"),
                    expected: format!("a greatest value of at least {least}"),
                    given: greatest,
                }));
            }
        }
        Ok(())
    }

    /// Whether range and rate lie within the limits; for detections without an angle yet.
    pub fn contains(&self, range_m: f64, rate_mps: f64) -> bool {
        self.contains_range(range_m) && within(rate_mps, self.rate_mps)
    }

    /// Whether a range lies within the limits.
    pub fn contains_range(&self, range_m: f64) -> bool {
        within(range_m, self.range_m)
    }

    /// Whether azimuth, elevation and the height of what is seen there at a range lie within the limits.
    pub fn contains_direction(&self, range_m: f64, direction: Direction) -> bool {
        let [_, _, height_m] = direction.place_m(range_m);
        within(direction.azimuth_rad, self.azimuth_rad)
            && within(direction.elevation_rad, self.elevation_rad)
            && within(height_m, self.height_m)
    }

    /// Keeps the items for which `contains` holds and counts the others.
    pub fn retain<T>(items: &mut Vec<T>, contains: impl FnMut(&T) -> bool) -> usize {
        let before = items.len();
        items.retain(contains);
        before - items.len()
    }
}

/// How much a region of interest holds; what the 3D-CNN paper (Sang et al. 2021) takes unless said otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct RegionOptions {
    /// Range bins, the strongest in their middle.
    #[option(default = 65, range = 1..)]
    pub bins: usize,
    /// Chirps of each transmitter, from the first of the frame.
    #[option(default = 4, range = 1..)]
    pub chirps: usize,
}

fn within(value: f64, limits: Option<[f64; 2]>) -> bool {
    limits.is_none_or(|[least, greatest]| value >= least && value <= greatest)
}

/// Range spectrum of a frame: loops x transmitters x receivers x samples to loops x channels x
/// range bins, with the scale of [`crate::RangeDoppler`], before any Doppler transform.
///
/// # Errors
/// [`InputError::Empty`] for a frame without values, [`InputError::OutOfRange`] for a window out of
/// range.
pub fn range_spectrum(
    frame: ArrayView4<Complex32>,
    window: Window,
) -> Result<Array3<Complex32>, SignalError> {
    let (loops, tx, rx, samples) = frame.dim();
    if frame.is_empty() {
        return Err(SignalError::Argument(InputError::Empty {
            what: "frame".into(),
            expected: "loops x transmitters x receivers x samples".into(),
        }));
    }
    let mut transform = RowTransform::new(window, samples, 1)?;
    let mut rows: Vec<Complex32> = Vec::with_capacity(frame.len());
    for chirp in frame.rows() {
        rows.extend(chirp.iter().zip(&transform.weights).map(|(x, &w)| x * w));
    }
    transform.transform(&mut rows);
    Array3::from_shape_vec((loops, tx * rx, samples), rows).map_err(|_| {
        SignalError::Argument(InputError::Shape {
            what: "frame".into(),
            expected: "loops x transmitters x receivers x samples".into(),
            given: vec![loops, tx, rx, samples],
        })
    })
}

/// Power of each range bin of a [`range_spectrum`], mean over all loops and channels.
pub fn range_power(spectrum: ArrayView3<Complex32>) -> Vec<f64> {
    let (loops, channels, ranges) = spectrum.dim();
    let share = 1.0 / (loops * channels).max(1) as f64;
    let mut powers = vec![0.0; ranges];
    for row in spectrum.rows() {
        for (power, z) in powers.iter_mut().zip(row) {
            *power += f64::from(z.norm_sqr()) * share;
        }
    }
    powers
}

/// The range bin with the most power over all loops and channels of a [`range_spectrum`].
pub fn strongest_range(spectrum: ArrayView3<Complex32>) -> usize {
    descending(range_power(spectrum)).first().copied().unwrap_or(0)
}

/// The region of interest of the 3D-CNN paper (Sang et al. 2021): the `length` range bins around
/// `centre`, all channels, the first `chirps` loops, as range x channels x chirps. Range bins wrap,
/// as the transform's do.
///
/// # Errors
/// [`InputError::OutOfRange`] where the spectrum has fewer range bins or loops, or `centre` lies
/// outside it.
pub fn crop_region(
    spectrum: ArrayView3<Complex32>,
    centre: usize,
    length: usize,
    chirps: usize,
) -> Result<Array3<Complex32>, SignalError> {
    let (loops, channels, ranges) = spectrum.dim();
    check_range("region length", length as f64, 1.0, ranges as f64)?;
    check_range("region chirps", chirps as f64, 1.0, loops as f64)?;
    check_range("region centre", centre as f64, 0.0, ranges as f64 - 1.0)?;
    let first = centre + ranges - length / 2;
    Ok(Array3::from_shape_fn((length, channels, chirps), |(j, m, c)| {
        spectrum[[c, m, (first + j) % ranges]]
    }))
}

/// A region as snapshots: channels x (bins x chirps), the chirps of a bin side by side, scaled so that their covariance
/// is [`region_covariance`].
pub fn region_snapshots(region: ArrayView3<Complex32>) -> Array2<Complex64> {
    let (length, channels, chirps) = region.dim();
    let scale = (length as f64).sqrt();
    Array2::from_shape_fn((channels, length * chirps), |(channel, at)| {
        let z = region[[at / chirps, channel, at % chirps]];
        Complex64::new(z.re.into(), z.im.into()) * scale
    })
}

/// Covariance of what passes a band-pass filter around a region of interest, channels x channels:
/// by Parseval's theorem the mean over chirps of the sum over its range bins, so that a target in
/// the middle of a bin gives its power of one raw sample where the window was rectangular.
pub fn region_covariance(region: ArrayView3<Complex32>) -> Array2<Complex64> {
    crate::covariance::sample_covariance(region_snapshots(region).view())
}

/// A covariance as the dense networks of the paper take it (its equation 8): the upper triangle by rows
/// without the diagonal, real and imaginary parts, over the largest diagonal entry; zeros for a
/// covariance of zeros. Any scale will do.
pub fn covariance_features(covariance: ArrayView2<Complex64>) -> Vec<f32> {
    let elements = covariance.nrows();
    let largest = (0..elements).fold(0.0, |most, i| covariance[[i, i]].re.max(most));
    let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
    let mut features = Vec::with_capacity(elements * elements);
    for i in 0..elements {
        for k in i + 1..elements {
            let z = covariance[[i, k]] * scale;
            features.extend([z.re as f32, z.im as f32]);
        }
    }
    features
}

/// The three real channels in which the 3D-CNN takes a region: magnitude, real and imaginary part,
/// as range x channels x chirps x 3.
pub fn region_channels(region: ArrayView3<Complex32>) -> Array4<f32> {
    let (length, channels, chirps) = region.dim();
    Array4::from_shape_fn((length, channels, chirps, 3), |(j, m, c, part)| {
        let z = region[[j, m, c]];
        [z.norm(), z.re, z.im][part]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;
    use std::f64::consts::TAU;

    /// Four chirps of a tone of power 4 in bin 20 whose phase grows by half a radian a channel.
    fn frame() -> Array4<Complex32> {
        Array4::from_shape_fn((4, 2, 3, 64), |(_, t, r, n)| {
            let z = Complex64::cis(TAU * 20.0 * n as f64 / 64.0 + 0.5 * (3 * t + r) as f64) * 2.0;
            Complex32::new(z.re as f32, z.im as f32)
        })
    }

    #[test]
    fn limits_keep_what_is_within_and_count_the_rest() {
        let region = Region {
            range_m: Some([1.0, 5.0]),
            azimuth_rad: Some([-0.5, f64::INFINITY]),
            ..Region::default()
        };
        region.check().unwrap();
        let mut cells = vec![(0.5, 0.0), (1.0, 99.0), (5.0, -3.0), (f64::NAN, 0.0)];
        let dropped = Region::retain(&mut cells, |&(range, rate)| region.contains(range, rate));
        assert_eq!((cells.len(), dropped), (2, 2));
        let azimuth = |rad| region.contains_direction(3.0, Direction::azimuth(rad));
        assert!(azimuth(-0.5) && !azimuth(-0.6));
        let space = Region {
            elevation_rad: Some([-0.2, 0.4]),
            height_m: Some([-0.5, 2.0]),
            ..Region::default()
        };
        space.check().unwrap();
        // Half a radian up is too steep; 0.3 rad up is 2.1 m high at 7 m and 1.5 m at 5.
        let up = |range_m, rad| space.contains_direction(range_m, Direction::new(0.7, rad));
        assert!(up(5.0, 0.3) && !up(7.0, 0.3) && !up(1.0, 0.5) && !up(3.0, -0.19));
        for limits in [[2.0, 1.0], [f64::NAN, 1.0], [0.0, f64::NAN]] {
            let refused = Region { rate_mps: Some(limits), ..region }.check().unwrap_err();
            assert_eq!(
                (refused.code(), &*refused.details().what),
                ("out-of-range", "region.rate_mps")
            );
        }
    }

    #[test]
    fn the_region_is_centred_on_the_target_and_wraps() {
        let spectrum = range_spectrum(frame().view(), Window::Rectangular).unwrap();
        assert_eq!(strongest_range(spectrum.view()), 20);
        let region = crop_region(spectrum.view(), 20, 9, 3).unwrap();
        assert_eq!(region.dim(), (9, 6, 3));
        assert!((region[[4, 0, 2]].norm() - 2.0).abs() < 1e-5);
        assert!(region.index_axis(ndarray::Axis(0), 3).iter().all(|z| z.norm() < 1e-4));
        let wrapped = crop_region(spectrum.view(), 63, 64, 1).unwrap();
        assert!((wrapped[[20 + 64 - 31, 1, 0]].norm() - 2.0).abs() < 1e-5);
        let parts = region_channels(region.view());
        assert_eq!(parts[[4, 1, 0, 1]], region[[4, 1, 0]].re);
        assert_eq!(parts[[4, 1, 0, 0]], region[[4, 1, 0]].norm());
    }

    #[test]
    fn the_covariance_holds_power_and_phase() {
        let spectrum = range_spectrum(frame().view(), Window::Rectangular).unwrap();
        let region = crop_region(spectrum.view(), 20, 9, 4).unwrap();
        let covariance = region_covariance(region.view());
        assert!((covariance[[0, 0]].re - 4.0).abs() < 1e-4);
        assert!((covariance[[3, 1]] - Complex64::cis(1.0) * 4.0).norm() < 1e-4);
        let features = covariance_features(covariance.view());
        assert_eq!(features.len(), 6 * 5);
        // The first row's last entry: elements 0 and 5.
        let angle = features[9].atan2(features[8]);
        assert!((angle + 2.5).abs() < 1e-4, "{angle}");
        assert!(covariance_features(Array2::zeros((6, 6)).view()).iter().all(|x| *x == 0.0));
    }

    #[test]
    fn regions_beyond_the_spectrum_are_refused() {
        let spectrum = range_spectrum(frame().view(), Window::Hann).unwrap();
        for (centre, length, chirps, what) in [
            (64, 9, 1, "region centre"),
            (3, 65, 1, "region length"),
            (3, 0, 1, "region length"),
            (3, 9, 5, "region chirps"),
            (3, 9, 0, "region chirps"),
        ] {
            let refused = crop_region(spectrum.view(), centre, length, chirps).unwrap_err();
            assert_eq!((refused.code(), &*refused.details().what), ("out-of-range", what));
        }
        let none = range_spectrum(Array4::zeros((0, 1, 1, 8)).view(), Window::Hann).unwrap_err();
        assert_eq!((none.code(), &*none.details().what), ("empty", "frame"));
    }
}
