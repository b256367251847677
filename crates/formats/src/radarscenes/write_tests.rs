use super::write::{Packing, write};
use super::{Companions, read, sequence_names};
use crate::drive_log::{DropReason, ReadReport};
use boresight_core::Diagnose;
use boresight_core::drive::{
    Detection, DriveLog, MotionSample, Pose, RADARSCENES_SENSORS, Scan, Sensor,
};
use hdf5_pure::{CompoundTypeBuilder, FileBuilder};

fn scan(time_s: f64, sensor: u8, azimuths: &[f32]) -> Scan {
    let detection = |azimuth_rad: &f32| Detection {
        azimuth_rad: *azimuth_rad,
        range_rate_mps: -2.5,
        range_m: 20.0,
        rcs_dbsm: 1.5,
    };
    Scan {
        time_s,
        sensor,
        detections: azimuths.iter().map(detection).collect(),
        labels: azimuths.iter().map(|a| if *a > 0.0 { 11 } else { 0 }).collect(),
    }
}

/// Two radars, three scans, motion that begins 0.25 s before.
fn drive() -> DriveLog {
    let mounted = |k: usize| {
        let (id, mounting) = RADARSCENES_SENSORS[k];
        Sensor { id, mounting: Some(mounting) }
    };
    let sample = |k: u32| MotionSample {
        time_s: -0.25 + 0.01 * f64::from(k),
        yaw_rate_radps: 0.125,
        speed_mps: Some(10.0),
        pose: Some(Pose { x_m: f64::from(k), y_m: 0.5, yaw_rad: 0.25 }),
    };
    DriveLog {
        sensors: vec![mounted(0), mounted(1)],
        scans: vec![scan(0.0, 1, &[0.5, -0.25]), scan(0.05, 2, &[0.125]), scan(0.0745, 1, &[0.75])],
        motion: (0..40).map(sample).collect(),
    }
}

fn written(log: &DriveLog, packing: Packing) -> Vec<u8> {
    let mut bytes = vec![];
    write(log, &[], "sequence_1", packing, &mut bytes).unwrap();
    bytes
}

#[test]
fn what_is_written_is_read_back() {
    for packing in [Packing::Contiguous, Packing::Deflate] {
        let mut report = ReadReport::default();
        let log = read(written(&drive(), packing), Companions::default(), &mut report).unwrap();
        let mut expected = drive();
        // Times of a log begin with its first; stamps are in microseconds.
        let tidy = |time_s: f64| (time_s * 1e6).round() / 1e6;
        expected.scans.iter_mut().for_each(|s| s.time_s = tidy(s.time_s + 0.25));
        expected.motion.iter_mut().for_each(|s| s.time_s = tidy(s.time_s + 0.25));
        assert_eq!(log, expected);
        assert_eq!((report.detections, report.motion, report.drops().count()), (4, 40, 0));
    }
}

#[test]
fn the_files_beside_bring_back_empty_scans_and_mountings() {
    let mut log = drive();
    log.scans[1].detections.clear();
    log.scans[1].labels.clear();
    log.sensors[1].mounting.as_mut().unwrap().yaw_rad = -0.5;
    let mut bytes = vec![];
    let files = write(&log, &[], "night", Packing::Contiguous, &mut bytes).unwrap();
    let beside = Companions {
        scenes: Some(files.scenes.as_bytes()),
        sensors: Some(files.sensors.as_bytes()),
    };
    let mut report = ReadReport::default();
    let back = read(bytes, beside, &mut report).unwrap();
    assert_eq!(back.sensors, log.sensors);
    assert_eq!(back.scans.len(), 3);
    assert_eq!((back.scans[1].sensor, back.scans[1].detections.len()), (2, 0));
    assert_eq!((&report.remarks[..], report.sequence.unwrap().0), (&[][..], "night".to_owned()));
    assert_eq!(sequence_names(files.sequences.as_bytes()).unwrap(), ["night"]);
}

/// NaN where no estimator needs a number keeps the row; elsewhere it leaves the row out.
#[test]
fn numbers_that_are_none_are_counted() {
    let mut log = drive();
    log.scans[0].detections[0].range_m = f32::NAN;
    log.scans[0].detections[1].rcs_dbsm = f32::INFINITY;
    log.scans[1].detections[0].azimuth_rad = f32::NAN;
    log.scans[2].detections[0].range_rate_mps = f32::NAN;
    // Rows without x_seq and y_seq, and one sample without speed, one without a yaw rate.
    log.motion[0].speed_mps = None;
    log.motion[1].yaw_rate_radps = f64::NAN;
    log.motion.iter_mut().for_each(|sample| sample.pose = None);
    let mut report = ReadReport::default();
    let bytes = written(&log, Packing::Contiguous);
    let back = read(bytes, Companions::default(), &mut report).unwrap();
    assert!(back.scans[0].detections[0].range_m.is_nan());
    assert_eq!(back.scans[0].detections[0].range_rate_mps, -2.5);
    assert!(back.scans[0].detections[1].rcs_dbsm.is_nan());
    assert_eq!(back.scans.iter().map(|s| s.detections.len()).collect::<Vec<_>>(), [2, 0, 0]);
    assert_eq!((report.incomplete, report.motion_incomplete), (2, 39));
    assert_eq!(report.dropped(DropReason::NotFinite), 2);
    assert_eq!(report.dropped(DropReason::MotionNotFinite), 1);
    assert_eq!((back.motion[0].speed_mps, back.motion[1].speed_mps), (None, Some(10.0)));
    assert!(back.motion.iter().all(|sample| sample.pose.is_none()));
}

