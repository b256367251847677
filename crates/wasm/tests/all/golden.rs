//! The same numbers natively and in wasm: digests of simulations, bit for bit, and angles of every
//! method against `tests/golden/angles.csv`, to rounding. The file is what
//! `cargo test -p boresight-wasm --test all -- print_angles --nocapture` prints.

use boresight_aoa::{Data, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::{Complex32, Complex64, Direction, Random};
use boresight_math::fft::Transforms;
use boresight_math::phasor::cis;
use boresight_simulate::digest::{
    REFERENCE_CUBE, REFERENCE_DRIVE, REFERENCE_RADARSCENES_DRIVE, REFERENCE_SNAPSHOTS,
    REFERENCE_STREET, reference_cube, reference_drive, reference_radarscenes_drive,
    reference_snapshots, reference_street,
};
use boresight_simulate::{Fluctuation, Scene, SnapshotOptions, SnapshotSimulator, Target};
use ndarray::Array2;
use std::f64::consts::TAU;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test;

/// Angles may differ by this, deg: iterations end at 1e-8 rad, and rounding differs between FFTs.
const TOLERANCE_DEG: f64 = 1e-5;

fn snapshots(array: &str, count: usize) -> Array2<Complex64> {
    let target = |azimuth_deg: f64, power_db| Target {
        direction: Direction::azimuth(azimuth_deg.to_radians()).into(),
        power_db,
        ..Target::default()
    };
    let options = SnapshotOptions {
        scene: Scene::Given(vec![target(-17.0, 0.0), target(24.0, -3.0)]),
        snr_db: 20.0,
        snapshots: count,
        fluctuation: Fluctuation::RandomPhase,
        seed: 11,
        ..SnapshotOptions::default()
    };
    let simulator = SnapshotSimulator::new(&preset(array).unwrap(), &options).unwrap();
    simulator.scene(0).unwrap().0
}

/// Azimuths of the two sources, strongest first, deg.
fn angles(method: Method, array: &str) -> Vec<f64> {
    let needs = method.requirements();
    let count = needs.max_snapshots.unwrap_or(50);
    let options =
        EstimatorOptions { sources: SourceCount::Known(2), ..EstimatorOptions::default() };
    let mut estimator = Estimator::new(method, &preset(array).unwrap(), &options).unwrap();
    let estimate = estimator.estimate(Data::Snapshots(snapshots(array, count).view())).unwrap();
    estimate.sources.iter().take(2).map(|s| s.direction.azimuth_rad.to_degrees()).collect()
}

fn cases() -> impl Iterator<Item = (Method, &'static str)> {
    Method::ALL.into_iter().flat_map(|method| {
        let sparse = !method.requirements().uniform_array;
        ["ula10"].into_iter().chain(sparse.then_some("lrr48")).map(move |array| (method, array))
    })
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn angles_are_those_of_the_golden_file() {
    let golden = include_str!("../../../../tests/golden/angles.csv");
    let mut lines = golden.lines().skip(1);
    for (method, array) in cases() {
        let fields: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!((fields[0], fields[1]), (method.name(), array));
        let found = angles(method, array);
        assert_eq!(found.len(), 2, "{} on {array}", method.name());
        for (angle, field) in found.iter().zip(&fields[2..]) {
            let expected: f64 = field.parse().unwrap();
            let error = (angle - expected).abs();
            assert!(error < TOLERANCE_DEG, "{} on {array}: {angle}, {expected}", method.name());
        }
    }
    assert_eq!(lines.next(), None);
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn simulations_have_the_same_bits() {
    assert_eq!(reference_snapshots().unwrap(), REFERENCE_SNAPSHOTS);
    assert_eq!(reference_cube().unwrap(), REFERENCE_CUBE);
    assert_eq!(reference_drive().unwrap(), REFERENCE_DRIVE);
    assert_eq!(reference_radarscenes_drive().unwrap(), REFERENCE_RADARSCENES_DRIVE);
    assert_eq!(reference_street().unwrap(), REFERENCE_STREET);
}

/// Plans differ between natively and wasm; both must be what they are planned for.
#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn transforms_are_the_definition() {
    let mut random = Random::new(5, 0);
    for length in 1..=2048_usize {
        let x: Vec<Complex64> = (0..length).map(|_| random.complex_normal(1.0)).collect();
        let bin = (random.unit() * length as f64) as usize;
        let term = |n: usize| cis(-TAU * (bin * n % length) as f64 / length as f64) * x[n];
        let expected: Complex64 = (0..length).map(term).sum();
        // Bins are of the size of the root of the length; sums like this one round with the length.
        let unit = length as f64 * f64::EPSILON;
        let mut double = x.clone();
        f64::plan_forward(length).process(&mut double);
        assert!((double[bin] - expected).norm() < 8.0 * unit, "{length}, bin {bin}");
        let narrow = |z: &Complex64| Complex32::new(z.re as f32, z.im as f32);
        let mut single: Vec<Complex32> = x.iter().map(narrow).collect();
        f32::plan_forward(length).process(&mut single);
        let found = Complex64::new(single[bin].re.into(), single[bin].im.into());
        let limit = 32.0 * f64::from(f32::EPSILON) * (length as f64).sqrt();
        assert!((found - expected).norm() < limit, "{length}, bin {bin}: {found} {expected}");
    }
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn print_angles() {
    println!("method,array,first_deg,second_deg");
    for (method, array) in cases() {
        let found: Vec<String> = angles(method, array).iter().map(f64::to_string).collect();
        assert_eq!(found.len(), 2, "{}", method.name());
        println!("{},{array},{}", method.name(), found.join(","));
    }
}
