//! Estimators against the bounds of theory, and the bounds against closed forms.

use crate::support::{azimuths, found, known, scene};
use boresight_aoa::bounds::esprit_error::esprit_error;
use boresight_aoa::bounds::{
    Signals, deterministic_bound, single_snapshot, stochastic_bound, uncorrelated,
};
use boresight_aoa::options::EspritForm;
use boresight_aoa::order::counting::{CountSizes, Criterion, count_sources};
use boresight_aoa::{AoaError, Data, Estimator, EstimatorOptions, Method};
use boresight_core::presets::preset;
use boresight_core::steering::{steering_matrix, steering_vector};
use boresight_core::{Array, Complex64, Direction, InputError, Random};
use boresight_math::linalg::hermitian_eigen;
use boresight_signal::{forward_backward, sample_covariance};
use ndarray::{Array1, Array2};
use std::f64::consts::PI;

const TRIALS: u64 = 500;
const SNAPSHOTS: usize = 100;
/// 20 dB below a source of power 1.
const NOISE: f64 = 0.01;

/// Root mean square error over both sources of the standard scene: 10 elements, 100 snapshots,
/// sources of 20 dB at -5 and 12 degrees.
fn rms_error(method: Method, options: &EstimatorOptions) -> f64 {
    let array = Array::ula(10).unwrap();
    let truth = azimuths(&[-5.0, 12.0]);
    let mut estimator = Estimator::new(method, &array, options).unwrap();
    let mut squares = 0.0;
    for trial in 0..TRIALS {
        let mut random = Random::new(100, trial);
        let y = scene(&array, &truth, &[1.0, 1.0], NOISE, SNAPSHOTS, &mut random);
        let result = estimator.estimate(Data::Snapshots(y.view())).unwrap();
        assert!(result.resolved, "{} in trial {trial}", method.name());
        for (angle, source) in found(&result).iter().zip(&truth) {
            squares += (angle - source.azimuth_rad).powi(2);
        }
    }
    (squares / (2 * TRIALS) as f64).sqrt()
}

fn rms(deviations: &[f64]) -> f64 {
    (deviations.iter().map(|x| x * x).sum::<f64>() / deviations.len() as f64).sqrt()
}

/// The RMSE of 1000 errors of a normal distribution has a standard deviation of 2.2 %: an
/// efficient estimator has a ratio of 1 +- 0.07, to within three of them.
fn assert_ratio(what: &str, error: f64, theory: f64) {
    let ratio = error / theory;
    println!("{what}: RMSE {:.5} deg, {ratio:.3} of theory", error.to_degrees());
    assert!((0.9..=1.15).contains(&ratio), "{what}: {ratio}");
}

#[test]
fn music_and_root_music_reach_the_bound() {
    let array = Array::ula(10).unwrap();
    let truth = azimuths(&[-5.0, 12.0]);
    let covariance = uncorrelated(&[1.0, 1.0]);
    let signals =
        Signals { covariance: covariance.view(), noise_power: NOISE, snapshots: SNAPSHOTS };
    let bound = rms(&stochastic_bound(&array, &truth, &signals).unwrap().azimuth_rad);
    for method in [Method::Music, Method::RootMusic] {
        assert_ratio(method.name(), rms_error(method, &known(2)), bound);
    }
    // Its nulls are sharp but not efficient: the error is the bound's several times over.
    let min_norm = rms_error(Method::MinNorm, &known(2)) / bound;
    println!("min-norm: {min_norm:.3} of the bound");
    assert!((1.0..3.0).contains(&min_norm));
}

