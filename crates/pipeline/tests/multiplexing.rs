//! Folds of the range rate and transmitters that send at once, on simulated cubes.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use boresight_aoa::bounds::{Signals, deterministic_bound, single_snapshot};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex32, Complex64, Direction, Multiplexing, Random, Waveform};
use boresight_formats::{Capture, RadarConfig};
use boresight_pipeline::regions::RegionFinder;
use boresight_pipeline::{Chain, ChainOptions, CubeFrames, FrameResult, PipelineError};
use boresight_signal::RangeDoppler;
use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube, waveform_awr1642};
use ndarray::Array5;
use std::ops::ControlFlow;

fn short() -> Waveform {
    Waveform { samples: 64, loops: 32, ..waveform_awr1642() }
}

fn target(range_m: f64, rate_mps: f64, azimuth_deg: f64) -> CubeTarget {
    CubeTarget {
        range_m,
        rate_mps,
        direction: Direction::azimuth(azimuth_deg.to_radians()).into(),
        power_db: 0.0,
        phase_rad: None,
    }
}

fn cube_of(
    waveform: &Waveform,
    array: &Array,
    targets: &[CubeTarget],
    snr_db: f64,
    seed: u64,
) -> Array5<Complex32> {
    let options = CubeOptions { snr_db, seed, ..CubeOptions::default() };
    simulate_cube(waveform, array, targets, &options).unwrap()
}

fn processing_gain(waveform: &Waveform) -> f64 {
    RangeDoppler::new(waveform, 1, &Default::default()).unwrap().processing_gain()
}

/// Raw SNR that makes a cell's.
fn raw_snr_db(waveform: &Waveform, cell_snr_db: f64) -> f64 {
    cell_snr_db - 10.0 * processing_gain(waveform).log10()
}

fn folding(folds: usize) -> ChainOptions {
    let mut options = ChainOptions { doppler_folds: folds, ..ChainOptions::default() };
    options.region.range_m = Some([0.5, 100.0]);
    options
}

fn strongest(result: &FrameResult) -> &boresight_pipeline::Detection {
    &result.detections[0]
}

#[test]
fn rates_over_all_folds_are_told_in_99_percent_at_15_db() {
    for (name, cells) in [("awr1642", 200), ("awr1843", 200), ("lrr48", 60), ("cascade86", 40)] {
        let array = preset(name).unwrap();
        let transmitters = array.tx().len();
        // Range bins of 0.4 m, so that what moves stays in its bin.
        let waveform = Waveform {
            transmitters,
            slope_hz_per_s: 30e12,
            chirp_interval_s: 30e-6,
            adc_start_s: 4e-6,
            ..short()
        };
        let snr_db = raw_snr_db(&waveform, 15.0);
        let options = folding(transmitters / 2);
        let mut chain = Chain::new(&waveform, array.rx().len(), &array, &options).unwrap();
        let limit = waveform.max_rate_mps() * transmitters as f64;
        let mut random = Random::new(9, 0);
        let (mut right, mut wrong, mut undecided, mut missed) = (0, 0, 0, 0);
        for seed in 0..cells {
            let uniform = |random: &mut Random| random.phase() / std::f64::consts::TAU + 0.5;
            let rate_mps = 0.98 * limit * (2.0 * uniform(&mut random) - 1.0);
            let range_m = 6.0 + uniform(&mut random);
            let azimuth_deg = 50.0 * (2.0 * uniform(&mut random) - 1.0);
            let truth = target(range_m, rate_mps, azimuth_deg);
            let cube = cube_of(&waveform, &array, &[truth], snr_db, seed);
            let result = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
            assert!((result.unambiguous_rate_mps - limit).abs() < 1e-9);
            let Some(found) = result.detections.first() else {
                missed += 1;
                continue;
            };
            let sure = found.fold_probability.unwrap() >= 0.99;
            let is_near = (found.rate_mps - rate_mps).abs() < waveform.rate_resolution_mps();
            right += usize::from(is_near && sure);
            undecided += usize::from(!sure);
            wrong += usize::from(sure && !is_near);
            assert!(sure || found.doppler_fold == 0);
        }
        println!("{name}: right {right}, undecided {undecided}, wrong {wrong}, missed {missed}");
        assert!(right * 100 >= 99 * cells as usize, "{name}: {right} of {cells}");
    }
}

