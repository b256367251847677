use super::table::{write_detections, write_motion};
use super::{DriveFormat, DriveRead, DropReason, delphi, open};
use crate::error::FormatError;
use boresight_core::Diagnose;
use boresight_core::drive::{Detection, Pose, Scan};
use std::f64::consts::FRAC_PI_2;
use std::io::Write;

const RADAR: &[u8] = include_bytes!("../../../../recordings/delphi/front_radar.csv.gz");
const POSE: &[u8] = include_bytes!("../../../../recordings/delphi/pose_10hz.csv.gz");

fn gzip(text: &str) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(vec![], flate2::Compression::fast());
    packer.write_all(text.as_bytes()).unwrap();
    packer.finish().unwrap()
}

fn read(files: &[(&str, &str)]) -> Result<DriveRead, FormatError> {
    let files: Vec<_> = files.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    open(&files, None)
}

const HEAD: &str = "frame,t_s,track_id,status,range_m,azimuth_rad,range_rate_mps\n";
const POSE_HEAD: &str = "t_s,east_m,north_m,yaw_rad,vx_lidar_mps,vy_lidar_mps,yaw_rate_radps\n";

/// The counts are those awk finds in the files.
#[test]
fn the_recording_is_read_whole() {
    let read = open(&[("pose.csv.gz", POSE), ("radar.csv.gz", RADAR)], None).unwrap();
    assert_eq!(read.format, DriveFormat::Delphi);
    let (log, report) = (&read.log, &read.report);
    assert_eq!((report.detections, report.motion), (307_397, 5997));
    let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
    assert_eq!(report.drops().collect::<Vec<_>>(), [(DropReason::InvalidMarker, 192)]);
    assert_eq!(kept, 307_397 - 192);
    assert_eq!((log.scans.len(), log.motion.len()), (12_003, 5997));
    assert!(log.scans.is_sorted_by(|a, b| a.time_s < b.time_s));
    assert_eq!(log.sensors[0].mounting.unwrap().x_m, 3.4);
}

#[test]
fn frames_become_scans_and_what_is_left_out_is_counted() {
    let radar = format!(
        "{HEAD}7,1.0,1,3,10,0.1,-5\n7,1.2,2,0,10,0.1,-5\n7,1.2,3,6,10,0.1,-5\n7,1.2,4,3,10,0.1,-81.9\n\
         7,1.2,1,3,10,0.1,-5\n7,1.2,5,3,10,nan,-5\n7,1.2,6,3,inf,0.1,1e300\n8,2,1,3,nan,-0.2,4\n9,inf,1,3,1,1,1\n"
    );
    let read = read(&[("radar.csv", &radar)]).unwrap();
    let scans = &read.log.scans;
    assert_eq!(scans.len(), 2);
    assert!((scans[0].time_s - (1.0 + 6.0 * 1.2) / 7.0).abs() < 1e-12);
    assert_eq!(scans.iter().map(|s| s.detections.len()).collect::<Vec<_>>(), [1, 1]);
    assert_eq!(scans[1].detections[0].azimuth_rad, -0.2);
    assert!(scans[1].detections[0].range_m.is_nan());
    let drops: Vec<_> = read.report.drops().collect();
    assert_eq!(
        drops,
        [
            (DropReason::NotFinite, 2),
            (DropReason::InvalidMarker, 2),
            (DropReason::Status, 2),
            (DropReason::Duplicate, 1),
        ]
    );
    assert_eq!(read.report.detections, 9);
}

