//! What is said of cells agrees with what the chain makes of them.

#![allow(clippy::unwrap_used)]

use boresight_core::presets::preset;
use boresight_core::{Complex32, Diagnose, Direction, Multiplexing, Waveform};
use boresight_pipeline::{Chain, ChainOptions, CubeFrames, Verdict};
use boresight_signal::{CfarKind, Region};
use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube, waveform_awr1642};
use ndarray::Array5;
use std::ops::ControlFlow;

fn target(range_m: f64, azimuth_deg: f64, power_db: f64) -> CubeTarget {
    CubeTarget {
        range_m,
        rate_mps: 0.0,
        direction: Direction::azimuth(azimuth_deg.to_radians()).into(),
        power_db,
        phase_rad: None,
    }
}

fn frames() -> Array5<Complex32> {
    let targets = [target(3.0, 20.0, 0.0), target(5.0, -40.0, -6.0)];
    let options = CubeOptions { snr_db: 10.0, seed: 12, ..CubeOptions::default() };
    simulate_cube(&waveform(), &preset("awr1642").unwrap(), &targets, &options).unwrap()
}

fn waveform() -> Waveform {
    Waveform { samples: 64, ..waveform_awr1642() }
}

fn chain(options: &ChainOptions) -> Chain {
    let array = preset("awr1642").unwrap();
    Chain::new(&waveform(), array.rx().len(), &array, options).unwrap()
}

/// Every cell: those kept are the detections, and each count is that of the verdicts.
#[test]
fn verdicts_are_what_the_chain_counts() {
    let cube = frames();
    let source = CubeFrames(cube.view());
    for kind in [CfarKind::Excision, CfarKind::OrderedStatistic, CfarKind::GreatestOf] {
        let mut options = ChainOptions::default();
        options.cfar.kind = kind;
        options.cfar.false_alarm = 0.02;
        options.angle.options.max_peaks = 1;
        options.max_detections = 2;
        options.region = Region {
            range_m: Some([1.0, 8.0]),
            rate_mps: Some([-2.0, 2.0]),
            azimuth_rad: Some([-0.5, 0.5]),
            ..Region::default()
        };
        let mut chain = chain(&options);
        let result = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
        let mut tally = std::collections::HashMap::new();
        for range_bin in 0..result.range_m.len() {
            for doppler_bin in 0..result.rate_mps.len() {
                let bins = [range_bin, doppler_bin];
                let told =
                    chain.explain(&source, 0..1, bins, &mut |_| ControlFlow::Continue(())).unwrap();
                *tally.entry(format!("{:?}", told.verdict)).or_insert(0) += 1;
                let is_one = result.detections.iter().any(|d| [d.range_bin, d.doppler_bin] == bins);
                assert_eq!(is_one, told.verdict == Verdict::Kept, "{kind:?} {told:?}");
                assert_eq!(told.power > told.threshold, told.verdict != Verdict::BelowThreshold);
                assert_eq!(told.profile_threshold[range_bin], told.threshold);
            }
        }
        let count = |verdicts: &[Verdict]| -> usize {
            verdicts.iter().map(|v| tally.get(&format!("{v:?}")).copied().unwrap_or(0)).sum()
        };
        let counts = result.counts;
        let cells = result.range_m.len() * result.rate_mps.len();
        assert_eq!(cells - count(&[Verdict::BelowThreshold]), counts.cells_over_threshold);
        assert_eq!(count(&[Verdict::Grouped]), counts.grouped);
        let outside = [Verdict::OutsideRange, Verdict::OutsideRate, Verdict::OutsideDirection];
        let left_out = counts.outside_region + counts.outside_usable_range;
        assert!(count(&outside) <= left_out && count(&outside) > 0);
        assert!(count(&[Verdict::BeyondLimit]) > 0, "{tally:?}");
    }
}

#[test]
fn echoes_in_other_doppler_bands_are_said_to_be_such() {
    let waveform =
        Waveform { multiplexing: Multiplexing::DopplerDivision, loops: 48, ..waveform() };
    let array = preset("awr1642").unwrap();
    let targets = [target(3.0, 20.0, 0.0), target(5.0, -40.0, -6.0)];
    let simulated = CubeOptions { snr_db: 10.0, seed: 12, ..CubeOptions::default() };
    let cube = simulate_cube(&waveform, &array, &targets, &simulated).unwrap();
    let source = CubeFrames(cube.view());
    let options = ChainOptions::default();
    let mut chain = Chain::new(&waveform, array.rx().len(), &array, &options).unwrap();
    let counts = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap().counts;
    let mut echoes = 0;
    for range_bin in 0..64 {
        for doppler_bin in 0..48 {
            let bins = [range_bin, doppler_bin];
            let told =
                chain.explain(&source, 0..1, bins, &mut |_| ControlFlow::Continue(())).unwrap();
            assert!(told.verdict != Verdict::BeyondLimit, "{told:?}");
            echoes += usize::from(told.verdict == Verdict::OtherBand);
        }
    }
    assert!(counts.other_bands > 0);
    assert_eq!(echoes, counts.other_bands);
}

#[test]
fn sentences_have_figures_and_bins_outside_are_refused() {
    let cube = frames();
    let source = CubeFrames(cube.view());
    let mut chain = chain(&ChainOptions::default());
    let result = chain.process(cube.index_axis(ndarray::Axis(0), 0)).unwrap();
    let first = &result.detections[0];
    let mut explain = |range_bin, doppler_bin| {
        chain.explain(&source, 0..1, [range_bin, doppler_bin], &mut |_| ControlFlow::Continue(()))
    };
    let told = explain(first.range_bin, first.doppler_bin).unwrap();
    assert!(told.message.starts_with("A detection: "), "{}", told.message);
    let told = explain(first.range_bin + 1, first.doppler_bin).unwrap();
    assert_eq!(told.verdict, Verdict::Grouped);
    assert_eq!([told.peak_range_bin, told.peak_doppler_bin], [first.range_bin, first.doppler_bin]);
    assert!(told.message.contains("1 range bin and 0 Doppler bins away"), "{}", told.message);
    // A neighbour 8 bins before has the target among its training cells, and does without it.
    let told = explain(first.range_bin - 8, first.doppler_bin).unwrap();
    assert!(told.excised_cells >= 3, "{told:?}");
    assert!(told.message.contains("left out as targets themselves"), "{}", told.message);
    let refused = explain(100_000, 0).unwrap_err();
    assert_eq!((refused.code(), &*refused.details().what), ("out-of-range", "range bin"));
}
