//! Whatever goes in, an estimator answers with an estimate or with an error that says what was
//! wrong.

use crate::support::{azimuths, known, scene};
use boresight_aoa::options::{EspritForm, IaaForm, Thresholding};
use boresight_aoa::order::counting::{CountOptions, count_sources_in};
use boresight_aoa::{AoaError, Data, Estimator, EstimatorOptions, Method, SourceCount, Warning};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex64, Diagnose, InputError, Limits, Random};
use ndarray::{Array1, Array2};
use proptest::prelude::*;

fn error(method: Method, array: &Array, options: &EstimatorOptions) -> AoaError {
    Estimator::new(method, array, options).err().unwrap()
}

#[test]
fn a_count_of_sources_knows_what_it_takes_before_it_starts() {
    let count = |elements: usize| {
        let noise = Array2::from_elem((elements, 3), Complex64::new(1.0, 0.0));
        count_sources_in(Data::Snapshots(noise.view()), &CountOptions::default())
    };
    // Tests of this file have threads of their own.
    Limits { operations: 1e4, ..Limits::default() }.set().unwrap();
    assert!(count(12).is_ok());
    assert!(matches!(count(40), Err(AoaError::Argument(InputError::TooLarge { .. }))));
}

#[test]
fn arrays_that_do_not_suit_are_refused_by_name() {
    let point = Array::new(&[[0.0; 3], [0.0; 3]]).unwrap();
    let vertical = Array::new(&[[0.0; 3], [0.0, 0.0, 1.0]]).unwrap();
    let planar = preset("awr1843").unwrap();
    let sparse = preset("lrr48").unwrap();
    let irregular = Array::new(&[[0.0; 3], [0.0, 1.0, 0.0], [0.0, 2.0_f64.sqrt(), 0.0]]).unwrap();
    let array = Array::ula(8).unwrap();
    for method in Method::ALL.into_iter().filter(|&m| Estimator::new(m, &array, &known(1)).is_ok())
    {
        for array in [&point, &vertical] {
            let error = error(method, array, &known(1));
            assert_eq!(error.code(), "unsuitable-array", "{}", method.name());
        }
        let needs = method.requirements();
        let outcome = |array: &Array| Estimator::new(method, array, &known(1)).map(|_| ());
        assert_eq!(outcome(&planar).is_ok(), needs.elevation, "{}", method.name());
        assert_eq!(outcome(&sparse).is_ok(), !needs.uniform_array, "{}", method.name());
        let free = !needs.uniform_array && !needs.lattice;
        assert_eq!(outcome(&irregular).is_ok(), free, "{}", method.name());
    }
}

#[test]
fn too_many_sources_are_refused_with_the_limit() {
    let array = Array::ula(8).unwrap();
    let limits = [
        (Method::Music, EstimatorOptions::default(), 7),
        (Method::RootMusic, EstimatorOptions::default(), 7),
        (Method::Esprit, EstimatorOptions::default(), 7),
        (Method::MinNorm, EstimatorOptions::default(), 7),
        (Method::SingleSnapshotMusic, EstimatorOptions::default(), 4),
        (Method::Music, EstimatorOptions { smoothing: Some(5), ..EstimatorOptions::default() }, 4),
    ];
    for (method, options, limit) in limits {
        let wanted = |n| EstimatorOptions { sources: SourceCount::Known(n), ..options };
        assert!(Estimator::new(method, &array, &wanted(limit)).is_ok(), "{}", method.name());
        let given = error(method, &array, &wanted(limit + 1));
        assert_eq!(
            given,
            AoaError::TooManySources { method: method.name(), most: limit, given: limit + 1 }
        );
    }
}

#[test]
fn averaging_and_smoothing_need_a_uniform_array() {
    let sparse = preset("lrr48").unwrap();
    for options in [
        EstimatorOptions { forward_backward: true, ..EstimatorOptions::default() },
        EstimatorOptions { smoothing: Some(8), ..EstimatorOptions::default() },
    ] {
        let error = error(Method::Music, &sparse, &options);
        assert!(matches!(error, AoaError::Array { .. }), "{error}");
    }
    let long = EstimatorOptions { smoothing: Some(9), ..EstimatorOptions::default() };
    let error = error(Method::Capon, &Array::ula(8).unwrap(), &long);
    assert!(matches!(error, AoaError::Argument(InputError::OutOfRange { .. })), "{error}");
}

