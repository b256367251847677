//! Angular resolution of an array.

use crate::array::Array;
use std::f64::consts::FRAC_PI_2;

/// Azimuth beside boresight where the beam of a beamformer has its first null, rad: the Rayleigh limit, from which on
/// two equal targets are told apart. `pi / 2` where the pattern has no null.
///
/// `N` elements `d` half wavelengths apart have the pattern `sin(N x) / sin(x)` with `x = pi d sin(azimuth) / 2`, whose
/// first null is at `sin(azimuth) = 2 / (N d)`. `N d` is the aperture from the first to the last element and one spacing
/// more: each element stands for half a spacing to either side. Without that spacing the limit would be that of a
/// continuous aperture, a tenth too wide for eleven elements. An array with gaps counts as the filled one on its grid;
/// one on no grid has the mean gap between its places along y for a spacing.
///
/// ```
/// use boresight_core::presets::preset;
/// use boresight_core::resolution::resolution_rad;
///
/// assert!((resolution_rad(&preset("ula8")?).sin() - 2.0 / 8.0).abs() < 1e-12);
/// # Ok::<(), boresight_core::InputError>(())
/// ```
pub fn resolution_rad(array: &Array) -> f64 {
    let aperture = array.aperture();
    let spacing = array.lattice().map_or_else(|| mean_gap(array), |lattice| lattice.spacing);
    let sine = 2.0 / (aperture + spacing);
    if sine < 1.0 { sine.asin() } else { FRAC_PI_2 }
}

/// Aperture over the number of gaps between places along y.
fn mean_gap(array: &Array) -> f64 {
    let places = array.positions();
    let is_new = |&k: &usize| places[..k].iter().all(|p| (p[1] - places[k][1]).abs() > 1e-6);
    let gaps = (0..places.len()).filter(is_new).count().saturating_sub(1);
    array.aperture() / gaps.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::Direction;
    use crate::steering::steering_vector;

    fn along_y(places: &[f64]) -> Array {
        let positions: Vec<_> = places.iter().map(|&y| [0.0, y, 0.0]).collect();
        Array::new(&positions).unwrap()
    }

    #[test]
    fn is_the_first_null_of_evenly_spaced_elements() {
        for places in
            [vec![0.0, 1.0, 2.0], vec![0.0, -2.0, -4.0, -6.0], vec![1.0, 1.5, 2.0, 2.5, 3.0, 3.5]]
        {
            let array = along_y(&places);
            let response = |azimuth: f64| {
                let sum: crate::Complex64 =
                    steering_vector(&array, Direction::azimuth(azimuth)).iter().sum();
                sum.norm() / array.len() as f64
            };
            let limit = resolution_rad(&array);
            assert!(response(limit) < 1e-12, "{places:?}");
            assert!((1..100).all(|k| response(limit * f64::from(k) / 100.0) > 0.005), "{places:?}");
        }
    }

    #[test]
    fn counts_gaps_as_filled_and_takes_the_mean_gap_off_a_grid() {
        let sine = |places: &[f64]| resolution_rad(&along_y(places)).sin();
        assert!((sine(&[0.0, 2.0, 5.0]) - 2.0 / 6.0).abs() < 1e-12);
        assert!((sine(&[0.0, 2.0f64.sqrt(), 6.0]) - 2.0 / 9.0).abs() < 1e-12);
        assert_eq!(resolution_rad(&along_y(&[0.0, 1.0])), FRAC_PI_2);
        assert_eq!(resolution_rad(&along_y(&[0.0])), FRAC_PI_2);
    }
}