#[test]
fn esprit_has_the_error_theory_gives_it() {
    let array = Array::ula(10).unwrap();
    let truth = azimuths(&[-5.0, 12.0]);
    let covariance = uncorrelated(&[1.0, 1.0]);
    let signals =
        Signals { covariance: covariance.view(), noise_power: NOISE, snapshots: SNAPSHOTS };
    let theory = rms(&esprit_error(&array, &truth, &signals).unwrap());
    let bound = rms(&stochastic_bound(&array, &truth, &signals).unwrap().azimuth_rad);
    println!("ESPRIT's asymptotic error is {:.3} of the bound", theory / bound);
    assert!(theory > bound);
    for esprit in [EspritForm::LeastSquares, EspritForm::TotalLeastSquares] {
        let error = rms_error(Method::Esprit, &EstimatorOptions { esprit, ..known(2) });
        assert_ratio(&format!("ESPRIT, {esprit:?}"), error, theory);
    }
}

#[test]
fn one_source_on_a_line_has_a_bound_in_closed_form() {
    let (elements, power, noise, snapshots) = (7_usize, 2.0, 0.3, 20_usize);
    let array = Array::ula(elements).unwrap();
    let truth = azimuths(&[25.0]);
    let covariance = uncorrelated(&[power]);
    let signals = Signals { covariance: covariance.view(), noise_power: noise, snapshots };
    let (k, n) = (elements as f64, snapshots as f64);
    let slope = PI * truth[0].azimuth_rad.cos();
    let deterministic = 6.0 * noise / (n * power * slope * slope * k * (k * k - 1.0));
    let stochastic = deterministic * (1.0 + noise / (k * power));
    let found = deterministic_bound(&array, &truth, &signals).unwrap();
    assert!((found.azimuth_rad[0] / deterministic.sqrt() - 1.0).abs() < 1e-10);
    assert!(found.elevation_rad.is_none());
    let found = stochastic_bound(&array, &truth, &signals).unwrap();
    assert!((found.azimuth_rad[0] / stochastic.sqrt() - 1.0).abs() < 1e-10);
}

/// Mean of the data, and the parameters it depends on: angles, then real and imaginary amplitudes
/// of every source and snapshot.
fn mean(array: &Array, parameters: &[f64], sources: usize, snapshots: usize) -> Array1<Complex64> {
    let angles = 2 * sources;
    let directions: Vec<Direction> =
        (0..sources).map(|i| Direction::new(parameters[i], parameters[sources + i])).collect();
    let amplitudes = Array2::from_shape_fn((sources, snapshots), |(i, t)| {
        let at = angles + 2 * (i * snapshots + t);
        Complex64::new(parameters[at], parameters[at + 1])
    });
    steering_matrix(array, &directions).dot(&amplitudes).flatten().to_owned()
}

#[test]
fn the_deterministic_bound_is_the_inverse_of_the_fisher_matrix() {
    let array = preset("awr1843").unwrap();
    let (sources, snapshots, noise) = (2, 3, 0.05);
    let mut random = Random::new(41, 0);
    let mut parameters = vec![-0.2, 0.3, 0.1, -0.15];
    parameters.extend((0..2 * sources * snapshots).map(|_| random.normal()));
    let columns: Vec<Array1<Complex64>> = (0..parameters.len())
        .map(|i| {
            let moved = |step: f64| {
                let mut moved = parameters.clone();
                moved[i] += step;
                mean(&array, &moved, sources, snapshots)
            };
            (moved(1e-5) - moved(-1e-5)).mapv(|z| z / 2e-5)
        })
        .collect();
    let fisher = Array2::from_shape_fn((columns.len(), columns.len()), |(i, k)| {
        let product: Complex64 =
            columns[i].iter().zip(&columns[k]).map(|(x, y)| x.conj() * y).sum();
        Complex64::new(2.0 / noise * product.re, 0.0)
    });
    let inverse = boresight_math::linalg::Cholesky::new(fisher.view()).unwrap().inverse();
    let directions = [
        Direction::new(parameters[0], parameters[2]),
        Direction::new(parameters[1], parameters[3]),
    ];
    let amplitudes = Array2::from_shape_fn((sources, snapshots), |(i, t)| {
        let at = 2 * sources + 2 * (i * snapshots + t);
        Complex64::new(parameters[at], parameters[at + 1])
    });
    let covariance = sample_covariance(amplitudes.view());
    let signals = Signals { covariance: covariance.view(), noise_power: noise, snapshots };
    let bound = deterministic_bound(&array, &directions, &signals).unwrap();
    for ((i, k), value) in bound.covariance.indexed_iter() {
        let wanted = inverse[[i, k]].re;
        assert!((value - wanted).abs() < 1e-6 * bound.covariance.diag().sum(), "{value} {wanted}");
    }
    assert_eq!(bound.elevation_rad.unwrap().len(), 2);
}

