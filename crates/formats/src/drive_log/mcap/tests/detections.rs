//! Detections out of messages of all kinds.

use super::bag::*;
use crate::drive_log::mcap::{TopicOptions, TopicUse, read};
use crate::drive_log::{DriveRead, DropReason};
use crate::mcap::made::{channel, file, message, schema};
use crate::ros::made::{Cdr, HEADER, TIME, VECTOR};
use boresight_core::Diagnose;
use std::f64::consts::PI;

#[test]
fn point_clouds_of_any_layout_give_detections() {
    let mut bag = Bag::default();
    let id = bag.clouds("/radar/points");
    let names = ["intensity", "X", "y", "z", "Radial_Velocity", "rcs"];
    let points: [&[f32]; 4] = [
        &[9.0, 3.0, 4.0, 0.0, -5.0, 12.0],
        &[9.0, 0.0, -2.0, 0.0, 1.0, f32::NAN],
        &[9.0, 1.0, 2.0, 2.0, 0.5, 1.0],
        &[9.0, f32::NAN, 2.0, 2.0, 0.5, 1.0],
    ];
    bag.add(id, T, cloud(T, "radar", &names, &points, 2));
    let DriveRead { log, report, .. } = bag.read();
    let found: Vec<_> = log.scans[0].detections.iter().map(numbers).collect();
    let azimuth = |y: f64, x: f64| y.atan2(x) as f32;
    assert_eq!(
        found,
        [
            [5.0, azimuth(4.0, 3.0), -5.0],
            [2.0, azimuth(-2.0, 0.0), 1.0],
            [3.0, azimuth(2.0, 1.0), 0.5],
        ]
    );
    assert_eq!(log.scans[0].detections[0].rcs_dbsm, 12.0);
    assert_eq!((report.incomplete, report.dropped(DropReason::NotFinite)), (1, 1));
    // Every type of number, the bytes the other way round.
    for (datatype, size) in [(1, 1), (2, 1), (3, 2), (4, 2), (5, 4), (6, 4), (7, 4), (8, 8)] {
        let mut bag = Bag::default();
        let id = bag.clouds("/points");
        let one = |number: u8| match datatype {
            7 => f32::from(number).to_be_bytes().to_vec(),
            8 => f64::from(number).to_be_bytes().to_vec(),
            _ => [vec![0; size - 1], vec![number]].concat(),
        };
        let data: Vec<u8> = [3, 4, 7].into_iter().flat_map(one).collect();
        let mut cdr = Cdr::big_endian().header(T, "radar").u32(1).u32(1).u32(3);
        for (k, name) in ["x", "y", "v_r"].into_iter().enumerate() {
            cdr = cdr.text(name).u32((k * size) as u32).u8(datatype).u32(1);
        }
        let step = 3 * size as u32;
        bag.add(id, T, cdr.u8(1).u32(step).u32(step).bytes(&data).u8(1));
        let log = bag.read().log;
        assert_eq!(numbers(&log.scans[0].detections[0]), [5.0, azimuth(4.0, 3.0), 7.0]);
    }
}

#[test]
fn clouds_whose_points_are_not_in_their_data_are_counted_and_none_is_endless() {
    let mut bag = Bag::default();
    let id = bag.clouds("/points");
    let good: [&[f32]; 1] = [&[3.0, 4.0, 1.0]];
    bag.add(id, T, cloud(T, "radar", &["x", "y", "v"], &good, 1));
    for (height, width, step, row, bytes) in [
        (1, u32::MAX, 12, u32::MAX, 12),
        (u32::MAX, 1, 12, 0, 12),
        (u32::MAX, u32::MAX, u32::MAX, u32::MAX, 12),
        (1, u32::MAX, 0, 0, 12),
        (2, 1, 12, 12, 23),
    ] {
        let mut cdr = Cdr::new().header(T + 1, "radar").u32(height).u32(width).u32(3);
        for (k, name) in ["x", "y", "v"].into_iter().enumerate() {
            cdr = cdr.text(name).u32(4 * k as u32).u8(7).u32(1);
        }
        bag.add(id, T, cdr.u8(0).u32(step).u32(row).bytes(&vec![0; bytes]).u8(1));
    }
    let DriveRead { log, report, .. } = bag.read();
    assert_eq!((log.scans.len(), report.topics[0].unreadable), (1, 5));
    assert!(report.topics[0].note.contains("not in its data"), "{:?}", report.topics);
    assert_eq!(report.remarks[0].code, "unreadable-messages");
}