#[test]
fn poses_are_moved_to_the_axle_and_turned_to_where_the_car_drives_and_speed_has_a_sign() {
    let heading = FRAC_PI_2 - delphi::HEADING_OFFSET_RAD;
    let pose = format!(
        "{POSE_HEAD}0,10,20,{heading},3,4,0.1\n0,10,20,0,3,4,0.1\n1,10,20,0,-3,-4,0.2\n2,10,20,0,nan,1,0\n"
    );
    let read =
        read(&[("pose.csv", &pose), ("radar.csv", &format!("{HEAD}0,0,1,3,9,0,1\n"))]).unwrap();
    let motion = &read.log.motion;
    assert_eq!(motion.len(), 2);
    let Pose { x_m, y_m, yaw_rad } = motion[0].pose.unwrap();
    assert!((yaw_rad - FRAC_PI_2).abs() < 1e-12);
    assert!((x_m - 10.0).abs() < 1e-12 && (y_m - (20.0 - delphi::POSE_AHEAD_M)).abs() < 1e-12);
    assert_eq!((motion[0].speed_mps, motion[1].speed_mps), (Some(5.0), Some(-5.0)));
    assert_eq!(read.report.dropped(DropReason::MotionDuplicate), 1);
    assert_eq!(read.report.dropped(DropReason::MotionNotFinite), 1);
}

const DETECTIONS_CSV: &str = "sensor,time_s,azimuth_deg,range_rate_mps,rcs_dbsm\n\
    3,0.1,90,-5,\n1,0.05,-180,2.5,7\n3,0.1,0,1,-3\n3,0.2,0,1,-3\n";
const MOTION_CSV: &str = "time_s,yaw_rate_degps,x_m,y_m,yaw_rad\n0,180,1,2,3\n1,-90,1,2,3\n";

#[test]
fn general_tables_plain_and_packed_are_the_same() {
    let plain = read(&[("a.csv", DETECTIONS_CSV), ("b.csv", MOTION_CSV)]).unwrap();
    assert_eq!(plain.format, DriveFormat::Csv);
    let log = &plain.log;
    assert_eq!(log.sensors.iter().map(|s| s.id).collect::<Vec<_>>(), [1, 3]);
    let scans: Vec<_> =
        log.scans.iter().map(|s| (s.time_s, s.sensor, s.detections.len())).collect();
    assert_eq!(scans, [(0.05, 1, 1), (0.1, 3, 2), (0.2, 3, 1)]);
    assert_eq!(log.scans[1].detections[0].azimuth_rad, std::f32::consts::FRAC_PI_2);
    assert!(log.scans[1].detections[0].rcs_dbsm.is_nan());
    assert_eq!(log.scans[0].detections[0].rcs_dbsm, 7.0);
    assert_eq!(log.motion[1].yaw_rate_radps, -FRAC_PI_2);
    assert_eq!(log.motion[0].speed_mps, None);
    assert_eq!(log.motion[0].pose, Some(Pose { x_m: 1.0, y_m: 2.0, yaw_rad: 3.0 }));
    let (a, b) = (gzip(DETECTIONS_CSV), gzip(MOTION_CSV));
    let packed = open(&[("b.csv.gz", &b), ("a.csv.gz", &a)], Some(DriveFormat::Csv)).unwrap();
    // NaN keeps them from being equal as they are.
    assert_eq!(format!("{packed:?}"), format!("{plain:?}"));
}

#[test]
fn what_is_written_as_tables_is_read_back() {
    let mut log = open(&[("pose.csv.gz", POSE), ("radar.csv.gz", RADAR)], None).unwrap().log;
    log.motion[3].speed_mps = None;
    log.motion[4].pose = None;
    log.scans[0].detections[0].range_m = f32::NAN;
    let (mut detections, mut motion) = (vec![], vec![]);
    write_detections(&log, &mut detections).unwrap();
    write_motion(&log, &mut motion).unwrap();
    let back = open(&[("d.csv", &detections), ("m.csv", &motion)], None).unwrap();
    assert_eq!(back.log.motion, log.motion);
    log.scans.retain(|scan| !scan.detections.is_empty());
    // NaN keeps them from being equal as they are.
    assert!(back.log.scans[0].detections[0].range_m.is_nan());
    log.scans[0].detections[0].range_m = 0.0;
    let mut scans = back.log.scans;
    scans[0].detections[0].range_m = 0.0;
    // The Delphi's cross-sections are not recorded.
    let bits = |scans: &[Scan]| -> Vec<_> {
        let number = |d: &Detection| [d.azimuth_rad, d.range_rate_mps, d.range_m].map(f32::to_bits);
        let row = |s: &Scan| (s.time_s, s.detections.iter().map(number).collect::<Vec<_>>());
        scans.iter().map(row).collect()
    };
    assert!(bits(&scans) == bits(&log.scans));
    assert_eq!(back.report.motion_incomplete, 2);
}

