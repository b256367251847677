//! Sparse and gridless methods on whatever arrays, options and data there are: no panic, no NaN.

use boresight_aoa::options::{IaaForm, IaaOptions, NompOptions, Thresholding};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::{Array, Complex64};
use ndarray::Array2;
use proptest::prelude::*;

fn arrays() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let along = |step: f64| {
        prop::collection::vec(0..20u8, 2..9)
            .prop_map(move |ys| ys.iter().map(|&y| [0.0, step * f64::from(y), 0.0]).collect())
    };
    let solid = prop::collection::vec([-3.0..3.0, -5.0..5.0, -3.0..3.0], 1..8);
    prop_oneof![
        along(1.0),
        along(0.5),
        along(2.0),
        along(0.37),
        solid.prop_map(|positions: Vec<[f64; 3]>| positions),
        Just((0..8).map(|k| [0.0, f64::from(k), 0.0]).collect::<Vec<_>>()),
        Just((0..8).map(|k| [0.0, f64::from(k % 4), f64::from(k / 4)]).collect::<Vec<_>>()),
    ]
}

fn options() -> impl Strategy<Value = EstimatorOptions> {
    let iaa = (
        1..20usize,
        prop_oneof![Just(Thresholding::None), Just(Thresholding::Hard), Just(Thresholding::Soft)],
        0.0..60.0,
        prop_oneof![Just(0.0), 1e-6..1.0],
        prop_oneof![Just(IaaForm::Auto), Just(IaaForm::Dense), Just(IaaForm::Fast)],
    );
    let nomp = (
        1e-6..0.4,
        prop_oneof![Just(None), (1e-6..10.0).prop_map(Some)],
        1..8usize,
        0..4usize,
        0..4usize,
        1..12usize,
    );
    let sources = prop_oneof![
        (1..9usize).prop_map(SourceCount::Known),
        Just(SourceCount::Aic),
        Just(SourceCount::Mdl)
    ];
    (iaa, nomp, sources, 16..150usize, 0.1..1.57, 1..8usize).prop_map(
        |(iaa, nomp, sources, grid_points, field_of_view_rad, max_iterations)| EstimatorOptions {
            sources,
            grid_points,
            field_of_view_rad,
            max_iterations,
            elevation_points: 5,
            iaa: IaaOptions {
                iterations: iaa.0,
                thresholding: iaa.1,
                threshold_db: iaa.2,
                regularisation: iaa.3,
                form: iaa.4,
                ..EstimatorOptions::default().iaa
            },
            nomp: NompOptions {
                false_alarm: nomp.0,
                noise_power: nomp.1,
                oversampling: nomp.2,
                single_refinements: nomp.3,
                cyclic_refinements: nomp.4,
                max_sources: nomp.5,
            },
            ..EstimatorOptions::default()
        },
    )
}

/// Random parts, some of them zero, over many orders of magnitude.
fn snapshots() -> impl Strategy<Value = Vec<f64>> {
    let part = prop_oneof![4 => -1.0..1.0, 1 => Just(0.0), 1 => Just(1.0)];
    let scale = prop_oneof![3 => Just(1.0), 1 => (-200.0..150.0).prop_map(|e: f64| 10f64.powf(e))];
    (prop::collection::vec(part, 2 * 9 * 12), scale, prop::bool::ANY).prop_map(
        |(mut parts, scale, silent)| {
            parts.iter_mut().for_each(|x: &mut f64| *x *= if silent { 0.0 } else { scale });
            parts
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]
    #[test]
    fn results_are_finite_or_typed_errors(
        positions in arrays(),
        options in options(),
        parts in snapshots(),
        count in 1..12usize,
        which in 0..4usize,
        covariance in prop::bool::weighted(0.1),
    ) {
        let array = Array::new(&positions).unwrap();
        let methods =
            [Method::Iaa, Method::Nomp, Method::MaximumLikelihood, Method::SparseBayesian];
        let Ok(mut estimator) = Estimator::new(methods[which], &array, &options) else {
            return Ok(());
        };
        let elements = array.len();
        let y = Array2::from_shape_fn((elements, count), |(k, n)| {
            let at = 2 * ((k % 9) * 12 + n);
            Complex64::new(parts[at], parts[at + 1])
        });
        let r = boresight_signal::sample_covariance(y.view());
        let data = if covariance && r.iter().all(|z| z.is_finite()) {
            Data::Covariance { matrix: r.view(), snapshots: count }
        } else {
            Data::Snapshots(y.view())
        };
        let Ok(result) = estimator.estimate(data) else {
            return Ok(());
        };
        for source in &result.sources {
            prop_assert!(source.direction.azimuth_rad.is_finite());
            prop_assert!(source.direction.elevation_rad.is_finite());
            prop_assert!(source.power.is_finite() && source.power >= 0.0, "{:?}", source);
            prop_assert!(source.amplitude.is_none_or(|s| s.is_finite()));
        }
        if let Some(spectrum) = &result.spectrum {
            prop_assert!(spectrum.values.iter().all(|v| v.is_finite() && *v >= 0.0));
        }
        prop_assert_eq!(result.resolved, !result.sources.is_empty() && result.resolved);
    }
}
