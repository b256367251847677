//! Whatever is given, there is a result or a typed error.

#![allow(clippy::unwrap_used)]

use boresight_core::{Complex32, Complex64, Diagnose, Multiplexing, Sampling, Waveform};
use boresight_options::Named;
use boresight_signal::region::{crop_region, range_spectrum, region_covariance};
use boresight_signal::{
    BinNoise, Cfar, CfarAxes, CfarKind, CfarOptions, RangeDoppler, RangeDopplerOptions, Window,
    forward_backward, group_peaks, load_diagonal, sample_covariance, spatial_smoothing, tdm,
};
use ndarray::{Array2, Array4};
use proptest::prelude::*;

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(0.0), 0.0..1.0, any::<f64>()]
}

fn any_count() -> impl Strategy<Value = usize> {
    prop_oneof![8 => 0..12_usize, 1 => Just(usize::MAX), 1 => Just(1 << 40)]
}

fn any_kind() -> impl Strategy<Value = CfarKind> {
    prop::sample::select(CfarKind::VARIANTS)
}

fn any_window() -> impl Strategy<Value = Window> {
    prop_oneof![
        prop::sample::select(&Window::NAMES[..]).prop_map(|name| Window::named(name).unwrap()),
        any_number().prop_map(|sidelobe_db| Window::Chebyshev { sidelobe_db }),
        (any_count(), any_number())
            .prop_map(|(nbar, sidelobe_db)| Window::Taylor { nbar, sidelobe_db }),
    ]
}

fn any_noise() -> impl Strategy<Value = Option<BinNoise>> {
    prop::option::of(
        (any_window(), any_count(), any_count())
            .prop_map(|(window, samples, padding)| BinNoise::new(window, samples, padding)),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn cfar_detects_or_says_why_not(
        kind in any_kind(),
        rank in any_number(),
        axes in prop::sample::select(vec![CfarAxes::Range, CfarAxes::Doppler, CfarAxes::Both]),
        false_alarm in prop_oneof![3 => 1e-9..0.5, 1 => any_number()],
        guard_cells in prop::array::uniform2(any_count()),
        training_cells in prop::array::uniform2(any_count()),
        looks in prop_oneof![3 => 1..20_usize, 1 => any_count()],
        ranges in prop_oneof![3 => 1..40_usize, 1 => any_count()],
        dopplers in prop_oneof![3 => 1..40_usize, 1 => any_count()],
        noise in prop::array::uniform2(any_noise()),
        cells in prop::collection::vec(prop_oneof![0.0_f32..9.0, any::<f32>()], 1..9),
    ) {
        let options = CfarOptions {
            kind, axes, false_alarm, guard_cells, training_cells, rank, looks, noise,
        };
        // A map of a gigabyte is allowed, and not for a test to make.
        prop_assume!(ranges.saturating_mul(dopplers) < 1 << 20 || ranges.min(dopplers) > 1 << 14);
        if let Ok(mut cfar) = Cfar::new(ranges, dopplers, &options) {
            for (_, factors) in cfar.rows() {
                prop_assert!(factors.threshold > 0.0 && factors.threshold.is_finite());
                prop_assert!(factors.bias > 0.0 && factors.bias.is_finite());
            }
            let map = Array2::from_shape_fn((ranges, dopplers), |(r, d)| {
                cells[(r * dopplers + d) % cells.len()]
            });
            if let Ok(detections) = cfar.detect(map.view()) {
                let peaks = group_peaks(map.view(), &detections);
                prop_assert_eq!(peaks.peaks.len() + peaks.grouped, detections.len());
                for peak in peaks.peaks {
                    prop_assert!(peak.range_bin >= 0.0 && peak.range_bin < ranges as f64);
                    prop_assert!(peak.power.is_finite());
                }
            }
            let other = cfar.detect(Array2::zeros((ranges + 1, dopplers)).view()).err();
            let other = other.map(|error| (error.code(), error.details().what));
            prop_assert_eq!(other, Some(("shape", "power map".to_owned())));
        }
    }

    #[test]
    fn frames_are_transformed_or_refused(
        range_window in any_window(),
        doppler_window in any_window(),
        range_padding in any_count(),
        doppler_padding in any_count(),
        receivers in any_count(),
        samples in any_count(),
        loops in any_count(),
    ) {
        let waveform = Waveform {
            start_frequency_hz: 77e9,
            slope_hz_per_s: 60e12,
            sample_rate_hz: 5e6,
            sampling: Sampling::Complex,
            samples,
            adc_start_s: 2e-6,
            chirp_interval_s: 60e-6,
            transmitters: 2,
            loops,
            frame_interval_s: 40e-3,
            multiplexing: Multiplexing::TimeDivision,
            doppler_bands: None,
        };
        let options = RangeDopplerOptions {
            range_window,
            doppler_window,
            range_padding,
            doppler_padding,
            static_clutter_removal: true,
        };
        if let Ok(mut plan) = RangeDoppler::new(&waveform, receivers, &options) {
            let mut map = plan.output();
            let frame = Array4::from_elem((loops, 2, receivers, samples), Complex32::new(1.0, 0.0));
            plan.process(frame.view(), &mut map).unwrap();
            prop_assert!(map.power.iter().all(|p| p.is_finite()));
            prop_assert!(plan.range_profile(&map).is_ok());
        }
    }

    #[test]
    fn covariances_of_any_shape_do_not_panic(
        rows in 0..6_usize,
        columns in 0..6_usize,
        length in any_count(),
        share in any_number(),
        value in any_number(),
    ) {
        let y = Array2::from_elem((rows, columns), Complex64::new(value, 1.0));
        let mut r = sample_covariance(y.view());
        let _ = spatial_smoothing(y.view(), length);
        let _ = spatial_smoothing(r.view(), length);
        prop_assert_eq!(forward_backward(r.view()).dim(), (rows, rows));
        load_diagonal(&mut r, share);
        let mut cell = vec![Complex64::ZERO; rows];
        let _ = tdm::compensate(&mut cell, columns, share);
    }

    #[test]
    fn regions_are_cropped_or_refused(
        window in any_window(),
        shape in prop::array::uniform4(0..5_usize),
        centre in any_count(),
        length in any_count(),
        chirps in any_count(),
    ) {
        let [loops, tx, rx, samples] = shape;
        let frame = Array4::from_elem((loops, tx, rx, samples), Complex32::new(1.0, 0.0));
        if let Ok(spectrum) = range_spectrum(frame.view(), window)
            && let Ok(region) = crop_region(spectrum.view(), centre, length, chirps)
        {
            prop_assert_eq!(region_covariance(region.view()).nrows(), tx * rx);
        }
    }
}
