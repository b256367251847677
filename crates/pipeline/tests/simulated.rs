//! The chain on simulated cubes, of which the truth is known.

#![allow(clippy::unwrap_used)]

use boresight_aoa::{Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::{Array, Direction, Waveform};
use boresight_pipeline::{Chain, ChainOptions, CubeFrames, FrameResult};
use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube, waveform_awr1642};
use std::ops::ControlFlow;

fn target(range_m: f64, rate_mps: f64, azimuth_deg: f64, power_db: f64) -> CubeTarget {
    CubeTarget {
        range_m,
        rate_mps,
        direction: Direction::azimuth(azimuth_deg.to_radians()).into(),
        power_db,
        phase_rad: None,
    }
}

fn run(
    waveform: &Waveform,
    array: &Array,
    targets: &[CubeTarget],
    snr_db: f64,
    options: &ChainOptions,
) -> FrameResult {
    let cube = CubeOptions { snr_db, seed: 11, ..CubeOptions::default() };
    let cube = simulate_cube(waveform, array, targets, &cube).unwrap();
    let receivers = array.rx().len();
    let mut chain = Chain::new(waveform, receivers, array, options).unwrap();
    chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap()
}

/// Every target is found, and nothing else.
fn assert_found(result: &FrameResult, targets: &[CubeTarget], waveform: &Waveform) {
    assert_eq!(result.detections.len(), targets.len(), "{:?}", result.detections);
    for target in targets {
        let found = result
            .detections
            .iter()
            .min_by(|a, b| {
                let far = |d: &&boresight_pipeline::Detection| (d.range_m - target.range_m).abs();
                far(a).total_cmp(&far(b))
            })
            .unwrap();
        let range_bins = (found.range_m - target.range_m) / waveform.range_resolution_m();
        let rate_bins = (found.rate_mps - target.rate_mps) / waveform.rate_resolution_mps();
        // The parabola is off by up to 0.05 bins for a Hann window; the target moves while it is
        // looked at, by up to half of 0.3 bins here.
        assert!(range_bins.abs() < 0.25, "{range_bins} range bins: {found:?}");
        assert!(rate_bins.abs() < 0.1, "{rate_bins} Doppler bins: {found:?}");
        let azimuth_deg = (found.azimuth_rad - target.direction.azimuth_rad).to_degrees();
        assert!(azimuth_deg.abs() < 0.5, "{azimuth_deg} deg: {found:?}");
        let power_db = 10.0 * found.power.log10() - target.power_db;
        assert!(power_db.abs() < 0.7, "{power_db} dB: {found:?}");
    }
}

#[test]
fn moving_targets_are_where_they_are() {
    // Without the compensation of the transmitters' turns, angles of moving targets are off by
    // tens of degrees.
    let (waveform, array) = (waveform_awr1642(), preset("awr1642").unwrap());
    let targets = [
        target(3.0, -4.2, 35.0, -3.0),
        target(5.02, 1.3, -20.0, -10.0),
        target(8.0, 3.1, 5.0, 0.0),
        target(10.0, 0.0, -48.0, -6.0),
    ];
    let result = run(&waveform, &array, &targets, 10.0, &ChainOptions::default());
    assert_found(&result, &targets, &waveform);
}

#[test]
fn cells_come_with_the_response_of_their_target() {
    let (waveform, array) = (waveform_awr1642(), preset("awr1642").unwrap());
    let targets = [target(3.0, -4.2, 35.0, 0.0), target(8.0, 3.1, 5.0, -3.0)];
    let cube = CubeOptions { snr_db: 20.0, seed: 11, frames: 2, ..CubeOptions::default() };
    let cube = simulate_cube(&waveform, &array, &targets, &cube).unwrap();
    let mut chain = Chain::new(&waveform, 4, &array, &ChainOptions::default()).unwrap();
    let one = chain.cells(cube.index_axis(ndarray::Axis(0), 1)).unwrap();
    let go_on = &mut |_| ControlFlow::Continue(());
    let both = chain.combined_cells(&CubeFrames(cube.view()), 0..2, go_on).unwrap();
    assert_eq!(one.snapshots.dim(), (2, 8, 1));
    assert_eq!(both.snapshots.dim(), (both.cells.len(), 8, 2));
    assert!(one.counts.cells_over_threshold > 2 && one.counts.without_angle == 0);
    for ((cell, snapshot), target) in one.cells.iter().zip(one.snapshots.outer_iter()).zip(&targets)
    {
        let gain_db = 10.0 * cell.power.log10() - target.power_db;
        assert!(gain_db.abs() < 0.7, "{gain_db} dB: {cell:?}");
        assert!((cell.rate_mps - target.rate_mps).abs() < 0.1 * waveform.rate_resolution_mps());
        // Noise is 40 dB below the target; straddling and the rest of the Doppler compensation
        // cost less than a tenth of a radian. The power of the match is within 1 % of all power.
        let a = boresight_core::steering::steering_vector(&array, *target.direction);
        let match_power: boresight_core::Complex64 =
            a.iter().zip(snapshot.iter()).map(|(a, y)| a.conj() * y).sum();
        let power: f64 = snapshot.iter().map(|y| y.norm_sqr()).sum();
        let share = match_power.norm_sqr() / (8.0 * power);
        assert!(share > 0.99, "{share}: {cell:?}");
    }
}

