//! What pieces of real drives come to, taken as drives of one vehicle.

use crate::support::drive::{each, merged, record, rms, within};
use boresight_core::drive::DriveLog;
use boresight_fleet::fleet::Fleet;
use boresight_formats::radarscenes::{Companions, read_path};
use boresight_formats::{ReadReport, drive_log};
use std::path::Path;

/// Motion is looked up between samples, s.
const MARGIN_S: f64 = 0.3;

/// The part of a log from one time to another.
fn piece(log: &DriveLog, from_s: f64, to_s: f64) -> DriveLog {
    let scans = log.scans.iter().filter(|scan| scan.time_s >= from_s && scan.time_s < to_s);
    let near = |time_s: f64| time_s >= from_s - MARGIN_S && time_s < to_s + MARGIN_S;
    let motion = log.motion.iter().filter(|sample| near(sample.time_s));
    DriveLog {
        sensors: log.sensors.clone(),
        scans: scans.cloned().collect(),
        motion: motion.copied().collect(),
    }
}

/// The pieces of a log of one length as drives of a vehicle.
fn in_pieces(log: &DriveLog, length_s: f64, min_speed_mps: f64) -> Fleet {
    let end_s = log.scans.last().unwrap().time_s;
    let starts: Vec<usize> = (0..(end_s / length_s) as usize).collect();
    merged(each(&starts, |&at| {
        let from_s = at as f64 * length_s;
        record("car", at, &piece(log, from_s, from_s + length_s), min_speed_mps)
    }))
}

/// Prints what is told of a vehicle whose truth is known; the errors of its angles with their deviations, deg, and the knocks.
fn told(fleet: &Fleet, truth_deg: impl Fn(u8) -> f64) -> (Vec<(f64, f64)>, usize) {
    let vehicle = &fleet.vehicles[0];
    let mut errors = vec![];
    let mut knocks = 0;
    for radar in &vehicle.radars {
        let error = |angle: f64| angle.to_degrees() - truth_deg(radar.sensor);
        let alone: Vec<(f64, f64)> =
            radar.drives.iter().map(|d| (error(d.angle_rad), d.sigma_rad.to_degrees())).collect();
        println!(
            "  radar {}: {:+.3} +- {:.3} deg off by {:?}; {} drives {:.3} rms, within {:.2?}; scatter {:.2}, knocks {:.2?}, drift {:?}",
            radar.sensor,
            error(radar.angle_rad),
            radar.sigma_rad.to_degrees(),
            radar.source,
            alone.len(),
            rms(&alone),
            within(&alone),
            radar.scatter,
            radar.knocks.iter().map(|k| (k.drive, k.step_rad.to_degrees())).collect::<Vec<_>>(),
            radar.drift.map(|drift| drift.rate_rad.to_degrees()),
        );
        errors.push((error(radar.angle_rad), radar.sigma_rad.to_degrees()));
        knocks += radar.knocks.len();
    }
    println!("  {:.4?}", vehicle.shared);
    println!("  within one and two {:.2?}, {knocks} knocks", within(&errors));
    (errors, knocks)
}

#[test]
fn pieces_of_a_real_drive_of_four_radars_agree() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/radarscenes-105");
    let sequence = folder.join("sequence_105");
    if !sequence.is_dir() {
        println!("skipped: no copy of RadarScenes' sequence 105 lies beside this checkout");
        return;
    }
    let read = |path: &Path| std::fs::read(path).unwrap();
    let scenes = read(&sequence.join("scenes.json"));
    let sensors = read(&folder.join("sensors.json"));
    let companions = Companions { scenes: Some(&scenes), sensors: Some(&sensors) };
    let mut report = ReadReport::default();
    let log = read_path(&sequence.join("radar_data.h5"), companions, &mut report).unwrap();
    let truth = |sensor: u8| {
        let of = log.sensors.iter().find(|s| s.id == sensor).unwrap();
        of.mounting.unwrap().yaw_rad.to_degrees()
    };
    for length_s in [10.0, 15.0, 25.0] {
        println!("pieces of {length_s} s");
        let (errors, _) = told(&in_pieces(&log, length_s, 1.0), truth);
        // Four angles of one car, which err alike where the car does: all within three deviations, and within a quarter degree.
        let near = |(error, sigma): &(f64, f64)| error.abs() < 3.0 * sigma && error.abs() < 0.25;
        assert!(errors.iter().all(near), "{errors:?}");
    }
}

#[test]
fn pieces_of_a_real_drive_in_traffic_agree() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../recordings/delphi");
    let names = ["front_radar.csv.gz", "pose_10hz.csv.gz"];
    let bytes = names.map(|name| std::fs::read(folder.join(name)).unwrap());
    let files = [(names[0], &bytes[0][..]), (names[1], &bytes[1][..])];
    let log = drive_log::open(&files, None).unwrap().log;
    println!("Delphi in pieces of 50 s");
    // What the set's makers state.
    let (errors, knocks) = told(&in_pieces(&log, 50.0, 3.0), |_| -1.96);
    assert!(errors[0].0.abs() < 3.0 * errors[0].1, "{errors:?}");
    assert_eq!(knocks, 0);
}
