use super::super::{DriveFormat, DriveRead, DropReason, MountingSource, open};
use super::{TopicClock, TopicOptions, TopicUse, read};
use crate::error::FormatError;
use crate::mcap::made::{channel, chunk, file, message, schema};
use crate::ros::made::{Cdr, HEADER, QUATERNION, TIME, VECTOR, definition};
use boresight_core::Diagnose;
use boresight_core::drive::{Detection, Pose};
use std::f64::consts::{FRAC_PI_2, PI};

const RETURN: (&str, &str) = (
    "radar_msgs/RadarReturn",
    "float32 range\nfloat32 azimuth # Positive angles are anticlockwise\nfloat32 elevation\n\
     float32 doppler_velocity\nfloat32 amplitude",
);
const FIELD: (&str, &str) = (
    "sensor_msgs/PointField",
    "uint8 INT8=1\nstring name\nuint32 offset\nuint8 datatype\nuint32 count",
);
const CLOUD: &str = "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n\
    uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense";
/// 2026, ns.
const T: u64 = 1_790_000_000_000_000_000;
const MS: u64 = 1_000_000;

/// A recording that is written.
#[derive(Default)]
struct Bag {
    records: Vec<Vec<u8>>,
    next: u16,
}

impl Bag {
    fn topic(&mut self, topic: &str, kind: &str, own: &str, others: &[(&str, &str)]) -> u16 {
        self.next += 1;
        let id = self.next;
        self.records.push(schema(id, kind, "ros2msg", &definition(own, others)));
        self.records.push(channel(id, id, topic, "cdr"));
        id
    }

    fn scans(&mut self, topic: &str) -> u16 {
        let own = "std_msgs/Header header\nradar_msgs/RadarReturn[] returns";
        self.topic(topic, "radar_msgs/msg/RadarScan", own, &[HEADER, TIME, RETURN])
    }

    fn clouds(&mut self, topic: &str) -> u16 {
        self.topic(topic, "sensor_msgs/msg/PointCloud2", CLOUD, &[HEADER, TIME, FIELD])
    }

    fn add(&mut self, id: u16, log_ns: u64, cdr: Cdr) {
        self.records.push(message(id, log_ns, &cdr.done()));
    }

    fn bytes(&self) -> Vec<u8> {
        file(&[chunk("lz4", &self.records.concat())], &[])
    }

    fn read(&self) -> DriveRead {
        read(&self.bytes(), TopicOptions::default()).unwrap()
    }
}

/// A RadarScan of returns (range, azimuth, range rate).
fn scan(time_ns: u64, frame: &str, returns: &[[f32; 3]]) -> Cdr {
    let cdr = Cdr::new().header(time_ns, frame).u32(returns.len() as u32);
    returns.iter().fold(cdr, |cdr, [range, azimuth, rate]| {
        cdr.f32(*range).f32(*azimuth).f32(0.0).f32(*rate).f32(30.0)
    })
}

fn numbers(detection: &Detection) -> [f32; 3] {
    [detection.range_m, detection.azimuth_rad, detection.range_rate_mps]
}

fn odometry(bag: &mut Bag, topic: &str) -> u16 {
    let own = "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
        geometry_msgs/TwistWithCovariance twist";
    let others = [
        HEADER,
        TIME,
        VECTOR,
        QUATERNION,
        ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"),
        ("geometry_msgs/Pose", "Point position\nQuaternion orientation"),
        ("geometry_msgs/Twist", "Vector3  linear\nVector3  angular"),
        ("geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"),
        ("geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"),
    ];
    bag.topic(topic, "nav_msgs/msg/Odometry", own, &others)
}

fn odometer(time_ns: u64, x: f64, yaw: f64, speed: f64, rate: f64) -> Cdr {
    let (sine, cosine) = (yaw / 2.0).sin_cos();
    let cdr = Cdr::new().header(time_ns, "odom").text("base_link");
    let cdr = cdr.f64s(&[x, -x, 0.0, 0.0, 0.0, sine, cosine]).f64s(&[0.0; 36]);
    cdr.f64s(&[speed, 0.1, 0.0, 0.0, 0.0, rate]).f64s(&[0.0; 36])
}

fn twist(bag: &mut Bag, topic: &str) -> u16 {
    let own = "std_msgs/Header header\ngeometry_msgs/Twist twist";
    let others = [HEADER, TIME, VECTOR, ("geometry_msgs/Twist", "Vector3 linear\nVector3 angular")];
    bag.topic(topic, "geometry_msgs/msg/TwistStamped", own, &others)
}

fn inertial(bag: &mut Bag) -> u16 {
    let own = "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
        geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance";
    bag.topic("/imu", "sensor_msgs/msg/Imu", own, &[HEADER, TIME, VECTOR, QUATERNION])
}

fn turn_rates(time_ns: u64, rates: [f64; 3]) -> Cdr {
    let cdr = Cdr::new().header(time_ns, "imu").f64s(&[0.0, 0.0, 0.0, 1.0]).f64s(&[0.0; 9]);
    cdr.f64s(&rates).f64s(&[0.0; 9])
}

fn transforms(bag: &mut Bag, all: &[(&str, &str, [f64; 3], [f64; 4])]) {
    let others = [
        HEADER,
        TIME,
        VECTOR,
        QUATERNION,
        (
            "geometry_msgs/TransformStamped",
            "std_msgs/Header header\nstring child_frame_id\nTransform transform",
        ),
        ("geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"),
    ];
    let own = "geometry_msgs/TransformStamped[] transforms";
    let id = bag.topic("/tf_static", "tf2_msgs/msg/TFMessage", own, &others);
    let cdr =
        all.iter().fold(Cdr::new().u32(all.len() as u32), |cdr, (parent, child, shift, turn)| {
            cdr.header(0, parent).text(child).f64s(shift).f64s(turn)
        });
    bag.add(id, T, cdr);
}

/// Points of `names` of 32-bit floats, each point and row padded.
fn cloud(time_ns: u64, frame: &str, names: &[&str], points: &[&[f32]], rows: u32) -> Cdr {
    let (step, columns) = (4 * names.len() + 3, points.len() / rows as usize);
    let row_step = columns * step + 5;
    let mut data = vec![0xee; row_step * rows as usize];
    for (k, point) in points.iter().enumerate() {
        let start = k / columns * row_step + k % columns * step;
        for (place, number) in data[start..].chunks_exact_mut(4).zip(*point) {
            place.copy_from_slice(&number.to_le_bytes());
        }
    }
    let cdr = Cdr::new().header(time_ns, frame).u32(rows).u32(columns as u32);
    let cdr = names.iter().enumerate().fold(cdr.u32(names.len() as u32), |cdr, (k, name)| {
        cdr.text(name).u32(4 * k as u32).u8(7).u32(1)
    });
    cdr.u8(0).u32(step as u32).u32(row_step as u32).bytes(&data).u8(1)
}

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