#[test]
fn a_fold_corrects_rate_range_and_angle() {
    let (waveform, array) = (short(), preset("awr1642").unwrap());
    let truth = target(7.0, 1.4 * waveform.max_rate_mps(), 20.0);
    let cube = cube_of(&waveform, &array, &[truth], 10.0, 1);
    let run = |folds| {
        let mut chain = Chain::new(&waveform, 4, &array, &folding(folds)).unwrap();
        chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap()
    };
    let (folded, told) = (run(0), run(1));
    let found = strongest(&told);
    assert_eq!((found.doppler_fold, told.counts.undecided_folds), (1, 0));
    assert!((found.rate_mps - truth.rate_mps).abs() < waveform.rate_resolution_mps());
    assert!((found.azimuth_rad - truth.direction.azimuth_rad).abs() < 0.01, "{found:?}");
    let moved = truth.range_m + truth.rate_mps * waveform.frame_time_s() / 2.0;
    assert!((found.range_m - moved).abs() < 0.1 * waveform.range_resolution_m());
    let wrong = strongest(&folded);
    assert_eq!((wrong.doppler_fold, wrong.fold_probability), (0, None));
    assert!((wrong.rate_mps - truth.rate_mps + 2.0 * waveform.max_rate_mps()).abs() < 0.2);
    assert!((wrong.azimuth_rad - truth.direction.azimuth_rad).abs() > 0.1, "{wrong:?}");
    // The limits of the region are those of the rate in its fold.
    let mut options = folding(1);
    options.region.rate_mps = Some([0.0, 20.0]);
    let mut chain = Chain::new(&waveform, 4, &array, &options).unwrap();
    let kept = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
    assert_eq!(strongest(&kept), found);
    options.region.rate_mps = Some([-20.0, 0.0]);
    let mut chain = Chain::new(&waveform, 4, &array, &options).unwrap();
    let dropped = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
    assert!(dropped.detections.is_empty() && dropped.counts.outside_region > 0);
    // Frames together tell the same.
    let mut chain = Chain::new(&waveform, 4, &array, &folding(1)).unwrap();
    let go_on = &mut |_| ControlFlow::Continue(());
    let together = chain.combine(&CubeFrames(cube.view()), 0..1, go_on).unwrap();
    assert_eq!(strongest(&together).doppler_fold, 1);
    let cell = (found.range_bin, found.doppler_bin);
    let snapshots = chain.cell_snapshots(&CubeFrames(cube.view()), 0..1, cell.0, cell.1).unwrap();
    let a = boresight_core::steering::steering_vector(&array, *truth.direction);
    let product: Complex64 = a.iter().zip(&snapshots).map(|(a, y)| a.conj() * y).sum();
    let power: f64 = snapshots.iter().map(|y| y.norm_sqr()).sum();
    assert!(product.norm_sqr() / (8.0 * power) > 0.98);
}

#[test]
fn an_array_that_cannot_tell_keeps_the_bin_and_says_so() {
    // Two transmitters half a wavelength apart, one receiver.
    let array = Array::mimo(&[[0.0; 3], [0.0, 1.0, 0.0]], &[[0.0; 3]]).unwrap();
    let waveform = short();
    let truth = target(7.0, 1.4 * waveform.max_rate_mps(), 20.0);
    let cube = cube_of(&waveform, &array, &[truth], 10.0, 1);
    let mut chain = Chain::new(&waveform, 1, &array, &folding(1)).unwrap();
    let result = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
    let found = strongest(&result);
    assert_eq!(found.doppler_fold, 0);
    assert!(found.fold_probability.unwrap() < 0.99);
    assert!(result.counts.undecided_folds > 0);
    assert!(result.warnings.iter().any(|w| w.code == "undecided-folds"), "{:?}", result.warnings);
}

