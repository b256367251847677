//! Regions of simulated cubes, told apart by methods that need no network.

#![allow(clippy::unwrap_used)]

use boresight_aoa::order::counting::{CountOptions, count_sources_in};
use boresight_aoa::{
    AoaError, CountSources, Counted, Data, Estimator, EstimatorOptions, Method, SourceCount,
    SourceProbabilities,
};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex32, Diagnose, Direction, Waveform};
use boresight_pipeline::regions::{RegionChainOptions, RegionFinder, RegionFrame, Rotation};
use boresight_pipeline::{CubeFrames, PipelineError, RegionChain};
use boresight_signal::{CfarOptions, Region, Window};
use boresight_simulate::{
    CubeOptions, CubeTarget, simulate_cube, waveform_3dcnn_experiment, waveform_3dcnn_simulated,
};
use ndarray::{Array5, Axis};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Minimum description length, as sure as can be.
struct Mdl;

impl CountSources for Mdl {
    fn check_array(&self, _: &Array) -> Result<(), AoaError> {
        Ok(())
    }

    fn count(&self, data: Data<'_>) -> Result<SourceProbabilities, AoaError> {
        let sources = count_sources_in(data, &CountOptions::default())?.1.sources.min(2);
        let mut probability = [0.0; 3];
        probability[sources] = 1.0;
        Ok(SourceProbabilities { sources, probability })
    }
}

fn counted(array: &Array) -> Counted {
    let of = |sources| {
        let sources = SourceCount::Known(sources);
        let options = EstimatorOptions { sources, ..EstimatorOptions::default() };
        Estimator::new(Method::MaximumLikelihood, array, &options).unwrap()
    };
    Counted::new(Arc::new(Mdl), [of(1), of(2)]).unwrap()
}

fn target(range_m: f64, azimuth_deg: f64) -> CubeTarget {
    let direction = Direction::azimuth(azimuth_deg.to_radians());
    CubeTarget { range_m, direction: direction.into(), ..CubeTarget::default() }
}

fn cube(
    waveform: &Waveform,
    array: &Array,
    targets: &[CubeTarget],
    seed: u64,
) -> Array5<Complex32> {
    let options = CubeOptions { snr_db: 5.0, seed, ..CubeOptions::default() };
    simulate_cube(waveform, array, targets, &options).unwrap()
}

fn run(targets: &[CubeTarget], options: &RegionChainOptions) -> RegionFrame {
    let (waveform, array) = (waveform_3dcnn_simulated(), Array::ula(8).unwrap());
    let cube = cube(&waveform, &array, targets, 3);
    let mut chain = RegionChain::new(&waveform, 8, options, counted(&array)).unwrap();
    chain.process(cube.index_axis(Axis(0), 0)).unwrap()
}

