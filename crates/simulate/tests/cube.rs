//! Data cubes against closed forms, and through the range-Doppler transform back to the targets.

#![allow(clippy::unwrap_used)]

use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::presets::preset;
use boresight_core::steering::steering_vector;
use boresight_core::units::SPEED_OF_LIGHT_MPS;
use boresight_core::{Array, Complex32, Complex64, Direction, Imperfections, InputError, Waveform};
use boresight_math::decibels::db_to_power;
use boresight_signal::range::{range_doppler_coupling_m, range_of_bin_m};
use boresight_signal::range_doppler::rate_of_bin_mps;
use boresight_signal::{
    Cfar, CfarOptions, Peak, RangeDoppler, RangeDopplerMap, RangeDopplerOptions, group_peaks, tdm,
};
use boresight_simulate::{
    CubeOptions, CubeTarget, Field, SimulateError, simulate_cube, waveform_3dcnn_simulated,
    waveform_awr1642,
};
use ndarray::{Array1, Array5, Axis};
use proptest::prelude::*;
use std::f64::consts::TAU;

const NOISELESS: f64 = 300.0;

fn wide(z: Complex32) -> Complex64 {
    Complex64::new(z.re.into(), z.im.into())
}

fn awr1642() -> (Waveform, Array) {
    (Waveform { loops: 64, ..waveform_awr1642() }, preset("awr1642").unwrap())
}

fn target(range_m: f64, rate_mps: f64, azimuth_deg: f64) -> CubeTarget {
    CubeTarget {
        range_m,
        rate_mps,
        direction: Direction::azimuth(azimuth_deg.to_radians()).into(),
        ..CubeTarget::default()
    }
}

/// The strongest peak of the first frame, the plan and the map it is in.
fn strongest(
    waveform: &Waveform,
    cube: &Array5<Complex32>,
    receivers: usize,
) -> (Peak, RangeDopplerMap) {
    let mut plan = RangeDoppler::new(waveform, receivers, &RangeDopplerOptions::default()).unwrap();
    let mut map = plan.output();
    plan.process(cube.index_axis(Axis(0), 0), &mut map).unwrap();
    let (ranges, dopplers) = map.power.dim();
    let options =
        CfarOptions { looks: plan.channels(), noise: plan.bin_noise(), ..CfarOptions::default() };
    let mut cfar = Cfar::new(ranges, dopplers, &options).unwrap();
    let detections = cfar.detect(map.power.view()).unwrap();
    let peaks = group_peaks(map.power.view(), &detections).peaks;
    let best = peaks.into_iter().max_by(|a, b| a.power.total_cmp(&b.power)).unwrap();
    (best, map)
}

/// Every sample against equation 9 with the range and the time of that sample.
#[test]
fn samples_are_those_of_the_signal_model() {
    let (waveform, array) = awr1642();
    let waveform = Waveform { loops: 3, ..waveform };
    let moving = CubeTarget { phase_rad: Some(0.4), power_db: 6.0, ..target(3.0, 2.5, 25.0) };
    let options = CubeOptions { snr_db: NOISELESS, frames: 2, ..CubeOptions::default() };
    let cube = simulate_cube(&waveform, &array, &[moving], &options).unwrap();
    assert_eq!(cube.dim(), (2, 3, 2, 4, 256));
    let steering = steering_vector(&array, *moving.direction);
    for ((f, l, t, r, n), z) in cube.indexed_iter() {
        let ramp_s = waveform.adc_start_s + n as f64 / waveform.sample_rate_hz;
        let time_s = f as f64 * waveform.frame_interval_s
            + (2 * l + t) as f64 * waveform.chirp_interval_s
            + ramp_s;
        let delay_s = 2.0 * (3.0 + 2.5 * time_s) / SPEED_OF_LIGHT_MPS;
        let turns = delay_s * (waveform.start_frequency_hz + waveform.slope_hz_per_s * ramp_s);
        let expected = Complex64::from_polar(10.0_f64.powf(0.3), TAU * turns.fract() + 0.4)
            * steering[4 * t + r];
        assert!((wide(*z) - expected).norm() < 1e-6, "{f} {l} {t} {r} {n}");
    }
}

