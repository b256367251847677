use super::super::open::open;
use super::*;
use crate::drive_log::DropReason;
use boresight_core::drive::Mounting;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

const LOG: &str = "n015-2018-07-24-11-22-45+0800";

/// A cloud as nuScenes writes it, of rows x, y, rcs, vx, vy, dyn_prop, invalid_state, ambig_state.
fn nuscenes(rows: &[[f64; 8]]) -> Vec<u8> {
    let head = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z dyn_prop id rcs vx vy vx_comp vy_comp \
         is_quality_valid ambig_state x_rms y_rms invalid_state pdh0 vx_rms vy_rms\n\
         SIZE 4 4 4 1 2 4 4 4 4 4 1 1 1 1 1 1 1 1\nTYPE F F F I I F F F F F I I I I I I I I\n\
         COUNT 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n\
         POINTS {0}\nDATA binary\n",
        rows.len()
    );
    let mut bytes = head.into_bytes();
    for [x, y, rcs, vx, vy, dynamic, invalid, ambiguous] in rows.iter().copied() {
        let float = |number: f64| (number as f32).to_le_bytes();
        for number in [x, y, 0.0] {
            bytes.extend(float(number));
        }
        bytes.push(dynamic as u8);
        bytes.extend([1, 0]);
        for number in [rcs, vx, vy, 99.0, 99.0] {
            bytes.extend(float(number));
        }
        bytes.extend([1, ambiguous as u8, 19, 19, invalid as u8, 1, 16, 3]);
    }
    bytes
}

fn name(channel: &str, stamp_us: u64) -> String {
    format!("sweeps/{channel}/{LOG}__{channel}__{stamp_us}.pcd")
}

const GOOD: [f64; 8] = [3.0, 4.0, 5.5, -10.0, 0.0, 1.0, 0.0, 3.0];
/// A time of the first cloud, us.
const T: u64 = 1_532_402_927_664_178;

fn read(files: &[(String, Vec<u8>)]) -> Result<DriveRead, FormatError> {
    let files: Vec<_> = files.iter().map(|(name, bytes)| (name.as_str(), &bytes[..])).collect();
    open(&files, None)
}

fn codes(read: &DriveRead) -> Vec<&str> {
    read.report.remarks.iter().map(|remark| remark.code).collect()
}

#[test]
fn names_tell_radar_and_time() {
    for (path, expected) in [
        (name("RADAR_FRONT", T), Some((Some(LOG), "RADAR_FRONT", 1_000 * i128::from(T)))),
        (
            "a/RADAR_LEFT_BACK/RADAR_LEFT_BACK_1692868171704871.pcd".into(),
            Some((None, "RADAR_LEFT_BACK", 1_692_868_171_704_871_000)),
        ),
        ("front\\1692868171.0487.pcd".into(), Some((None, "front", 1_692_868_171_048_700_000))),
        ("1692868171.PCD".into(), Some((None, "radar", 1_692_868_171_000_000_000))),
        ("x-1692868171704.pcd".into(), Some((None, "x", 1_692_868_171_704_000_000))),
        ("x1692868171704871123.pcd".into(), Some((None, "x", 1_692_868_171_704_871_123))),
        ("cloud_17.pcd".into(), None),
        ("1.2.3.pcd".into(), None),
        (".pcd".into(), None),
        ("pcd".into(), None),
    ] {
        let found = name::parse(&path);
        let found = found.as_ref().map(|n| (n.log.as_deref(), n.channel.as_str(), n.stamp_ns));
        assert_eq!(found, expected, "{path}");
    }
}

