//! Fluctuation, phase noise, reflection by the road and interference in simulated cubes, against theory.

#![allow(clippy::unwrap_used)]

use boresight_core::units::SPEED_OF_LIGHT_MPS;
use boresight_core::{Array, Complex32, Complex64, Direction, Multiplexing, Sampling, Waveform};
use boresight_simulate::cube::{CubeOptions, CubeTarget, Field, simulate_cube};
use boresight_simulate::fluctuation::SwerlingModel;
use boresight_simulate::ground::Ground;
use boresight_simulate::interference::Interferer;
use ndarray::{Array5, s};
use std::f64::consts::PI;

const WAVEFORM: Waveform = Waveform {
    start_frequency_hz: 77e9,
    slope_hz_per_s: 20e12,
    sample_rate_hz: 10e6,
    sampling: Sampling::Complex,
    samples: 256,
    adc_start_s: 3e-6,
    chirp_interval_s: 40e-6,
    transmitters: 1,
    loops: 64,
    frame_interval_s: 10e-3,
    multiplexing: Multiplexing::TimeDivision,
    doppler_bands: None,
};

fn array() -> Array {
    let receivers: Vec<[f64; 3]> = (0..4).map(|k| [0.0, f64::from(k), 0.0]).collect();
    Array::mimo(&[[0.0; 3]], &receivers).unwrap()
}

fn target(range_m: f64) -> CubeTarget {
    CubeTarget { range_m, phase_rad: Some(0.3), ..CubeTarget::default() }
}

/// All but free of noise.
fn cube(targets: &[CubeTarget], options: CubeOptions) -> Array5<Complex32> {
    let options = CubeOptions { snr_db: 300.0, seed: 5, ..options };
    simulate_cube(&WAVEFORM, &array(), targets, &options).unwrap()
}

fn ratio(z: Complex32, to: Complex32) -> Complex64 {
    let wide = |z: Complex32| Complex64::new(z.re.into(), z.im.into());
    wide(z) / wide(to)
}

#[test]
fn swerlings_models_change_power_by_frame_or_by_chirp() {
    let steady = cube(&[target(30.0)], CubeOptions { frames: 60, ..CubeOptions::default() });
    for (fluctuation, fast, variance) in [
        (SwerlingModel::Swerling1, false, 1.0),
        (SwerlingModel::Swerling2, true, 1.0),
        (SwerlingModel::Swerling3, false, 0.5),
        (SwerlingModel::Swerling4, true, 0.5),
    ] {
        let options = CubeOptions { frames: 60, fluctuation, ..CubeOptions::default() };
        let one = cube(&[target(30.0)], options);
        let power = |frame: usize, chirp: usize| {
            let at = [frame, chirp, 0, 0, 7];
            let factor = ratio(one[at], steady[at]);
            assert!(factor.im.abs() < 1e-5 * factor.re, "the phase stays");
            factor.norm_sqr()
        };
        assert_eq!((power(3, 0) - power(3, 1)).abs() > 1e-6, fast, "{fluctuation:?}");
        let all: Vec<f64> = if fast {
            (0..60).flat_map(|f| (0..64).map(move |c| (f, c))).map(|(f, c)| power(f, c)).collect()
        } else {
            (0..60).map(|f| power(f, 0)).collect()
        };
        let n = all.len() as f64;
        let mean = all.iter().sum::<f64>() / n;
        let spread = all.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / n;
        // Of 60 or 3,840 draws: four standard errors of mean and variance (the fourth moment of an exponential is 9).
        assert!((mean - 1.0).abs() < 4.0 * (variance / n).sqrt(), "{fluctuation:?} {mean}");
        assert!(
            (spread / variance - 1.0).abs() < 4.0 * (8.0 / n).sqrt(),
            "{fluctuation:?} {spread}"
        );
    }
}

/// The phase of an echo of delay `tau` is off by a variance of `4 pi^2 K tau`, `K` the level at 1 MHz times (1 MHz)^2.
#[test]
fn phase_noise_grows_with_range_as_it_should() {
    let level_dbc_hz = -85.0;
    let slope = 10f64.powf(0.1 * level_dbc_hz) * 1e12;
    for range_m in [10.0, 40.0, 70.0] {
        let frames = 30;
        let steady = cube(&[target(range_m)], CubeOptions { frames, ..CubeOptions::default() });
        let noise = Some(level_dbc_hz);
        let options = CubeOptions { frames, phase_noise_db: noise, ..CubeOptions::default() };
        let noisy = cube(&[target(range_m)], options);
        let (mut sum, mut count) = (0.0, 0.0);
        for frame in 0..frames {
            for chirp in 0..64 {
                // Far enough apart to be independent.
                for sample in [20, 120, 220] {
                    let at = [frame, chirp, 0, 1, sample];
                    sum += ratio(noisy[at], steady[at]).arg().powi(2);
                    count += 1.0;
                }
            }
        }
        let variance = sum / count;
        let expected = 4.0 * PI * PI * slope * 2.0 * range_m / SPEED_OF_LIGHT_MPS;
        // 5,760 squares of normal numbers: 1.9 %. A delay within a step of the path lacks up to a step's sixth.
        assert!((variance / expected - 1.0).abs() < 0.12, "{range_m}: {variance} {expected}");
    }
}

