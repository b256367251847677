//! Azimuth and elevation of boards with three transmitters: from simulated samples over the bytes of a capture card and
//! the chain to directions, against the Cramer-Rao bound of both.

#![allow(clippy::unwrap_used)]

use boresight_aoa::bounds::{Signals, deterministic_bound, single_snapshot};
use boresight_aoa::{Method, SourceCount};
use boresight_core::{Array, Complex32, Complex64, Diagnose, Direction, Random, Waveform};
use boresight_formats::{Capture, RadarConfig};
use boresight_pipeline::{Chain, ChainOptions, Detection, Frame, FrameSource, PipelineError};
use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube};
use ndarray::{Array4, Axis};
use std::ops::ControlFlow;

const CFG: &str = include_str!("../../../recordings/awr1642/profile.cfg");
const BOARDS: [(&str, &str); 3] =
    [("xWR18xx", "77 "), ("xWR68xx_AOP", "60.5 "), ("iwr6843ods", "60.5 ")];
/// Far enough apart for no sidelobe of a Hann window to reach from one to the next.
const RANGES_M: [f64; 5] = [3.0, 4.5, 6.0, 8.0, 10.0];
const POWER_DB: f64 = -30.0;
/// Of a 0 dB target. 25 dB in a cell: 36 dB of 256 samples and 16 loops, less 3.5 dB of two windows and 7.5 dB here.
const SNR_DB: f64 = 22.5;
const FRAMES: u64 = 60;

fn config(platform: &str, start_ghz: &str) -> RadarConfig {
    let text = CFG
        .replace("Platform:xWR16xx", &format!("Platform:{platform}"))
        .replace("channelCfg 15 3 0", "channelCfg 15 7 0\nchirpCfg 2 2 0 0 0 0 0 4")
        .replace("frameCfg 0 1 ", "frameCfg 0 2 ")
        .replace("profileCfg 0 77 ", &format!("profileCfg 0 {start_ghz}"));
    RadarConfig::parse(text.as_bytes()).unwrap()
}

/// As a DCA1000 records it: two samples' real parts, then their imaginary parts.
fn recorded(frame: &Array4<Complex32>) -> Vec<u8> {
    let number = |x: f32| ((x * 32768.0).round() as i16).to_le_bytes();
    let samples: Vec<Complex32> = frame.iter().copied().collect();
    let pair = |pair: &[Complex32]| [pair[0].re, pair[1].re, pair[0].im, pair[1].im].map(number);
    samples.chunks_exact(2).flat_map(pair).flatten().collect()
}

/// A target at each range, anywhere in the field of view, at rates in the middle of a Doppler bin.
fn targets(waveform: &Waveform, random: &mut Random) -> Vec<CubeTarget> {
    RANGES_M
        .iter()
        .map(|&range_m| CubeTarget {
            range_m,
            rate_mps: random.uniform(-6.0, 7.0).floor() * waveform.rate_resolution_mps(),
            direction: Direction::new(random.uniform(-0.6, 0.6), random.uniform(-0.35, 0.35))
                .into(),
            power_db: POWER_DB,
            phase_rad: None,
        })
        .collect()
}

fn sample(
    config: &RadarConfig,
    array: &Array,
    targets: &[CubeTarget],
    snr_db: f64,
    seed: u64,
) -> Array4<Complex32> {
    let options = CubeOptions { snr_db, seed, ..CubeOptions::default() };
    let cube = simulate_cube(&config.waveform, array, targets, &options).unwrap();
    let bytes = recorded(&cube.index_axis(Axis(0), 0).to_owned());
    let frame = Capture::new(&bytes, config).unwrap().frame(0).unwrap();
    assert_eq!(frame.clipped, 0);
    frame.samples
}

fn nearest<'a>(detections: &'a [Detection], target: &CubeTarget) -> Option<&'a Detection> {
    detections.iter().find(|d| (d.range_m - target.range_m).abs() < 0.2)
}

fn options(method: Method) -> ChainOptions {
    let mut options = ChainOptions::default();
    options.angle.method = method;
    options.angle.options.sources = SourceCount::Known(1);
    if method == Method::Iaa {
        // Its peaks alone, some of which are of noise, are 1.5 and 1.3 times the bound off; the strongest, refined, may
        // come from a coarse grid.
        options.angle.options.max_peaks = 1;
        (options.angle.options.refine, options.angle.options.grid_points) = (true, 41);
        options.angle.options.elevation_points = 13;
    }
    options
}

