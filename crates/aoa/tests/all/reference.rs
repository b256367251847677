//! Estimators against numbers made with NumPy from the definitions (`reference/make.py`).

use crate::support::{estimate, found, known};
use boresight_aoa::options::EspritForm;
use boresight_aoa::{EstimatorOptions, Method};
use boresight_core::{Array, Complex64};
use boresight_math::linalg::hermitian_eigen;
use boresight_signal::sample_covariance;
use ndarray::Array2;
use serde_json::Value;

struct Case {
    array: Array,
    y: Array2<Complex64>,
    numbers: Value,
}

impl Case {
    fn list(&self, key: &str) -> Vec<f64> {
        numbers(&self.numbers[key])
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn cases() -> Vec<Case> {
    let all: Value = serde_json::from_str(include_str!("../reference/reference.json")).unwrap();
    let case = |numbers_of: &Value| {
        let y: Vec<[f64; 3]> = numbers(&numbers_of["y"]).iter().map(|&y| [0.0, y, 0.0]).collect();
        let matrix = |key: &str| -> Vec<Vec<f64>> {
            numbers_of[key].as_array().unwrap().iter().map(numbers).collect()
        };
        let (re, im) = (matrix("real"), matrix("imag"));
        Case {
            array: Array::new(&y).unwrap(),
            y: Array2::from_shape_fn((re.len(), re[0].len()), |(k, t)| {
                Complex64::new(re[k][t], im[k][t])
            }),
            numbers: numbers_of.clone(),
        }
    };
    all.as_array().unwrap().iter().map(case).collect()
}

/// Relative to the larger of the two, at every point.
fn assert_equal(found: &[f64], wanted: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), wanted.len(), "{what}");
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w).abs() <= tolerance * f.abs().max(w.abs()), "{what}: {f} for {w}");
    }
}

#[test]
fn eigenvalues_and_spectra_equal_those_of_numpy() {
    let options = EstimatorOptions { grid_points: 64, ..known(2) };
    for case in cases() {
        let r = sample_covariance(case.y.view());
        let values = hermitian_eigen(r.view()).unwrap().values.to_vec();
        assert_equal(&values, &case.list("eigenvalues"), 1e-12, "eigenvalues");
        for (method, key, tolerance) in [
            (Method::Bartlett, "bartlett", 1e-11),
            (Method::Capon, "capon", 1e-11),
            (Method::Music, "music", 1e-11),
            (Method::MinNorm, "minNorm", 1e-9),
        ] {
            let result = estimate(method, &case.array, &options, &case.y);
            let values = result.spectrum.unwrap().values;
            assert_equal(&values, &case.list(key), tolerance, method.name());
        }
    }
}

#[test]
fn angles_equal_those_of_numpy() {
    for case in cases() {
        // Golden section on a smooth minimum is good to the square root of the precision.
        let music = estimate(Method::Music, &case.array, &known(2), &case.y);
        for (f, w) in found(&music).iter().zip(case.list("musicAzimuths")) {
            assert!((f - w).abs() < 1e-7, "MUSIC: {f} for {w}");
        }
        if case.array.is_uniform() {
            let form = |esprit| EstimatorOptions { esprit, ..known(2) };
            for (method, options, key) in [
                (Method::RootMusic, known(2), "rootMusicAzimuths"),
                (Method::Esprit, form(EspritForm::LeastSquares), "espritAzimuths"),
                (Method::Esprit, form(EspritForm::TotalLeastSquares), "totalEspritAzimuths"),
            ] {
                let result = found(&estimate(method, &case.array, &options, &case.y));
                assert_eq!(result.len(), 2, "{key}");
                for (f, w) in result.iter().zip(case.list(key)) {
                    assert!((f - w).abs() < 1e-11, "{key}: {f} for {w}");
                }
            }
        }
    }
}
