//! Clocks that jump, and detections that no sensor measures.

use crate::common::{BATCH, Drive, detection, network};
use boresight_core::{Detection, Diagnose};
use boresight_mounting::{
    Alignment, AngleEstimate, CalibrationOptions, Calibrator, Car, FrameInput, Fusion, Joint,
    Method, MountingError, Remark,
};

/// Consecutive frames on a new time base that start a session.
const RESET_FRAMES: usize = 10;

fn options(drive: &Drive, method: Method) -> CalibrationOptions {
    CalibrationOptions { nominal_rad: Some(drive.angle_rad), ..drive.options(method) }
}

/// Adds a drive on a clock that starts at a time; returns how many frames are rejected.
fn add(calibrator: &mut Calibrator, drive: &Drive, start_s: f64) -> usize {
    let mut rejected = 0;
    drive.run(|frame, _| {
        let frame = FrameInput { time_s: start_s + frame.time_s, ..frame };
        rejected += usize::from(calibrator.add(frame).is_err());
    });
    rejected
}

fn every_method() -> impl Iterator<Item = Method> {
    BATCH.into_iter().chain([Method::Recursive])
}

fn says(estimate: &AngleEstimate, remark: Remark) -> bool {
    estimate.remarks.contains(&remark)
}

#[test]
fn a_clock_that_was_reset_starts_a_session_that_continues_the_estimate() {
    let first = Drive::default();
    let second = Drive { seed: 2, standing: 0, ..first };
    for method in every_method() {
        let o = options(&first, method);
        // After 32 bits of microseconds, after time since boot, and after frames of the year 2106.
        for (before_s, after_s) in [(4250.0, 0.0), (1e5, 3.0), (4.3e9, 1.7e9)] {
            let mut calibrator = Calibrator::new(o).unwrap();
            assert_eq!(add(&mut calibrator, &first, before_s), 0);
            let before = calibrator.estimate();
            assert_eq!(add(&mut calibrator, &second, after_s), RESET_FRAMES - 1, "{method:?}");
            let after = calibrator.estimate();
            assert_eq!((after.clock_resets, after.rejected_frames), (1, RESET_FRAMES as u64 - 1));
            assert_eq!(after.frames.given, 2 * 600 - (RESET_FRAMES as u64 - 1));
            assert!(says(&after, Remark::ClockReset) && !says(&before, Remark::ClockReset));
            assert!(!after.stale);
            let last_s = after_s + 599.0 / 13.5;
            assert!((after.last_frame_s.unwrap() - last_s).abs() < 1e-6);
            // The second drive tells as much as the first one; the other methods are limited by the bias at standstill.
            if method == Method::Recursive {
                assert!(after.sigma_rad < 0.9 * before.sigma_rad, "{after:?} {before:?}");
            }
            assert!((after.angle_rad - first.angle_rad).abs() < 4.0 * after.sigma_rad);
        }
    }
}

#[test]
fn one_initial_frame_in_the_future_costs_ten_frames() {
    let drive = Drive::default();
    for method in every_method() {
        let mut calibrator = Calibrator::new(options(&drive, method)).unwrap();
        let future =
            FrameInput { time_s: 1e9, detections: &[], yaw_rate_radps: None, speed_mps: None };
        calibrator.add(future).unwrap();
        assert_eq!(add(&mut calibrator, &drive, 0.0), RESET_FRAMES - 1);
        assert_eq!(calibrator.estimate().alignment, Some(Alignment::Aligned), "{method:?}");
    }
}