/// Slepian's and Bangs' formula `F_ik = N tr(R^-1 dR_i R^-1 dR_k)` over angles, the entries of the
/// signal covariance and the noise power, by differences.
#[test]
fn the_stochastic_bound_is_the_inverse_of_the_fisher_matrix() {
    let array =
        Array::new(&[[0.0; 3], [0.0, 1.0, 0.0], [0.0, 2.3, 0.0], [0.0, 4.0, 0.0], [0.0, 5.1, 0.0]])
            .unwrap();
    let (snapshots, at) = (50, [-0.15, 0.2]);
    // Angles, powers, real and imaginary cross power, noise.
    let parameters = [at[0], at[1], 1.0, 0.6, 0.2, -0.3, 0.1];
    let model = |p: &[f64]| -> Array2<Complex64> {
        let a = steering_matrix(&array, &[Direction::azimuth(p[0]), Direction::azimuth(p[1])]);
        let cross = Complex64::new(p[4], p[5]);
        let powers = ndarray::array![
            [Complex64::new(p[2], 0.0), cross],
            [cross.conj(), Complex64::new(p[3], 0.0)]
        ];
        a.dot(&powers).dot(&boresight_math::linalg::adjoint(a.view()))
            + Array2::<Complex64>::eye(5).mapv(|z| z * p[6])
    };
    let inverse =
        boresight_math::linalg::Cholesky::new(model(&parameters).view()).unwrap().inverse();
    let slopes: Vec<Array2<Complex64>> = (0..parameters.len())
        .map(|i| {
            let moved = |step: f64| {
                let mut moved = parameters;
                moved[i] += step;
                model(&moved)
            };
            inverse.dot(&(moved(1e-6) - moved(-1e-6)).mapv(|z| z / 2e-6))
        })
        .collect();
    let fisher = Array2::from_shape_fn((parameters.len(), parameters.len()), |(i, k)| {
        let trace = slopes[i].dot(&slopes[k]).diag().sum();
        Complex64::new(snapshots as f64 * trace.re, 0.0)
    });
    let wanted = boresight_math::linalg::Cholesky::new(fisher.view()).unwrap().inverse();
    let covariance = ndarray::array![
        [Complex64::new(1.0, 0.0), Complex64::new(0.2, -0.3)],
        [Complex64::new(0.2, 0.3), Complex64::new(0.6, 0.0)]
    ];
    let signals = Signals { covariance: covariance.view(), noise_power: 0.1, snapshots };
    let directions = at.map(Direction::azimuth);
    let bound = stochastic_bound(&array, &directions, &signals).unwrap();
    for i in 0..2 {
        let ratio = bound.azimuth_rad[i] / wanted[[i, i]].re.sqrt();
        assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
    }
}

