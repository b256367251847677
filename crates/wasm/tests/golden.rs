//! The same numbers natively and in wasm: digests of simulations, bit for bit, and angles of every
//! method against `tests/golden/angles.csv`, to rounding. The file is what
//! `cargo test -p boresight-wasm --test golden -- print_angles --nocapture` prints.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use boresight_aoa::{Data, Estimator, Method, Options, SourceCount};
use boresight_core::presets::preset;
use boresight_core::{Complex64, Direction};
use boresight_simulate::digest::{
    REFERENCE_CUBE, REFERENCE_SNAPSHOTS, reference_cube, reference_snapshots,
};
use boresight_simulate::{Fluctuation, Scene, SnapshotOptions, SnapshotSimulator, Target};
use ndarray::Array2;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test;

/// Angles may differ by this, deg: iterations end at 1e-8 rad, and rounding differs between FFTs.
const TOLERANCE_DEG: f64 = 1e-5;

fn snapshots(array: &str, count: usize) -> Array2<Complex64> {
    let target = |azimuth_deg: f64, power_db| Target {
        direction: Direction::azimuth(azimuth_deg.to_radians()),
        power_db,
        phase_rad: None,
    };
    let options = SnapshotOptions {
        scene: Scene::Given(vec![target(-17.0, 0.0), target(24.0, -3.0)]),
        snr_db: 20.0,
        snapshots: count,
        fluctuation: Fluctuation::RandomPhase,
        imperfections: None,
        seed: 11,
    };
    let simulator = SnapshotSimulator::new(&preset(array).unwrap(), &options).unwrap();
    simulator.scene(0).unwrap().0
}

/// Azimuths of the two sources, strongest first, deg.
fn angles(method: Method, array: &str) -> Vec<f64> {
    let needs = method.requirements();
    let count = needs.max_snapshots.unwrap_or(50);
    let options = Options { sources: SourceCount::Known(2), ..Options::default() };
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
    let golden = include_str!("../../../tests/golden/angles.csv");
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
