//! Several radars together against each by itself.

use crate::size::sized;
use crate::support::{Drive, without_real_errors};
use boresight_core::{Diagnose, Random};
use boresight_mounting::{CalibrationOptions, FrameInput, Joint, MountingError, Recursive};

fn radars(seed: u64) -> [Drive; 3] {
    let mut random = Random::new(seed, 2);
    let scale = 1.0 + 0.02 * random.normal();
    let bias_radps = 0.1_f64.to_radians() * random.normal();
    // The third sees little and sits near the axle: alone it cannot tell the scale.
    [(-0.436, 3.86, 60), (1.484, 3.663, 60), (0.1, 0.5, 15)].map(|(angle_rad, x_m, detections)| {
        Drive { seed, angle_rad, x_m, scale, bias_radps, detections, ..Drive::default() }
    })
}

fn options(drive: &Drive) -> CalibrationOptions {
    CalibrationOptions {
        x_m: drive.x_m,
        y_m: drive.y_m,
        nominal_rad: Some(drive.angle_rad + 0.03),
        ..without_real_errors(CalibrationOptions::default())
    }
}

fn run(drives: &[Drive]) -> (Joint, Vec<Recursive>) {
    let named: Vec<(u8, CalibrationOptions)> =
        drives.iter().enumerate().map(|(id, drive)| (id as u8, options(drive))).collect();
    let mut joint = Joint::new(&named).unwrap();
    let mut alone = Vec::new();
    for (id, drive) in drives.iter().enumerate() {
        let mut recursive = Recursive::new(&options(drive)).unwrap();
        for frame in drive.frames() {
            let input = FrameInput {
                time_s: frame.time_s,
                detections: &frame.detections,
                yaw_rate_radps: Some(frame.yaw_rate_radps),
                speed_mps: None,
            };
            joint.add(id as u8, input).unwrap();
            recursive.add(input).unwrap();
        }
        alone.push(recursive);
    }
    (joint, alone)
}

#[test]
fn one_radar_by_itself_gives_what_the_recursive_method_gives() {
    let (joint, alone) = run(&radars(1)[..1]);
    let (a, b) = (joint.estimate().remove(0).1, alone[0].estimate());
    assert!((a.angle_rad - b.angle_rad).abs() < 1e-9, "{a:?} {b:?}");
    assert!((a.scale - b.scale).abs() < 1e-9);
    assert!((a.sigma_rad / b.sigma_rad - 1.0).abs() < 1e-6, "{a:?} {b:?}");
    assert!((a.scale_sigma / b.scale_sigma - 1.0).abs() < 1e-6);
    assert_eq!(a.frames, b.frames);
}

#[test]
fn together_they_share_one_scale_and_know_it_better() {
    let trials = sized(60, 15);
    let (mut within, mut scale_within, mut total) = (0, 0, 0);
    let (mut joint_squares, mut alone_squares) = (0.0, 0.0);
    for seed in 0..trials {
        let drives = radars(seed);
        let (joint, alone) = run(&drives);
        let together = joint.estimate();
        let scales: Vec<f64> = together.iter().map(|(_, e)| e.scale).collect();
        assert!(scales.windows(2).all(|pair| pair[0] == pair[1]), "{scales:?}");
        for ((drive, (_, e)), alone) in drives.iter().zip(&together).zip(&alone) {
            within += u32::from((e.angle_rad - drive.angle_rad).abs() < 2.0 * e.sigma_rad);
            scale_within += u32::from((e.scale - drive.scale).abs() < 2.0 * e.scale_sigma);
            total += 1;
            joint_squares += (e.scale - drive.scale).powi(2);
            alone_squares += (alone.estimate().scale - drive.scale).powi(2);
        }
    }
    println!(
        "angles {within}, scales {scale_within} of {total} within two; scale {joint_squares:e} {alone_squares:e}"
    );
    // Of three angles a drive, the drives are independent: 95 % less three deviations of a share.
    let share = 0.954 - 3.0 * (0.954 * 0.046 / trials as f64).sqrt();
    assert!(f64::from(within) >= share * f64::from(total), "{within}");
    assert!(f64::from(scale_within) >= share * f64::from(total), "{scale_within}");
    assert!(joint_squares < 0.5 * alone_squares, "{joint_squares} {alone_squares}");
}

#[test]
fn radars_are_named_once_and_frames_belong_to_one() {
    let what = |error: MountingError| (error.code(), error.details().what);
    assert_eq!(what(Joint::new(&[]).unwrap_err()), ("empty", "radars".into()));
    let options = CalibrationOptions::default();
    let twice = Joint::new(&[(1, options), (1, options)]).unwrap_err();
    assert_eq!(what(twice), ("out-of-range", "sensor".into()));
    let mut joint = Joint::new(&[(1, options)]).unwrap();
    let frame = FrameInput { time_s: 0.0, detections: &[], yaw_rate_radps: None, speed_mps: None };
    assert_eq!(what(joint.add(2, frame).unwrap_err()), ("out-of-range", "sensor".into()));
    assert_eq!(joint.estimate()[0].1.frames.given, 0);
}