fn message(files: &[(&str, &str)]) -> String {
    read(files).unwrap_err().to_string()
}

#[test]
fn errors_name_file_line_and_column() {
    let one = |text: &str| message(&[("d.csv", text)]);
    let lines = [
        (one(""), "column time_s in d.csv"),
        (one("time_s,azimuth_rad,range_rate_mps\n"), "line 2: the table in d.csv is empty"),
        (one("time_s,range_rate_mps\n1,2\n"), "line 1: column azimuth_rad or azimuth_deg in d.csv"),
        (one("time_s,azimuth_rad,range_rate_mps\n1,2,3\n1,x,3\n"), "line 3: azimuth_rad in d.csv"),
        (one("time_s,azimuth_rad,range_rate_mps\n1,45,3\n"), "line 2: azimuth_rad in d.csv"),
        (one("time_s,azimuth_rad,range_rate_mps\n1,2\n"), "line 2: the line in d.csv"),
        (one("time_s,azimuth_rad,range_rate_mps\n2,0,3\n1,0,3\n"), "line 3: time runs backwards"),
        (one("sensor,time_s,azimuth_rad,range_rate_mps\n256,2,0,3\n"), "line 2: sensor in d.csv"),
        (one(&format!("{HEAD}1,1,1,3,9,0,x\n")), "line 2: range_rate_mps in d.csv"),
        (one("frame,t_s\n1,1\n"), "line 1: column azimuth_rad in d.csv"),
        (
            message(&[("d.csv", DETECTIONS_CSV), ("m.csv", "time_s,yaw_rate_radps,x_m\n1,2,3\n")]),
            "line 1: column y_m in m.csv",
        ),
        (
            message(&[("d.csv", DETECTIONS_CSV), ("m.csv", "time_s,yaw_rate_radps\n1,2\n0,2\n")]),
            "motion, line 3: time runs backwards",
        ),
        (message(&[("d.csv", DETECTIONS_CSV), ("e.csv", DETECTIONS_CSV)]), "both d.csv and e.csv"),
        (message(&[]), "no files"),
        (message(&[("m.csv", MOTION_CSV)]), "column azimuth_rad or azimuth_deg in m.csv"),
        (message(&[("a.txt", "a"), ("b.txt", "b")]), "a.txt, b.txt"),
    ];
    for (given, part) in lines {
        assert!(given.contains(part), "{given:?} does not say {part:?}");
    }
}

#[test]
fn damaged_packs_are_refused_and_other_files_remarked_on() {
    let whole = gzip(DETECTIONS_CSV);
    let error = open(&[("a.csv.gz", &whole[..whole.len() - 9])], None).unwrap_err();
    assert_eq!(error.code(), "malformed-gzip");
    let bomb = gzip(&format!("{DETECTIONS_CSV}{}", " ".repeat(40 << 20)));
    let error = open(&[("a.csv.gz", &bomb)], None).unwrap_err();
    assert!(error.to_string().contains("unpacks to more than"), "{error}");
    let read = read(&[("a.csv", DETECTIONS_CSV), ("notes.txt", "hello")]).unwrap();
    assert_eq!(read.report.remarks.len(), 1);
    assert_eq!(read.report.remarks[0].code, "ignored-file");
}