/// Root mean square error of the azimuth over the bound at the cell's SNR, and that, over seeds, with the target in a
/// Doppler bin that need not be whole and in the middle of a range bin halfway through the frame.
fn over_the_bound(waveform: &Waveform, array: &Array, bin: f64, azimuth_deg: f64) -> (f64, f64) {
    let cell_snr_db = 22.0;
    let snr_db = raw_snr_db(waveform, cell_snr_db);
    let rate_mps = bin * waveform.rate_resolution_mps();
    let coupling = boresight_signal::range::range_doppler_coupling_m(waveform, rate_mps);
    let middle = 20.0 * waveform.range_resolution_m() - coupling;
    let range_m = middle - rate_mps * waveform.frame_time_s() / 2.0;
    let truth = target(range_m, rate_mps, azimuth_deg);
    let mut chain = Chain::new(waveform, array.rx().len(), array, &folding(0)).unwrap();
    let (runs, mut squares, mut snr) = (600, 0.0, 0.0);
    for seed in 0..runs {
        let cube = cube_of(waveform, array, &[truth], snr_db, seed);
        let result = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
        let found = strongest(&result);
        assert!((found.rate_mps - rate_mps).abs() < waveform.rate_resolution_mps(), "{found:?}");
        squares += (found.azimuth_rad - truth.direction.azimuth_rad).powi(2);
        snr += found.snr / runs as f64;
    }
    let covariance = single_snapshot(&[Complex64::ONE]);
    let noise_power = 1.0 / snr;
    let signals = Signals { covariance: covariance.view(), noise_power, snapshots: 1 };
    let bound = deterministic_bound(array, &[*truth.direction], &signals).unwrap();
    ((squares / runs as f64).sqrt() / bound.azimuth_rad[0], 10.0 * snr.log10())
}

fn filled(transmitters: usize) -> Array {
    let tx: Vec<[f64; 3]> = (0..transmitters).map(|t| [0.0, 4.0 * t as f64, 0.0]).collect();
    let rx: Vec<[f64; 3]> = (0..4).map(|r| [0.0, f64::from(r), 0.0]).collect();
    Array::mimo(&tx, &rx).unwrap()
}

#[test]
fn angles_of_each_multiplexing_are_within_1_1_of_the_bound() {
    let of = |multiplexing, transmitters, loops| Waveform {
        multiplexing,
        transmitters,
        loops,
        samples: 64,
        ..waveform_awr1642()
    };
    for (waveform, bin) in [
        (of(Multiplexing::TimeDivision, 2, 32), 7.0),
        (of(Multiplexing::BinaryPhase, 2, 32), 7.0),
        (of(Multiplexing::BinaryPhase, 2, 32), -11.4),
        (of(Multiplexing::BinaryPhase, 4, 16), 5.0),
        (of(Multiplexing::DopplerDivision, 2, 48), -20.0),
        (of(Multiplexing::DopplerDivision, 4, 96), 37.0),
    ] {
        let array = filled(waveform.transmitters);
        let (ratio, snr_db) = over_the_bound(&waveform, &array, bin, 15.0);
        let Waveform { multiplexing, transmitters, .. } = waveform;
        println!(
            "{multiplexing:?} {transmitters}, bin {bin}: {ratio:.3} of the bound, {snr_db:.1} dB"
        );
        // The root of the mean of 600 squares has a standard error of 3 %.
        assert!((0.9..1.1).contains(&ratio), "{ratio}");
        // What a bin loses that is not in the middle.
        assert!((snr_db - 22.0).abs() < if bin.fract() == 0.0 { 0.3 } else { 1.2 }, "{snr_db}");
    }
}

#[test]
fn sending_at_once_gathers_the_energy_of_all() {
    let gain = |multiplexing, loops| processing_gain(&Waveform { multiplexing, loops, ..short() });
    let alone = gain(Multiplexing::TimeDivision, 24);
    // In the same 48 chirps.
    assert!((gain(Multiplexing::BinaryPhase, 24) / alone - 2.0).abs() < 1e-9);
    let ratio = gain(Multiplexing::DopplerDivision, 48) / alone;
    assert!((ratio - 2.0).abs() < 0.05, "{ratio}");
}