/// Root mean square of the errors of azimuth and elevation over their bounds, for each method.
fn scores(platform: &str, start_ghz: &str, methods: &[Method]) -> Vec<[f64; 2]> {
    let config = config(platform, start_ghz);
    let array = config.array().unwrap();
    let waveform = config.waveform;
    // Of the Hann windows over samples and loops.
    let noise_power = 10_f64.powf(-SNR_DB / 10.0)
        * (1.5 / waveform.samples as f64)
        * (1.5 / waveform.loops as f64);
    let mut chains: Vec<Chain> = methods
        .iter()
        .map(|&method| Chain::new(&waveform, 4, &array, &options(method)).unwrap())
        .collect();
    let mut squares = vec![[0.0; 2]; methods.len()];
    for seed in 0..FRAMES {
        let targets = targets(&waveform, &mut Random::new(77, seed));
        let silent = sample(&config, &array, &targets, 250.0, seed);
        let noisy = sample(&config, &array, &targets, SNR_DB, seed);
        // What windows and bins leave of each target's power is taken from the same cells without noise.
        let cells = chains[0].cells(silent.view()).unwrap();
        let bounds: Vec<[f64; 2]> = targets
            .iter()
            .map(|target| {
                let at = cells.cells.iter().position(|c| (c.range_m - target.range_m).abs() < 0.2);
                let snapshot = cells.snapshots.index_axis(Axis(0), at.unwrap());
                let power = snapshot.iter().map(|z| z.norm_sqr()).sum::<f64>() / 12.0;
                let covariance = single_snapshot(&[Complex64::from(power.sqrt())]);
                let signals = Signals { covariance: covariance.view(), noise_power, snapshots: 1 };
                let bound = deterministic_bound(&array, &[*target.direction], &signals).unwrap();
                [bound.azimuth_rad[0], bound.elevation_rad.unwrap()[0]]
            })
            .collect();
        for (chain, squares) in chains.iter_mut().zip(&mut squares) {
            let result = chain.process(noisy.view()).unwrap();
            for (target, bound) in targets.iter().zip(&bounds) {
                let found = nearest(&result.detections, target).unwrap();
                let off = [
                    found.azimuth_rad - target.direction.azimuth_rad,
                    found.elevation_rad - target.direction.elevation_rad,
                ];
                for k in 0..2 {
                    squares[k] += (off[k] / bound[k]).powi(2);
                }
                let place =
                    Direction::new(found.azimuth_rad, found.elevation_rad).place_m(found.range_m);
                assert_eq!([found.x_m, found.y_m, found.z_m], place);
            }
        }
    }
    let count = FRAMES as f64 * RANGES_M.len() as f64;
    squares.iter().map(|both| both.map(|sum| (sum / count).sqrt())).collect()
}

/// 300 errors of a normal distribution give a ratio of 1 +- 0.041.
#[test]
fn azimuth_and_elevation_reach_their_bound_through_bytes_and_chain() {
    let methods = [
        Method::Bartlett,
        Method::Capon,
        Method::Iaa,
        Method::Nomp,
        Method::AtomicNorm,
        Method::MaximumLikelihood,
    ];
    for (platform, start_ghz) in BOARDS {
        for (method, [azimuth, elevation]) in
            methods.iter().zip(scores(platform, start_ghz, &methods))
        {
            println!(
                "{platform}, {}: azimuth {azimuth:.3}, elevation {elevation:.3} of the bound",
                method.name()
            );
            assert!((0.9..1.1).contains(&azimuth), "{platform}, {method:?}: azimuth {azimuth}");
            assert!(
                (0.9..1.1).contains(&elevation),
                "{platform}, {method:?}: elevation {elevation}"
            );
        }
    }
}

/// Frames as they come from a capture card.
struct Recorded(Vec<Array4<Complex32>>);

impl FrameSource for Recorded {
    type Error = PipelineError;

    fn frames(&self) -> usize {
        self.0.len()
    }

    fn frame(&self, index: usize) -> Result<Frame, PipelineError> {
        Ok(Frame { samples: self.0[index].clone(), clipped: 0 })
    }
}

