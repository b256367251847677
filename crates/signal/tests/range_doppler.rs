//! The range-Doppler plan against the definition of the transforms.

#![allow(clippy::unwrap_used)]

use boresight_core::{
    Complex32, Complex64, Diagnose, InputError, Multiplexing, Random, Sampling, Waveform,
};
use boresight_signal::{
    RangeDoppler, RangeDopplerOptions, SignalError, Window, power_map, remove_static_clutter,
};
use ndarray::{Array3, Array4};
use std::f64::consts::TAU;

fn waveform(samples: usize, transmitters: usize, loops: usize) -> Waveform {
    Waveform {
        start_frequency_hz: 77e9,
        slope_hz_per_s: 60e12,
        sample_rate_hz: 5e6,
        sampling: Sampling::Complex,
        samples,
        adc_start_s: 2e-6,
        chirp_interval_s: 60e-6,
        transmitters,
        loops,
        frame_interval_s: 40e-3,
        multiplexing: Multiplexing::TimeDivision,
        doppler_bands: None,
    }
}

fn noise(shape: (usize, usize, usize, usize)) -> Array4<Complex32> {
    let mut random = Random::new(3, 0);
    Array4::from_shape_fn(shape, |_| {
        let z = random.complex_normal(1.0);
        Complex32::new(z.re as f32, z.im as f32)
    })
}

/// The transforms by their definition, in `f64`.
fn by_definition(frame: &Array4<Complex32>, options: &RangeDopplerOptions) -> Array3<Complex64> {
    let (loops, tx, rx, samples) = frame.dim();
    let range_weights = options.range_window.coefficients(samples).unwrap();
    let doppler_weights = options.doppler_window.coefficients(loops).unwrap();
    let gain = range_weights.iter().sum::<f64>() * doppler_weights.iter().sum::<f64>();
    let (ranges, dopplers) = (samples * options.range_padding, loops * options.doppler_padding);
    Array3::from_shape_fn((tx * rx, ranges, dopplers), |(channel, r, d)| {
        let mut sum = Complex64::ZERO;
        for l in 0..loops {
            for n in 0..samples {
                let x = frame[[l, channel / rx, channel % rx, n]];
                let turns = (r * n) as f64 / ranges as f64
                    + (d as f64 - (dopplers / 2) as f64) * l as f64 / dopplers as f64;
                sum += Complex64::new(x.re.into(), x.im.into())
                    * Complex64::cis(-TAU * turns)
                    * (range_weights[n] * doppler_weights[l]);
            }
        }
        sum / gain
    })
}

#[test]
fn equals_the_definition_for_even_odd_and_padded_lengths() {
    for (samples, tx, loops, range_padding, doppler_padding) in
        [(16, 2, 8, 1, 1), (12, 1, 7, 1, 1), (10, 1, 5, 2, 3), (9, 3, 6, 1, 4), (4, 1, 1, 1, 1)]
    {
        let options = RangeDopplerOptions {
            range_window: Window::Hamming,
            doppler_window: Window::Hann,
            range_padding,
            doppler_padding,
            static_clutter_removal: false,
        };
        let frame = noise((loops, tx, 2, samples));
        let mut plan = RangeDoppler::new(&waveform(samples, tx, loops), 2, &options).unwrap();
        let mut map = plan.output();
        plan.process(frame.view(), &mut map).unwrap();
        let reference = by_definition(&frame, &options);
        for (given, expected) in map.cube.iter().zip(&reference) {
            let given = Complex64::new(given.re.into(), given.im.into());
            assert!((given - expected).norm() < 1e-6, "{given} {expected}");
        }
        let power = power_map(map.cube.view());
        for (given, expected) in map.power.iter().zip(&power) {
            assert!((given - expected).abs() < 1e-6);
        }
        // Frames that are not contiguous give the same.
        let fortran = {
            let mut turned = Array4::zeros((samples, 2, tx, loops));
            turned.assign(&frame.view().permuted_axes([3, 2, 1, 0]));
            turned
        };
        let again = map.clone();
        plan.process(fortran.view().permuted_axes([3, 2, 1, 0]), &mut map).unwrap();
        assert_eq!(map, again);
    }
}

#[test]
fn a_tone_keeps_its_power_in_cell_and_profile() {
    let options = RangeDopplerOptions { doppler_padding: 2, ..RangeDopplerOptions::default() };
    let (samples, loops) = (64, 32);
    let frame = Array4::from_shape_fn((loops, 1, 2, samples), |(l, _, _, n)| {
        let turns = 20.0 * n as f64 / 64.0 + 5.0 * l as f64 / 32.0;
        let z = Complex64::cis(TAU * turns) * 3.0;
        Complex32::new(z.re as f32, z.im as f32)
    });
    let mut plan = RangeDoppler::new(&waveform(samples, 1, loops), 2, &options).unwrap();
    let mut map = plan.output();
    plan.process(frame.view(), &mut map).unwrap();
    assert!((map.power[[20, 32 + 10]] - 9.0).abs() < 1e-4);
    assert!((plan.range_profile(&map).unwrap()[20] - 9.0).abs() < 1e-4);
    let resolution = plan.waveform().rate_resolution_mps();
    assert!((plan.rate_mps()[42] - 5.0 * resolution).abs() < 1e-9);
    assert!((plan.range_m()[20] - 20.0 * plan.waveform().range_resolution_m()).abs() < 1e-9);
    assert!(plan.rate_mps().windows(2).all(|w| w[0] < w[1]));
    let snapshot = map.snapshot(20, 42).unwrap();
    assert!(snapshot.len() == 2 && (snapshot[0].norm() - 3.0).abs() < 1e-4);
    for (range, doppler, what) in [(64, 0, "range bin"), (0, 64, "Doppler bin")] {
        assert_eq!(map.snapshot(range, doppler).unwrap_err().details().what, what);
    }
}