#[test]
fn late_frames_start_no_session() {
    let drive = Drive { frames: 300, ..Drive::default() };
    for method in [Method::Recursive, Method::LeastSquares] {
        let mut calibrator = Calibrator::new(options(&drive, method)).unwrap();
        let mut on_time = Calibrator::new(options(&drive, method)).unwrap();
        let empty =
            |time_s| FrameInput { time_s, detections: &[], yaw_rate_radps: None, speed_mps: None };
        let mut late = 0;
        drive.run(|frame, _| {
            assert_eq!(calibrator.add(frame).unwrap(), on_time.add(frame).unwrap());
            // A second radar whose clock is behind, late frames, and a clock that does not run.
            for time_s in [frame.time_s - 100.0, frame.time_s - 1.0, -5.0] {
                let error = calibrator.add(empty(time_s)).unwrap_err();
                assert_eq!(error.code(), "time-backwards");
                late += 1;
            }
        });
        // Twenty frames that were kept back for a few seconds.
        let last_s = on_time.estimate().last_frame_s.unwrap();
        for k in 0..20 {
            let given = last_s - 8.0 + 0.1 * f64::from(k);
            let backwards = MountingError::TimeBackwards { previous: last_s, given };
            assert_eq!(calibrator.add(empty(given)), Err(backwards));
        }
        assert!(calibrator.estimate().stale && says(&calibrator.estimate(), Remark::Stale));
        for _ in 0..20 {
            calibrator.add(empty(-1e3)).unwrap_err();
            calibrator.add(empty(f64::NAN)).unwrap_err();
        }
        let next = empty(last_s + 0.1);
        assert_eq!(calibrator.add(next), on_time.add(next));
        let (found, expected) = (calibrator.estimate(), on_time.estimate());
        assert_eq!((found.clock_resets, found.rejected_frames), (0, late + 60));
        assert!(!found.stale);
        assert_eq!(found, AngleEstimate { rejected_frames: late + 60, ..expected });
    }
}

#[test]
fn a_restart_keeps_the_angle_and_drops_the_delay() {
    let drive = Drive { frames: 1200, turn_radps: 0.5, ..Drive::default() };
    let o = CalibrationOptions {
        delay_s: 0.02,
        delay_sigma_s: 0.03,
        ..options(&drive, Method::Recursive)
    };
    let mut calibrator = Calibrator::new(o).unwrap();
    add(&mut calibrator, &drive, 1e4);
    let before = calibrator.estimate();
    assert!(before.delay_sigma_s < 0.02, "{before:?}");
    calibrator.restart();
    let after = calibrator.estimate();
    assert!((after.angle_rad - before.angle_rad).abs() < 1e-9, "{after:?} {before:?}");
    assert!((after.sigma_rad / before.sigma_rad - 1.0).abs() < 1e-6);
    assert!((after.scale - before.scale).abs() < 1e-9);
    assert!((after.delay_s - o.delay_s).abs() < 1e-12);
    assert!((after.delay_sigma_s - o.delay_sigma_s).abs() < 1e-12);
    assert_eq!((after.last_frame_s, after.clock_resets, after.frames), (None, 0, before.frames));
    assert_eq!((after.converged, after.alignment), (before.converged, before.alignment));
    // Frames on the old clock, on an earlier one, and on a snapshot of the new session.
    assert_eq!(add(&mut calibrator, &Drive { seed: 2, ..drive }, 0.0), 0);
    calibrator.restart();
    let mut restored = Calibrator::restore(&calibrator.snapshot().unwrap(), None).unwrap();
    for calibrator in [&mut calibrator, &mut restored] {
        assert_eq!(add(calibrator, &Drive { seed: 3, ..drive }, -1e6), 0);
    }
    let (end, other) = (calibrator.estimate(), restored.estimate());
    assert_eq!(end, other);
    assert!(end.sigma_rad < before.sigma_rad && end.converged, "{end:?}");
    assert!((end.delay_s).abs() < 3.0 * end.delay_sigma_s + 0.02, "{end:?}");
}