#[test]
fn clutter_removal_leaves_what_moves() {
    let (waveform, array) = (waveform_awr1642(), preset("awr1642").unwrap());
    let targets = [target(4.0, 0.0, 10.0, 0.0), target(7.0, 2.0, -10.0, -20.0)];
    let mut options = ChainOptions::default();
    options.range_doppler.static_clutter_removal = true;
    let result = run(&waveform, &array, &targets, 10.0, &options);
    assert_found(&result, &targets[1..], &waveform);
}

#[test]
fn two_targets_of_one_cell_are_told_apart() {
    let (waveform, array) = (waveform_awr1642(), preset("lrr48").unwrap());
    let waveform = Waveform { transmitters: 6, ..waveform };
    let targets = [target(6.0, 0.0, -4.0, 0.0), target(6.0, 0.0, 6.0, -4.0)];
    for method in [Method::Bartlett, Method::Iaa] {
        let mut options = ChainOptions::default();
        options.angle.method = method;
        let result = run(&waveform, &array, &targets, 20.0, &options);
        let strongest: Vec<f64> =
            result.detections.iter().take(2).map(|d| d.azimuth_rad.to_degrees()).collect();
        assert!((strongest[0] + 4.0).abs() < 0.3, "{method:?}: {strongest:?}");
        assert!((strongest[1] - 6.0).abs() < 0.3, "{method:?}: {strongest:?}");
    }
}

#[test]
fn elevation_comes_with_a_planar_array() {
    let array = preset("awr1843").unwrap();
    let waveform = Waveform { transmitters: 3, ..waveform_awr1642() };
    let up = Direction::new(0.2, 0.15);
    let targets = [CubeTarget { direction: up.into(), ..target(5.0, 1.0, 0.0, 0.0) }];
    let result = run(&waveform, &array, &targets, 20.0, &ChainOptions::default());
    let found = result.detections[0];
    assert!((found.azimuth_rad - 0.2).abs() < 0.01, "{found:?}");
    assert!((found.elevation_rad - 0.15).abs() < 0.02, "{found:?}");
}

#[test]
fn noise_alone_is_detected_as_often_as_asked_for() {
    let (waveform, array) = (waveform_awr1642(), preset("awr1642").unwrap());
    let false_alarm = 1e-3;
    let mut options =
        ChainOptions { peak_grouping: false, max_detections: 65_536, ..Default::default() };
    options.cfar.false_alarm = false_alarm;
    options.region.range_m = Some([0.0, 1e3]);
    let cube = CubeOptions { snr_db: 0.0, frames: 50, seed: 5, ..CubeOptions::default() };
    let quiet = [target(1.0, 0.0, 0.0, -200.0)];
    let cube = simulate_cube(&waveform, &array, &quiet, &cube).unwrap();
    let mut chain = Chain::new(&waveform, 4, &array, &options).unwrap();
    let mut over = 0;
    let go = &mut |_| ControlFlow::Continue(());
    let source = CubeFrames(cube.view());
    chain.each(&source, 0..50, |r| over += r.counts.cells_over_threshold, go).unwrap();
    let cells = 50.0 * 256.0 * 16.0;
    let rate = f64::from(u32::try_from(over).unwrap()) / cells;
    // 205 expected; with cells correlated by the windows the count's standard deviation is about
    // 20, a tenth. Correlated training cells are allowed for only on average: another tenth.
    assert!((rate / false_alarm - 1.0).abs() < 0.5, "{rate}");
}

#[test]
fn targets_that_leave_their_cell_are_remarked() {
    let (waveform, array) = (waveform_awr1642(), preset("awr1642").unwrap());
    let cube = CubeOptions { frames: 4, seed: 2, ..CubeOptions::default() };
    let mut chain = Chain::new(&waveform, 4, &array, &ChainOptions::default()).unwrap();
    for (rate_mps, remarked) in [(2.0, true), (0.0, false)] {
        let targets = [target(6.0, rate_mps, 0.0, 0.0)];
        let cube = simulate_cube(&waveform, &array, &targets, &cube).unwrap();
        let go = &mut |_| ControlFlow::Continue(());
        let result = chain.combine(&CubeFrames(cube.view()), 0..4, go).unwrap();
        let found = result.warnings.iter().any(|warning| warning.code == "moving-targets");
        assert_eq!(found, remarked);
    }
}

#[test]
fn methods_that_count_sources_work_on_one_frame_by_smoothing() {
    let (waveform, array) = (waveform_awr1642(), preset("awr1642").unwrap());
    let targets = [target(5.0, 1.0, 20.0, 0.0)];
    let mut options = ChainOptions::default();
    options.angle.method = Method::RootMusic;
    options.angle.options.sources = SourceCount::Known(1);
    options.angle.options.smoothing = Some(5);
    let result = run(&waveform, &array, &targets, 20.0, &options);
    assert_found(&result, &targets, &waveform);
}
