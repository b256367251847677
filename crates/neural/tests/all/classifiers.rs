//! Counting network, DNN and 3D-CNN on simulated cubes, against the truth.

use crate::support::{card, golden, model, names, root};
use boresight_aoa::{Data, EstimatorOptions, SourceCount, Warning};
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex32, Complex64, Diagnose, Direction, Random};
use boresight_math::phasor::cis;
use boresight_neural::{Kind, covariance_features};
use boresight_signal::region::{region_covariance, region_snapshots};
use ndarray::{Array2, Array3, array};

/// A region of targets at whole degrees: their power in neighbouring bins near the middle, noise in all.
fn region(array: &Array, degrees: &[f64], noise: f64, number: u64) -> Array3<Complex32> {
    let random = &mut Random::new(29, number);
    let at: Vec<Direction> = degrees.iter().map(|d| Direction::azimuth(d.to_radians())).collect();
    let steering = steering_matrix(array, &at);
    let mut region = Array3::from_shape_fn((65, 8, 4), |_| random.complex_normal(noise));
    for (k, response) in steering.columns().into_iter().enumerate() {
        let (bin, phase) = (32 + 7 * k, cis(random.phase()));
        for (beside, share) in [(0, 0.8), (1, 0.4)] {
            for m in 0..8 {
                for c in 0..4 {
                    region[[bin + beside, m, c]] += response[m] * phase * share;
                }
            }
        }
    }
    region.mapv(|z| Complex32::new(z.re as f32, z.im as f32))
}

/// A score at 15 dB from a card.
fn metric(name: &str, score: &str) -> f64 {
    let text = std::fs::read(root().join(format!("models/{name}.json"))).unwrap();
    let card: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let at = |m: &&serde_json::Value| m["snrDb"] == 15;
    card["metrics"].as_array().unwrap().iter().find(at).unwrap()[score].as_f64().unwrap()
}

fn of_kind(kind: Kind, targets: Option<usize>) -> Vec<String> {
    names().into_iter().filter(|n| card(n).kind == kind && card(n).targets == targets).collect()
}

#[test]
fn features_are_the_upper_triangle_over_the_largest_power() {
    let y =
        array![[Complex64::new(1.0, 1.0)], [Complex64::new(0.0, 2.0)], [Complex64::new(3.0, 0.0)]];
    // y_0 conj(y_1), y_0 conj(y_2), y_1 conj(y_2) over |y_2|^2.
    let expected = [2.0, -2.0, 3.0, 3.0, 0.0, 6.0].map(|x: f32| x / 9.0);
    let features = covariance_features(Data::Snapshots(y.view()));
    assert!(features.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-6), "{features:?}");
    let none = Array2::<Complex64>::zeros((8, 2));
    assert_eq!(covariance_features(Data::Snapshots(none.view())), vec![0.0; 56]);
}

/// 20 dB in the strongest bin; the card states 99 % at 5 dB of a raw sample, which is no less.
#[test]
fn targets_are_counted() {
    let array = Array::ula(8).unwrap();
    for name in of_kind(Kind::Counting, None) {
        let network = model(&name);
        let mut right = 0;
        for number in 0..30 {
            let degrees = &[-6.0, 5.0][..number % 3];
            let region = region(&array, degrees, 1e-2, number as u64);
            let covariance = region_covariance(region.view());
            let data = Data::Covariance { matrix: covariance.view(), snapshots: 4 };
            let counted = network.count(data).unwrap();
            let snapshots = region_snapshots(region.view());
            let same = network.count(Data::Snapshots(snapshots.view())).unwrap();
            assert!((counted.probability[2] - same.probability[2]).abs() < 1e-4);
            right += usize::from(counted.sources == degrees.len());
        }
        println!("{name}: {right} of 30");
        assert!(right >= 27, "{name}: {right}");
    }
}

#[test]
fn two_targets_are_found_to_a_degree_and_mirrored_by_a_mirrored_array() {
    let left = Array::ula(8).unwrap();
    let mirrored: Vec<[f64; 3]> = (0..8).map(|k| [0.0, -f64::from(k), 0.0]).collect();
    let right = Array::new(&mirrored).unwrap();
    let options = EstimatorOptions {
        field_of_view_rad: 10.0_f64.to_radians(),
        sources: SourceCount::Known(2),
        ..EstimatorOptions::default()
    };
    for kind in [Kind::Dnn, Kind::Cnn3d] {
        for name in of_kind(kind, Some(2)) {
            let network = model(&name);
            let mut good = 0;
            for number in 0..20 {
                let region = region(&left, &[-6.0, 4.0], 1e-2, number);
                let estimate = network.estimate_region(region.view(), &left, &options).unwrap();
                assert!(estimate.resolved && estimate.warnings.is_empty());
                let other = network.estimate_region(region.view(), &right, &options).unwrap();
                let degrees = |estimate: &boresight_aoa::Estimate, sign: f64| {
                    let mut all: Vec<f64> = estimate
                        .sources
                        .iter()
                        .map(|s| (sign * s.direction.azimuth_rad.to_degrees()).round())
                        .collect();
                    all.sort_by(f64::total_cmp);
                    all
                };
                assert_eq!(degrees(&estimate, 1.0), degrees(&other, -1.0));
                let found = degrees(&estimate, 1.0);
                let right = (found[0] + 6.0).abs() <= 1.0 && (found[1] - 4.0).abs() <= 1.0;
                good += usize::from(right);
                if right {
                    // Power of a raw sample: 0.8^2 + 0.4^2, and what an error of a degree costs.
                    assert!(estimate.sources.iter().all(|s| (0.4..1.3).contains(&s.power)));
                }
            }
            // A fifth less than on the card: 20 scatter by two.
            let stated = metric(&name, "within1Deg");
            println!("{name}: {good} of 20, {stated} on its card");
            assert!(good as f64 >= 20.0 * (stated - 0.2), "{name}: {good}");
        }
    }
}

#[test]
fn limits_and_other_numbers_of_targets_are_told() {
    let array = Array::ula(8).unwrap();
    let network = model("dnn-small-2");
    let region = region(&array, &[-6.0, 4.0], 1e-2, 0);
    let snapshots = region_snapshots(region.view());
    let run = |options: &EstimatorOptions| {
        let mut estimator = network.estimator(&array, options).unwrap();
        estimator.estimate(Data::Snapshots(snapshots.view())).unwrap()
    };
    let wide = run(&EstimatorOptions::default());
    assert!(matches!(wide.warnings[..], [Warning::OutsideTraining { .. }]), "{:?}", wide.warnings);
    let known =
        run(&EstimatorOptions { sources: SourceCount::Known(5), ..EstimatorOptions::default() });
    assert_eq!(known.sources.len(), 5);
    let narrow = run(&EstimatorOptions {
        field_of_view_rad: 0.05,
        confidence: Some(0.0),
        ..EstimatorOptions::default()
    });
    assert!(narrow.sources.iter().all(|s| s.direction.azimuth_rad.abs() <= 0.051));
    let wrong = network.estimator(&Array::ula(7).unwrap(), &EstimatorOptions::default());
    assert_eq!(wrong.err().unwrap().code(), "unsuitable-array");
}

/// The features as Python makes them lie within what they are made of here.
#[test]
fn golden_features_are_bounded() {
    let features = golden("dnn-small-2", "covariance");
    assert_eq!(features.shape()[1], boresight_neural::COVARIANCE_FEATURES);
    assert!(features.iter().all(|x| x.abs() <= 1.0 + 1e-6));
}