#[test]
fn doppler_division_tells_rates_over_the_whole_chirp_rate() {
    let waveform = Waveform {
        multiplexing: Multiplexing::DopplerDivision,
        transmitters: 4,
        loops: 96,
        samples: 64,
        ..waveform_awr1642()
    };
    let array = filled(4);
    let mut chain = Chain::new(&waveform, 4, &array, &folding(0)).unwrap();
    let limit = waveform.max_rate_mps();
    for (n, share) in [-0.95, -0.6, -0.2, 0.0, 0.31, 0.7, 0.94].into_iter().enumerate() {
        let truth = target(4.0, share * limit, -10.0 + 5.0 * n as f64);
        let cube = cube_of(&waveform, &array, &[truth], 10.0, n as u64);
        let result = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
        assert_eq!(result.detections.len(), 1, "{:?}", result.detections);
        let found = strongest(&result);
        assert!((found.rate_mps - truth.rate_mps).abs() < waveform.rate_resolution_mps());
        assert!((found.azimuth_rad - truth.direction.azimuth_rad).abs() < 0.01, "{found:?}");
        assert!(result.counts.other_bands >= 5, "{:?}", result.counts);
    }
    let waveform = Waveform { samples: 128, ..waveform };
    let refused = RegionFinder::new(&waveform, 4, &array, &Default::default()).err();
    assert_eq!(refused, Some(PipelineError::Multiplexing));
}

/// Bytes of a capture as a two-lane board records it.
fn recorded(cube: &Array5<Complex32>, full_scale: f32) -> Vec<u8> {
    let words = |z: &Complex32| [z.re, z.im].map(|v| (v * full_scale).round() as i16);
    let samples = cube.as_slice().unwrap();
    samples
        .chunks_exact(2)
        .flat_map(|pair| {
            let [[i0, q0], [i1, q1]] = [words(&pair[0]), words(&pair[1])];
            [i0, i1, q0, q1].into_iter().flat_map(i16::to_le_bytes)
        })
        .collect()
}

#[test]
fn sub_frames_go_round_through_a_capture() {
    let text = "dfeDataOutputMode 3\nchannelCfg 15 3 0\nadcCfg 2 1\nadcbufCfg -1 0 0 1 1
profileCfg 0 77 40 7 57.14 0 0 60 1 64 5209 0 0 30\nprofileCfg 1 76 10 6 30 0 0 20 1 128 6250 0 0 30
chirpCfg 0 0 0 0 0 0 0 1\nchirpCfg 1 1 0 0 0 0 0 2\nchirpCfg 2 3 1 0 0 0 0 3
advFrameCfg 2 0 2 1 0\nsubFrameCfg 0 0 0 2 16 20 0 1 1 20\nsubFrameCfg 1 0 2 2 32 10 0 1 1 15
bpmCfg 1 1 2 3\n% Platform:xWR16xx\n";
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    let array = preset("awr1642").unwrap();
    let truths = [target(5.0, 1.1, 25.0), target(9.0, -2.0, -18.0)];
    let cubes: Vec<Array5<Complex32>> = config
        .sub_frames
        .iter()
        .zip(truths)
        .map(|(part, truth)| {
            let options = CubeOptions { snr_db: 10.0, seed: 4, frames: 2, ..Default::default() };
            simulate_cube(&part.waveform, &array, &[truth], &options).unwrap()
        })
        .collect();
    let mut bytes = vec![];
    for frame in 0..2 {
        for cube in &cubes {
            let one = cube.slice(ndarray::s![frame..=frame, .., .., .., ..]).to_owned();
            bytes.extend(recorded(&one, 8192.0));
        }
    }
    assert_eq!(bytes.len() as u64, 2 * config.frame_bytes());
    for (number, truth) in truths.iter().enumerate() {
        let config = config.clone().choose(number).unwrap();
        let capture = Capture::new(&bytes, &config).unwrap();
        assert_eq!((capture.frames(), capture.trailing_bytes()), (2, 0));
        assert_eq!(capture.remarks(), []);
        let mut chain =
            Chain::new(&config.waveform, 4, &config.array().unwrap(), &folding(0)).unwrap();
        let frame = capture.frame(1).unwrap();
        let result = chain.process(frame.samples.view()).unwrap();
        let found = strongest(&result);
        assert!((found.rate_mps - truth.rate_mps).abs() < 0.2, "{number}: {found:?}");
        assert!((found.azimuth_rad - truth.direction.azimuth_rad).abs() < 0.02, "{found:?}");
    }
}
