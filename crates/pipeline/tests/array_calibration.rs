//! The recorded capture of an AWR1642 calibrates its own array on half of its frames; the others show it.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod recorded;

use boresight_aoa::order::counting::{CountOptions, count_sources_in};
use boresight_aoa::{Data, Method};
use boresight_array_calibration::{CalibrationOptions, CalibrationResult, CellUse, Reflector};
use boresight_core::correction::Correction;
use boresight_core::{Array, ArrayCalibration, Diagnose};
use boresight_pipeline::array_calibration::{CalibrationFrames, calibrate_array, unwatched};
use boresight_pipeline::{AngleOptions, Chain, ChainOptions};
use recorded::{board, recording};

/// What the board itself says of its strongest target, in our frame.
const BOARD_DEG: f64 = -10.8;

/// Counts with what the array's calibration leaves as mismatch.
fn counted(array: &Array, forward_backward: bool) -> CountOptions {
    let mismatch_db = array.correction().and_then(Correction::residual_db);
    CountOptions { forward_backward, mismatch_db, ..CountOptions::default() }
}

fn calibrated(options: &CalibrationOptions) -> CalibrationResult {
    let (waveform, receivers, array) = board();
    let frames = CalibrationFrames::halves(8);
    let radar = (&waveform, receivers, &array);
    calibrate_array(radar, &recording(), &frames, options, &mut unwatched).unwrap()
}

#[test]
fn half_of_the_frames_calibrate_the_board_for_the_others() {
    let result = calibrated(&CalibrationOptions::default());
    for cell in &result.cells {
        println!(
            "{:5.2} m {:6.2} deg residual {:6.1} dB snr {:4.1} dB {:?}",
            cell.range_m,
            cell.direction.azimuth_rad.to_degrees(),
            10.0 * cell.residual.log10(),
            10.0 * cell.snr.log10(),
            cell.state
        );
    }
    for c in &result.calibration.channels {
        println!(
            "{:6.2} +- {:.2} deg, {:5.2} +- {:.2} dB",
            c.phase_rad.to_degrees(),
            c.phase_std_rad.unwrap().to_degrees(),
            c.gain_db,
            c.gain_std_db.unwrap()
        );
    }
    let check = result.check.as_ref().unwrap();
    println!("before {:?}\nafter {:?}\nleft out {:?}", check.before, check.after, result.left_out);
    for cell in &check.cells {
        println!("{:5.2} m {:?} -> {:?}", cell.range_m, cell.before, cell.after);
    }
    println!("{:?} {:?}", result.calibration.residual_db, result.warnings);
    assert!(check.after.residual_phase_rad < 0.6 * check.before.residual_phase_rad);

    let (waveform, receivers, plan) = board();
    let array = plan.calibrated(&result.calibration).unwrap();
    let angle = AngleOptions { method: Method::Nomp, ..AngleOptions::default() };
    let options = ChainOptions { angle, ..ChainOptions::default() };
    for array in [&plan, &array] {
        let mut chain = Chain::new(&waveform, receivers, array, &options).unwrap();
        let seen = chain.combine(&recording(), 4..8, &mut unwatched).unwrap();
        let first: Vec<_> = seen.detections.iter().filter(|d| d.range_bin == 58).collect();
        println!("{:?}", first.iter().map(|d| d.azimuth_rad.to_degrees()).collect::<Vec<_>>());
        let snapshots = chain.cell_snapshots(&recording(), 4..8, 58, 8).unwrap();
        let count =
            count_sources_in(Data::Snapshots(snapshots.view()), &counted(array, false)).unwrap();
        let both =
            count_sources_in(Data::Snapshots(snapshots.view()), &counted(array, true)).unwrap();
        println!("MDL {} forward-backward {}", count.1.sources, both.1.sources);
        assert_eq!(seen.calibrated, array.correction().is_some());
        if seen.calibrated {
            assert_eq!(first.len(), 1, "{first:?}");
            assert!((first[0].azimuth_rad.to_degrees() - BOARD_DEG).abs() < 1.0, "{first:?}");
            assert_eq!((count.1.sources, both.1.sources), (1, 1));
        } else {
            assert!(count.1.sources > 1 && both.1.sources > 1);
            assert!(first.len() > 1, "{first:?}");
        }
    }
}

#[test]
fn a_reflector_is_found_by_its_range_and_tells_the_turn() {
    let at =
        Reflector { range_m: 2.95, azimuth_rad: Some(BOARD_DEG.to_radians()), elevation_rad: 0.0 };
    let options = CalibrationOptions {
        reflectors: vec![at],
        range_bias: true,
        ..CalibrationOptions::default()
    };
    let result = calibrated(&options);
    assert_eq!(result.cells.len(), 1);
    assert_eq!(result.cells[0].state, CellUse::Used);
    assert!(result.calibration.range_bias_m.abs() < 0.05);
    assert!(result.warnings.iter().any(|w| w.code == "one-calibration-cell"));
    let check = result.check.unwrap();
    assert!((check.cells[0].azimuth_rad.to_degrees() - BOARD_DEG).abs() < 0.2, "{check:?}");
    let (waveform, receivers, array) = board();
    let far = Reflector { range_m: 8.0, ..at };
    let none = CalibrationOptions { reflectors: vec![far], ..CalibrationOptions::default() };
    let frames = CalibrationFrames::halves(8);
    let radar = (&waveform, receivers, &array);
    let error = calibrate_array(radar, &recording(), &frames, &none, &mut unwatched).unwrap_err();
    assert!(format!("{error:?}").contains("range_m of a reflector"), "{error:?}");
}

#[test]
fn range_bias_is_taken_off_and_other_boards_are_refused() {
    let (waveform, receivers, plan) = board();
    let calibration = ArrayCalibration { range_bias_m: 0.5, ..ArrayCalibration::neutral(&plan) };
    let moved = plan.calibrated(&calibration).unwrap();
    let ranges = |array: &Array| -> Vec<f64> {
        let mut chain = Chain::new(&waveform, receivers, array, &ChainOptions::default()).unwrap();
        let seen = chain.combine(&recording(), 0..2, &mut unwatched).unwrap();
        seen.detections.iter().map(|d| d.range_m).filter(|m| *m > 2.0 && *m < 8.0).collect()
    };
    let (before, after) = (ranges(&plan), ranges(&moved));
    for range in after {
        assert!(before.iter().any(|b| (b - 0.5 - range).abs() < 1e-9), "{range} {before:?}");
    }
    let other = Array::ula(8).unwrap();
    assert_eq!(other.calibrated(&calibration).unwrap_err().code(), "other-array");
}
