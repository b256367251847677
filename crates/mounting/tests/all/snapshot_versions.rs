//! Snapshots of earlier versions are restored and continue as they did in the version that wrote them.

use crate::common::Drive;
use boresight_mounting::{CalibrationOptions, Calibrator, Method};
use serde_json::Value;
use std::path::PathBuf;

/// Versions with fixtures, all of which must be readable.
const VERSIONS: [u8; 2] = [3, 4];
/// Allowed relative difference of a continued estimate. Mathematical functions differ in the last digit between platforms.
const TOLERANCE: f64 = 1e-9;

/// A drive in two parts: the snapshot is taken after `cut` frames of the whole.
struct Case {
    name: &'static str,
    options: CalibrationOptions,
    drives: Vec<Drive>,
    with_speed: bool,
    cut: usize,
}

fn cases() -> [Case; 3] {
    let drive = Drive { frames: 260, standing: 20, detections: 24, ..Drive::default() };
    let nominal = CalibrationOptions {
        nominal_rad: Some(drive.angle_rad + 0.02),
        ..drive.options(Method::Recursive)
    };
    let knocked = [0.0, 0.03].map(|off_rad| Drive {
        angle_rad: drive.angle_rad + off_rad,
        frames: 1000,
        ..drive
    });
    [
        Case { name: "led", options: nominal, drives: vec![drive], with_speed: true, cut: 150 },
        Case {
            name: "voting",
            options: CalibrationOptions { nominal_rad: None, ..nominal },
            drives: vec![drive],
            with_speed: false,
            cut: 26,
        },
        Case {
            name: "knocked",
            options: nominal,
            drives: knocked.to_vec(),
            with_speed: true,
            cut: 1500,
        },
    ]
}

impl Case {
    fn path(&self, version: u8, extension: &str) -> PathBuf {
        let folder = format!("{}/tests/fixtures/snapshots", env!("CARGO_MANIFEST_DIR"));
        PathBuf::from(folder).join(format!("v{version}-{}.{extension}", self.name))
    }

    /// Adds the frames in a range of places to a calibration.
    fn feed(&self, calibrator: &mut Calibrator, range: std::ops::Range<usize>) {
        let (mut place, mut start_s) = (0, 0.0);
        for drive in &self.drives {
            drive.run(|mut frame, _| {
                frame.time_s += start_s;
                frame.speed_mps = frame.speed_mps.filter(|_| self.with_speed);
                if range.contains(&place) {
                    calibrator.add(frame).unwrap();
                }
                place += 1;
            });
            start_s += drive.frames as f64 / 13.5;
        }
    }

    fn start(&self) -> Calibrator {
        let mut calibrator = Calibrator::new(self.options).unwrap();
        self.feed(&mut calibrator, 0..self.cut);
        calibrator
    }

    fn finish(&self, mut calibrator: Calibrator) -> Value {
        self.feed(&mut calibrator, self.cut..usize::MAX);
        serde_json::to_value(calibrator.estimate()).unwrap()
    }
}

/// Asserts that all that was expected is there; later versions may report more.
fn assert_near(expected: &Value, given: &Value, path: &str) {
    match (expected, given) {
        (Value::Object(expected), Value::Object(given)) => {
            for (key, expected) in expected {
                assert_near(expected, &given[key], &format!("{path}.{key}"));
            }
        }
        (Value::Array(expected), Value::Array(given)) => {
            assert_eq!(expected.len(), given.len(), "{path}: {expected:?} {given:?}");
            for (expected, given) in expected.iter().zip(given) {
                assert_near(expected, given, path);
            }
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            assert!((a - b).abs() <= TOLERANCE * a.abs(), "{path}: {a} expected, {b} found");
        }
        (expected, given) => assert_eq!(expected, given, "{path}"),
    }
}

#[test]
fn snapshots_of_all_versions_continue_as_in_the_version_that_wrote_them() {
    for case in cases() {
        for version in VERSIONS {
            let bytes = std::fs::read(case.path(version, "bin")).unwrap();
            assert_eq!(bytes[4], version);
            let expected = std::fs::read_to_string(case.path(version, "json")).unwrap();
            let restored = Calibrator::restore(&bytes, None).unwrap();
            let found = case.finish(restored);
            assert_near(&serde_json::from_str(&expected).unwrap(), &found, case.name);
        }
    }
}

/// Writes the fixtures of a new version on its first run, and fails so that they get committed.
#[test]
fn the_present_version_has_fixtures() {
    let mut written = Vec::new();
    for case in cases() {
        let calibrator = case.start();
        let bytes = calibrator.snapshot().unwrap();
        let path = case.path(bytes[4], "bin");
        if path.exists() {
            assert!(VERSIONS.contains(&bytes[4]), "add version {} to VERSIONS", bytes[4]);
            continue;
        }
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &bytes).unwrap();
        let result = serde_json::to_string_pretty(&case.finish(calibrator)).unwrap();
        std::fs::write(case.path(bytes[4], "json"), result + "\n").unwrap();
        written.push(path);
    }
    assert!(written.is_empty(), "commit these and the .json files beside them: {written:?}");
}