#[test]
fn a_field_of_view_between_grid_points_is_refused() {
    let narrow = EstimatorOptions {
        field_of_view_rad: 0.01,
        grid_points: 21,
        ..EstimatorOptions::default()
    };
    for method in [Method::Bartlett, Method::Iaa] {
        let error = error(method, &Array::ula(8).unwrap(), &narrow);
        assert!(
            matches!(&error, AoaError::Argument(InputError::OutOfRange { what, .. })
                if what == "grid_points"),
            "{error}"
        );
    }
}

#[test]
fn the_number_of_snapshots_is_checked() {
    let array = Array::ula(8).unwrap();
    let mut random = Random::new(61, 0);
    let one = scene(&array, &azimuths(&[10.0]), &[1.0], 1e-3, 1, &mut random);
    let three = scene(&array, &azimuths(&[10.0]), &[1.0], 0.1, 3, &mut random);
    for method in [Method::Music, Method::RootMusic, Method::Esprit, Method::MinNorm] {
        let mut estimator = Estimator::new(method, &array, &known(1)).unwrap();
        let error = estimator.estimate(Data::Snapshots(one.view())).unwrap_err();
        assert!(matches!(error, AoaError::Snapshots { given: 1, .. }), "{error}");
        assert!(estimator.estimate(Data::Snapshots(three.view())).unwrap().resolved);
        let mut five = Estimator::new(method, &array, &known(5)).unwrap();
        let error = five.estimate(Data::Snapshots(three.view())).unwrap_err();
        assert!(matches!(error, AoaError::Snapshots { given: 3, .. }), "{error}");
        let smoothed = EstimatorOptions { smoothing: Some(6), ..known(1) };
        let mut estimator = Estimator::new(method, &array, &smoothed).unwrap();
        assert!(estimator.estimate(Data::Snapshots(one.view())).unwrap().resolved);
    }
    let method = Method::SingleSnapshotMusic;
    let mut estimator = Estimator::new(method, &array, &known(1)).unwrap();
    let error = estimator.estimate(Data::Snapshots(three.view())).unwrap_err();
    assert_eq!(error.code(), "snapshot-count");
    let identity = Array2::<Complex64>::eye(8);
    let data = Data::Covariance { matrix: identity.view(), snapshots: 1 };
    assert_eq!(estimator.estimate(data).unwrap_err().code(), "needs-snapshots");
}

#[test]
fn malformed_data_is_refused_and_the_estimator_goes_on() {
    let array = Array::ula(6).unwrap();
    let mut random = Random::new(62, 0);
    let good = scene(&array, &azimuths(&[10.0]), &[1.0], 0.1, 4, &mut random);
    let mut nan = good.clone();
    nan[[2, 1]] = Complex64::new(0.0, f64::NAN);
    let mut infinite = good.clone();
    infinite[[5, 0]] = Complex64::new(f64::INFINITY, 0.0);
    let huge = good.mapv(|z| z * 1e200);
    let few = Array2::zeros((5, 4));
    let none = Array2::zeros((6, 0));
    let mut skew = Array2::<Complex64>::eye(6);
    skew[[0, 1]] = Complex64::new(0.5, 0.0);
    for method in
        [Method::Bartlett, Method::Capon, Method::Music, Method::RootMusic, Method::Esprit]
    {
        let mut estimator = Estimator::new(method, &array, &known(1)).unwrap();
        for (data, code) in [
            (&nan, "not-finite"),
            (&infinite, "not-finite"),
            (&huge, "out-of-range"),
            (&few, "shape"),
            (&none, "empty"),
        ] {
            let error = estimator.estimate(Data::Snapshots(data.view())).unwrap_err();
            assert_eq!(error.code(), code, "{}: {error}", method.name());
            let details = error.details();
            assert!(!details.what.is_empty() && !details.expected.is_empty());
            assert!(estimator.estimate(Data::Snapshots(good.view())).unwrap().resolved);
        }
        for (matrix, snapshots, code) in [
            (&skew, 10, "out-of-range"),
            (&good, 10, "shape"),
            (&nan, 10, "shape"),
            (&skew, 0, "empty"),
        ] {
            let data = Data::Covariance { matrix: matrix.view(), snapshots };
            assert_eq!(estimator.estimate(data).unwrap_err().code(), code);
        }
    }
}

