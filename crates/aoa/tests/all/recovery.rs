//! Every method finds sources exactly, or as exactly as it can, when there is no noise.

use crate::support::{azimuths, estimate, found, known, scene};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method, SourceCount, Warning};
use boresight_core::presets::preset;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Direction, Random};
use ndarray::Array2;

const SUBSPACE: [Method; 4] = [Method::Music, Method::RootMusic, Method::Esprit, Method::MinNorm];

fn assert_close(found: &[f64], wanted: &[Direction], tolerance: f64, what: &str) {
    assert_eq!(found.len(), wanted.len(), "{what}: {found:?}");
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w.azimuth_rad).abs() < tolerance, "{what}: {found:?} for {wanted:?}");
    }
}

#[test]
fn subspace_methods_are_exact_without_noise() {
    let mut random = Random::new(21, 0);
    let wanted = azimuths(&[-40.0, -3.0, 1.5, 62.0]);
    for name in ["ula10", "awr1642", "cascade86", "ula32"] {
        let array = preset(name).unwrap();
        let y = scene(&array, &wanted, &[1.0, 0.5, 2.0, 0.1], 0.0, 12, &mut random);
        for method in SUBSPACE {
            for sources in [SourceCount::Known(4), SourceCount::Mdl, SourceCount::Aic] {
                let options = EstimatorOptions { sources, ..EstimatorOptions::default() };
                let result = estimate(method, &array, &options, &y);
                let what = format!("{} on {name}, {sources:?}", method.name());
                assert_close(&found(&result), &wanted, 1e-6, &what);
                assert!(result.resolved && result.warnings.is_empty(), "{what}");
            }
        }
    }
}

#[test]
fn powers_are_those_of_the_sources() {
    let mut random = Random::new(22, 0);
    let array = Array::ula(10).unwrap();
    let wanted = azimuths(&[-20.0, 15.0]);
    let y = scene(&array, &wanted, &[1.0, 0.01], 0.0, 200, &mut random);
    for method in SUBSPACE {
        let result = estimate(method, &array, &known(2), &y);
        let powers: Vec<f64> = result.sources.iter().map(|s| s.power).collect();
        // The mean of 200 exponentials of mean p has a spread of p / sqrt(200): five of those.
        assert!((powers[0] - 1.0).abs() < 0.36, "{powers:?}");
        assert!((powers[1] - 0.01).abs() < 0.0036, "{powers:?}");
    }
}

#[test]
fn both_forms_of_esprit_agree_without_noise() {
    let mut random = Random::new(23, 0);
    let wanted = azimuths(&[-11.0, 35.0]);
    for name in ["ula8", "awr1642"] {
        let array = preset(name).unwrap();
        let y = scene(&array, &wanted, &[1.0, 1.0], 0.0, 20, &mut random);
        for esprit in [
            boresight_aoa::options::EspritForm::LeastSquares,
            boresight_aoa::options::EspritForm::TotalLeastSquares,
        ] {
            let options = EstimatorOptions { esprit, ..known(2) };
            let result = estimate(Method::Esprit, &array, &options, &y);
            assert_close(&found(&result), &wanted, 1e-9, &format!("{esprit:?} on {name}"));
        }
    }
}

#[test]
fn a_single_snapshot_is_enough_for_its_own_music() {
    let array = Array::ula(16).unwrap();
    let wanted = azimuths(&[-30.0, 2.0, 21.0]);
    let mut random = Random::new(24, 0);
    let y = scene(&array, &wanted, &[1.0, 0.3, 0.6], 0.0, 1, &mut random);
    for forward_backward in [false, true] {
        let options = EstimatorOptions { forward_backward, ..known(3) };
        let result = estimate(Method::SingleSnapshotMusic, &array, &options, &y);
        assert_close(&found(&result), &wanted, 1e-6, "single snapshot");
        let power: f64 = result.sources.iter().map(|s| s.amplitude.unwrap().norm_sqr()).sum();
        let again: f64 = result.sources.iter().map(|s| s.power).sum();
        assert!((power - again).abs() < 1e-9 * power);
    }
}

#[test]
fn capon_says_that_it_loaded_a_covariance_without_noise() {
    let array = Array::ula(12).unwrap();
    let wanted = azimuths(&[-25.0, 10.0]);
    let mut random = Random::new(25, 0);
    let y = scene(&array, &wanted, &[1.0, 1.0], 0.0, 40, &mut random);
    let result = estimate(Method::Capon, &array, &EstimatorOptions::default(), &y);
    assert_close(&found(&result), &wanted, 1e-5, "capon");
    assert!(matches!(result.warnings[..], [Warning::Loaded { share }] if share < 1e-7));
    let few = y.slice(ndarray::s![.., ..3]).to_owned();
    let result = estimate(Method::Capon, &array, &EstimatorOptions::default(), &few);
    assert_close(&found(&result), &wanted, 5e-3, "capon, three snapshots");
    assert!(matches!(result.warnings[..], [Warning::Loaded { share }] if share >= 1e-2));
}