/// MUSIC takes a snapshot of each of several frames. 200 errors give a ratio of 1 +- 0.05.
#[test]
fn music_over_frames_reaches_the_bound_of_all() {
    const FRAMES_TOGETHER: usize = 4;
    let config = config("xWR18xx", "77 ");
    let array = config.array().unwrap();
    let waveform = config.waveform;
    let mut chain = Chain::new(&waveform, 4, &array, &options(Method::Music)).unwrap();
    let noise_power = 10_f64.powf(-SNR_DB / 10.0)
        * (1.5 / waveform.samples as f64)
        * (1.5 / waveform.loops as f64);
    let (mut squares, mut count) = ([0.0; 2], 0.0);
    for seed in 0..40 {
        let targets: Vec<CubeTarget> = targets(&waveform, &mut Random::new(78, seed))
            .into_iter()
            .map(|target| CubeTarget { rate_mps: 0.0, phase_rad: Some(1.0), ..target })
            .collect();
        let frames = |snr_db, many| -> Vec<Array4<Complex32>> {
            (0..many).map(|k| sample(&config, &array, &targets, snr_db, 100 * seed + k)).collect()
        };
        let silent = chain.cells(frames(250.0, 1)[0].view()).unwrap();
        let noisy = Recorded(frames(SNR_DB, FRAMES_TOGETHER as u64));
        let go_on = &mut |_| ControlFlow::Continue(());
        let result = chain.combine(&noisy, 0..FRAMES_TOGETHER, go_on).unwrap();
        for target in &targets {
            let at = silent.cells.iter().position(|c| (c.range_m - target.range_m).abs() < 0.2);
            let snapshot = silent.snapshots.index_axis(Axis(0), at.unwrap());
            let power = snapshot.iter().map(|z| z.norm_sqr()).sum::<f64>() / 12.0;
            let covariance = single_snapshot(&[Complex64::from(power.sqrt())]);
            let signals =
                Signals { covariance: covariance.view(), noise_power, snapshots: FRAMES_TOGETHER };
            let bound = deterministic_bound(&array, &[*target.direction], &signals).unwrap();
            let found = nearest(&result.detections, target).unwrap();
            let azimuth = found.azimuth_rad - target.direction.azimuth_rad;
            let elevation = found.elevation_rad - target.direction.elevation_rad;
            squares[0] += (azimuth / bound.azimuth_rad[0]).powi(2);
            squares[1] += (elevation / bound.elevation_rad.unwrap()[0]).powi(2);
            count += 1.0;
        }
    }
    let [azimuth, elevation] = squares.map(|sum: f64| (sum / count).sqrt());
    println!("music: azimuth {azimuth:.3}, elevation {elevation:.3} of the bound");
    assert!((0.85..1.1).contains(&azimuth), "{azimuth}");
    assert!((0.85..1.1).contains(&elevation), "{elevation}");
}

/// The sign of turned antennas is taken off, in the chain and nowhere else.
#[test]
fn turned_antennas_are_undone() {
    let config = config("xWR68xx_AOP", "60.5 ");
    let array = config.array().unwrap();
    let target = CubeTarget {
        range_m: 5.0,
        direction: Direction::new(0.3, 0.2).into(),
        power_db: POWER_DB,
        ..CubeTarget::default()
    };
    let frame = sample(&config, &array, &[target], 40.0, 1);
    let at = |array: &Array| {
        let mut chain = Chain::new(&config.waveform, 4, array, &options(Method::Bartlett)).unwrap();
        let found = chain.process(frame.view()).unwrap();
        *nearest(&found.detections, &target).unwrap()
    };
    let right = at(&array);
    assert!((right.azimuth_rad - 0.3).abs() < 0.01, "{right:?}");
    assert!((right.elevation_rad - 0.2).abs() < 0.01, "{right:?}");
    assert!((right.z_m - 5.0 * 0.2_f64.sin()).abs() < 0.06, "{right:?}");
    let upright = Array::mimo(array.tx(), array.rx()).unwrap();
    let wrong = at(&upright);
    assert!((wrong.elevation_rad - 0.2).abs() > 0.2, "{wrong:?}");
}

#[test]
fn methods_that_tell_no_elevation_are_refused_by_name() {
    let config = config("xWR18xx", "77 ");
    let array = config.array().unwrap();
    for method in Method::ALL {
        let made = Chain::new(&config.waveform, 4, &array, &options(method));
        match made {
            Ok(_) => assert!(method.requirements().elevation, "{method:?}"),
            Err(error) => {
                assert!(!method.requirements().elevation, "{method:?}: {error}");
                assert_eq!(error.code(), "unsuitable-array", "{error}");
            }
        }
    }
}

#[test]
fn detections_outside_elevation_and_height_are_dropped_and_counted() {
    let config = config("xWR18xx", "77 ");
    let array = config.array().unwrap();
    let target = |range_m, elevation_rad| CubeTarget {
        range_m,
        direction: Direction::new(0.1, elevation_rad).into(),
        power_db: POWER_DB,
        ..CubeTarget::default()
    };
    let all = [target(3.0, 0.0), target(5.0, 0.3), target(8.0, 0.2), target(10.0, -0.1)];
    let frame = sample(&config, &array, &all, 40.0, 3);
    let kept = |elevation_rad, height_m| {
        let mut options = options(Method::Bartlett);
        (options.region.elevation_rad, options.region.height_m) = (elevation_rad, height_m);
        let mut chain = Chain::new(&config.waveform, 4, &array, &options).unwrap();
        let result = chain.process(frame.view()).unwrap();
        let kept: Vec<bool> =
            all.iter().map(|target| nearest(&result.detections, target).is_some()).collect();
        (kept, result.counts.outside_region)
    };
    let (everything, before) = kept(None, None);
    assert_eq!(everything, [true; 4]);
    let (level, dropped) = kept(Some([-0.15, 0.25]), None);
    assert_eq!((level, dropped - before), (vec![true, false, true, true], 1));
    // 1.48 m and 1.59 m up, and 1 m below.
    let (low, dropped) = kept(None, Some([-0.5, 1.53]));
    assert_eq!((low, dropped - before), (vec![true, true, false, false], 2));
}