#[test]
fn radars_of_a_car_and_fused_motions_start_sessions_too() {
    let drive = Drive::default();
    let o = options(&drive, Method::Recursive);
    let radars = vec![(1, o), (2, o)];
    let mut joint = Joint::new(&radars).unwrap();
    let mut cars =
        [Car::together(radars.clone()).unwrap(), Car::apart(radars.clone(), None).unwrap()];
    let mounted = [1, 2].map(|sensor| boresight_mounting::fusion::Mounted {
        sensor,
        angle_rad: drive.angle_rad,
        x_m: drive.x_m,
        y_m: drive.y_m,
    });
    let mut fusion = Fusion::new(&mounted, 0.0, &network()).unwrap();
    let mut fused = 0;
    for (session, start_s) in [5e3, 0.0].into_iter().enumerate() {
        let mut k = 0;
        drive.run(|frame, _| {
            let frame = FrameInput { time_s: start_s + frame.time_s, ..frame };
            for sensor in [1, 2] {
                let results = [
                    joint.add(sensor, frame).is_ok(),
                    cars[0].add(sensor, frame).is_ok(),
                    cars[1].add(sensor, frame).is_ok(),
                ];
                assert_eq!(results, [session == 0 || k >= RESET_FRAMES - 1; 3]);
            }
            if k < 100 {
                fused += usize::from(fusion.add(1 + (k % 2) as u8, frame).is_ok());
            }
            k += 1;
        });
    }
    assert_eq!(fused, 200 - (RESET_FRAMES - 1));
    let joint_estimates = joint.estimate();
    for (sensor, estimate) in &joint_estimates {
        assert_eq!((estimate.clock_resets, estimate.rejected_frames), (1, 9));
        assert!((estimate.angle_rad - drive.angle_rad).abs() < 4.0 * estimate.sigma_rad);
        assert_eq!(cars[0].estimate(*sensor).unwrap(), *estimate);
        assert_eq!(cars[1].estimate(*sensor).unwrap().clock_resets, 1);
    }
    for car in &mut cars {
        car.restart();
        drive.run(|frame, _| {
            car.add(1, FrameInput { time_s: frame.time_s - 1e7, ..frame }).unwrap();
        });
    }
}

/// Detections as sensors fill empty places of a list.
const INVALID: [(f32, f32); 6] = [
    (655.35 * 0.017_453_292, 0.0),
    (655.35 * 0.017_453_292, -12.0),
    (f32::NAN, -3.0),
    (-1e30, 0.0),
    (0.1, 655.35),
    (0.2, f32::INFINITY),
];

/// Adds a drive with `count` of the invalid detections in each frame, the first one after the first detection, and checks weights and counts.
fn add_invalid(drive: &Drive, invalid: &[(f32, f32)], mut add: impl FnMut(FrameInput) -> Vec<f32>) {
    drive.run(|frame, _| {
        let mut detections = frame.detections.to_vec();
        let marked: Vec<Detection> = invalid.iter().map(|&(a, r)| detection(a, r)).collect();
        detections.splice(1..1, marked);
        let weights = add(FrameInput { detections: &detections, ..frame });
        assert_eq!(weights.len(), detections.len());
        assert!(weights[1..=invalid.len()].iter().all(|weight| *weight == 0.0));
    });
}

#[test]
fn invalid_detections_are_left_out_and_counted() {
    let drive = Drive { frames: 900, ..Drive::default() };
    let off_rad = 3.0_f64.to_radians();
    // A single one as well as more than there are valid ones.
    let many = INVALID.repeat(20);
    let repeated = vec![INVALID[0]; 100];
    for invalid in [&INVALID[..1], &INVALID[4..5], &INVALID, &many, &repeated] {
        let expected = 900 * invalid.len() as u64;
        for method in every_method() {
            let o = CalibrationOptions {
                nominal_rad: Some(drive.angle_rad - off_rad),
                ..drive.options(method)
            };
            let mut clean = Calibrator::new(o).unwrap();
            let mut calibrator = Calibrator::new(o).unwrap();
            drive.run(|frame, _| {
                clean.add(frame).unwrap();
            });
            add_invalid(&drive, invalid, |frame| calibrator.add(frame).unwrap().weights);
            let (clean, estimate) = (clean.estimate(), calibrator.estimate());
            assert_eq!(estimate.alignment, Some(Alignment::Misaligned), "{method:?} {estimate:?}");
            assert_eq!(estimate.rejected_detections, expected);
            assert!(says(&estimate, Remark::InvalidDetections));
            assert!(!says(&clean, Remark::InvalidDetections));
            // All else is as without them.
            let mut same = estimate.clone();
            same.rejected_detections = 0;
            same.remarks.retain(|remark| *remark != Remark::InvalidDetections);
            assert_eq!(same, clean, "{method:?}");
        }
        let o = CalibrationOptions {
            nominal_rad: Some(drive.angle_rad - off_rad),
            ..drive.options(Method::Recursive)
        };
        let mut joint = Joint::new(&[(3, o)]).unwrap();
        add_invalid(&drive, invalid, |frame| joint.add(3, frame).unwrap().weights);
        let (_, estimate) = joint.estimate().remove(0);
        assert_eq!(estimate.alignment, Some(Alignment::Misaligned), "{estimate:?}");
        assert_eq!(estimate.rejected_detections, expected);
    }
}