/// Four paths: `(1 - rho exp(j 2 pi (r' - r) / lambda))^2` times the echo, as long as they are in one range cell.
#[test]
fn a_road_makes_lobes_over_range() {
    let ground = Ground { radar_height_m: 0.5, reflection: 0.6 };
    for range_m in [20.0, 33.0, 51.0, 70.0] {
        let direction = Direction::new(0.0, (0.4f64 / range_m).asin());
        let target = CubeTarget { direction: direction.into(), ..target(range_m) };
        let plain = cube(&[target], CubeOptions::default());
        let options = CubeOptions { ground: Some(ground), ..CubeOptions::default() };
        let with = cube(&[target], options);
        let along = range_m * direction.elevation_rad.cos();
        let longer = along.hypot(1.0 + range_m * direction.elevation_rad.sin()) - range_m;
        for sample in [0, 255] {
            let time_s = WAVEFORM.adc_start_s + sample as f64 / WAVEFORM.sample_rate_hz;
            let frequency = WAVEFORM.start_frequency_hz + WAVEFORM.slope_hz_per_s * time_s;
            let turn = 2.0 * PI * frequency * longer / SPEED_OF_LIGHT_MPS;
            let one = 1.0 - Complex64::from_polar(0.6, turn);
            let at = [0, 0, 0, 0, sample];
            let found = ratio(with[at], plain[at]);
            assert!((found - one * one).norm() < 2e-3, "{range_m} {sample}: {found} {}", one * one);
        }
    }
    let near = CubeOptions { ground: Some(ground), field: Field::Near, ..CubeOptions::default() };
    assert!(simulate_cube(&WAVEFORM, &array(), &[target(20.0)], &near).is_err());
}

/// Ramps that cross leave the band after `fs / |S - S'|`; ramps alike leave a tone.
#[test]
fn interference_lasts_as_long_as_ramps_are_near_each_other() {
    let crossing = Interferer {
        direction: Direction::azimuth(0.4).into(),
        power_db: 20.0,
        start_frequency_hz: 77.6e9,
        slope_hz_per_s: -10e12,
        ramp_s: 40e-6,
        interval_s: 40e-6,
        ..Interferer::default()
    };
    let options = CubeOptions { interferers: vec![crossing], ..CubeOptions::default() };
    let with = cube(&[], options);
    let hit = with.slice(s![0, 0, 0, 0, ..]).iter().filter(|z| z.norm() > 1.0).count() as f64;
    let expected = WAVEFORM.sample_rate_hz.powi(2) / 30e12;
    assert!((hit - expected).abs() <= 1.0, "{hit} samples of {expected}");
    let largest = with.iter().map(|z| z.norm()).fold(0.0, f32::max);
    assert!((largest - 10.0).abs() < 1e-3, "{largest}");
    // From receiver to receiver the phase turns as that of an echo from there.
    let strongest = |r: usize| with[[0, 0, 0, r, hit_at(&with)]];
    let turn = ratio(strongest(1), strongest(0)).arg();
    assert!((turn - PI * 0.4f64.sin()).abs() < 1e-4, "{turn}");

    let alike = Interferer {
        start_frequency_hz: WAVEFORM.start_frequency_hz - 1e6,
        slope_hz_per_s: WAVEFORM.slope_hz_per_s,
        ..crossing
    };
    let with = cube(&[], CubeOptions { interferers: vec![alike], ..CubeOptions::default() });
    let chirp: Vec<Complex32> = with.slice(s![0, 1, 0, 0, ..]).to_vec();
    let step = ratio(chirp[101], chirp[100]).arg();
    assert!((step - 2.0 * PI * 1e6 / WAVEFORM.sample_rate_hz).abs() < 1e-4, "{step}");
    assert!(chirp.iter().all(|z| (z.norm() - 10.0).abs() < 1e-3));
}

fn hit_at(cube: &Array5<Complex32>) -> usize {
    (0..WAVEFORM.samples).find(|&n| cube[[0, 0, 0, 0, n]].norm() > 1.0).unwrap()
}

#[test]
fn what_is_not_asked_for_changes_no_sample() {
    let plain = cube(&[target(30.0)], CubeOptions::default());
    let none = CubeOptions {
        ground: Some(Ground { reflection: 0.0, ..Ground::default() }),
        phase_noise_db: Some(-200.0),
        ..CubeOptions::default()
    };
    let same = cube(&[target(30.0)], none);
    let furthest = plain.iter().zip(&same).map(|(a, b)| (a - b).norm()).fold(0.0, f32::max);
    assert!(furthest < 1e-4, "{furthest}");
}