#[test]
fn a_recording_without_rows_is_refused() {
    let mut log = drive();
    log.scans.iter_mut().for_each(|scan| {
        scan.detections.clear();
        scan.labels.clear();
    });
    for packing in [Packing::Contiguous, Packing::Deflate] {
        let bytes = written(&log, packing);
        let error = read(bytes, Companions::default(), &mut ReadReport::default()).unwrap_err();
        assert!(
            error.to_string().contains("radar_data: none; expected at least one row"),
            "{error}"
        );
    }
}

/// What packs to less than a 64th is no recording but a file made to fill memory.
#[test]
fn a_recording_that_unpacks_beyond_reason_is_refused() {
    let zeros = |rows: usize| {
        let mut file = FileBuilder::new();
        let names = ["range_sc", "azimuth_sc", "rcs", "vr"];
        let builder = CompoundTypeBuilder::new().i64_field("timestamp").u8_field("sensor_id");
        let fields = names.iter().fold(builder, |builder, name| builder.f32_field(name));
        let radar = fields.u8_field("label_id").build().unwrap();
        let builder = CompoundTypeBuilder::new().i64_field("timestamp");
        let names = ["x_seq", "y_seq", "yaw_seq", "vx", "yaw_rate"];
        let odometry =
            names.iter().fold(builder, |builder, name| builder.f32_field(name)).build().unwrap();
        for (name, datatype, rows) in [("radar_data", radar, rows), ("odometry", odometry, 4)] {
            let bytes = vec![0; rows * datatype.type_size() as usize];
            let count = rows as u64;
            let dataset = file.create_dataset(name).with_compound_data(datatype, bytes, count);
            dataset.with_chunks(&[count.min(1 << 16)]).with_deflate(6);
        }
        let bytes = file.finish().unwrap();
        read(bytes, Companions::default(), &mut ReadReport::default())
    };
    assert_eq!(zeros(200_000).unwrap().scans[0].detections.len(), 200_000);
    let error = zeros(1_000_000).unwrap_err().to_string();
    assert!(error.contains("no more rows than the file can hold"), "{error}");
}

#[test]
fn scans_of_one_time_keep_apart_and_scenes_point_at_their_rows() {
    let mut log = drive();
    log.scans[1].time_s = 0.0;
    log.scans[2].time_s = 0.0;
    log.scans[1].detections.clear();
    log.scans[1].labels.clear();
    let files = write(&log, &[], "night", Packing::Contiguous, std::io::sink()).unwrap();
    let scenes: serde_json::Value = serde_json::from_str(&files.scenes).unwrap();
    assert_eq!(scenes["sequence_name"], "night");
    let [first, second, third] = ["100000250000", "100000250001", "100000250002"];
    let scene = |stamp: &str| scenes["scenes"][stamp].clone();
    assert_eq!(scene(first)["radar_indices"], serde_json::json!([0, 2]));
    assert_eq!(scene(second)["radar_indices"], serde_json::json!([2, 2]));
    assert_eq!(scene(third)["radar_indices"], serde_json::json!([2, 3]));
    assert_eq!(scene(first)["next_timestamp"].to_string(), second);
    assert_eq!(scene(first)["next_timestamp_same_sensor"].to_string(), third);
    assert_eq!(scene(third)["prev_timestamp_same_sensor"].to_string(), first);
    assert!(scene(second)["prev_timestamp_same_sensor"].is_null());
    assert_eq!(scene(first)["odometry_index"], 25);
    let sensors: serde_json::Value = serde_json::from_str(&files.sensors).unwrap();
    assert_eq!(sensors["radar_2"]["yaw"], RADARSCENES_SENSORS[1].1.yaw_rad);
}

#[test]
fn what_cannot_be_written_is_refused() {
    let code = |change: fn(&mut DriveLog), tracks: &[Vec<u32>]| {
        let mut log = drive();
        change(&mut log);
        let error = write(&log, tracks, "s", Packing::Deflate, std::io::sink()).unwrap_err();
        error.code()
    };
    assert_eq!(code(|log| log.scans.clear(), &[]), "empty");
    assert_eq!(code(|log| log.motion.clear(), &[]), "empty");
    assert_eq!(code(|log| log.scans[1].labels.clear(), &[]), "shape");
    assert_eq!(code(|_| (), &[vec![1]]), "shape");
    assert_eq!(code(|_| (), &[vec![1], vec![1], vec![1]]), "shape");
    assert_eq!(code(|log| log.scans[1].time_s = -0.125, &[]), "time-backwards");
    assert_eq!(code(|log| log.motion[1].time_s = -9.0, &[]), "out-of-range");
    assert_eq!(code(|log| log.scans[2].time_s = f64::NAN, &[]), "out-of-range");
    assert_eq!(code(|log| log.scans[2].time_s = 1e9, &[]), "out-of-range");
}

/// A device that is full.
struct Full;

impl std::io::Write for Full {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(std::io::Error::other("full"))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error() {
    let error = write(&drive(), &[], "s", Packing::Contiguous, Full).unwrap_err();
    assert!(error.code() == "not-written" && error.to_string().contains("full"), "{error}");
}
