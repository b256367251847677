//! Every model of the repository gives what PyTorch gave when it was exported.

use crate::support::{golden, model, names};
use boresight_neural::Model;
use ndarray::{ArrayD, Axis, Slice, concatenate};

/// Largest difference from PyTorch, relative to the largest output or 1, and then to the largest of its kind (along the last
/// axis): single precision with sums in another order.
const TOLERANCE: f32 = 1e-4;
/// Confidence below which no card reports a target. Such queries are empty, and magnify rounding: beside their
/// kind they have ten times the tolerance.
const EMPTY: f32 = 1e-3;

fn inputs(name: &str, model: &Model) -> Vec<(String, ArrayD<f32>)> {
    model.inputs().iter().map(|port| (port.name.clone(), golden(name, &port.name))).collect()
}

fn run(model: &Model, inputs: &[(String, ArrayD<f32>)]) -> Vec<(String, ArrayD<f32>)> {
    let views: Vec<_> = inputs.iter().map(|(name, x)| (name.as_str(), x.view())).collect();
    model.run(&views).unwrap()
}

#[test]
fn every_model_equals_pytorch() {
    let names = names();
    assert!(names.contains(&"learned-pursuit".to_owned()), "{names:?}");
    for name in names {
        let model = model(&name);
        for (port, given) in run(model, &inputs(&name, model)) {
            let expected = golden(&name, &port);
            assert_eq!(given.shape(), expected.shape(), "{name} {port}");
            let scale = expected.iter().fold(1.0f32, |most, x| most.max(x.abs()));
            let difference = (&given - &expected).iter().fold(0.0f32, |most, d| most.max(d.abs()));
            assert!(difference <= TOLERANCE * scale, "{name} {port}: {difference}");
            let last = Axis(expected.ndim() - 1);
            let confidence = expected.index_axis(last, 2.min(expected.shape()[last.0] - 1));
            for (kind, expected) in expected.axis_iter(last).enumerate() {
                let given = given.index_axis(last, kind);
                let scale = expected.iter().fold(1.0f32, |most, x| most.max(x.abs()));
                let mut apart = (&given - &expected).mapv(f32::abs);
                if model.kind().answers_target_set() && kind != 2 {
                    apart.zip_mut_with(&confidence, |d, &sure| {
                        *d *= if sure < EMPTY { 0.1 } else { 1.0 };
                    });
                }
                let difference = apart.iter().fold(0.0f32, |most, &d| most.max(d));
                println!("{name} {port} {kind}: {:.1e}", difference / scale);
                assert!(difference <= TOLERANCE * scale, "{name} {port} {kind}: {difference}");
            }
        }
    }
}

/// 37 examples run as 32 and five more; each is what it is alone, to rounding: sums may be taken in another order.
#[test]
fn a_batch_is_its_examples() {
    for name in ["learned-pursuit", "dnn-small-2"] {
        let model = model(name);
        let golden = inputs(name, model);
        let batched = |port: &str| port != "positions";
        let many: Vec<(String, ArrayD<f32>)> = golden
            .iter()
            .map(|(port, x)| {
                let stacked = if batched(port) {
                    let whole = concatenate(Axis(0), &vec![x.view(); 10]).unwrap();
                    whole.slice_axis(Axis(0), Slice::from(..37)).to_owned()
                } else {
                    x.clone()
                };
                (port.clone(), stacked)
            })
            .collect();
        let all = &run(model, &many)[0].1;
        assert_eq!(all.shape()[0], 37);
        let four = &run(model, &golden)[0].1;
        for (k, example) in all.outer_iter().enumerate() {
            let alone = four.index_axis(Axis(0), k % 4);
            let difference = (&example - &alone).iter().fold(0.0f32, |most, d| most.max(d.abs()));
            assert!(difference < 2e-5, "{name} {k}: {difference}");
        }
    }
}
