//! Sidelobes of the conventional beam.

use boresight_aoa::{EstimatorOptions, Grid, Method};
use boresight_core::correction::Correction;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Direction};

/// Margin by which a peak must stand above the highest sidelobe to count, dB: the sidelobes of two
/// equally strong sources may add up.
const MARGIN_DB: f64 = 6.0;

/// Loading of Capon's method where none was asked for, as a share of the mean element power. Few
/// snapshots of strong targets, seen by an array that is not quite as planned, would otherwise
/// cancel the very targets (Cox, Zeskind and Owen 1987).
const CAPON_LOADING: f64 = 0.1;

/// Least mismatch that estimators take.
const LEAST_DB: f64 = -100.0;

/// Options under which a cell's spectrum gives sources only. The conventional beamformer, and
/// Capon's with its loading, show each source with the sidelobes of the array; what lies below the
/// highest of them, and a margin, is not reported. Other methods keep their dynamic range. What a
/// calibration leaves of the array's errors is the mismatch where none is asked for.
pub fn suited(method: Method, array: &Array, options: &EstimatorOptions) -> EstimatorOptions {
    let mut options = *options;
    options.mismatch_db = options.mismatch_db.or_else(|| mismatch_left_db(array));
    if method == Method::Capon && options.loading == 0.0 {
        options.loading = CAPON_LOADING;
    }
    if matches!(method, Method::Bartlett | Method::Capon) {
        let limit_db = (highest_sidelobe_db(array, &options) - MARGIN_DB).max(1.0);
        options.dynamic_range_db = options.dynamic_range_db.min(limit_db);
    }
    options
}

/// What the array's calibration leaves of its errors, over the power of a target, dB.
pub fn mismatch_left_db(array: &Array) -> Option<f64> {
    let left_db = array.correction().and_then(Correction::residual_db);
    left_db.map(|db| db.clamp(LEAST_DB, 0.0))
}

/// Depth of the highest sidelobe below the main lobe of a beam to boresight, dB (positive);
/// infinite if there is none in the field of view.
fn highest_sidelobe_db(array: &Array, options: &EstimatorOptions) -> f64 {
    let grid = Grid::new(array, options);
    let (azimuths, elevations) = (grid.azimuth_rad.len(), grid.elevation_rad.len());
    let ahead = steering_vector(array, Direction::azimuth(0.0));
    let power: Vec<f64> = (0..grid.len())
        .map(|index| {
            let a = steering_vector(array, grid.direction(index));
            let sum: boresight_core::Complex64 =
                a.iter().zip(&ahead).map(|(a, b)| a.conj() * b).sum();
            sum.norm_sqr() / (array.len() * array.len()) as f64
        })
        .collect();
    let mut highest = 0.0_f64;
    for e in 0..elevations {
        for a in 0..azimuths {
            let here = power[e * azimuths + a];
            let is_top = (-1..=1_isize).all(|de| {
                (-1..=1_isize).all(|da| {
                    let row = e.checked_add_signed(de).filter(|&row| row < elevations);
                    let column = a.checked_add_signed(da).filter(|&column| column < azimuths);
                    match (row, column) {
                        (Some(row), Some(column)) => power[row * azimuths + column] <= here,
                        _ => true,
                    }
                })
            });
            // The main lobe and grating lobes are no sidelobes.
            if is_top && here < 0.99 {
                highest = highest.max(here);
            }
        }
    }
    -10.0 * highest.log10()
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::presets::preset;

    #[test]
    fn sidelobes_are_those_of_the_array() {
        let depth =
            |name: &str| highest_sidelobe_db(&preset(name).unwrap(), &EstimatorOptions::default());
        // A uniform array of 8: the first sidelobe of sin(8x) / 8 sin(x) lies at -12.8 dB.
        assert!((depth("awr1642") - 12.8).abs() < 0.05, "{}", depth("awr1642"));
        assert!((depth("lrr48") - 14.5).abs() < 0.1, "{}", depth("lrr48"));
    }

    #[test]
    fn only_beams_are_limited() {
        let array = preset("awr1642").unwrap();
        let given = EstimatorOptions::default();
        for method in [Method::Bartlett, Method::Capon] {
            let beam = suited(method, &array, &given);
            assert!((beam.dynamic_range_db - 6.8).abs() < 0.1);
        }
        assert_eq!(suited(Method::Iaa, &array, &given), given);
        let asked = EstimatorOptions { dynamic_range_db: 3.0, loading: 0.5, ..given };
        assert_eq!(suited(Method::Capon, &array, &asked), asked);
    }
}