#[test]
fn what_has_no_velocity_of_its_own_is_told_and_not_used() {
    let mut bag = Bag::default();
    let (lidar, compensated) = (bag.clouds("/lidar"), bag.clouds("/radar/compensated"));
    let point: [&[f32]; 1] = [&[3.0, 4.0, 1.0]];
    let image = bag.topic(
        "/image",
        "sensor_msgs/msg/Image",
        "std_msgs/Header header\nuint8[] data",
        &[HEADER, TIME],
    );
    for _ in 0..3 {
        bag.add(lidar, T, cloud(T, "lidar", &["x", "y", "intensity"], &point, 1));
        bag.add(compensated, T, cloud(T, "radar", &["x", "y", "vr_comp"], &point, 1));
        bag.add(image, T, Cdr::new().header(T, "camera").bytes(&[1, 2]));
    }
    let error = read(&bag.bytes(), TopicOptions::default()).unwrap_err();
    assert_eq!(error.code(), "no-drive-log");
    for part in
        ["/lidar", "/radar/compensated", "not compensated", "/image", "sensor_msgs/msg/Image"]
    {
        assert!(error.to_string().contains(part), "{error}");
    }
    let radar = bag.scans("/radar");
    bag.add(radar, T, scan(T, "radar", &[[1.0, 0.0, 1.0]]));
    let report = bag.read().report;
    let told: Vec<_> = report.topics.iter().map(|t| (&*t.name, t.messages, t.used_as)).collect();
    assert_eq!(
        told,
        [
            ("/image", 3, TopicUse::Unused),
            ("/lidar", 3, TopicUse::Unused),
            ("/radar", 1, TopicUse::Radar),
            ("/radar/compensated", 3, TopicUse::Unused),
        ]
    );
}

fn tracks(bag: &mut Bag) -> u16 {
    let others = [
        HEADER,
        TIME,
        VECTOR,
        ("unique_identifier_msgs/UUID", "uint8[16] uuid"),
        ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"),
        (
            "radar_msgs/RadarTrack",
            "unique_identifier_msgs/UUID uuid\ngeometry_msgs/Point position\ngeometry_msgs/Vector3 velocity\n\
             geometry_msgs/Vector3 size\nuint16 classification\nfloat32[6] position_covariance",
        ),
    ];
    let own = "std_msgs/Header header\nradar_msgs/RadarTrack[] tracks";
    let id = bag.topic("/radar/tracks", "radar_msgs/msg/RadarTracks", own, &others);
    let mut cdr = Cdr::new().header(T, "radar").u32(1);
    for k in 0..16 {
        cdr = cdr.u8(k);
    }
    let cdr = cdr.f64s(&[6.0, 8.0, 0.0]).f64s(&[-5.0, 10.0, 3.0]).f64s(&[0.0; 3]).u16(3);
    let cdr = (0..6).fold(cdr, |cdr, _| cdr.f32(0.1));
    bag.add(id, T, cdr);
    id
}

#[test]
fn tracks_are_read_where_there_are_no_detections_and_said_to_be_tracks() {
    let mut bag = Bag::default();
    tracks(&mut bag);
    let DriveRead { log, report, .. } = bag.read();
    let rate = (-5.0 * 6.0 + 10.0 * 8.0) / 10.0;
    assert_eq!(numbers(&log.scans[0].detections[0]), [10.0, 8.0_f64.atan2(6.0) as f32, rate]);
    assert_eq!(report.topics[0].used_as, TopicUse::Tracks);
    assert!(report.topics[0].note.contains("filtered"));
    let radar = bag.scans("/radar/scan");
    bag.add(radar, T, scan(T, "radar", &[[1.0, 0.0, 1.0]]));
    let both = bag.read();
    assert_eq!((both.log.sensors.len(), both.report.topics[1].used_as), (1, TopicUse::Unused));
    let named =
        TopicOptions { radar_topics: vec!["/radar/tracks".into()], ..TopicOptions::default() };
    let read = read(&bag.bytes(), named).unwrap();
    assert_eq!((read.log.scans.len(), read.report.topics[0].used_as), (1, TopicUse::Unused));
    assert_eq!(read.report.topics[1].used_as, TopicUse::Tracks);
}

