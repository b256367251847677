//! The recursive estimator against drives of which the truth is known.

use crate::size::sized;
use crate::support::{Drive, detection, without_real_errors};
use boresight_core::{Diagnose, Random};
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, FrameInput, MountingError, Recursive, Remark, Verdict,
};

fn options(drive: &Drive) -> CalibrationOptions {
    CalibrationOptions {
        x_m: drive.x_m,
        y_m: drive.y_m,
        nominal_rad: Some(drive.angle_rad + 0.05),
        ..without_real_errors(CalibrationOptions::default())
    }
}

fn run(drive: &Drive, options: &CalibrationOptions) -> AngleEstimate {
    let mut recursive = Recursive::new(options).unwrap();
    for frame in drive.frames() {
        recursive
            .add(FrameInput {
                time_s: frame.time_s,
                detections: &frame.detections,
                yaw_rate_radps: Some(frame.yaw_rate_radps),
                speed_mps: None,
            })
            .unwrap();
    }
    recursive.estimate()
}

#[test]
fn without_noise_the_truth_comes_back() {
    for angle_rad in [0.0, 0.436, -1.484, 3.05] {
        let drive = Drive { angle_rad, noise: 0.0, moving: 0.0, ..Drive::default() };
        let result = run(&drive, &options(&drive));
        // Detections are single precision, and the unknowns have priors.
        assert!((result.angle_rad - angle_rad).abs() < 1e-4, "{angle_rad} {result:?}");
        assert!((result.scale - 1.0).abs() < 1e-3, "{result:?}");
        assert_eq!(
            result.frames.used + result.frames.standing + result.frames.slow,
            result.frames.given
        );
    }
}

#[test]
fn scale_and_bias_are_found_with_the_angle() {
    let drive = Drive { scale: 1.02, bias_radps: 0.003, duration_s: 200.0, ..Drive::default() };
    let result = run(&drive, &options(&drive));
    let within =
        |error: f64, sigma: f64| assert!(error.abs() < 4.0 * sigma, "{error} {sigma} {result:?}");
    within(result.angle_rad - drive.angle_rad, result.sigma_rad);
    within(result.scale - 1.02, result.scale_sigma);
    within(result.bias_radps - 0.003, result.bias_sigma_radps);
    assert!(result.sigma_rad < 0.05_f64.to_radians(), "{result:?}");
    assert!(result.converged, "{result:?}");
    assert_eq!(result.misaligned, Some(true));
}

#[test]
fn without_a_nominal_angle_a_vote_finds_where_to_begin() {
    for angle_rad in [-2.5, -0.4, 1.484] {
        let drive = Drive { angle_rad, moving: 0.4, ..Drive::default() };
        let result = run(&drive, &CalibrationOptions { nominal_rad: None, ..options(&drive) });
        let error = result.angle_rad - angle_rad;
        assert!(error.abs() < 4.0 * result.sigma_rad, "{angle_rad} {result:?}");
        assert!(result.converged && result.misaligned.is_none(), "{result:?}");
    }
}

#[test]
fn standard_deviations_are_honest_with_half_of_the_detections_moving() {
    // Drives with scale and bias drawn. The estimator is told that neither errors last nor the axle
    // slips, as it is here.
    let trials = sized(200, 50);
    let (mut one, mut two, mut sum) = (0, 0, 0.0);
    for seed in 0..trials {
        let mut random = Random::new(seed, 1);
        let drive = Drive {
            seed,
            scale: 1.0 + 0.02 * random.normal(),
            bias_radps: 0.1_f64.to_radians() * random.normal(),
            moving: 0.5,
            duration_s: 60.0,
            detections: 40,
            ..Drive::default()
        };
        let result = run(&drive, &options(&drive));
        let ratio = (result.angle_rad - drive.angle_rad) / result.sigma_rad;
        one += u32::from(ratio.abs() < 1.0);
        two += u32::from(ratio.abs() < 2.0);
        sum += ratio;
    }
    println!("within 1: {one}, within 2: {two} of {trials}; mean ratio {:.2}", sum / trials as f64);
    // Of n drives a share p scatters by sqrt(n p (1-p)) of them, and the mean of n normals by
    // 1/sqrt(n). Three and a half of these: too wide is dishonest too.
    let n = trials as f64;
    let off =
        |count, p: f64, times: f64| f64::from(count) - n * p - times * (n * p * (1.0 - p)).sqrt();
    assert!(off(one, 0.683, -3.0) >= 0.0 && off(one, 0.683, 3.5) <= 0.0, "{one}");
    assert!(off(two, 0.954, -3.0) >= 0.0, "{two}");
    assert!((sum / n).abs() < 3.5 / n.sqrt(), "{sum}");
}

