//! Time of a run of each model at batches of 1 and 32, and of an estimate of a set of targets.
#![allow(clippy::unwrap_used, missing_docs)]

use boresight_aoa::{Data, EstimatorOptions};
use boresight_core::Complex64;
use boresight_core::presets::preset;
use boresight_neural::{Axis, Card, Model};
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::{Array2, ArrayD};
use std::hint::black_box;
use std::path::Path;

fn models(criterion: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "onnx") {
            continue;
        }
        let card = Card::from_json(&std::fs::read(path.with_extension("json")).unwrap()).unwrap();
        let model = Model::load(&std::fs::read(&path).unwrap(), Some(&card)).unwrap();
        for batch in [1, 32] {
            let shape = |axes: &[Axis]| -> Vec<usize> {
                axes.iter()
                    .map(|axis| match axis {
                        Axis::Length(length) => *length,
                        Axis::Named(_) => batch,
                    })
                    .collect()
            };
            let inputs: Vec<(&str, ArrayD<f32>)> = model
                .inputs()
                .iter()
                .map(|port| {
                    let mut k = 0.0f32;
                    let numbers = ArrayD::from_shape_simple_fn(shape(&port.axes), || {
                        k += 0.7;
                        k.sin()
                    });
                    (port.name.as_str(), numbers)
                })
                .collect();
            let views: Vec<_> = inputs.iter().map(|(name, x)| (*name, x.view())).collect();
            let mut group = criterion.benchmark_group(&card.name);
            group.sample_size(20);
            group.bench_function(format!("batch {batch}"), |bencher| {
                bencher.iter(|| model.run(black_box(&views)).unwrap());
            });
            group.finish();
        }
        if card.kind.answers_target_set() {
            let array = preset("lrr48").unwrap();
            let mut estimator = model.estimator(&array, &EstimatorOptions::default()).unwrap();
            let y = Array2::from_shape_fn((48, 1), |(k, _)| Complex64::cis(0.3 * k as f64));
            criterion.bench_function(&format!("{} estimate", card.name), |bencher| {
                bencher.iter(|| estimator.estimate(Data::Snapshots(black_box(y.view()))).unwrap());
            });
        }
    }
}

criterion_group!(benches, models);
criterion_main!(benches);