#[test]
fn a_target_is_found_at_its_range_rate_and_power() {
    let (waveform, array) = awr1642();
    for (range_m, rate_mps, power_db) in
        [(4.21, 1.3, 0.0), (7.77, -2.0, -9.0), (2.0, 0.0, 5.0), (11.0, 3.9, 0.0)]
    {
        let moving = CubeTarget { power_db, ..target(range_m, rate_mps, 10.0) };
        let options = CubeOptions { snr_db: 10.0, seed: 4, ..CubeOptions::default() };
        let cube = simulate_cube(&waveform, &array, &[moving], &options).unwrap();
        let (peak, map) = strongest(&waveform, &cube, 4);
        let (ranges, dopplers) = map.power.dim();
        let rate = rate_of_bin_mps(&waveform, dopplers, peak.doppler_bin);
        let range = range_of_bin_m(&waveform, ranges, peak.range_bin)
            - range_doppler_coupling_m(&waveform, rate);
        // The frame shows the target where it is in its middle.
        let middle_s = 31.5 * waveform.loop_interval_s()
            + 0.5 * waveform.chirp_interval_s
            + waveform.adc_start_s
            + waveform.sweep_s() / 2.0;
        let expected = range_m + rate_mps * middle_s;
        assert!((range - expected).abs() < 0.06 * waveform.range_resolution_m(), "{range}");
        assert!((rate - rate_mps).abs() < 0.06 * waveform.rate_resolution_mps(), "{rate}");
        // Migration through up to a bin costs most of this.
        let db = 10.0 * peak.power.log10() - power_db;
        assert!(db < 0.3 && db > -1.2, "{db}");
    }
}

/// Azimuth of the largest correlation with the steering vectors, deg.
fn azimuth_deg(array: &Array, snapshot: &[Complex64]) -> f64 {
    let snapshot = Array1::from(snapshot.to_vec());
    let power = |deg: f64| {
        let a = steering_vector(array, Direction::azimuth(deg.to_radians()));
        a.iter().zip(&snapshot).map(|(a, y)| a.conj() * y).sum::<Complex64>().norm()
    };
    let grid = (-600..=600).map(|k| f64::from(k) * 0.1);
    grid.max_by(|a, b| power(*a).total_cmp(&power(*b))).unwrap()
}

#[test]
fn the_angle_of_a_moving_target_needs_the_tdm_phase_taken_off() {
    let (waveform, array) = awr1642();
    for (rate_mps, azimuth) in [(2.0, 20.0), (-3.3, -35.0), (0.0, 11.0)] {
        let moving = target(5.0, rate_mps, azimuth);
        let options = CubeOptions { snr_db: 30.0, seed: 8, ..CubeOptions::default() };
        let cube = simulate_cube(&waveform, &array, &[moving], &options).unwrap();
        let (peak, map) = strongest(&waveform, &cube, 4);
        let cell = peak.detection;
        let mut snapshot = map.snapshot(cell.range_bin, cell.doppler_bin).unwrap().to_vec();
        let raw = azimuth_deg(&array, &snapshot);
        let dopplers = map.power.ncols();
        let step = tdm::phase_step_rad(peak.doppler_bin, dopplers, 2, 0);
        tdm::compensate(&mut snapshot, 2, step).unwrap();
        let found = azimuth_deg(&array, &snapshot);
        assert!((found - azimuth).abs() < 0.3, "{found} for {azimuth}");
        assert_eq!((raw - azimuth).abs() > 2.0, rate_mps != 0.0, "{raw} for {azimuth}");
    }
}

/// 524 288 samples: the standard error of a mean power is 0.14 % of it; five of them.
#[test]
fn powers_are_those_asked_for() {
    let (waveform, array) = awr1642();
    let options = CubeOptions { snr_db: 7.0, frames: 4, seed: 3, ..CubeOptions::default() };
    let mean = |targets: &[CubeTarget]| {
        let cube = simulate_cube(&waveform, &array, targets, &options).unwrap();
        cube.iter().map(|z| f64::from(z.norm_sqr())).sum::<f64>() / cube.len() as f64
    };
    let noise = mean(&[]);
    assert!((noise / db_to_power(-7.0) - 1.0).abs() < 0.007, "{noise}");
    let both = mean(&[CubeTarget { power_db: -4.0, ..target(4.0, 1.0, 0.0) }]);
    assert!((both - noise - db_to_power(-4.0)).abs() < 0.007, "{both}");
}

/// The spherical wave's phase over the array differs from the plane one's by `pi p^2 lambda / 8 R`
/// terms; at ten times the range a tenth is left. Compared in the middle of the chirp, where the
/// frequency is the one the wavelength is of.
#[test]
fn the_near_field_tends_to_the_far_field() {
    let waveform = waveform_3dcnn_simulated();
    let array = preset("ula8").unwrap();
    let difference = |range_m: f64| {
        let at = CubeTarget { phase_rad: Some(0.0), ..target(range_m, 0.0, 30.0) };
        let cube = |field| {
            let options = CubeOptions { snr_db: NOISELESS, field, ..CubeOptions::default() };
            simulate_cube(&waveform, &array, &[at], &options).unwrap()
        };
        let (near, far) = (cube(Field::Near), cube(Field::Far));
        (0..8)
            .map(|r| {
                let [near, far] = [&near, &far].map(|c| wide(c[[0, 0, 0, r, 128]]));
                (near * far.conj()).arg().abs()
            })
            .fold(0.0, f64::max)
    };
    let (close, distant) = (difference(2.0), difference(20.0));
    assert!(close > 0.01 && close < 0.1, "{close}");
    assert!((close / distant - 10.0).abs() < 1.0, "{close} {distant}");
    assert!(difference(200.0) < 1e-3);
}