fn positions() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let anywhere = prop::collection::vec(prop::array::uniform3(-20.0..20.0f64), 1..10);
    let line =
        (1usize..12, prop_oneof![Just(1.0), Just(0.5), Just(2.0), 0.1..3.0f64], any::<bool>())
            .prop_map(|(n, d, falling)| {
                let sign = if falling { -1.0 } else { 1.0 };
                (0..n).map(|k| [0.0, sign * d * k as f64, 0.0]).collect()
            });
    let plane = (1usize..4, 1usize..4)
        .prop_map(|(n, m)| (0..n * m).map(|k| [0.0, (k % n) as f64, (k / n) as f64]).collect());
    let sparse = prop::collection::vec(0u32..30, 1..9)
        .prop_map(|ys| ys.iter().map(|&y| [0.0, f64::from(y), 0.0]).collect());
    prop_oneof![anywhere, line, plane, sparse]
}

fn options() -> impl Strategy<Value = EstimatorOptions> {
    let sources = prop_oneof![
        (1usize..12).prop_map(SourceCount::Known),
        Just(SourceCount::Aic),
        Just(SourceCount::Mdl),
        Just(SourceCount::Network),
    ];
    let shape = (sources, 0.1..1.57f64, 40usize..200, 3usize..8);
    let averaging =
        (any::<bool>(), prop::option::of(2usize..9), prop_oneof![Just(0.0), 0.0..1.0f64]);
    let peaks = (1.0..100.0f64, 1usize..8, any::<bool>());
    let iaa = (1usize..4, 0usize..3, 0usize..3);
    (shape, averaging, peaks, iaa).prop_map(|(shape, averaging, peaks, iaa)| {
        let mut options = EstimatorOptions {
            sources: shape.0,
            field_of_view_rad: shape.1,
            grid_points: shape.2,
            elevation_points: shape.3,
            forward_backward: averaging.0,
            smoothing: averaging.1,
            loading: averaging.2,
            dynamic_range_db: peaks.0,
            max_peaks: peaks.1,
            esprit: if peaks.2 { EspritForm::LeastSquares } else { EspritForm::TotalLeastSquares },
            max_iterations: 5,
            ..EstimatorOptions::default()
        };
        options.iaa.iterations = iaa.0;
        options.iaa.thresholding =
            [Thresholding::None, Thresholding::Hard, Thresholding::Soft][iaa.1];
        options.iaa.form = [IaaForm::Auto, IaaForm::Fast, IaaForm::Dense][iaa.2];
        options.nomp.max_sources = peaks.1;
        options
    })
}

