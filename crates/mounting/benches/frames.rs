//! Time of one frame of 100 detections, 30 of them moving: the motion by itself, and a calibration that takes
//! the frame.

#![allow(clippy::unwrap_used, missing_docs)]

use boresight_core::{Detection, Random};
use boresight_mounting::network::{MotionNetwork, WindowFrame};
use boresight_mounting::{
    CalibrationOptions, Calibrator, FrameInput, Method, MotionEstimator, MotionMethod,
};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

const PERIOD: usize = 128;

/// A radar turned by 0.4 rad, 3.9 m ahead of the axle, as its car swings left and right.
fn frames(count: usize) -> Vec<(f64, Vec<Detection>)> {
    let mut random = Random::new(1, 0);
    let (sin, cos) = 0.4_f64.sin_cos();
    (0..PERIOD)
        .map(|index| {
            let rate = 0.3 * (std::f64::consts::TAU * index as f64 / PERIOD as f64).sin();
            let car = [10.0, 3.9 * rate];
            let velocity = [cos * car[0] + sin * car[1], cos * car[1] - sin * car[0]];
            let detections = (0..count)
                .map(|i| {
                    let azimuth = random.uniform(-1.0, 1.0);
                    let own = if i % 10 < 3 { random.uniform(-15.0, 15.0) } else { 0.0 };
                    let closing = velocity[0] * azimuth.cos() + velocity[1] * azimuth.sin() + own;
                    Detection {
                        azimuth_rad: (azimuth + 0.0087 * random.normal()) as f32,
                        range_rate_mps: (-closing + 0.1 * random.normal()) as f32,
                        range_m: 20.0,
                        rcs_dbsm: f32::NAN,
                    }
                })
                .collect();
            (rate, detections)
        })
        .collect()
}

fn motions(criterion: &mut Criterion) {
    let frames = frames(100);
    for method in &MotionMethod::ALL[..3] {
        let mut estimator = MotionEstimator::new(&CalibrationOptions::default(), *method).unwrap();
        let mut next = frames.iter().cycle();
        criterion.bench_function(method.name(), |bencher| {
            bencher.iter(|| estimator.estimate(black_box(&next.next().unwrap().1)).unwrap());
        });
    }
}

/// DeepEgo on frames as dense as those of RadarScenes' front radars, and DeepEgo+ on windows of eight of them.
fn networks(criterion: &mut Criterion) {
    let frames = frames(225);
    let bytes = include_bytes!("../../../models/motion/deepego-plus.bin");
    let network = MotionNetwork::read(bytes).unwrap();
    let mut next = frames.iter().cycle();
    criterion.bench_function("deepego, 225 detections", |bencher| {
        bencher.iter(|| network.single().motion(black_box(&next.next().unwrap().1)));
    });
    let motions: Vec<_> =
        frames[..8].iter().map(|frame| network.single().motion(&frame.1)).collect();
    let window: Vec<WindowFrame> = motions
        .iter()
        .enumerate()
        .map(|(k, motion)| WindowFrame { time_s: 0.074 * k as f64, motion })
        .collect();
    criterion.bench_function("deepego-plus, eight frames", |bencher| {
        bencher.iter(|| network.smoothing().unwrap().smooth(black_box(&window)));
    });
}

fn calibrations(criterion: &mut Criterion) {
    let frames = frames(100);
    for method in [Method::WeightedMean, Method::Recursive] {
        let options = CalibrationOptions {
            method,
            x_m: 3.9,
            nominal_rad: Some(0.38),
            ..CalibrationOptions::default()
        };
        let mut calibrator = Calibrator::new(options).unwrap();
        let (mut next, mut time_s) = (frames.iter().cycle(), 0.0);
        criterion.bench_function(&format!("a frame of {}", method.name()), |bencher| {
            bencher.iter(|| {
                let (rate, detections) = next.next().unwrap();
                time_s += 0.074;
                let frame = FrameInput {
                    time_s,
                    detections: black_box(detections),
                    yaw_rate_radps: Some(*rate),
                    speed_mps: Some(10.0),
                };
                calibrator.add(frame).unwrap()
            });
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(30)
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(1));
    targets = motions, networks, calibrations
}
criterion_main!(benches);