/// Mean noise power of 8192 cells: its standard error is 1.1 % where they are independent, up to
/// twice that behind windows; five of the latter.
#[test]
fn noise_falls_by_the_processing_gain() {
    for window in [Window::Rectangular, Window::BlackmanHarris] {
        let options = RangeDopplerOptions {
            range_window: window,
            doppler_window: window,
            ..RangeDopplerOptions::default()
        };
        let mut plan = RangeDoppler::new(&waveform(64, 1, 64), 2, &options).unwrap();
        let mut map = plan.output();
        plan.process(noise((64, 1, 2, 64)).view(), &mut map).unwrap();
        let mean = map.power.mean().unwrap();
        let ratio = f64::from(mean) * plan.processing_gain();
        assert!((ratio - 1.0).abs() < 0.11, "{ratio}");
    }
}

/// The Hann window correlates neighbours by 2/3 and those after next by 1/6.
#[test]
fn correlation_is_that_of_the_windows() {
    let options = RangeDopplerOptions {
        range_window: Window::Rectangular,
        doppler_padding: 2,
        ..RangeDopplerOptions::default()
    };
    let plan = RangeDoppler::new(&waveform(64, 1, 512), 1, &options).unwrap();
    let [range, doppler] = plan.bin_noise().map(|noise| noise.unwrap().correlated_bins().unwrap());
    let hann = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);
    assert!((range - 1.0).abs() < 1e-12);
    assert!((doppler / (2.0 * hann) - 1.0).abs() < 0.01, "{doppler}");
}

#[test]
fn static_clutter_goes_and_movers_stay() {
    let frame = Array4::from_shape_fn((16, 1, 1, 8), |(l, _, _, n)| {
        let fixed = Complex32::new(5.0, n as f32);
        let moving = Complex64::cis(TAU * 4.0 * l as f64 / 16.0);
        fixed + Complex32::new(moving.re as f32, moving.im as f32)
    });
    let options = RangeDopplerOptions {
        range_window: Window::Rectangular,
        doppler_window: Window::Rectangular,
        static_clutter_removal: true,
        ..RangeDopplerOptions::default()
    };
    let mut plan = RangeDoppler::new(&waveform(8, 1, 16), 1, &options).unwrap();
    let mut map = plan.output();
    plan.process(frame.view(), &mut map).unwrap();
    assert!(map.power.column(8).iter().all(|&p| p < 1e-9));
    assert!((map.power[[0, 12]] - 1.0).abs() < 1e-5);

    let mut cleaned = frame.clone();
    remove_static_clutter(cleaned.view_mut());
    let options = RangeDopplerOptions { static_clutter_removal: false, ..options };
    let mut plain = RangeDoppler::new(&waveform(8, 1, 16), 1, &options).unwrap();
    let mut again = plain.output();
    plain.process(cleaned.view(), &mut again).unwrap();
    assert!((&again.power - &map.power).iter().all(|d| d.abs() < 1e-6));
}

#[test]
fn wrong_shapes_and_sizes_are_named() {
    let good = waveform(8, 1, 4);
    let options = RangeDopplerOptions::default();
    let mut plan = RangeDoppler::new(&good, 2, &options).unwrap();
    let mut map = plan.output();
    for shape in [(4, 1, 2, 7), (0, 1, 2, 8), (4, 2, 2, 8)] {
        let error = plan.process(Array4::zeros(shape).view(), &mut map).unwrap_err();
        assert!(matches!(error, SignalError::Argument(InputError::Shape { .. })));
    }
    let mut other = RangeDoppler::new(&good, 1, &options).unwrap().output();
    let refused = plan.process(Array4::zeros((4, 1, 2, 8)).view(), &mut other).unwrap_err();
    assert!(matches!(refused, SignalError::Argument(InputError::Shape { .. })), "{refused}");
    assert!(plan.process(Array4::zeros((4, 1, 2, 8)).view(), &mut map).is_ok());

    let huge = Waveform { loops: 40_000, frame_interval_s: 3.0, ..waveform(65_536, 1, 4) };
    let huge = Waveform { sample_rate_hz: 5e9, ..huge };
    let error = RangeDoppler::new(&huge, 64, &options).err();
    assert!(
        matches!(error, Some(SignalError::Argument(InputError::TooLarge { given, .. })) if given > 1e9),
        "{error:?}"
    );
    let padded = RangeDopplerOptions { range_padding: 0, ..options };
    let what = |result: Result<RangeDoppler, SignalError>| result.err().unwrap().details().what;
    assert_eq!(what(RangeDoppler::new(&good, 2, &padded)), "padding");
    let broken = Waveform { sample_rate_hz: f64::NAN, ..good };
    assert_eq!(what(RangeDoppler::new(&broken, 2, &options)), "sample_rate_hz");
    assert_eq!(what(RangeDoppler::new(&good, 0, &options)), "receivers");
}
