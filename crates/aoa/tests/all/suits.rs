//! What is said to suit, an estimator takes, and nothing else.

use boresight_aoa::suits::{Unsuited, unsuited};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex64};
use boresight_options::Named;
use ndarray::Array2;

#[test]
fn agrees_with_what_estimators_take() {
    let along = |places: &[f64]| {
        let positions: Vec<_> = places.iter().map(|&y| [0.0, y, 0.0]).collect();
        Array::new(&positions).unwrap()
    };
    let arrays = [
        along(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]),
        along(&[0.0, 2.0, 5.0, 7.0]),
        along(&[0.0, 1.0, 2.0f64.sqrt(), 7.0]),
        Array::new(&[[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]).unwrap(),
        preset("awr1843").unwrap(),
    ];
    let kinds = [
        EstimatorOptions::default(),
        EstimatorOptions { forward_backward: true, ..EstimatorOptions::default() },
        EstimatorOptions { smoothing: Some(4), ..EstimatorOptions::default() },
    ];
    let mut seen = vec![];
    for method in Method::ALL {
        for array in &arrays {
            for kind in &kinds {
                let averaged = kind.forward_backward || kind.smoothing.is_some();
                if averaged && !array.is_uniform() {
                    continue;
                }
                for snapshots in [1, 2, 9] {
                    let options = EstimatorOptions { sources: SourceCount::Known(1), ..*kind };
                    let data = Array2::from_shape_fn((array.len(), snapshots), |(k, n)| {
                        Complex64::from_polar(1.0 + 0.1 * (k * (n + 1) % 3) as f64, (n * n) as f64)
                    });
                    let made = Estimator::new(method, array, &options)
                        .and_then(|mut one| one.estimate(Data::Snapshots(data.view())));
                    let said = unsuited(method, array, &options, snapshots);
                    let what =
                        format!("{method:?} {array:?} {kind:?} {snapshots}: {said:?} {made:?}");
                    let code = made.as_ref().err().map(boresight_core::Diagnose::code);
                    match said {
                        None => assert!(
                            !matches!(code, Some("unsuitable-array" | "snapshot-count")),
                            "{what}"
                        ),
                        Some(Unsuited::FewSnapshots | Unsuited::ManySnapshots) => {
                            assert_eq!(code, Some("snapshot-count"), "{what}");
                        }
                        Some(_) => assert_eq!(code, Some("unsuitable-array"), "{what}"),
                    }
                    seen.extend(said.map(Unsuited::name));
                }
            }
        }
    }
    seen.sort_unstable();
    seen.dedup();
    let all = [
        "elevation",
        "few-snapshots",
        "grid",
        "many-snapshots",
        "no-neighbours",
        "one-place",
        "uniform-array",
    ];
    assert_eq!(seen, all);
}

#[test]
fn elements_at_0_2_and_5_stand_on_a_grid() {
    let array = Array::new(&[[0.0; 3], [0.0, 2.0, 0.0], [0.0, 5.0, 0.0]]).unwrap();
    for method in Method::ALL.iter().filter(|method| method.requirements().lattice) {
        assert_ne!(
            unsuited(*method, &array, &EstimatorOptions::default(), 1),
            Some(Unsuited::Grid),
            "{method:?}"
        );
    }
}