#[test]
fn vendors_messages_are_known_by_the_names_of_their_fields() {
    let mut bag = Bag::default();
    let own = "std_msgs/Header header\nuint8 count\nars_msgs/Cluster[2] clusters";
    let cluster = (
        "ars_msgs/Cluster",
        "uint8 id\nfloat64 dist_long\nfloat64 dist_lat\nfloat64 vrel_long\nfloat64 vrel_lat\nfloat64 rcs",
    );
    let id = bag.topic("/ars408", "ars_msgs/msg/ClusterList", own, &[HEADER, TIME, cluster]);
    let cdr = Cdr::new().header(T, "ars").u8(2);
    let cdr = cdr.u8(1).f64s(&[3.0, -4.0, 5.0, 0.0, 7.5]).u8(2).f64s(&[1.0, 0.0, -2.0, 9.0, 1.0]);
    bag.add(id, T, cdr);
    // Angles in degrees, some beyond what radians could be.
    let list =
        ("ars548_msgs/Detection", "float32 azimuth\nfloat32 range\nfloat32 range_rate\nint8 rcs");
    let own = "std_msgs/Header header\nars548_msgs/Detection[] list_detections";
    let id = bag.topic("/ars548", "ars548_msgs/msg/DetectionList", own, &[HEADER, TIME, list]);
    let cdr = Cdr::new().header(T, "ars548").u32(2).f32(-45.0).f32(10.0).f32(1.5).u8(3);
    bag.add(id, T, cdr.f32(1.0).f32(20.0).f32(2.5).u8(250));
    let DriveRead { log, report, .. } = bag.read();
    let ars408: Vec<_> = log.scans[0].detections.iter().map(numbers).collect();
    assert_eq!(ars408, [[5.0, (-4.0_f64).atan2(3.0) as f32, 3.0], [1.0, 0.0, -2.0]]);
    assert_eq!(log.scans[0].detections[0].rcs_dbsm, 7.5);
    let ars548 = &log.scans[1].detections;
    assert!((ars548[0].azimuth_rad + 45.0_f32.to_radians()).abs() < 1e-6);
    assert!((ars548[1].azimuth_rad - 1.0_f32.to_radians()).abs() < 1e-6);
    assert_eq!(ars548[1].rcs_dbsm, -6.0);
    assert!(report.topics[1].note.contains("in degrees"));
}

#[test]
fn messages_of_one_detection_each_are_put_together() {
    let own = "std_msgs/Header header\nuint16 point_id\nfloat32 x\nfloat32 y\nfloat32 z\nfloat32 range\n\
        float32 velocity\nuint16 doppler_bin\nfloat32 bearing\nfloat32 intensity";
    let mut bag = Bag::default();
    let id = bag.topic("/ti_mmwave/radar_scan", "ti_mmwave_rospkg/RadarScan", own, &[HEADER, TIME]);
    for (k, point) in [0, 1, 2, 0, 1, 0, 0].into_iter().enumerate() {
        let cdr = Cdr::new().header(T + k as u64 * MS, "ti").u16(point);
        let cdr = cdr.f32(2.0).f32(0.0).f32(0.0).f32(2.0).f32(k as f32).u16(3).f32(0.0).f32(9.0);
        bag.add(id, T, cdr);
    }
    let log = bag.read().log;
    assert_eq!(log.scans.iter().map(|s| s.detections.len()).collect::<Vec<_>>(), [3, 2, 1, 1]);
}

#[test]
fn azimuths_are_mirrored_where_the_text_says_so_or_the_radar_hangs_upside_down() {
    let first = (
        RETURN.0,
        "float32 range\nfloat32 azimuth\n# Negative angles are anticlockwise from the sensor.\n\
        float32 elevation\nfloat32 doppler_velocity\nfloat32 amplitude",
    );
    let mut bag = Bag::default();
    let own = "std_msgs/Header header\nradar_msgs/RadarReturn[] returns";
    let old = bag.topic("/a", "radar_msgs/msg/RadarScan", own, &[HEADER, TIME, first]);
    let down = bag.scans("/b");
    bag.add(old, T, scan(T, "a", &[[1.0, 0.25, 1.0]]));
    bag.add(down, T, scan(T, "b", &[[1.0, 0.5, 1.0]]));
    let (sine, cosine) = (PI / 2.0).sin_cos();
    transforms(&mut bag, &[("base_link", "b", [1.0, 0.0, 0.0], [sine, 0.0, 0.0, cosine])]);
    let DriveRead { log, report, .. } = bag.read();
    assert_eq!(log.scans[0].detections[0].azimuth_rad, -0.25);
    assert_eq!(log.scans[1].detections[0].azimuth_rad, -0.5);
    assert!(report.topics[0].note.contains("to the right"));
    assert_eq!(report.remarks[0].code, "upside-down");
}

#[test]
fn foxglove_point_clouds_in_json_are_read() {
    let mut records =
        vec![schema(1, "foxglove.PointCloud", "jsonschema", "{}"), channel(1, 1, "/radar", "json")];
    // x = 3, y = 4, range_rate = -2 as 32-bit floats.
    let json = r#"{"timestamp":{"sec":5,"nsec":250000000},"frame_id":"radar_1","point_stride":12,"fields":[
        {"name":"x","offset":0,"type":7},{"name":"y","offset":4,"type":7},{"name":"range_rate","offset":8,"type":7}],
        "data":"AABAQAAAgEAAAADA"}"#;
    records.push(message(1, 9, json.as_bytes()));
    records.push(message(1, 9, b"{}"));
    let read = read(&file(&records, &[]), TopicOptions::default()).unwrap();
    assert_eq!(numbers(&read.log.scans[0].detections[0]), [5.0, 4.0_f64.atan2(3.0) as f32, -2.0]);
    assert_eq!((read.report.start_s, read.report.topics[0].unreadable), (Some(5.25), 1));
}
