//! IAA and sparse Bayesian learning against an independent NumPy implementation
//! (`reference/sparse.py`).

use boresight_aoa::options::{IaaForm, IaaPrecision};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method};
use boresight_core::{Array, Complex64};
use ndarray::Array2;
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    method: String,
    positions: Vec<f64>,
    points: usize,
    iterations: usize,
    re: Vec<Vec<f64>>,
    im: Vec<Vec<f64>>,
    power: Vec<f64>,
}

#[test]
fn spectra_agree_with_the_reference() {
    let cases: Vec<Case> = serde_json::from_str(include_str!("../reference/sparse.json")).unwrap();
    assert_eq!(cases.len(), 8);
    for (number, case) in cases.iter().enumerate() {
        let positions: Vec<[f64; 3]> = case.positions.iter().map(|&y| [0.0, y, 0.0]).collect();
        let array = Array::new(&positions).unwrap();
        let method = Method::from_name(&case.method).unwrap();
        let y = Array2::from_shape_fn((case.re.len(), case.re[0].len()), |(k, n)| {
            Complex64::new(case.re[k][n], case.im[k][n])
        });
        let mut options = EstimatorOptions {
            grid_points: case.points,
            max_iterations: case.iterations,
            tolerance: 1e-15,
            ..EstimatorOptions::default()
        };
        options.iaa.iterations = case.iterations;
        options.iaa.precision = IaaPrecision::Double;
        for form in [IaaForm::Auto, IaaForm::Dense] {
            options.iaa.form = form;
            let mut estimator = Estimator::new(method, &array, &options).unwrap();
            let result = estimator.estimate(Data::Snapshots(y.view())).unwrap();
            let values = result.spectrum.unwrap().values;
            assert_eq!(values.len(), case.power.len());
            let scale = case.power.iter().copied().fold(0.0, f64::max);
            let error = values
                .iter()
                .zip(&case.power)
                .map(|(v, p)| (v - p).abs() / scale)
                .fold(0.0, f64::max);
            println!("case {number}, {}, {form:?}: {error:.1e}", case.method);
            assert!(error < 1e-8, "case {number}, {}: {error}", case.method);
        }
    }
}