/// Snapshots of kinds that have broken estimators before: noise, one wave, nothing, repeated
/// columns, one dead element, numbers far from 1.
fn data(array: &Array, kind: usize, snapshots: usize, seed: u64) -> Array2<Complex64> {
    let mut random = Random::new(seed, 0);
    let noise = |random: &mut Random| {
        Array2::from_shape_fn((array.len(), snapshots), |_| random.complex_normal(1.0))
    };
    match kind {
        0 => noise(&mut random),
        1 => scene(array, &azimuths(&[10.0]), &[1.0], 0.0, snapshots, &mut random),
        2 => Array2::zeros((array.len(), snapshots)),
        3 => {
            let column = noise(&mut random).column(0).to_owned();
            Array2::from_shape_fn((array.len(), snapshots), |(k, _)| column[k])
        }
        4 => {
            let mut y =
                scene(array, &azimuths(&[-30.0, 5.0]), &[1.0, 1.0], 1e-3, snapshots, &mut random);
            y.row_mut(0).fill(Complex64::ZERO);
            y
        }
        5 => noise(&mut random).mapv(|z| z * 1e130),
        _ => noise(&mut random).mapv(|z| z * 1e-170),
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: proptest::test_runner::RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_answer_is_finite_and_within_the_field_of_view(
        positions in positions(),
        options in options(),
        method in prop::sample::select(Method::ALL.to_vec()),
        kind in 0usize..7,
        snapshots in 1usize..6,
        as_covariance in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let array = Array::new(&positions).unwrap();
        let y = data(&array, kind, snapshots, seed);
        let Ok(mut estimator) = Estimator::new(method, &array, &options) else {
            return Ok(());
        };
        let r = boresight_signal::sample_covariance(y.view());
        let data = if as_covariance && r.iter().all(|z| z.re.is_finite() && z.im.is_finite()) {
            Data::Covariance { matrix: r.view(), snapshots }
        } else {
            Data::Snapshots(y.view())
        };
        match estimator.estimate(data) {
            Ok(estimate) => {
                for source in &estimate.sources {
                    let at = source.direction;
                    prop_assert!(at.azimuth_rad.is_finite() && at.elevation_rad.is_finite());
                    prop_assert!(source.power.is_finite() && source.power >= 0.0, "{:?}", source);
                    // Refinement may leave the field of view by one step of the grid.
                    let limit = options.field_of_view_rad.sin() + 2.5 / options.grid_points as f64;
                    prop_assert!(at.azimuth_rad.sin().abs() <= limit, "{:?}", at);
                }
                if let Some(spectrum) = &estimate.spectrum {
                    let points = spectrum.azimuth_rad.len() * spectrum.elevation_rad.len();
                    prop_assert_eq!(spectrum.values.len(), points);
                    prop_assert!(spectrum.values.iter().all(|v| v.is_finite() && *v >= 0.0));
                }
                prop_assert!(!estimate.resolved || !estimate.sources.is_empty());
            }
            Err(error) => {
                prop_assert!(!error.details().what.is_empty(), "{}", error);
            }
        }
    }
}

#[test]
fn positions_in_metres_are_remarked_on() {
    let metres: Vec<[f64; 3]> = (0..8).map(|k| [0.0, 0.001_95 * f64::from(k), 0.0]).collect();
    let y = Array2::from_elem((8, 1), Complex64::new(1.0, 0.0));
    for (array, expected) in [(Array::new(&metres).unwrap(), true), (Array::ula(2).unwrap(), false)]
    {
        let mut estimator = Estimator::new(Method::Bartlett, &array, &known(1)).unwrap();
        let data = Data::Snapshots(y.slice(ndarray::s![..array.len(), ..]));
        let warnings = estimator.estimate(data).unwrap().warnings;
        let remarked = warnings.iter().any(|w| matches!(w, Warning::TinyArray { .. }));
        assert_eq!(remarked, expected, "{warnings:?}");
    }
}

#[test]
fn data_whose_powers_vanish_is_refused_and_zeros_are_not() {
    let array = Array::ula(8).unwrap();
    for method in [Method::Nomp, Method::MaximumLikelihood, Method::Music, Method::Iaa] {
        let mut estimator = Estimator::new(method, &array, &known(1)).unwrap();
        let mut estimate = |value: f64| {
            let y = Array2::from_shape_fn((8, 4), |(k, n)| {
                Complex64::new(value, value * ((k + 1) as f64 * 0.1 - n as f64))
            });
            estimator.estimate(Data::Snapshots(y.view()))
        };
        let error = estimate(1e-200).unwrap_err();
        assert_eq!(error.details().what, "largest part of the snapshots", "{}", method.name());
        assert!(!estimate(0.0).unwrap().resolved);
        assert!(!estimate(1e-100).unwrap().sources.is_empty(), "{}", method.name());
    }
}

#[test]
fn a_covariance_that_is_none_is_refused_with_what_is_wrong() {
    let array = Array::ula(3).unwrap();
    let mut estimator = Estimator::new(Method::Capon, &array, &known(1)).unwrap();
    let mut refused = |entry: [usize; 2], value: f64| {
        let mut matrix = Array2::from_diag(&Array1::from_elem(3, Complex64::new(1.0, 0.0)));
        matrix[entry] = Complex64::new(value, 0.0);
        let data = Data::Covariance { matrix: matrix.view(), snapshots: 10 };
        estimator.estimate(data).unwrap_err().to_string()
    };
    let skewed = refused([0, 1], 0.5);
    assert!(skewed.starts_with("asymmetry of the covariance is 0.5"), "{skewed}");
    let negative = refused([2, 2], -0.25);
    assert!(negative.starts_with("diagonal of the covariance is -0.25"), "{negative}");
}
