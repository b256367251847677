use super::Companions;
use crate::drive_log::mcap::TopicOptions;
use crate::drive_log::{DriveFormat, DropReason, MountingSource, ReadReport, open, open_owned};
use crate::error::FormatError;
use boresight_core::Diagnose;
use boresight_core::drive::RADARSCENES_SENSORS;
use boresight_core::drive::{Detection, DriveLog};
use proptest::prelude::*;
use std::path::PathBuf;

fn read(bytes: Vec<u8>) -> Result<(DriveLog, ReadReport), FormatError> {
    let mut report = ReadReport::default();
    super::read(bytes, Companions::default(), &mut report).map(|log| (log, report))
}

fn read_path(path: &std::path::Path) -> Result<(DriveLog, ReadReport), FormatError> {
    let mut report = ReadReport::default();
    super::read_path(path, Companions::default(), &mut report).map(|log| (log, report))
}

fn golden(name: &str) -> PathBuf {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/radarscenes");
    PathBuf::from(folder).join(format!("{name}.h5"))
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(golden(name)).unwrap()
}

const LAYOUTS: [&str; 12] = [
    "contiguous",
    "wide",
    "narrow",
    "big_endian",
    "chunked",
    "deflated",
    "filtered",
    "growing",
    "latest_contiguous",
    "latest_chunked",
    "latest_filtered",
    "latest_growing",
];

/// The drive of `make.py`, whose odometry begins 501 us before the first scan.
fn check(log: &DriveLog, report: &ReadReport, name: &str) {
    let scans: Vec<_> = log
        .scans
        .iter()
        .map(|s| ((s.time_s * 1e6).round(), s.sensor, s.detections.len()))
        .collect();
    assert_eq!(scans, [(501.0, 1, 2), (20_501.0, 2, 0), (74_501.0, 1, 1)], "{name}");
    let nan_beside =
        Detection { azimuth_rad: 0.125, range_rate_mps: -2.25, range_m: 20.5, rcs_dbsm: -7.5 };
    assert_eq!(log.scans[0].detections[1], nan_beside, "{name}");
    assert_eq!(log.scans[0].labels, [11, 11], "{name}");
    assert_eq!(log.scans[2].detections[0].azimuth_rad, 0.75, "{name}");
    assert_eq!((report.detections, report.motion), (4, 10), "{name}");
    assert_eq!(report.drops().collect::<Vec<_>>(), [(DropReason::NotFinite, 1)], "{name}");
    assert_eq!((report.incomplete, report.motion_incomplete), (1, 0), "{name}");
    assert_eq!(log.motion.len(), 10, "{name}");
    let last = log.motion[9];
    assert_eq!(((last.time_s * 1e6).round(), last.speed_mps), (90_000.0, Some(19.0)), "{name}");
    assert_eq!(last.yaw_rate_radps, 4.5, "{name}");
    let pose = last.pose.unwrap();
    assert!((pose.x_m - 0.9).abs() < 1e-7, "{name}");
    assert_eq!((pose.y_m, pose.yaw_rad), (0.5, 0.25), "{name}");
    let mountings: Vec<_> = log.sensors.iter().map(|s| (s.id, s.mounting)).collect();
    let car = RADARSCENES_SENSORS;
    assert_eq!(mountings, [(1, Some(car[0].1)), (2, Some(car[1].1))], "{name}");
}