#[test]
fn bounds_of_what_cannot_be_told_apart_are_infinite_and_bad_arguments_are_named() {
    let array = Array::ula(4).unwrap();
    let covariance = uncorrelated(&[1.0, 1.0]);
    let signals = Signals { covariance: covariance.view(), noise_power: 0.1, snapshots: 5 };
    for direction in [0.1, PI / 2.0] {
        let same = [Direction::azimuth(direction); 2];
        for bound in [stochastic_bound, deterministic_bound] {
            let bound = bound(&array, &same, &signals).unwrap();
            assert!(bound.azimuth_rad.iter().all(|x| *x == f64::INFINITY), "{bound:?}");
        }
        assert!(esprit_error(&array, &same, &signals).unwrap()[0] == f64::INFINITY);
    }
    let along = [Direction::azimuth(0.2), Direction::azimuth(PI / 2.0)];
    let bound = stochastic_bound(&array, &along, &signals).unwrap().azimuth_rad;
    assert!(bound[0] < 0.1 && bound[1] == f64::INFINITY, "{bound:?}");
    let coherent = single_snapshot(&[Complex64::new(1.0, 0.0), Complex64::new(0.0, 1.0)]);
    let one = Signals { covariance: coherent.view(), noise_power: 0.1, snapshots: 1 };
    let two = azimuths(&[-10.0, 10.0]);
    assert!(deterministic_bound(&array, &two, &one).unwrap().azimuth_rad[0].is_finite());
    let bad = [
        (azimuths(&[]), 0.1, "empty"),
        (azimuths(&[0.0]), 0.1, "shape"),
        (azimuths(&[0.0, 1.0, 2.0, 3.0]), 0.1, "too-many-sources"),
        (azimuths(&[0.0, 100.0]), 0.1, "out-of-range"),
        (two.clone(), 0.0, "out-of-range"),
        (two.clone(), f64::NAN, "out-of-range"),
    ];
    for (directions, noise_power, code) in bad {
        let signals = Signals { noise_power, ..signals };
        for bound in [stochastic_bound, deterministic_bound] {
            let error = bound(&array, &directions, &signals).unwrap_err();
            assert_eq!(boresight_core::Diagnose::code(&error), code);
        }
    }
    let sparse = preset("lrr48").unwrap();
    assert!(matches!(esprit_error(&sparse, &two, &signals), Err(AoaError::Array { .. })));
    let nan = Array2::from_elem((2, 2), Complex64::new(f64::NAN, 0.0));
    let signals = Signals { covariance: nan.view(), ..signals };
    let error = stochastic_bound(&array, &two, &signals).unwrap_err();
    assert!(matches!(error, AoaError::Argument(InputError::NotFinite { .. })));
}

/// MDL misses and false alarms are both far rarer than 1 % here; the largest-root test has its false alarms; AIC overestimates in
/// the large-N limit with a probability of several per cent (Wax and Kailath 1985).
#[test]
fn counting_is_right_where_theory_says_so() {
    let array = Array::ula(8).unwrap();
    let trials = 300;
    let mut right = [[0; 3]; 2];
    for trial in 0..trials {
        let mut random = Random::new(51, trial);
        let sources = (trial % 4) as usize;
        let directions = azimuths(&[-20.0, 5.0, 35.0][..sources]);
        let y = scene(&array, &directions, &[1.0, 1.0, 1.0], 0.1, 100, &mut random);
        let plain = sample_covariance(y.view());
        for (f, both) in [(0, plain.clone()), (1, forward_backward(plain.view()))] {
            let values = hermitian_eigen(both.view()).unwrap().values.to_vec();
            let sizes = CountSizes { vectors: 100, subarrays: 1, forward_backward: f == 1 };
            let criteria = [Criterion::Mdl, Criterion::Aic, Criterion::LargestRoot];
            for (c, criterion) in criteria.into_iter().enumerate() {
                let count = count_sources(&values, sizes, criterion, 1e-2);
                right[f][c] += usize::from(count.sources == sources);
            }
        }
    }
    println!("right counts of {trials}: {right:?} (rows: plain, averaged; MDL, AIC, largest root)");
    assert!(right.iter().all(|r| r[0] >= 295 && r[1] >= 240 && r[2] >= 288), "{right:?}");
}

#[test]
fn steering_of_the_bound_is_that_of_the_estimators() {
    let array = preset("awr1642").unwrap();
    let a = steering_vector(&array, Direction::azimuth(0.3));
    let y = a.insert_axis(ndarray::Axis(1));
    let result =
        crate::support::estimate(Method::Bartlett, &array, &EstimatorOptions::default(), &y);
    assert!((result.sources[0].direction.azimuth_rad - 0.3).abs() < 1e-8);
}