#[test]
fn imperfections_shape_the_response_in_both_fields() {
    let waveform = Waveform { loops: 1, samples: 256, ..waveform_3dcnn_simulated() };
    let array = preset("ula8").unwrap();
    let spread = ImperfectionSpread {
        gain_db: 1.0,
        phase_rad: 0.3,
        position: 0.1,
        coupling_db: Some(-15.0),
    };
    let imperfections = Imperfections::random(&array, spread, 6).unwrap();
    let at = CubeTarget { phase_rad: Some(0.0), ..target(250.0, 0.0, -20.0) };
    let expected = imperfections.steering_vector(&array, *at.direction).unwrap();
    for (field, tolerance) in [(Field::Far, 1e-5), (Field::Near, 2e-3)] {
        let options = CubeOptions {
            snr_db: NOISELESS,
            field,
            imperfections: Some(imperfections.clone()),
            ..CubeOptions::default()
        };
        let cube = simulate_cube(&waveform, &array, &[at], &options).unwrap();
        for r in 1..8 {
            let ratio = wide(cube[[0, 0, 0, r, 128]]) / wide(cube[[0, 0, 0, 0, 128]]);
            assert!((ratio - expected[r] / expected[0]).norm() < tolerance, "{field:?} {r}");
        }
    }
}

#[test]
fn frames_repeat_with_the_seed_and_noise_differs() {
    let (waveform, array) = awr1642();
    let waveform = Waveform { loops: 2, ..waveform };
    let cube = |frames, seed| {
        let options = CubeOptions { frames, seed, ..CubeOptions::default() };
        simulate_cube(&waveform, &array, &[target(3.0, 0.0, 0.0)], &options).unwrap()
    };
    let (two, one) = (cube(2, 1), cube(1, 1));
    assert_eq!(two.index_axis(Axis(0), 0), one.index_axis(Axis(0), 0));
    assert_ne!(two.index_axis(Axis(0), 1), one.index_axis(Axis(0), 0));
    assert_ne!(cube(1, 2), one);
}

#[test]
fn what_cannot_be_simulated_is_named() {
    let (waveform, array) = awr1642();
    let run = |waveform: &Waveform, array: &Array, t: CubeTarget, options: &CubeOptions| {
        simulate_cube(waveform, array, &[t], options).unwrap_err().to_string()
    };
    let options = CubeOptions::default();
    let good = target(3.0, 0.0, 0.0);
    assert!(run(&waveform, &array, target(14.0, 0.0, 0.0), &options).contains("range_m"));
    let leaving = run(&waveform, &array, target(13.0, 90.0, 0.0), &options);
    assert!(leaving.contains("end of the last frame"), "{leaving}");
    assert!(run(&waveform, &array, target(3.0, 0.0, 91.0), &options).contains("azimuth"));
    let three = preset("awr1843").unwrap();
    assert!(run(&waveform, &three, good, &options).contains("transmitters"));
    let short = CubeOptions { imperfections: Some(Imperfections::none(3)), ..options.clone() };
    assert!(run(&waveform, &array, good, &short).contains("errors"));
    let long = CubeOptions { frames: 100_000, ..options.clone() };
    let error = simulate_cube(&waveform, &array, &[good], &long).unwrap_err();
    assert!(matches!(error, SimulateError::Argument(InputError::TooLarge { .. })));
    let none = CubeOptions { frames: 0, ..options };
    let error = simulate_cube(&waveform, &array, &[good], &none).unwrap_err();
    assert!(matches!(error, SimulateError::Argument(InputError::OutOfRange { .. })));
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(-1.0),
        Just(0.0),
        Just(1e300),
        -100.0..100.0,
        any::<f64>(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Whatever the numbers, there is a finite cube or a typed error.
    #[test]
    fn any_numbers_give_a_finite_cube_or_an_error(
        start_frequency_hz in prop_oneof![Just(77e9), any_number()],
        slope_hz_per_s in prop_oneof![Just(60e12), any_number()],
        numbers in prop::array::uniform6(any_number()),
        frames in prop_oneof![0..3_usize, Just(usize::MAX)],
        near in any::<bool>(),
    ) {
        let [range_m, rate_mps, azimuth_rad, power_db, snr_db, phase] = numbers;
        let waveform = Waveform {
            start_frequency_hz,
            slope_hz_per_s,
            samples: 16,
            loops: 2,
            ..waveform_awr1642()
        };
        let target = CubeTarget {
            range_m,
            rate_mps,
            direction: Direction::azimuth(azimuth_rad).into(),
            power_db,
            phase_rad: Some(phase),
        };
        let field = if near { Field::Near } else { Field::Far };
        let options = CubeOptions { snr_db, frames, field, ..CubeOptions::default() };
        let array = preset("awr1642").unwrap();
        if let Ok(cube) = simulate_cube(&waveform, &array, &[target], &options) {
            prop_assert!(cube.iter().all(|z| z.re.is_finite() && z.im.is_finite()));
        }
    }
}
