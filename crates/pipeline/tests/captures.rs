//! Simulated frames as the bytes of each kind of board, through the readers and the chain. All figures here are of
//! simulation; no recording of these boards but the bundled one was at hand.

#![allow(clippy::unwrap_used)]

use boresight_aoa::bounds::{BoundRequest, BoundTarget, target_bound};
use boresight_aoa::{Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex32, Direction, Random, Sampling, Waveform};
use boresight_formats::dca1000::{CASCADE_RECEIVERS, IqOrder, write};
use boresight_formats::{Capture, Layout, RadarConfig, ReadingOptions, Settled};
use boresight_pipeline::{Chain, ChainOptions};
use boresight_signal::{RangeDoppler, RangeDopplerOptions};
use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube};
use ndarray::{Array5, Axis};

const CFG: &[u8] = include_bytes!("../../../recordings/awr1642/profile.cfg");

/// A board: its configuration with few chirps, and its array.
fn board(layout: Layout, sampling: Sampling) -> (RadarConfig, Array) {
    let mut config = RadarConfig::parse(CFG).unwrap();
    config.adc.layout = layout;
    config.waveform = Waveform { samples: 64, loops: 8, sampling, ..config.waveform };
    if layout == Layout::Cascade {
        config.receivers = CASCADE_RECEIVERS.to_vec();
        config.transmitters = (3..12).rev().collect();
        config.waveform = Waveform { transmitters: 9, loops: 2, ..config.waveform };
        return (config, preset("cascade86").unwrap());
    }
    (config, preset("awr1642").unwrap())
}

/// Frames well within the converter's range.
fn quiet(mut frames: Array5<Complex32>) -> Array5<Complex32> {
    frames.mapv_inplace(|z| z * 0.02);
    frames
}

/// Root of the mean squared error of the azimuth over its bound: frames of one target, written as the board's bytes,
/// read, transformed, detected and estimated.
fn over_bound(layout: Layout, sampling: Sampling, frames: usize) -> f64 {
    let (config, array) = board(layout, sampling);
    let waveform = config.waveform;
    let mut options = ChainOptions::default();
    options.angle.method = Method::MaximumLikelihood;
    options.angle.options.sources = SourceCount::Known(1);
    options.range_doppler.range_window = boresight_signal::Window::Rectangular;
    options.range_doppler.doppler_window = boresight_signal::Window::Rectangular;
    let plan = RangeDoppler::new(&waveform, array.rx().len(), &options.range_doppler).unwrap();
    let cell_snr_db = 20.0;
    let snr_db = cell_snr_db - 10.0 * plan.processing_gain().log10();
    // In the middle of its bin, so that nothing is lost.
    let range_m = 20.0 * waveform.range_resolution_m();
    let direction = Direction::azimuth(0.2);
    let target = CubeTarget { range_m, direction: direction.into(), ..CubeTarget::default() };
    let cube = CubeOptions { snr_db, frames, seed: 7, ..CubeOptions::default() };
    let cube = quiet(simulate_cube(&waveform, &array, &[target], &cube).unwrap());
    let bytes = write(cube.view(), &config).unwrap();
    let capture = Capture::new(&bytes, &config).unwrap();
    assert_eq!((capture.frames(), capture.trailing_bytes()), (frames, 0));
    let mut chain = Chain::new(&waveform, array.rx().len(), &array, &options).unwrap();
    let mut squares = 0.0;
    for k in 0..frames {
        let frame = capture.frame(k).unwrap();
        assert_eq!(frame.clipped, 0);
        let found = chain.process(frame.samples.view()).unwrap();
        let nearest = found.detections.first().unwrap();
        assert_eq!(nearest.range_bin, 20, "{nearest:?}");
        squares += (nearest.azimuth_rad - direction.azimuth_rad).powi(2);
    }
    let told = BoundTarget { direction: direction.into(), snr_db: cell_snr_db, phase_rad: 0.0 };
    let bound = target_bound(&array, &[told], &BoundRequest::default()).unwrap().azimuth_rad[0];
    (squares / frames as f64).sqrt() / bound
}

/// Of n trials the root mean square of a normal error is off by a standard deviation of `1 / sqrt(2 n)`: 0.035 for 400, of
/// which 1.1 is almost three away.
#[test]
fn angles_of_each_board_reach_their_bound() {
    for (layout, sampling, frames) in [
        (Layout::TwoLane, Sampling::Complex, 400),
        (Layout::TwoLane, Sampling::Real, 400),
        (Layout::FourLane, Sampling::Complex, 400),
        (Layout::FourLane, Sampling::Real, 400),
        (Layout::Cascade, Sampling::Complex, 400),
    ] {
        let ratio = over_bound(layout, sampling, frames);
        println!("{layout:?} {sampling:?}: {ratio:.3} of the bound, simulated");
        assert!((0.9..1.1).contains(&ratio), "{layout:?} {sampling:?}: {ratio}");
    }
}

