//! Recordings as drives: what of their topics is read, and at which times.

use super::bag::*;
use crate::drive_log::mcap::{TopicClock, TopicOptions, TopicUse, read};
use crate::drive_log::{DriveFormat, DriveRead, DropReason, MountingSource, open};
use crate::error::FormatError;
use crate::mcap::made::{channel, file, message, schema};
use crate::ros::made::Cdr;
use boresight_core::Diagnose;
use boresight_core::drive::Pose;
use std::f64::consts::FRAC_PI_2;

#[test]
fn radar_scans_odometry_and_mountings_become_a_drive() {
    let mut bag = Bag::default();
    let left = bag.scans("/radar/left");
    let front = bag.scans("/radar/front");
    let motion = odometry(&mut bag, "/odom");
    let half = (FRAC_PI_2 / 2.0).sin_cos();
    transforms(
        &mut bag,
        &[
            ("base_link", "bumper", [3.5, 0.0, 0.5], [0.0, 0.0, 0.0, 1.0]),
            ("bumper", "radar_left", [0.25, 0.75, 0.0], [0.0, 0.0, half.0, half.1]),
        ],
    );
    for k in 0..3_u64 {
        let time = T + 100 * k * MS;
        bag.add(
            left,
            time + 7 * MS,
            scan(time, "radar_left", &[[10.0, 0.5, -3.0], [20.0, f32::NAN, 1.0]]),
        );
        bag.add(front, time + 8 * MS, scan(time + MS, "radar_front", &[[k as f32, 0.1, 2.0]]));
        bag.add(motion, time, odometer(time, k as f64, 0.3, 12.0, 0.25));
    }
    let DriveRead { log, report, format } = bag.read();
    assert_eq!(format, DriveFormat::Mcap);
    // Numbered by name: front is 1.
    let mountings: Vec<_> = log.sensors.iter().map(|s| (s.id, s.mounting)).collect();
    assert_eq!((mountings[0], mountings[1].0), ((1, None), 2));
    let mounting = mountings[1].1.unwrap();
    assert!((mounting.x_m - 3.75).abs() < 1e-12 && (mounting.y_m - 0.75).abs() < 1e-12);
    assert!((mounting.yaw_rad - FRAC_PI_2).abs() < 1e-12);
    assert_eq!(report.mountings, Some(MountingSource::TfStatic));
    let times: Vec<_> = log.scans.iter().map(|s| (s.sensor, s.time_s)).collect();
    assert_eq!(times, [(2, 0.0), (1, 0.001), (2, 0.1), (1, 0.101), (2, 0.2), (1, 0.201)]);
    assert_eq!(
        log.scans[0].detections.iter().map(numbers).collect::<Vec<_>>(),
        [[10.0, 0.5, -3.0]]
    );
    assert_eq!((report.detections, report.dropped(DropReason::NotFinite)), (9, 3));
    assert_eq!(report.start_s, Some(T as f64 / 1e9));
    let sample = log.motion[2];
    assert_eq!((sample.time_s, sample.yaw_rate_radps, sample.speed_mps), (0.2, 0.25, Some(12.0)));
    let Pose { x_m, y_m, yaw_rad } = sample.pose.unwrap();
    assert_eq!((x_m, y_m), (2.0, -2.0));
    assert!((yaw_rad - 0.3).abs() < 1e-12);
    let told: Vec<_> = report
        .topics
        .iter()
        .map(|t| (&*t.name, t.messages, t.used_as, t.sensor, t.clock))
        .collect();
    let stamp = Some(TopicClock::Stamp);
    assert_eq!(
        told,
        [
            ("/odom", 3, TopicUse::Motion, None, stamp),
            ("/radar/front", 3, TopicUse::Radar, Some(1), stamp),
            ("/radar/left", 3, TopicUse::Radar, Some(2), stamp),
            ("/tf_static", 1, TopicUse::Mountings, None, None),
        ]
    );
    assert!(report.topics[1].note.contains("no transform to base_link"), "{:?}", report.topics[1]);
    assert!(report.remarks.is_empty(), "{:?}", report.remarks);
    // The same through the door of all formats.
    let bytes = bag.bytes();
    let opened = open(&[("a.mcap", &bytes)], None).unwrap();
    // NaN keeps them from being equal as they are.
    assert_eq!(format!("{:?}", opened.log), format!("{log:?}"));
    let other = TopicOptions { base_frame: Some("bumper".into()), ..TopicOptions::default() };
    assert_eq!(read(&bytes, other).unwrap().log.sensors[1].mounting.unwrap().x_m, 0.25);
}