#[test]
fn range_rates_are_velocities_along_the_ray_and_what_is_left_out_is_counted() {
    let mut rows = vec![GOOD; 7];
    rows[1][5] = 7.0;
    rows[2][6] = 4.0;
    rows[3][7] = 4.0;
    rows[4][0] = f64::NAN;
    (rows[5][0], rows[5][1]) = (0.0, 0.0);
    rows[6] = [0.0, -2.0, f64::NAN, 1.0, -3.0, 6.0, 0.0, 3.0];
    let read = read(&[(name("RADAR_FRONT", T), nuscenes(&rows))]).unwrap();
    assert_eq!(read.format, DriveFormat::Pcd);
    let detections = &read.log.scans[0].detections;
    assert_eq!(detections.len(), 2);
    let first = detections[0];
    assert!((f64::from(first.azimuth_rad) - (4.0_f64 / 3.0).atan()).abs() < 1e-7);
    assert_eq!((first.range_m, first.range_rate_mps, first.rcs_dbsm), (5.0, -6.0, 5.5));
    assert_eq!(detections[1].azimuth_rad, -FRAC_PI_2 as f32);
    assert_eq!(detections[1].range_rate_mps, 3.0);
    let drops: Vec<_> = read.report.drops().collect();
    assert_eq!(
        drops,
        [
            (DropReason::NotFinite, 2),
            (DropReason::InvalidState, 1),
            (DropReason::AmbiguousDoppler, 1),
            (DropReason::DynamicProperty, 1)
        ]
    );
    assert_eq!((read.report.detections, read.report.incomplete), (7, 1));
    assert_eq!(read.report.sequence, Some((LOG.into(), None)));
    assert_eq!(codes(&read), ["radar-names", "no-motion"]);
    assert_eq!(read.log.sensors[0].mounting, None);
}

#[test]
fn clouds_of_truckscenes_and_with_range_rates_are_read_too() {
    let head = |fields: &str, n: usize| {
        let of = |word: &str| vec![word; n].join(" ");
        format!(
            "VERSION 0.7\nFIELDS {fields}\nSIZE {}\nTYPE {}\nPOINTS 1\nDATA ascii\n",
            of("4"),
            of("F")
        )
    };
    let truck = head("x y z vrel_x vrel_y vrel_z rcs", 7) + "2 -2 1 3 0 -3 7\n";
    let radial = head("x y doppler", 3) + "2 0 -8\n";
    let read = read(&[
        ("R_1692868171704871.pcd".into(), truck.into_bytes()),
        ("R_1692868171804871.pcd".into(), radial.into_bytes()),
    ])
    .unwrap();
    let [a, b] = [0, 1].map(|i| read.log.scans[i].detections[0]);
    assert_eq!((a.range_m, a.range_rate_mps, a.rcs_dbsm), (3.0, 1.0, 7.0));
    assert_eq!((b.range_m, b.range_rate_mps), (2.0, -8.0));
    assert!((read.log.scans[1].time_s - 0.1).abs() < 1e-12);
    let lidar = head("x y z intensity", 4) + "1 2 3 4\n";
    let error = self::read(&[("R_1692868171704871.pcd".into(), lidar.into_bytes())]).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("vrel_x") && text.contains("R_1692868171704871.pcd"), "{text}");
}

/// The tables of a car that drives at 10 m/s on a circle of 50 m; its front radar is mounted as usual, the left one upside down.
fn tables(files: &mut Vec<(String, Vec<u8>)>) {
    let (mut data, mut poses) = ("[".to_owned(), "[\n".to_owned());
    for step in 0..40_u64 {
        let stamp_us = T - 500_000 + 50_000 * step;
        let angle = 0.2 * 0.05 * step as f64;
        let (x, y) = (50.0 * angle.sin(), 50.0 * (1.0 - angle.cos()));
        let comma = if step == 0 { "" } else { ",\n" };
        write!(
            poses,
            "{comma}{{\"token\": \"pose{step}\", \"timestamp\": {stamp_us}, \"rotation\": [{}, 0, 0, {}], \
             \"translation\": [{x}, {y}, 0.0], \"more\": {{\"a\": [1]}}}}",
            (angle / 2.0).cos(),
            (angle / 2.0).sin()
        )
        .unwrap();
        let (channel, file) = match step {
            10 => ("front", name("RADAR_FRONT", T)),
            12 => ("left", name("RADAR_LEFT", T + 100_000)),
            _ => ("camera", format!("sweeps/CAM/{LOG}__CAM__{stamp_us}.jpg")),
        };
        // The table's time, not the name's.
        let stamp_us = if step == 12 { stamp_us + 7 } else { stamp_us };
        write!(
            data,
            "{comma}{{\"filename\": \"{file}\", \"timestamp\": {stamp_us}, \"ego_pose_token\": \"pose{step}\", \
             \"calibrated_sensor_token\": \"{channel}\", \"is_key_frame\": false}}"
        )
        .unwrap();
    }
    // Another car at the same time.
    poses += &format!(
        ",{{\"token\": \"other\", \"timestamp\": {T}, \"rotation\": [1,0,0,0], \"translation\": [9,9,9]}}"
    );
    data += &format!(
        ",{{\"filename\": \"x/n008__CAM__1.jpg\", \"timestamp\": {T}, \"ego_pose_token\": \"other\", \
         \"calibrated_sensor_token\": \"camera\"}}"
    );
    let placed = "[{\"token\": \"front\", \"sensor_token\": \"s1\", \"translation\": [3.4, 0.1, 0.5], \"rotation\": [1, 0, 0, 0]}, \
                  {\"token\": \"left\", \"sensor_token\": \"s2\", \"translation\": [2.4, 0.8, 0.8], \
                   \"rotation\": [0, 0.7071067811865476, 0.7071067811865476, 0]}]";
    let sensors = "[{\"token\": \"s1\", \"channel\": \"RADAR_FRONT\", \"modality\": \"radar\"}, \
                    {\"token\": \"s2\", \"channel\": \"RADAR_LEFT\", \"modality\": \"radar\"}]";
    for (file, text) in [
        ("sample_data.json", data + "]"),
        ("ego_pose.json", poses + "]"),
        ("calibrated_sensor.json", placed.into()),
        ("sensor.json", sensors.into()),
    ] {
        files.push((format!("v1.0-mini/{file}"), text.into_bytes()));
    }
}

