//! Time of one estimate of every method on 32 elements, three sources at 20 dB: 64 snapshots, or
//! one for the methods that take no more.

#![allow(clippy::unwrap_used, missing_docs)]

use boresight_aoa::options::{IaaForm, IaaOptions};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Estimators, Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Direction, Random};
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::{Array2, Array3};
use std::hint::black_box;

fn estimators(criterion: &mut Criterion) {
    let array = Array::ula(32).unwrap();
    let directions = [-20.3f64, 5.2, 24.1].map(|deg| Direction::azimuth(deg.to_radians()));
    let steering = steering_matrix(&array, &directions);
    let mut random = Random::new(1, 0);
    let options =
        EstimatorOptions { sources: SourceCount::Known(3), ..EstimatorOptions::default() };
    for method in Method::ALL {
        let single = [Method::SingleSnapshotMusic, Method::Iaa, Method::Nomp];
        let snapshots = if single.contains(&method) { 1 } else { 64 };
        let signals = Array2::from_shape_fn((3, snapshots), |_| random.complex_normal(1.0));
        let noise = Array2::from_shape_fn((32, snapshots), |_| random.complex_normal(0.01));
        let y = steering.dot(&signals) + noise;
        let Ok(mut estimator) = Estimator::new(method, &array, &options) else {
            continue;
        };
        criterion.bench_function(method.name(), |bencher| {
            bencher.iter(|| estimator.estimate(Data::Snapshots(black_box(y.view()))).unwrap());
        });
    }
}

/// 64 cells of IAA on the sparse long-range array, on one thread and on two.
fn iaa_batch(criterion: &mut Criterion) {
    let array = preset("lrr48").unwrap();
    let mut random = Random::new(3, 0);
    let directions = [-20.3f64, 5.2, 24.1].map(|deg| Direction::azimuth(deg.to_radians()));
    let steering = steering_matrix(&array, &directions);
    let mut cells = Array3::zeros((64, 48, 1));
    for mut cell in cells.outer_iter_mut() {
        let signals = Array2::from_shape_fn((3, 1), |_| random.complex_normal(1.0));
        let noise = Array2::from_shape_fn((48, 1), |_| random.complex_normal(0.01));
        cell.assign(&(steering.dot(&signals) + noise));
    }
    for threads in [1, 2] {
        let mut estimators =
            Estimators::new(Method::Iaa, &array, &EstimatorOptions::default(), threads).unwrap();
        criterion.bench_function(&format!("iaa, lrr48, 64 cells, {threads} threads"), |bencher| {
            bencher.iter(|| estimators.estimate_batch(black_box(cells.view()), false).unwrap());
        });
    }
}

/// Both forms of IAA on the 48 elements of the sparse long-range array, one snapshot, 1024 angles,
/// 15 iterations.
fn iaa_forms(criterion: &mut Criterion) {
    let array = preset("lrr48").unwrap();
    let directions = [-20.3f64, 5.2, 24.1].map(|deg| Direction::azimuth(deg.to_radians()));
    let mut random = Random::new(2, 0);
    let signals = Array2::from_shape_fn((3, 1), |_| random.complex_normal(1.0));
    let noise = Array2::from_shape_fn((48, 1), |_| random.complex_normal(0.01));
    let y = steering_matrix(&array, &directions).dot(&signals) + noise;
    for (name, form) in [("iaa fast, lrr48", IaaForm::Fast), ("iaa dense, lrr48", IaaForm::Dense)] {
        let iaa = IaaOptions { form, ..EstimatorOptions::default().iaa };
        let options = EstimatorOptions { iaa, ..EstimatorOptions::default() };
        let mut estimator = Estimator::new(Method::Iaa, &array, &options).unwrap();
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| estimator.estimate(Data::Snapshots(black_box(y.view()))).unwrap());
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(30)
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(1));
    targets = estimators, iaa_forms, iaa_batch
}
criterion_main!(benches);