#[test]
fn elements_on_a_sparse_lattice() {
    let array = preset("lrr48").unwrap();
    let wanted = azimuths(&[-10.2, 0.4, 33.0]);
    let mut random = Random::new(26, 0);
    let y = scene(&array, &wanted, &[1.0, 1.0, 1.0], 0.0, 60, &mut random);
    for method in [Method::Music, Method::RootMusic, Method::Capon] {
        let result = estimate(method, &array, &known(3), &y);
        assert_close(&found(&result), &wanted, 1e-6, method.name());
    }
}

#[test]
fn azimuth_and_elevation_on_a_planar_array() {
    let array = preset("awr1843").unwrap();
    let wanted = [Direction::new(-0.35, 0.12), Direction::new(0.4, -0.2)];
    let mut random = Random::new(27, 0);
    let y = scene(&array, &wanted, &[1.0, 0.7], 0.0, 50, &mut random);
    let result = estimate(Method::Music, &array, &known(2), &y);
    let mut at: Vec<Direction> = result.sources.iter().map(|s| *s.direction).collect();
    at.sort_by(|a, b| a.azimuth_rad.total_cmp(&b.azimuth_rad));
    for (a, w) in at.iter().zip(&wanted) {
        assert!((a.azimuth_rad - w.azimuth_rad).abs() < 1e-6, "{at:?}");
        assert!((a.elevation_rad - w.elevation_rad).abs() < 1e-6, "{at:?}");
    }
    let one = scene(&array, &wanted[..1], &[1.0], 1e-3, 50, &mut random);
    for method in [Method::Bartlett, Method::Capon] {
        let first =
            estimate(method, &array, &EstimatorOptions::default(), &one).sources[0].direction;
        assert!((first.azimuth_rad - wanted[0].azimuth_rad).abs() < 0.01, "{first:?}");
        assert!((first.elevation_rad - wanted[0].elevation_rad).abs() < 0.02, "{first:?}");
    }
}

/// Two coherent sources give a covariance of rank one; averaging and smoothing restore it.
#[test]
fn coherent_sources_need_smoothing() {
    let array = Array::ula(12).unwrap();
    let wanted = azimuths(&[-5.0, 4.0]);
    let mut random = Random::new(28, 0);
    let wave = Array2::from_shape_fn((1, 60), |_| random.complex_normal(1.0));
    let both = ndarray::concatenate![ndarray::Axis(0), wave, wave];
    let noise = Array2::from_shape_fn((12, 60), |_| random.complex_normal(1e-4));
    let y = steering_matrix(&array, &wanted).dot(&both) + noise;
    for method in SUBSPACE {
        let plain = found(&estimate(method, &array, &known(2), &y));
        let right = plain.len() == 2
            && plain.iter().zip(&wanted).all(|(f, w)| (f - w.azimuth_rad).abs() < 0.005);
        assert!(!right, "{} cannot separate them: {plain:?}", method.name());
        let smoothing = EstimatorOptions { smoothing: Some(9), ..known(2) };
        let both = EstimatorOptions { forward_backward: true, smoothing: Some(10), ..known(2) };
        for options in [smoothing, both] {
            let result = estimate(method, &array, &options, &y);
            assert_close(&found(&result), &wanted, 0.005, method.name());
        }
    }
}

#[test]
fn wide_spacing_is_ambiguous_and_says_so() {
    let positions: Vec<[f64; 3]> = (0..8).map(|k| [0.0, 2.0 * f64::from(k), 0.0]).collect();
    let array = Array::new(&positions).unwrap();
    let wanted = azimuths(&[-12.0, 20.0]);
    let mut random = Random::new(29, 0);
    let y = scene(&array, &wanted, &[1.0, 0.5], 0.0, 20, &mut random);
    for method in [Method::Capon, Method::Music, Method::RootMusic, Method::Esprit, Method::MinNorm]
    {
        let result = estimate(method, &array, &known(2), &y);
        assert_close(&found(&result), &wanted, 1e-5, method.name());
        let [.., Warning::Ambiguous { unambiguous_rad }] = result.warnings[..] else {
            let first = result.warnings.first();
            assert!(matches!(first, Some(Warning::Ambiguous { .. })), "{:?}", result.warnings);
            continue;
        };
        assert!((unambiguous_rad - 30.0_f64.to_radians()).abs() < 1e-9);
        let narrow = EstimatorOptions { field_of_view_rad: 0.5, ..known(2) };
        let quiet = estimate(method, &array, &narrow, &y);
        assert!(!quiet.warnings.iter().any(|w| matches!(w, Warning::Ambiguous { .. })));
    }
}

#[test]
fn a_covariance_gives_what_its_snapshots_give() {
    let array = Array::ula(9).unwrap();
    let mut random = Random::new(30, 0);
    let y = scene(&array, &azimuths(&[-8.0, 19.0]), &[1.0, 1.0], 0.01, 40, &mut random);
    let r = boresight_signal::sample_covariance(y.view());
    for method in SUBSPACE.into_iter().chain([Method::Bartlett, Method::Capon]) {
        let mut estimator = Estimator::new(method, &array, &known(2)).unwrap();
        let from_snapshots = estimator.estimate(Data::Snapshots(y.view())).unwrap();
        let data = Data::Covariance { matrix: r.view(), snapshots: 40 };
        let from_covariance = estimator.estimate(data).unwrap();
        assert_eq!(found(&from_snapshots), found(&from_covariance), "{}", method.name());
    }
}