/// The mean of the noise's power over that of one raw sample, and of its square over the square of the mean, which is 2
/// for a complex normal variable.
#[test]
fn noise_of_real_samples_is_complex_normal_in_half_a_spectrum() {
    let (config, array) = board(Layout::TwoLane, Sampling::Real);
    let waveform = config.waveform;
    let options = RangeDopplerOptions::default();
    let cube = CubeOptions { snr_db: 0.0, frames: 60, seed: 3, ..CubeOptions::default() };
    let cube = simulate_cube(&waveform, &array, &[], &cube).unwrap();
    let mut plan = RangeDoppler::new(&waveform, 4, &options).unwrap();
    let mut map = plan.output();
    assert_eq!(map.power.dim(), (32, 8));
    let (mut mean, mut square, mut count) = (0.0, 0.0, 0.0);
    for frame in cube.outer_iter() {
        plan.process(frame, &mut map).unwrap();
        // The bin of zero has real numbers, and its neighbours a share of it.
        for z in map.cube.slice(ndarray::s![.., 2.., ..]) {
            let power = f64::from(z.norm_sqr());
            (mean, square, count) = (mean + power, square + power * power, count + 1.0);
        }
    }
    mean /= count;
    // Real samples of noise have half the power of complex ones.
    let gain = 0.5 / mean / plan.processing_gain();
    let kurtosis = square / count / (mean * mean);
    // 115,000 cells, of which windows leave some 30,000 independent: 0.6 % and 1.8 %; three times as much.
    assert!((gain - 1.0).abs() < 0.02, "{gain}");
    assert!((kurtosis - 2.0).abs() < 0.06, "{kurtosis}");
}

#[test]
fn noise_of_real_samples_is_detected_as_often_as_asked_for() {
    let (config, array) = board(Layout::TwoLane, Sampling::Real);
    let waveform = Waveform { samples: 256, loops: 16, ..config.waveform };
    let mut options =
        ChainOptions { peak_grouping: false, max_detections: 65_536, ..Default::default() };
    options.cfar.false_alarm = 1e-3;
    let cube = CubeOptions { snr_db: 0.0, frames: 100, seed: 5, ..CubeOptions::default() };
    let cube = simulate_cube(&waveform, &array, &[], &cube).unwrap();
    let mut chain = Chain::new(&waveform, 4, &array, &options).unwrap();
    let mut over = 0;
    for frame in cube.outer_iter() {
        over += chain.process(frame).unwrap().counts.cells_over_threshold;
    }
    // As for complex samples: 205 expected, and a fifth of deviation.
    let rate = over as f64 / (100.0 * 128.0 * 16.0);
    assert!((rate / 1e-3 - 1.0).abs() < 0.5, "{rate}");
}

#[test]
fn a_target_of_real_samples_is_where_that_of_complex_ones_is() {
    let (config, array) = board(Layout::TwoLane, Sampling::Complex);
    let target = CubeTarget {
        range_m: 5.0,
        rate_mps: 1.2,
        direction: Direction::azimuth(-0.3).into(),
        phase_rad: Some(0.4),
        ..CubeTarget::default()
    };
    let found = [Sampling::Complex, Sampling::Real].map(|sampling| {
        let waveform = Waveform { samples: 256, loops: 16, sampling, ..config.waveform };
        let cube = CubeOptions { snr_db: 20.0, seed: 1, ..CubeOptions::default() };
        let cube = simulate_cube(&waveform, &array, &[target], &cube).unwrap();
        let mut chain = Chain::new(&waveform, 4, &array, &ChainOptions::default()).unwrap();
        let result = chain.process(cube.index_axis(Axis(0), 0)).unwrap();
        assert_eq!(result.detections.len(), 1, "{sampling:?}: no image");
        result.detections[0]
    });
    let [complex, real] = found;
    assert!((complex.range_m - real.range_m).abs() < 0.005, "{found:?}");
    assert!((complex.rate_mps - real.rate_mps).abs() < 0.02, "{found:?}");
    assert!((complex.azimuth_rad - real.azimuth_rad).abs() < 0.005, "{found:?}");
    // Power and SNR of one raw sample, and of a cell: half of both.
    for (a, b) in [(complex.power, real.power), (complex.snr, real.snr)] {
        let db = 10.0 * (a / b).log10();
        assert!((db - 3.0).abs() < 0.7, "{db}: {found:?}");
    }
    // Beyond half the range there is nothing, and an imaginary part is none of a real sample.
    let real = Waveform { sampling: Sampling::Real, ..config.waveform };
    let far = CubeTarget { range_m: 1.01 * real.max_range_m(), ..target };
    assert!(simulate_cube(&real, &array, &[far], &CubeOptions::default()).is_err());
    let mut chain = Chain::new(&real, 4, &array, &ChainOptions::default()).unwrap();
    let frame = ndarray::Array4::from_elem((8, 2, 4, 64), Complex32::new(0.1, 0.1));
    let error = chain.process(frame.view()).unwrap_err();
    assert!(error.to_string().contains("imaginary part"), "{error}");
}