/// Azimuths in ascending order, deg.
fn azimuths_deg(frame: &RegionFrame, region: usize) -> Vec<f64> {
    let targets = frame.regions[region].targets.iter();
    let mut all: Vec<f64> = targets.map(|target| target.azimuth_rad.to_degrees()).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// At 5 dB a sample 1024 samples of 8 elements leave 0.035 deg of error on one target at boresight, and a tenth to
/// two tenths on pairs.
fn assert_at(found_deg: &[f64], truth_deg: &[f64]) {
    assert_eq!(found_deg.len(), truth_deg.len(), "{found_deg:?}");
    for (found, truth) in found_deg.iter().zip(truth_deg) {
        assert!((found - truth).abs() < 0.7, "{found_deg:?}");
    }
}

#[test]
fn regions_far_apart_hold_what_is_near_each() {
    let targets = [target(60.3, -4.2), target(160.0, -6.1), target(166.4, 5.3)];
    for rotation in [Rotation::Never, Rotation::Outside, Rotation::Always] {
        let options = RegionChainOptions { rotation, ..RegionChainOptions::default() };
        let frame = run(&targets, &options);
        assert_eq!(frame.regions.len(), 2, "{:?}", frame.regions);
        // The two at 160 m may be the first region or the second: powers are equal.
        let near = usize::from(frame.regions[0].range_m > 100.0);
        let [one, two] = [near, 1 - near];
        assert_eq!([one, two].map(|k| frame.regions[k].sources), [1, 2]);
        assert_eq!([one, two].map(|k| frame.regions[k].peaks), [1, 2]);
        assert_at(&azimuths_deg(&frame, one), &[-4.2]);
        assert_at(&azimuths_deg(&frame, two), &[-6.1, 5.3]);
        let rotated = rotation == Rotation::Always;
        assert!(frame.regions.iter().all(|region| region.rotated == rotated));
        // Each target is in the bin it is in: bins are 1 m, and parabolas between them good to a fifth.
        for (region, truths) in [(one, &targets[..1]), (two, &targets[1..])] {
            for truth in truths {
                let is_there = |found: &&boresight_pipeline::regions::RegionTarget| {
                    (found.azimuth_rad - truth.direction.azimuth_rad).abs() < 0.02
                };
                let found = frame.regions[region].targets.iter().find(is_there).unwrap();
                assert!((found.range_m - truth.range_m).abs() < 0.5, "{found:?} {truth:?}");
                assert!((10.0 * found.power.log10()).abs() < 1.0, "{found:?}");
            }
        }
        assert_eq!((frame.counts.joined, frame.counts.without_target), (1, 0));
        assert_eq!(frame.range_m.len(), frame.range_profile_db.len());
    }
}

#[test]
fn without_networks_ranges_and_azimuths_are_fitted_together() {
    let (waveform, array) = (waveform_3dcnn_simulated(), Array::ula(8).unwrap());
    // Within a bin of each other, one 10 dB weaker; another far away and far from boresight.
    let weaker = CubeTarget { power_db: -10.0, ..target(100.7, 3.1) };
    let targets = [target(100.2, -4.0), weaker, target(160.0, 51.0)];
    let cube = cube(&waveform, &array, &targets, 3);
    let options = RegionChainOptions::default();
    let mut chain = RegionChain::joint(&waveform, 8, &array, &options).unwrap();
    let frame = chain.process(cube.index_axis(Axis(0), 0)).unwrap();
    assert!(frame.warnings.is_empty(), "{:?}", frame.warnings);
    let found: Vec<_> = frame.regions.iter().flat_map(|region| &region.targets).collect();
    assert_eq!(found.len(), 3);
    for truth in &targets {
        let at = truth.direction.azimuth_rad;
        let near = |found: &&&boresight_pipeline::regions::RegionTarget| {
            (found.azimuth_rad - at).abs() <= 4.0 * found.azimuth_deviation_rad.unwrap()
        };
        let found = found.iter().find(near).unwrap();
        let off_m = (found.range_m - truth.range_m).abs();
        assert!(off_m <= 4.0 * found.range_deviation_m.unwrap(), "{found:?} {truth:?}");
        assert!((10.0 * found.power.log10() - truth.power_db).abs() < 1.0, "{found:?}");
    }
    let windowed = RegionChainOptions { region_window: Window::Hann, ..options };
    let refused = RegionChain::joint(&waveform, 8, &array, &windowed).err().unwrap();
    assert_eq!(refused.code(), "incompatible");
}

#[test]
fn nothing_there_makes_no_region() {
    for seed in 0..20 {
        let (waveform, array) = (waveform_3dcnn_simulated(), Array::ula(8).unwrap());
        let cube = cube(&waveform, &array, &[], seed);
        let options = RegionChainOptions::default();
        let mut chain = RegionChain::new(&waveform, 8, &options, counted(&array)).unwrap();
        let frame = chain.process(cube.index_axis(Axis(0), 0)).unwrap();
        // 5120 bins at 1e-6 each: one run in 200 would have one.
        assert!(frame.regions.is_empty() && frame.counts.cells_over_threshold == 0, "{seed}");
    }
}

#[test]
fn a_region_far_aside_is_turned_to_boresight_and_its_answers_back() {
    let (waveform, array) = (waveform_3dcnn_simulated(), Array::ula(8).unwrap());
    let targets = [target(80.0, 31.0), target(84.0, 40.0)];
    let cube = cube(&waveform, &array, &targets, 4);
    let options = RegionChainOptions::default();
    let mut finder = RegionFinder::new(&waveform, 8, &array, &options).unwrap();
    let found = finder.find(cube.index_axis(Axis(0), 0)).unwrap();
    let [region] = &found.regions[..] else { panic!("{:?}", found.regions.len()) };
    let coarse_deg = region.coarse_azimuth_rad.to_degrees();
    // The middle of the two sines is at 35.4 deg.
    assert!(region.rotated && (coarse_deg - 35.4).abs() < 1.0, "{coarse_deg}");
    // What is left has its phase even over the elements: the beam to boresight takes it all.
    let covariance = region.covariance(0.0);
    let turn: boresight_core::Complex64 = (1..8).map(|k| covariance[[k, k - 1]]).sum();
    assert!(turn.arg().abs() < 1e-6, "{turn}");
    let frame = run(&targets, &options);
    assert_at(&azimuths_deg(&frame, 0), &[31.0, 40.0]);
    // Where no turn is asked for nothing is turned.
    let options = RegionChainOptions { rotation: Rotation::Never, ..options };
    let frame = run(&targets, &options);
    assert!(!frame.regions[0].rotated);
    assert_at(&azimuths_deg(&frame, 0), &[31.0, 40.0]);
}

#[test]
fn what_moves_is_stood_still() {
    let (waveform, array) = (waveform_3dcnn_experiment(), preset("awr1642").unwrap());
    // A quarter of the unambiguous rate: 22.5 deg of phase between the transmitters, which would turn the angle by
    // some 1.5 deg.
    let rate_mps = 0.25 * waveform.max_rate_mps();
    let targets = [CubeTarget { rate_mps, ..target(10.0, 6.0) }];
    let cube = cube(&waveform, &array, &targets, 5);
    let options = RegionChainOptions::default();
    let mut chain = RegionChain::new(&waveform, 4, &options, counted(&array)).unwrap();
    let frame = chain.process(cube.index_axis(Axis(0), 0)).unwrap();
    let [region] = &frame.regions[..] else { panic!("{:?}", frame.regions) };
    assert!((region.rate_mps - rate_mps).abs() < 0.01, "{region:?}");
    assert_at(&azimuths_deg(&frame, 0), &[6.0]);
    let mut finder = RegionFinder::new(&waveform, 4, &array, &options).unwrap();
    let found = finder.find(cube.index_axis(Axis(0), 0)).unwrap();
    // Chirps alike: the middle bin holds one number an element.
    let middle = found.regions[0].region.index_axis(Axis(0), 32);
    for element in middle.rows() {
        let apart = (element[3] / element[0]).arg();
        assert!(apart.abs() < 0.3, "{apart}");
    }
}

#[test]
fn limits_and_reach_decide_what_becomes_a_region() {
    let targets = [target(80.0, -4.0), target(100.0, 3.0), target(200.0, 1.0)];
    let all = RegionChainOptions::default();
    let frame = run(&targets, &all);
    assert_eq!(frame.regions.iter().map(|region| region.peaks).sum::<usize>(), 3);
    assert_eq!((frame.regions.len(), frame.counts.joined), (2, 1));
    // Ten bins apart only what is within reach belongs together.
    let near = RegionChainOptions { reach_bins: Some(10), ..all };
    let frame = run(&targets, &near);
    assert_eq!((frame.regions.len(), frame.counts.joined), (3, 0));
    for region in &frame.regions {
        let truth = targets.iter().find(|t| (t.range_m - region.range_m).abs() < 1.0).unwrap();
        let strongest_rad = region.targets[0].azimuth_rad;
        assert!((strongest_rad - truth.direction.azimuth_rad).abs() < 0.02, "{region:?}");
    }
    let most = RegionChainOptions { max_regions: 1, ..near };
    let frame = run(&targets, &most);
    assert_eq!((frame.regions.len(), frame.counts.beyond_limit), (1, 2));
    let region = Region { range_m: Some([90.0, 120.0]), ..Region::default() };
    let frame = run(&targets, &RegionChainOptions { region, ..all });
    assert_eq!((frame.regions.len(), frame.counts.outside_region), (1, 2));
    // Its own region is 32 bins to either side; the stronger neighbour's main lobe is not in it.
    assert_at(&azimuths_deg(&frame, 0), &[3.0]);
    let region = Region { azimuth_rad: Some([0.0, 1.0]), ..Region::default() };
    let frame = run(&targets, &RegionChainOptions { region, ..near });
    assert_eq!(frame.regions.len(), 3);
    let left: Vec<f64> =
        frame.regions.iter().flat_map(|r| &r.targets).map(|t| t.azimuth_rad).collect();
    assert!(left.len() >= 2 && left.iter().all(|&azimuth| azimuth >= 0.0), "{left:?}");
    let sources: usize = frame.regions.iter().map(|region| region.sources).sum();
    assert_eq!(frame.counts.outside_region, sources - left.len());
}

#[test]
fn what_does_not_fit_is_refused() {
    let (waveform, array) = (waveform_3dcnn_simulated(), Array::ula(8).unwrap());
    let options = RegionChainOptions::default();
    let refused = |waveform: &Waveform, options: &RegionChainOptions, array: &Array| {
        let chain = RegionChain::new(waveform, 8, options, counted(array));
        let error = chain.err().unwrap();
        (error.code(), error.details().what)
    };
    let short = Waveform { samples: 64, ..waveform };
    assert_eq!(refused(&short, &options, &array), ("out-of-range", "region bins".into()));
    let few = Waveform { loops: 3, ..waveform };
    assert_eq!(refused(&few, &options, &array), ("out-of-range", "region chirps".into()));
    let other = Array::ula(7).unwrap();
    assert_eq!(refused(&waveform, &options, &other).0, "channels");
    let none = RegionChainOptions { max_regions: 0, ..options };
    assert_eq!(refused(&waveform, &none, &array).1, "max_regions");
    let wide = CfarOptions { training_cells: [0, 0], ..CfarOptions::default() };
    let wide = RegionChainOptions { cfar: wide, ..options };
    assert_eq!(refused(&waveform, &wide, &array).0, "out-of-range");
    let mut chain = RegionChain::new(&waveform, 8, &options, counted(&array)).unwrap();
    let mut frame = cube(&waveform, &array, &[target(80.0, 0.0)], 1);
    let cut = frame.slice(ndarray::s![0, .., .., .., ..200]);
    assert_eq!(chain.process(cut).unwrap_err().code(), "shape");
    frame[[0, 1, 0, 3, 17]].re = f32::NAN;
    assert_eq!(chain.process(frame.index_axis(Axis(0), 0)).unwrap_err().code(), "not-finite");
    // It works on after an error, over several frames, until it is told to stop.
    frame[[0, 1, 0, 3, 17]].re = 0.0;
    let source = CubeFrames(frame.view());
    let mut results = vec![];
    let go = &mut |_| ControlFlow::Continue(());
    chain.each(&source, 0..1, |result| results.push(result), go).unwrap();
    assert_eq!((results.len(), results[0].regions.len()), (1, 1));
    let stopped = chain.each(&source, 0..1, |_| (), &mut |_| ControlFlow::Break(()));
    assert!(matches!(stopped, Err(PipelineError::Cancelled { done: 0, total: 1 })));
}

#[test]
fn windows_of_detection_and_of_regions_are_each_their_own() {
    // 40 bins beside a target 50 dB stronger, whose sidelobes have fallen by 42 dB there: they hide the weak one unless
    // there is a window. It is 19 dB above the noise of a bin.
    let weak = CubeTarget { power_db: -10.0, ..target(120.2, 5.0) };
    let targets = [CubeTarget { power_db: 40.0, ..target(80.5, -2.0) }, weak];
    let sees = |range_window, region_window| {
        let options = RegionChainOptions { range_window, region_window, ..Default::default() };
        let frame = run(&targets, &options);
        frame.regions.iter().any(|region| (region.range_m - 120.2).abs() < 1.0)
    };
    assert!(!sees(Window::Rectangular, Window::Rectangular));
    assert!(sees(Window::Hann, Window::Rectangular));
}