#[test]
fn every_layout_of_h5py_gives_the_same_drive() {
    for name in LAYOUTS {
        let (log, report) = read(bytes(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        check(&log, &report, name);
        let (log, report) = read_path(&golden(name)).unwrap();
        check(&log, &report, name);
    }
}

#[test]
fn a_sequence_is_found_among_its_files() {
    let data = bytes("filtered");
    let files = [("notes.json", &b"{}"[..]), ("set/one/radar_data.h5", &data[..])];
    let read = open(&files, None).unwrap();
    assert_eq!(read.format, DriveFormat::Radarscenes);
    assert_eq!(read.report.remarks.len(), 1);
    check(&read.log, &read.report, "opened");
    let owned = files.map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).to_vec();
    let read = open_owned(owned, None, &TopicOptions::default()).unwrap();
    check(&read.log, &read.report, "given away");
    let error = open(&[("radar_data.h5", &data[..100])], None).unwrap_err();
    assert_eq!(error.code(), "malformed-hdf5");
    assert!(error.to_string().contains("radar_data.h5"), "{error}");
    assert_eq!(open(&files, Some(DriveFormat::Csv)).unwrap_err().code(), "no-drive-log");
}

#[test]
fn what_is_missing_or_wrong_is_named() {
    for (name, code, word) in [
        ("no_vr", "malformed-hdf5", "radar_data.vr"),
        ("no_odometry", "malformed-hdf5", "odometry"),
        ("backwards", "time-backwards", "radar_data, row 2"),
    ] {
        let error = read(bytes(name)).unwrap_err();
        assert_eq!(error.code(), code, "{name}: {error}");
        assert!(error.to_string().contains(word), "{name}: {error}");
    }
    let with = |name: &str, json: &str| {
        let data = bytes("contiguous");
        open(&[("radar_data.h5", &data), (name, json.as_bytes())], None).unwrap_err()
    };
    for (name, json, word) in [
        ("sensors.json", r#"{"radar_1": {"x": 1.0, "yaw": 0.0}}"#, "radar_1 without"),
        ("sensors.json", r#"{"radar_1": {"x": 1.0"#, "sensors.json: EOF"),
        ("sensors.json", "[]", "sensors.json: invalid type"),
        ("scenes.json", "{}", "missing field `sequence_name`"),
        ("scenes.json", r#"{"sequence_name": "a", "scenes": {"soon": {}}}"#, "scenes.json: "),
    ] {
        let error = with(name, json);
        assert_eq!(error.code(), "malformed-json", "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
    let error = read(bytes("hdf5_2")).unwrap_err();
    assert!(error.to_string().contains("data layout version: 5"), "{error}");
    for other in [&b""[..], b"time_s,azimuth_rad\n", &[0_u8; 4096]] {
        let error = read(other.to_vec()).unwrap_err();
        assert_eq!(error.code(), "malformed-hdf5");
        assert!(error.to_string().contains("a whole HDF5 file"), "{error}");
    }
}

#[test]
fn mountings_are_those_of_sensors_json() {
    let data = bytes("contiguous");
    let with = |json: &str| {
        open(&[("sensors.json", json.as_bytes()), ("radar_data.h5", &data)], None).unwrap()
    };
    let read =
        with(r#"{"radar_2": {"id": 2, "x": 1, "y": -2.5, "yaw": 0.75}, "camera": {"x": 3}}"#);
    assert_eq!(read.log.sensors[0].mounting, None);
    let mounting = read.log.sensors[1].mounting.unwrap();
    assert_eq!((mounting.x_m, mounting.y_m, mounting.yaw_rad), (1.0, -2.5, 0.75));
    assert_eq!(read.report.mountings, Some(MountingSource::SensorsJson));
    let read = with("{}");
    assert!(read.log.sensors.iter().all(|sensor| sensor.mounting.is_none()));
    assert_eq!(read.report.mountings, None);
    let read = open(&[("radar_data.h5", &data)], None).unwrap();
    assert_eq!(read.report.mountings, Some(MountingSource::Format));
}

/// Scans of make.py: radar 1 at ...647501 and ...721501, radar 2 at ...667501.
const SCENES: &str = r#"{"sequence_name": "night", "category": "train", "scenes": {
    "156862647501": {"sensor_id": 1, "radar_indices": [0, 2]},
    "156862650501": {"sensor_id": 4, "radar_indices": [2, 2]},
    "156862660501": {"sensor_id": 4, "radar_indices": [2, 9]},
    "156862667501": {"sensor_id": 1, "radar_indices": [2, 2]}}}"#;

#[test]
fn scenes_json_adds_scans_and_is_held_against_the_rows() {
    let data = bytes("contiguous");
    let read = open(&[("scenes.json", SCENES.as_bytes()), ("radar_data.h5", &data)], None).unwrap();
    let scans: Vec<_> = read
        .log
        .scans
        .iter()
        .map(|s| ((s.time_s * 1e6).round(), s.sensor, s.detections.len()))
        .collect();
    let expected = [
        (501.0, 1, 2),
        (3501.0, 4, 0),
        (13_501.0, 4, 0),
        (20_501.0, 2, 0),
        (20_501.0, 1, 0),
        (74_501.0, 1, 1),
    ];
    assert_eq!(scans, expected);
    assert_eq!(read.log.sensors.iter().map(|s| s.id).collect::<Vec<_>>(), [1, 2, 4]);
    assert_eq!(read.report.sequence, Some(("night".into(), Some("train".into()))));
    let remarks: Vec<_> = read.report.remarks.iter().map(|r| r.message.as_str()).collect();
    assert!(remarks.len() == 2 && remarks[0].starts_with("1 scans of scenes.json"), "{remarks:?}");
    assert!(remarks[1].starts_with("2 scans of radar_data.h5"), "{remarks:?}");
}

/// In the B-tree of a chunked dataset a chunk's key begins with its length.
#[test]
fn a_chunk_longer_than_the_file_is_refused_before_it_is_reserved() {
    let mut file = bytes("deflated");
    let tree = file.windows(5).position(|bytes| bytes == b"TREE\x01").unwrap();
    file[tree + 24..tree + 28].copy_from_slice(&u32::MAX.to_le_bytes());
    let error = read(file).unwrap_err().to_string();
    assert!(error.contains("4294967295 bytes") && error.contains("chunks inside"), "{error}");
}

/// The tail of such a file may hold nothing, so a little may be lost; half never.
#[test]
fn truncated_files_are_refused() {
    for name in LAYOUTS {
        let whole = bytes(name);
        for length in [8, 100, whole.len() / 4, whole.len() / 2] {
            let error = read(whole[..length].to_vec()).unwrap_err();
            assert_eq!(error.code(), "malformed-hdf5", "{name} at {length}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn damaged_files_never_panic(
        which in 0..LAYOUTS.len(),
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
    ) {
        let mut file = bytes(LAYOUTS[which]);
        for (place, value) in edits {
            let at = place.index(file.len());
            file[at] = value;
        }
        file.truncate(file.len() - cut.index(file.len()) / 8);
        let length = file.len() as u64;
        if let Ok((log, report)) = read(file) {
            let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
            let dropped = report.dropped(DropReason::NotFinite);
            prop_assert_eq!(kept as u64 + dropped, report.detections);
            prop_assert!(report.detections <= (16 << 20) / 64 + length);
        }
    }

    /// Rows stay as they are, whatever the files beside say.
    #[test]
    fn damaged_json_never_panics_and_keeps_the_rows(
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        cut in any::<prop::sample::Index>(),
    ) {
        let whole = [SCENES, r#"{"radar_1": {"id": 1, "x": 3.5, "y": -1e-3, "yaw": -1.25}}"#];
        let [scenes, sensors] = whole.map(|text| {
            let mut bytes = text.as_bytes().to_vec();
            for (place, value) in &edits {
                let at = place.index(bytes.len());
                bytes[at] = *value;
            }
            bytes.truncate(bytes.len() - cut.index(bytes.len()) / 16);
            bytes
        });
        for beside in [
            Companions { scenes: Some(&scenes), sensors: None },
            Companions { scenes: None, sensors: Some(&sensors) },
        ] {
            let mut report = ReadReport::default();
            if let Ok(log) = super::read(bytes("contiguous"), beside, &mut report) {
                let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
                prop_assert_eq!(kept, 3);
                prop_assert!(log.scans.is_sorted_by(|a, b| a.time_s <= b.time_s));
                prop_assert!(log.sensors.is_sorted_by(|a, b| a.id < b.id));
            }
        }
    }
}

#[test]
fn a_chunk_index_of_impossible_size_is_refused() {
    // 2.4 KB that claim an extensible array of 2^64 chunks, with valid checksums.
    let path =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/regressions/drive_h5/huge-array-index");
    let from_bytes = read(std::fs::read(path).unwrap());
    assert!(matches!(from_bytes, Err(FormatError::Hdf5 { .. })), "{from_bytes:?}");
    let from_path = read_path(std::path::Path::new(path));
    assert!(matches!(from_path, Err(FormatError::Hdf5 { .. })), "{from_path:?}");
}