#[test]
fn what_the_drive_cannot_tell_is_flagged() {
    let straight = Drive { yaw_rate_radps: 0.0, ..Drive::default() };
    let result = run(&straight, &options(&straight));
    assert!(result.remarks.contains(&Remark::ScaleUndetermined), "{result:?}");
    assert!(result.scale_sigma > 0.019);

    let central = Drive { x_m: 0.0, ..Drive::default() };
    let result = run(&central, &options(&central));
    assert!(result.remarks.contains(&Remark::ScaleUndetermined), "{result:?}");
    assert!((result.angle_rad - central.angle_rad).abs() < 4.0 * result.sigma_rad);

    let parked = Drive { speed_mps: 0.0, yaw_rate_radps: 0.0, ..Drive::default() };
    let result = run(&parked, &options(&parked));
    assert_eq!(result.frames.used, 0);
    assert!(result.sigma_rad.is_infinite());
    assert!(result.remarks.contains(&Remark::NoFrames));

    // At one yaw rate and one speed angle, scale, bias and slip are one unknown: what is seen is
    // shared out by their priors, and the angle stays as uncertain as they leave it.
    let circle = Drive { constant: true, ..Drive::default() };
    let real = CalibrationOptions::default();
    let options = options(&circle);
    let options = CalibrationOptions {
        slip_gradient_sigma_rad: real.slip_gradient_sigma_rad,
        delay_sigma_s: real.delay_sigma_s,
        ..options
    };
    let result = run(&circle, &options);
    assert!(result.remarks.contains(&Remark::BiasUndetermined), "{result:?}");
    assert!(!result.converged, "{result:?}");
    assert!(result.sigma_rad > 0.3_f64.to_radians(), "{result:?}");
    assert!((result.angle_rad - circle.angle_rad).abs() < 3.0 * result.sigma_rad, "{result:?}");
}

#[test]
fn poor_frames_are_counted_and_change_nothing() {
    let options =
        CalibrationOptions { x_m: 3.0, nominal_rad: Some(0.1), ..CalibrationOptions::default() };
    let mut recursive = Recursive::new(&options).unwrap();
    let one = [detection(0.1, -10.0)];
    let bad = [detection(f32::NAN, 1.0); 20];
    let same = [detection(0.2, -10.0); 20];
    for (k, detections) in [&one[..], &bad[..], &same[..], &[]].into_iter().enumerate() {
        let frame = FrameInput {
            time_s: k as f64,
            detections,
            yaw_rate_radps: Some(0.05),
            speed_mps: None,
        };
        recursive.add(frame).unwrap();
        recursive.add(FrameInput { yaw_rate_radps: None, ..frame }).unwrap();
        recursive.add(FrameInput { yaw_rate_radps: Some(9.0), ..frame }).unwrap();
    }
    let result = recursive.estimate();
    assert_eq!(result.frames.given, 12);
    assert_eq!(
        (result.frames.sparse, result.frames.without_motion, result.frames.turning),
        (4, 4, 4)
    );
    assert_eq!(result.angle_rad, 0.1);
    let backwards =
        FrameInput { time_s: 1.0, detections: &one, yaw_rate_radps: None, speed_mps: None };
    assert_eq!(
        recursive.add(backwards),
        Err(MountingError::TimeBackwards { previous: 3.0, given: 1.0 })
    );
    let refused = recursive.add(FrameInput { time_s: f64::NAN, ..backwards }).unwrap_err();
    assert_eq!((refused.code(), &*refused.details().what), ("not-finite", "time_s"));
}

#[test]
fn a_knock_raises_the_alarm_within_half_a_minute_and_is_followed_within_one() {
    for (seed, knock_rad) in [(1, 2.0_f64.to_radians()), (2, -2.0_f64.to_radians())] {
        let before = Drive { seed, duration_s: 3600.0, detections: 30, ..Drive::default() };
        let after = Drive {
            seed: seed + 10,
            angle_rad: before.angle_rad + knock_rad,
            duration_s: 75.0,
            ..before
        };
        // What is expected of real drives, in a clean one.
        let options = CalibrationOptions {
            nominal_rad: Some(before.angle_rad),
            x_m: before.x_m,
            y_m: before.y_m,
            ..CalibrationOptions::default()
        };
        let mut recursive = Recursive::new(&options).unwrap();
        let (mut driven_s, mut alarm_s, mut followed_s) = (0.0, None, None);
        let (mut last_s, mut knocked_s) = (0.0, 0.0);
        for (drive, start_s) in [(&before, 0.0), (&after, 3600.0)] {
            for frame in drive.frames() {
                let time_s = start_s + frame.time_s;
                let input = FrameInput {
                    time_s,
                    detections: &frame.detections,
                    yaw_rate_radps: Some(frame.yaw_rate_radps),
                    speed_mps: None,
                };
                let outcome = recursive.add(input).unwrap();
                if start_s == 0.0 {
                    knocked_s = time_s;
                    last_s = time_s;
                    continue;
                }
                if outcome.verdict == Verdict::Used {
                    driven_s += time_s - last_s;
                }
                last_s = time_s;
                let e = recursive.estimate();
                if alarm_s.is_none() && e.misaligned == Some(true) {
                    alarm_s = Some(driven_s);
                }
                let off = (e.angle_rad - after.angle_rad).abs();
                match followed_s {
                    None if off < 0.2_f64.to_radians() => followed_s = Some(driven_s),
                    Some(_) if off > 0.2_f64.to_radians() => followed_s = None,
                    _ => {}
                }
            }
            if start_s == 0.0 {
                let e = recursive.estimate();
                assert!(e.changed_s.is_none() && e.misaligned == Some(false), "{e:?}");
            }
        }
        let e = recursive.estimate();
        println!(
            "alarm after {alarm_s:?} s, followed after {followed_s:?} s, {:.3} +- {:.3} deg off",
            (e.angle_rad - after.angle_rad).to_degrees(),
            e.sigma_rad.to_degrees()
        );
        assert!(alarm_s.is_some_and(|time| time < 30.0), "{alarm_s:?}");
        assert!(followed_s.is_some_and(|time| time < 60.0), "{followed_s:?}");
        assert!(e.changed_s.is_some_and(|time| time > knocked_s), "{e:?}");
        assert!(e.remarks.contains(&Remark::Changed), "{e:?}");
        assert!((e.angle_rad - after.angle_rad).abs() < 3.0 * e.sigma_rad, "{e:?}");
    }
}