#[test]
fn speed_and_yaw_rate_of_two_topics_are_joined_by_time() {
    let mut bag = Bag::default();
    let radar = bag.scans("/radar");
    bag.add(radar, T, scan(T, "radar", &[[1.0, 0.0, 1.0]]));
    let (speed, rates) = (twist(&mut bag, "/vehicle/twist"), inertial(&mut bag));
    // The sensor lies on its side: its x points up.
    let half = (FRAC_PI_2 / 2.0).sin_cos();
    transforms(&mut bag, &[("base_link", "imu", [0.0; 3], [0.0, -half.0, 0.0, half.1])]);
    for k in 0..4_u64 {
        let time = T + 100 * k * MS;
        let twist = Cdr::new().header(time, "base_link").f64s(&[k as f64, 0.0, 0.0, 9.0, 9.0, 9.0]);
        bag.add(speed, time, twist);
        bag.add(rates, time, turn_rates(time + 50 * MS, [0.5, 0.1, -0.2]));
    }
    let DriveRead { log, report, .. } = bag.read();
    let samples: Vec<_> = log.motion.iter().map(|s| (s.time_s, s.speed_mps)).collect();
    assert_eq!(samples, [(0.05, Some(0.5)), (0.15, Some(1.5)), (0.25, Some(2.5)), (0.35, None)]);
    assert!((log.motion[0].yaw_rate_radps - 0.5).abs() < 1e-12);
    assert_eq!((report.motion, report.motion_incomplete), (4, 1));
    let named =
        TopicOptions { motion_topics: vec!["/vehicle/twist".into()], ..TopicOptions::default() };
    let alone = read(&bag.bytes(), named).unwrap();
    assert_eq!(alone.log.motion[1].yaw_rate_radps, 9.0);
    assert_eq!(alone.report.topics[0].note, "others are named");
    // Samples of one time, and ones that are none.
    bag.add(rates, T, turn_rates(T + 50 * MS, [0.5, 0.1, -0.2]));
    bag.add(rates, T, turn_rates(T + 60 * MS, [f64::NAN; 3]));
    let report = bag.read().report;
    assert_eq!(report.dropped(DropReason::MotionDuplicate), 1);
    assert_eq!(report.dropped(DropReason::MotionNotFinite), 1);
}

#[test]
fn clocks_that_differ_give_way_to_the_time_of_recording() {
    let mut bag = Bag::default();
    let radar = bag.scans("/radar");
    let speed = twist(&mut bag, "/twist");
    for k in 0..2 {
        let time = T + k * MS;
        // Since the radar was switched on.
        bag.add(radar, time, scan(1_000_000 + k, "radar", &[[1.0, 0.0, 1.0]]));
        bag.add(speed, time, Cdr::new().header(time, "base_link").f64s(&[1.0; 6]));
    }
    let DriveRead { log, report, .. } = bag.read();
    assert_eq!(log.scans[1].time_s, 0.001);
    assert_eq!(report.remarks[0].code, "clocks-differ");
    assert_eq!(report.topics[0].clock, Some(TopicClock::LogTime));
    // Without a stamp: when it was recorded.
    let mut bag = Bag::default();
    let radar = bag.scans("/radar");
    bag.add(radar, T, scan(0, "radar", &[[1.0, 0.0, 1.0]]));
    let report = bag.read().report;
    assert_eq!(
        (report.start_s, report.topics[0].clock),
        (Some(T as f64 / 1e9), Some(TopicClock::LogTime))
    );
}

#[test]
fn named_topics_are_read_alone_and_missed_where_they_are_not_there() {
    let mut bag = Bag::default();
    let (one, two) = (bag.scans("/one"), bag.scans("/two"));
    for id in [one, two] {
        bag.add(id, T, scan(T, "radar", &[[1.0, 0.0, 1.0]]));
    }
    let both = bag.read();
    assert_eq!((both.log.sensors.len(), both.report.remarks[0].code), (2, "same-frame"));
    let named = |names: &[&str]| TopicOptions {
        radar_topics: names.iter().map(|name| (*name).into()).collect(),
        ..TopicOptions::default()
    };
    assert_eq!(read(&bag.bytes(), named(&["/two"])).unwrap().log.sensors.len(), 1);
    let error = read(&bag.bytes(), named(&["/two", "/three"])).unwrap_err();
    assert!(matches!(&error, FormatError::Topic { topic, .. } if topic == "/three"), "{error}");
    assert!(error.to_string().contains("/one, /two"), "{error}");
    let motion = TopicOptions { motion_topics: vec!["/one".into()], ..TopicOptions::default() };
    assert_eq!(read(&bag.bytes(), motion).unwrap_err().code(), "unknown-topic");
}

#[test]
fn parts_of_a_recording_are_read_one_after_another() {
    let part = |k: u64, first: bool| {
        let mut bag = Bag::default();
        if !first {
            // Numbers of channels are each file's own.
            bag.next = 7;
        }
        let radar = bag.scans("/radar");
        bag.add(radar, T + k * MS, scan(T + k * MS, "radar", &[[1.0, 0.0, k as f32]]));
        bag.bytes()
    };
    let (one, two) = (part(0, true), part(5, false));
    let read =
        open(&[("bag_1.mcap", &two), ("bag_0.mcap", &one), ("metadata.yaml", b"x")], None).unwrap();
    let times: Vec<_> = read.log.scans.iter().map(|scan| scan.time_s).collect();
    assert_eq!(times, [0.0, 0.005]);
    assert_eq!(read.report.topics[0].messages, 2);
    assert_eq!(read.report.remarks.last().unwrap().code, "ignored-file");
}

#[test]
fn what_is_no_drive_says_what_is_there() {
    let error = open(&[("a.mcap", b"PK\x03\x04..........")], None).unwrap_err();
    assert!(error.to_string().contains("a.mcap"), "{error}");
    let empty = file(&[], &[]);
    let error = open(&[("a.mcap", &empty)], None).unwrap_err();
    assert!(error.to_string().contains("no topics"), "{error}");
    let records =
        [schema(1, "a.B", "protobuf", "?"), channel(1, 1, "/a", "protobuf"), message(1, 1, &[])];
    let error = open(&[("a.mcap", &file(&records, &[]))], None).unwrap_err();
    assert!(error.to_string().contains("\"protobuf\""), "{error}");
}
