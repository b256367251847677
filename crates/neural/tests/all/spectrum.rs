//! Networks that answer over a grid of angles: UAA on a snapshot, Papageorgiou's CNN and DeepMUSIC on a covariance.

use crate::support::{model, vectors};
use boresight_aoa::{
    AoaError, Data, Estimate, Estimator, EstimatorOptions, SourceCount, SpectrumKind, Warning,
};
use boresight_core::presets::preset;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Direction, Random};
use boresight_math::phasor::cis;
use boresight_neural::NeuralError;
use boresight_signal::sample_covariance;
use ndarray::{Array2, Array3, Axis};
use std::f64::consts::FRAC_PI_3;

const ON_COVARIANCE: [&str; 2] = ["covariance-cnn", "deep-music"];

fn options(sources: SourceCount) -> EstimatorOptions {
    EstimatorOptions { field_of_view_rad: FRAC_PI_3, sources, ..EstimatorOptions::default() }
}

fn estimator(name: &str, array: &Array, sources: usize) -> Estimator {
    model(name).estimator(array, &options(SourceCount::Known(sources))).unwrap()
}

fn degrees(estimate: &Estimate) -> Vec<f64> {
    let azimuth = |s: &boresight_aoa::Source| s.direction.azimuth_rad.to_degrees();
    let mut all: Vec<f64> = estimate.sources.iter().map(azimuth).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// One snapshot of targets at these azimuths, deg, with these powers, dB, at 30 dB.
fn snapshot(array: &Array, targets: &[(f64, f64)], seed: u64) -> Array2<Complex64> {
    let random = &mut Random::new(seed, 0);
    let at: Vec<Direction> =
        targets.iter().map(|(deg, _)| Direction::azimuth(deg.to_radians())).collect();
    let signals: Vec<Complex64> =
        targets.iter().map(|(_, db)| cis(random.phase()) * 10f64.powf(db / 20.0)).collect();
    let signals = Array2::from_shape_vec((at.len(), 1), signals).unwrap();
    let mut y = steering_matrix(array, &at).dot(&signals);
    y.mapv_inplace(|z| z + random.complex_normal(1e-3));
    y
}

/// Errors of separated targets are hundredths of a degree by the card, powers a decibel; four targets in ten scenes.
#[test]
fn unrolled_iaa_gives_a_power_spectrum() {
    let array = preset("lrr48").unwrap();
    let mut uaa = model("unrolled-iaa").estimator(&array, &options(SourceCount::Mdl)).unwrap();
    let targets = [(-41.3, -6.0), (-7.77, 0.0), (12.6, -10.0), (33.1, -3.0)];
    for seed in 0..10 {
        let y = snapshot(&array, &targets, seed);
        let estimate = uaa.estimate(Data::Snapshots(y.view())).unwrap();
        for (deg, db) in targets {
            let near = |s: &&boresight_aoa::Source| {
                (s.direction.azimuth_rad.to_degrees() - deg).abs() < 0.3
            };
            let source = estimate.sources.iter().find(near);
            let power_db = source.map(|s| 10.0 * s.power.log10());
            assert!(power_db.is_some_and(|p| (p - db).abs() < 4.0), "{seed} {deg}: {power_db:?}");
        }
        // What is no target is far weaker.
        let weak = estimate.sources.iter().skip(targets.len()).all(|s| s.power < 0.02);
        assert!(weak, "{:?}", estimate.sources);
        let spectrum = estimate.spectrum.as_ref().unwrap();
        assert_eq!(spectrum.kind, SpectrumKind::Power);
        assert_eq!(spectrum.values.len(), spectrum.azimuth_rad.len());
        assert!(spectrum.azimuth_rad.iter().all(|u| u.abs() <= FRAC_PI_3 + 1e-9));
        assert!(estimate.warnings.is_empty(), "{:?}", estimate.warnings);
        // Scaled data has the same angles, and powers that scale with it.
        let scaled = y.mapv(|z| z * 1e3);
        let louder = uaa.estimate(Data::Snapshots(scaled.view())).unwrap();
        for (one, other) in estimate.sources.iter().zip(&louder.sources).take(targets.len()) {
            let apart_rad = one.direction.azimuth_rad - other.direction.azimuth_rad;
            assert!(apart_rad.abs() < 1e-4 && (other.power / one.power / 1e6 - 1.0).abs() < 1e-2);
        }
    }
}

#[test]
fn unrolled_iaa_refuses_what_it_cannot_take_and_finds_nothing_in_nothing() {
    let array = preset("lrr48").unwrap();
    let network = model("unrolled-iaa");
    let mut uaa = network.estimator(&array, &options(SourceCount::Mdl)).unwrap();
    let silence = uaa.estimate(Data::Snapshots(Array2::zeros((48, 1)).view())).unwrap();
    assert!(silence.sources.is_empty() && silence.warnings.contains(&Warning::NoSources));
    let several = uaa.estimate(Data::Snapshots(Array2::ones((48, 2)).view()));
    assert!(matches!(several, Err(AoaError::Snapshots { given: 2, .. })), "{several:?}");
    let matrix = Array2::eye(48);
    let covariance = uaa.estimate(Data::Covariance { matrix: matrix.view(), snapshots: 9 });
    assert!(matches!(covariance, Err(AoaError::NeedsSnapshots { .. })), "{covariance:?}");
    let other = network.estimator(&preset("ula16").unwrap(), &options(SourceCount::Mdl));
    assert!(matches!(other, Err(NeuralError::Angle(AoaError::Array { .. }))));
}

/// Sources a beam and more apart, 10 dB above the noise in 200 snapshots: a step of the grid is 0.9 deg at boresight.
#[test]
fn networks_on_a_covariance_find_two_sources() {
    let array = preset("ula16").unwrap();
    for name in ON_COVARIANCE {
        let mut two = estimator(name, &array, 2);
        for (trial, truth) in
            [[-40.0, 3.0], [-12.3, 11.1], [0.0, 22.5], [20.0, 47.7]].iter().enumerate()
        {
            let y = vectors(&array, truth, 200, trial as u64);
            let estimate = two.estimate(Data::Snapshots(y.view())).unwrap();
            let found = degrees(&estimate);
            println!("{name} {truth:?}: {found:?}");
            assert_eq!(found.len(), 2);
            assert!(found.iter().zip(truth).all(|(f, t)| (f - t).abs() < 2.0), "{found:?}");
            assert!(estimate.warnings.is_empty(), "{:?}", estimate.warnings);
            assert_eq!(estimate.spectrum.as_ref().unwrap().kind, SpectrumKind::Pseudo);
            // Powers are fitted to the covariance; echoes of 200 snapshots scatter by 0.3 dB, and angles are off.
            assert!(estimate.sources.iter().all(|s| (10.0 * s.power.log10()).abs() < 2.0));
            let sure = |s: &boresight_aoa::Source| s.confidence.is_some();
            assert_eq!(estimate.sources.iter().all(sure), name == "covariance-cnn");
            // The covariance itself gives the same.
            let matrix = sample_covariance(y.view());
            let data = Data::Covariance { matrix: matrix.view(), snapshots: 200 };
            assert_eq!(degrees(&two.estimate(data).unwrap()), found);
        }
    }
}

#[test]
fn elements_counted_the_other_way_round_mirror_the_angles() {
    let array = preset("ula16").unwrap();
    let reversed = array.select(&(0..16).rev().collect::<Vec<_>>()).unwrap();
    for name in ON_COVARIANCE {
        let y = vectors(&array, &[-12.3, 30.0], 200, 1);
        let turned = y.slice(ndarray::s![..;-1, ..]).to_owned();
        let found = estimator(name, &array, 2).estimate(Data::Snapshots(y.view())).unwrap();
        let again = estimator(name, &reversed, 2).estimate(Data::Snapshots(turned.view())).unwrap();
        assert!(again.warnings.is_empty(), "{name}: {:?}", again.warnings);
        // Not the same covariance for the network, but the same targets.
        for (one, other) in degrees(&found).iter().zip(degrees(&again)) {
            assert!((one - other).abs() < 2.0, "{name}: {one} {other}");
        }
    }
}

#[test]
fn what_is_not_of_training_is_told_or_refused() {
    let array = preset("ula16").unwrap();
    let outside = |estimate: &Estimate, what: &str| {
        let of = |warning: &Warning| match warning {
            Warning::OutsideTraining { difference } => difference.contains(what),
            _ => false,
        };
        assert!(estimate.warnings.iter().any(of), "{what}: {:?}", estimate.warnings);
    };
    for name in ON_COVARIANCE {
        let y = vectors(&array, &[0.0, 20.0], 8, 1);
        outside(
            &estimator(name, &array, 2).estimate(Data::Snapshots(y.view())).unwrap(),
            "16 to 2000 snapshots",
        );
        let y = vectors(&array, &[-40.0, -20.0, 0.0, 20.0, 40.0], 200, 1);
        outside(
            &estimator(name, &array, 5).estimate(Data::Snapshots(y.view())).unwrap(),
            "up to 3 targets",
        );
        for other in ["ula8", "lrr48"] {
            let refused =
                model(name).estimator(&preset(other).unwrap(), &EstimatorOptions::default());
            assert!(matches!(refused, Err(NeuralError::Angle(AoaError::Array { .. }))), "{other}");
        }
        let silence =
            estimator(name, &array, 1).estimate(Data::Snapshots(Array2::zeros((16, 20)).view()));
        assert!(silence.unwrap().sources.iter().all(|s| s.power == 0.0));
    }
}

/// Without a number of sources the CNN reports what is probable, and DeepMUSIC what is near its highest peak.
#[test]
fn sources_need_not_be_counted() {
    let array = preset("ula16").unwrap();
    for name in ON_COVARIANCE {
        let mut any = model(name).estimator(&array, &options(SourceCount::Mdl)).unwrap();
        for truth in [vec![10.0], vec![-30.0, 14.0]] {
            let y = vectors(&array, &truth, 200, 5);
            let found = degrees(&any.estimate(Data::Snapshots(y.view())).unwrap());
            assert_eq!(found.len(), truth.len(), "{name} {truth:?}: {found:?}");
        }
    }
}

/// To rounding: sums in a batch may be taken in another order.
#[test]
fn a_batch_gives_what_its_cells_give_alone() {
    for (name, array, columns) in
        [("unrolled-iaa", "lrr48", 1), ("covariance-cnn", "ula16", 40), ("deep-music", "ula16", 40)]
    {
        let array = preset(array).unwrap();
        let mut cells = Array3::zeros((35, array.len(), columns));
        for (number, mut cell) in cells.outer_iter_mut().enumerate() {
            cell.assign(&vectors(&array, &[-20.0, 5.0 + number as f64], columns, number as u64));
        }
        let mut estimator = estimator(name, &array, 2);
        let batch = estimator.estimate_batch(cells.view(), true).unwrap();
        for (number, cell) in cells.axis_iter(Axis(0)).enumerate() {
            let alone = estimator.estimate(Data::Snapshots(cell)).unwrap();
            let together = batch.sources_of(number);
            assert_eq!(alone.sources.len(), together.len(), "{name} {number}");
            for (one, other) in alone.sources.iter().zip(together) {
                let apart_rad = one.direction.azimuth_rad - other.direction.azimuth_rad;
                assert!(apart_rad.abs() < 1e-4, "{name} {number}");
            }
        }
        assert!(batch.spectra.is_some());
    }
}

/// A maximum at the edge of a grid is no peak, and the points of these grids are up to a degree apart there.
#[test]
fn targets_are_found_where_the_field_of_view_ends() {
    for (name, array) in
        [("unrolled-iaa", "lrr48"), ("covariance-cnn", "ula16"), ("deep-music", "ula16")]
    {
        let array = preset(array).unwrap();
        let mut one = estimator(name, &array, 1);
        for deg in [-59.9, -59.5, 59.5, 59.9] {
            let y = if name == "unrolled-iaa" {
                snapshot(&array, &[(deg, 0.0)], 1)
            } else {
                vectors(&array, &[deg], 200, 1)
            };
            let estimate = one.estimate(Data::Snapshots(y.view())).unwrap();
            let off = estimate.sources[0].direction.azimuth_rad.to_degrees() - deg;
            let within = if name == "unrolled-iaa" { 0.5 } else { 2.0 };
            assert!(off.abs() < within, "{name} {deg}: off by {off}");
            let spectrum = estimate.spectrum.as_ref().unwrap();
            assert!(spectrum.azimuth_rad.iter().all(|u| u.abs() <= FRAC_PI_3 + 1e-9));
        }
    }
}