#[test]
fn tables_tell_places_times_and_motion() {
    let mut files = vec![
        (name("RADAR_LEFT", T + 100_000), nuscenes(&[GOOD])),
        (name("RADAR_FRONT", T), nuscenes(&[GOOD])),
        ("notes.txt".into(), vec![]),
    ];
    tables(&mut files);
    let all = read(&files).unwrap();
    let log = &all.log;
    let mounting = |i: usize| log.sensors[i].mounting.unwrap();
    assert_eq!(mounting(0), Mounting { x_m: 3.4, y_m: 0.1, yaw_rad: 0.0 });
    // Half a turn about the diagonal of x and y: x points to the left, z down.
    assert!((mounting(1).yaw_rad - FRAC_PI_2).abs() < 1e-12);
    assert_eq!(log.scans[1].detections[0].azimuth_rad, -log.scans[0].detections[0].azimuth_rad);
    assert_eq!(all.report.mountings, Some(MountingSource::CalibratedSensor));
    assert!((log.scans[1].time_s - 0.100_007).abs() < 1e-9);
    assert_eq!(codes(&all), ["ignored-file", "differentiated-poses", "radar-names", "upside-down"]);
    // The other car's pose is none of this one's, and those more than a second after the last cloud are not read.
    assert_eq!(log.motion.len(), 32 + 1);
    for sample in &log.motion {
        assert!((sample.yaw_rate_radps - 0.2).abs() < 1e-9, "{sample:?}");
        // A chord is shorter than its arc.
        assert!((sample.speed_mps.unwrap() - 10.0).abs() < 1e-3, "{sample:?}");
    }
    let first = log.motion[0];
    assert_eq!((first.time_s, first.pose.unwrap().x_m), (-0.5, 0.0));

    // Without sample_data.json the only place of a channel counts, and all poses of the time.
    files.retain(|(name, _)| !name.ends_with("sample_data.json"));
    let less = read(&files).unwrap();
    assert_eq!(less.log.sensors, log.sensors);
    assert!((less.log.scans[1].time_s - 0.1).abs() < 1e-9);
    let last = files.iter().position(|(name, _)| name.ends_with("calibrated_sensor.json")).unwrap();
    let twice = String::from_utf8(files[last].1.clone()).unwrap().replace("\"s2\"", "\"s1\"");
    files[last].1 = twice.into_bytes();
    let several = read(&files).unwrap();
    assert!(codes(&several).contains(&"several-places"));
    assert_eq!(several.log.sensors[0].mounting, None);
}

#[test]
fn the_chassis_of_a_truck_tells_its_motion() {
    let rows = format!(
        "[{{\"timestamp\": {}, \"vx\": 12.5, \"yaw_rate\": 0.25, \"token\": \"a\"}}, \
          {{\"timestamp\": {T}, \"vx\": 12.0, \"yaw_rate\": 0.5}}, {{\"timestamp\": {T}, \"vx\": 9, \"yaw_rate\": 0}}]",
        T + 20_000
    );
    let files = [
        (format!("R_{T}.pcd"), nuscenes(&[GOOD])),
        ("ego_motion_chassis.json".into(), rows.into_bytes()),
    ];
    let read = read(&files).unwrap();
    let motion: Vec<_> =
        read.log.motion.iter().map(|s| (s.time_s, s.yaw_rate_radps, s.speed_mps)).collect();
    assert_eq!(motion, [(0.0, 0.5, Some(12.0)), (0.02, 0.25, Some(12.5))]);
    assert_eq!(read.report.dropped(DropReason::MotionDuplicate), 1);
}

