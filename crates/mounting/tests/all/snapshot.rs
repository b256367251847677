//! Calibrations that are kept, go on elsewhere, and are merged.

use crate::common::Drive;
use boresight_core::{Detection, Diagnose, Random};
use boresight_mounting::{
    CalibrationOptions, Calibrator, FrameInput, Method, MountingError, Recursive, merge,
};
use proptest::prelude::*;

fn options(drive: &Drive) -> CalibrationOptions {
    CalibrationOptions {
        nominal_rad: Some(drive.angle_rad + 0.02),
        ..drive.options(Method::Recursive)
    }
}

struct Kept {
    time_s: f64,
    detections: Vec<Detection>,
    yaw_rate_radps: Option<f64>,
    speed_mps: Option<f64>,
}

impl Kept {
    fn input(&self) -> FrameInput<'_> {
        FrameInput {
            time_s: self.time_s,
            detections: &self.detections,
            yaw_rate_radps: self.yaw_rate_radps,
            speed_mps: self.speed_mps,
        }
    }
}

fn frames(drive: &Drive, speed_known: bool) -> Vec<Kept> {
    let mut frames = vec![];
    drive.run(|frame, _| {
        frames.push(Kept {
            time_s: frame.time_s,
            detections: frame.detections.to_vec(),
            yaw_rate_radps: frame.yaw_rate_radps,
            speed_mps: frame.speed_mps.filter(|_| speed_known),
        });
    });
    frames
}

#[test]
fn a_restored_calibration_goes_on_to_the_last_digit_at_every_cut() {
    for (nominal, speed_known) in [(true, true), (true, false), (false, false)] {
        let drive = Drive { frames: 260, standing: 20, detections: 24, ..Drive::default() };
        let frames = frames(&drive, speed_known);
        let options = CalibrationOptions {
            nominal_rad: nominal.then_some(drive.angle_rad + 0.02),
            ..options(&drive)
        };
        let mut whole = Calibrator::new(options).unwrap();
        let mut cut = Calibrator::new(options).unwrap();
        let mut largest = 0;
        for frame in &frames {
            let bytes = cut.snapshot().unwrap();
            largest = largest.max(bytes.len());
            cut = Calibrator::restore(&bytes, None).unwrap();
            assert_eq!(cut.snapshot().unwrap(), bytes);
            assert_eq!(whole.add(frame.input()), cut.add(frame.input()));
            assert_eq!(whole.estimate(), cut.estimate());
        }
        println!("largest snapshot: {largest} bytes");
        assert!(largest < 16_384, "{largest}");
    }
}

#[test]
fn other_methods_have_no_snapshot() {
    let error = Calibrator::new(Drive::default().options(Method::LeastSquares))
        .unwrap()
        .snapshot()
        .unwrap_err();
    assert_eq!((error.code(), &*error.details().given), ("incompatible", "least-squares"));
}

#[test]
fn bytes_that_are_no_snapshot_are_refused_by_name() {
    let drive = Drive { frames: 120, ..Drive::default() };
    let bytes = drive.calibrate(options(&drive)).snapshot().unwrap();
    let refused_as = |code: &str, bytes: &[u8], given: &str| {
        let error = Calibrator::restore(bytes, None).unwrap_err();
        assert_eq!(error.code(), code);
        assert!(error.details().given.contains(given), "{error}");
    };
    let refused = |bytes: &[u8], given: &str| refused_as("malformed-snapshot", bytes, given);
    refused(&[], "0 bytes");
    refused(b"RIFF....", "8 bytes");
    refused(&bytes[..bytes.len() - 1], "checksum");
    // A later version may have another checksum.
    for version in [0, 2, bytes[4] + 1, u8::MAX] {
        let mut other = bytes.clone();
        other[4] = version;
        refused_as("unsupported-snapshot", &other, &format!("version {version}"));
    }
    let mut other = bytes.clone();
    other[200] ^= 1;
    refused(&other, "checksum");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: proptest::test_runner::RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// With a checksum made to fit: what is restored does not panic.
    #[test]
    fn damaged_snapshots_are_refused_or_go_on(
        seed in 0..1000u64,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::weighted(0.2, any::<prop::sample::Index>()),
    ) {
        let drive = Drive { frames: 110, standing: 10, detections: 12, seed, ..Drive::default() };
        let mut bytes = drive.calibrate(options(&drive)).snapshot().unwrap();
        bytes.truncate(bytes.len() - 4);
        for (at, value) in damage {
            let at = 5 + at.index(bytes.len() - 5);
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(5 + cut.index(bytes.len() - 5));
        }
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        if let Ok(mut restored) = Calibrator::restore(&bytes, None) {
            let start_s = 1e6;
            let mut refused = 0;
            drive.run(|frame, _| {
                refused += usize::from(restored.add(FrameInput { time_s: start_s + frame.time_s, ..frame }).is_err());
            });
            let _ = (restored.estimate(), refused);
        }
    }
}

#[test]
fn drives_are_merged_with_a_bias_each() {
    let (mut squares, mut within, mut alone) = (0.0, 0, 0.0);
    let trials = 40;
    for trial in 0..trials {
        let mut random = Random::new(trial, 3);
        let scale = 1.0 + 0.02 * random.normal();
        let drives: Vec<Drive> = (0..4)
            .map(|k| Drive {
                seed: 10 * trial + k,
                scale,
                bias_radps: 0.1_f64.to_radians() * random.normal(),
                frames: 270,
                standing: 0,
                detections: 20,
                speed_swing: 0.1,
                ..Drive::default()
            })
            .collect();
        let calibrated: Vec<Recursive> = drives
            .iter()
            .map(|drive| {
                let bytes = drive.calibrate(options(drive)).snapshot().unwrap();
                Recursive::restore(&bytes).unwrap()
            })
            .collect();
        let merged = merge(&calibrated).unwrap();
        assert_eq!(merged.frames.given, 4 * 270);
        let error = merged.angle_rad - drives[0].angle_rad;
        squares += error * error;
        within += usize::from(error.abs() < 2.0 * merged.sigma_rad);
        let first = calibrated[0].estimate();
        alone += (first.angle_rad - drives[0].angle_rad).powi(2);
        assert!(merged.sigma_rad < first.sigma_rad, "{merged:?} {first:?}");
    }
    println!("merged {squares:e}, alone {alone:e}, {within} of {trials} within two");
    // Four drives have a quarter of the variance, which 40 trials know to 22 % each: a half is three of these off.
    assert!(squares < 0.5 * alone, "{squares} {alone}");
    // 95 of 100 less three times 3.4.
    assert!(within >= 34, "{within}");
    assert_eq!(merge(&[]).unwrap_err().code(), "empty");
    let moved = Drive { x_m: 2.0, frames: 5, ..Drive::default() };
    let [one, other] = [Drive { frames: 5, ..Drive::default() }, moved]
        .map(|drive| Recursive::new(&options(&drive)).unwrap());
    assert!(matches!(
        merge(&[one, other]),
        Err(MountingError::UnlikeSnapshots { what, expected: 3.86, given: 2.0 }) if what == "x_m"
    ));
}