/// What an ordinary scene holds: the transmitters' own coupling, and some objects whose powers fall with the fourth
/// power of range.
fn scene(random: &mut Random, waveform: &Waveform, coupled: bool) -> Vec<CubeTarget> {
    let coupling = CubeTarget { range_m: random.uniform(0.08, 0.16), ..CubeTarget::default() };
    let objects = 1 + (random.uniform(0.0, 6.0) as usize);
    let objects = (0..objects).map(|_| {
        let range_m = random.uniform(0.3, 0.9 * waveform.max_range_m());
        CubeTarget {
            range_m,
            rate_mps: random.uniform(-3.0, 3.0),
            direction: Direction::azimuth(random.uniform(-0.8, 0.8)).into(),
            power_db: -10.0 - 40.0 * range_m.log10() + 8.0 * random.normal(),
            phase_rad: None,
        }
    });
    coupled.then_some(coupling).into_iter().chain(objects).collect()
}

/// How the order of I and Q was told in scenes: right, not at all, wrong.
fn told(snr_db: f64, coupled: bool, scenes: u64) -> [usize; 3] {
    let (config, array) = board(Layout::TwoLane, Sampling::Complex);
    let mut config = config;
    config.waveform = Waveform { samples: 256, loops: 4, ..config.waveform };
    let auto = ReadingOptions { iq_order: IqOrder::Auto, ..ReadingOptions::default() };
    let mut counts = [0; 3];
    for seed in 0..scenes {
        let mut random = Random::new(seed, 9);
        let targets = scene(&mut random, &config.waveform, coupled);
        let cube = CubeOptions { snr_db, seed, ..CubeOptions::default() };
        let cube = quiet(simulate_cube(&config.waveform, &array, &targets, &cube).unwrap());
        config.adc.q_first = seed % 2 == 1;
        let bytes = write(cube.view(), &config).unwrap();
        config.adc.q_first = (seed / 2) % 2 == 1;
        let read = Settled::new(&bytes, &config, &auto).unwrap();
        let told = read.evidence.sides.is_some_and(|sides| sides.swapped.is_some());
        let right = read.config.adc.q_first == (seed % 2 == 1);
        counts[if !told {
            1
        } else if right {
            0
        } else {
            2
        }] += 1;
        assert!(read.evidence.other_lanes.is_none(), "{:?}", read.evidence);
    }
    counts
}

#[test]
fn the_order_of_i_and_q_is_never_told_wrong() {
    for snr_db in [-50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0] {
        let [right, open, wrong] = told(snr_db, true, 40);
        println!("simulated, {snr_db} dB: {right} right, {open} not told, {wrong} wrong");
        assert_eq!(wrong, 0, "{snr_db} dB");
        if snr_db >= 0.0 {
            assert!(right >= 38, "{snr_db} dB: {right}");
        }
    }
    // Without the coupling that every board has, what is near has to be there.
    let [right, open, wrong] = told(20.0, false, 80);
    println!("simulated without coupling, 20 dB: {right} right, {open} not told, {wrong} wrong");
    assert!(wrong <= 12, "{wrong}");
}

#[test]
fn the_lanes_of_a_capture_are_told_by_its_spectrum() {
    let mut wrong = 0;
    for seed in 0..20 {
        for (layout, other) in
            [(Layout::TwoLane, Layout::FourLane), (Layout::FourLane, Layout::TwoLane)]
        {
            let (mut config, array) = board(layout, Sampling::Complex);
            config.waveform = Waveform { samples: 256, loops: 4, ..config.waveform };
            let mut random = Random::new(seed, 2);
            let targets = scene(&mut random, &config.waveform, true);
            let cube = CubeOptions { snr_db: 10.0, seed, ..CubeOptions::default() };
            let cube = quiet(simulate_cube(&config.waveform, &array, &targets, &cube).unwrap());
            let bytes = write(cube.view(), &config).unwrap();
            let right = Settled::new(&bytes, &config, &ReadingOptions::default()).unwrap();
            assert_eq!(right.evidence.other_lanes, None, "{layout:?} {seed}");
            config.adc.layout = other;
            let read = Settled::new(&bytes, &config, &ReadingOptions::default()).unwrap();
            println!("{layout:?} as {other:?}: {:?}", read.evidence.other_lanes);
            wrong += usize::from(read.evidence.other_lanes.map(|(found, _)| found) != Some(layout));
        }
    }
    assert_eq!(wrong, 0, "of 40 not told");
}