#[test]
fn what_is_no_drive_is_refused_and_what_is_twice_is_taken_once() {
    let cloud = nuscenes(&[GOOD]);
    let message = |files: &[(String, Vec<u8>)]| read(files).unwrap_err().to_string();
    let other = name("RADAR_FRONT", T).replace("n015", "n008");
    for (given, part) in [
        (message(&[("a_1.pcd".into(), cloud.clone())]), "a Unix time at the end"),
        (message(&[(name("A", T), cloud.clone()), (other, cloud.clone())]), "and n008"),
        (
            message(&[(name("A", T), cloud[..cloud.len() - 1].to_vec())]),
            "expected 1 points of 43 bytes",
        ),
        (
            message(&[(name("A", T), cloud.clone()), ("ego_pose.json".into(), b"[{]".to_vec())]),
            "ego_pose.json",
        ),
        (
            message(&[
                (name("A", T), cloud.clone()),
                ("sample_data.json".into(), b"[] x".to_vec()),
            ]),
            "sample_data.json",
        ),
    ] {
        assert!(given.contains(part), "{given:?} does not say {part:?}");
    }
    let twice =
        read(&[(name("A", T), cloud.clone()), (name("A", T).replace("sweeps", "samples"), cloud)]);
    let twice = twice.unwrap();
    assert_eq!((twice.log.scans.len(), codes(&twice)[0]), (1, "duplicate-cloud"));
}

fn delft(points: &[[f32; 7]]) -> Vec<u8> {
    points.iter().flatten().flat_map(|number| number.to_le_bytes()).collect()
}

#[test]
fn frames_of_view_of_delft_are_scans_of_their_own_points() {
    let own = [3.0, -4.0, 12.0, -7.5, -5.0, 0.0, 0.0];
    let mut earlier = own;
    earlier[6] = -2.0;
    let pose = |angle: f64, x: f64| {
        let [s, c] = [angle.sin(), angle.cos()];
        format!(
            "{{\"mapToCamera\": {:?}}}\n{{\"odomToCamera\": [0,0,{c},{x},0,0,{s},1,0,0,0,1.3,0,0,0,1]}}\n",
            [0; 16]
        )
    };
    let read = read(&[
        ("radar/training/velodyne/00550.bin".into(), delft(&[own])),
        ("radar/training/velodyne/00549.bin".into(), delft(&[own, earlier])),
        ("radar/training/pose/00549.json".into(), pose(0.0, 1.0).into_bytes()),
        ("radar/training/pose/00550.json".into(), pose(0.02, 1.5).into_bytes()),
    ])
    .unwrap();
    assert_eq!(read.format, DriveFormat::ViewOfDelft);
    assert_eq!(read.log.scans.len(), 2);
    let d = read.log.scans[0].detections[0];
    assert_eq!((d.range_m, d.range_rate_mps, d.rcs_dbsm), (13.0, -5.0, -7.5));
    assert!(d.azimuth_rad < 0.0);
    assert_eq!(read.report.dropped(DropReason::EarlierScan), 1);
    assert!((read.log.scans[1].time_s - 0.1).abs() < 1e-12);
    let motion = &read.log.motion;
    assert_eq!((motion.len(), motion[0].pose), (2, None));
    assert!((motion[0].yaw_rate_radps - 0.2).abs() < 1e-12);
    assert!((motion[0].speed_mps.unwrap() - 5.0 * 0.01_f64.cos()).abs() < 1e-12);
    for (bytes, part) in
        [(&delft(&[own])[..27], "28 bytes each"), (&delft(&[[1.5; 7]]), "whole number")]
    {
        let error = self::read(&[("00549.bin".into(), bytes.to_vec())]).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    let bad = [("00549.bin".into(), delft(&[own])), ("00549.json".into(), b"{}".to_vec())];
    assert!(self::read(&bad).unwrap_err().to_string().contains("odomToCamera"));
}
