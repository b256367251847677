//! Signs found out of drives: against theory, on simulated drives of all scenarios, and on real ones.

use crate::size::sized;
use boresight_core::drive::{Detection, MotionSample, Mounting, Scan, Sensor};
use boresight_core::{DriveLog, Random};
use boresight_formats::ReadReport;
use boresight_formats::drive_log;
use boresight_formats::radarscenes::{Companions, read_path};
use boresight_mounting::signs::{SignFindings, Untold, apply, find_signs};
use boresight_mounting::{AzimuthSign, RangeRateSign, SignOptions};
use boresight_simulate::drive::{DriveOptions, DriveProfile, Scenario, simulate_drive};
use std::path::Path;

const GAP_S: f64 = 0.25;

/// A log as another driver writes it.
fn turned(log: &DriveLog, azimuth: f32, range_rate: f32) -> DriveLog {
    let mut log = log.clone();
    for detection in log.scans.iter_mut().flat_map(|scan| &mut scan.detections) {
        detection.azimuth_rad *= azimuth;
        detection.range_rate_mps *= range_rate;
    }
    log
}

fn found(what: &str, log: &DriveLog) -> SignFindings {
    let found = find_signs(log, GAP_S).unwrap();
    println!("{what}: {}; {}", found.azimuth_remark().message, found.range_rate_remark().message);
    println!("    {:?} {:?}", found.azimuth, found.range_rate);
    found
}

/// Drives of each scenario that are simulated: as many as the variable says, as `PROPTEST_CASES` does for property tests, or
/// few, which take seconds.
fn seeds() -> Option<u64> {
    std::env::var("SIGN_SEEDS").ok().map(|seeds| seeds.parse().unwrap())
}

/// Right, wrong and undecided, of azimuths and of range rates.
fn count(
    scenarios: &[Scenario],
    seeds: impl IntoIterator<Item = u64> + Clone,
    mut change: impl FnMut(DriveLog, u64) -> DriveLog,
) -> [[u32; 3]; 2] {
    let mut counts = [[0; 3]; 2];
    for &scenario in scenarios {
        for seed in seeds.clone() {
            let profile = [DriveProfile::Clean, DriveProfile::Radarscenes][seed as usize % 2];
            let options = DriveOptions {
                scenario,
                seed,
                profile,
                duration_s: 60.0,
                ..DriveOptions::default()
            };
            let log = change(simulate_drive(&options).unwrap().log, seed);
            // Both signs, in all combinations over the seeds.
            let [azimuth, range_rate] =
                [seed & 2, seed & 4].map(|bit| if bit > 0 { -1.0 } else { 1.0 });
            let found = found(&format!("{scenario:?} {seed}"), &turned(&log, azimuth, range_rate));
            let of = [(found.azimuth, azimuth), (found.range_rate, range_rate)];
            for (count, (finding, sign)) in counts.iter_mut().zip(of) {
                count[finding.usual.map_or(2, |usual| usize::from(usual != (sign > 0.0)))] += 1;
            }
        }
    }
    println!("azimuth, range rate: right, wrong, undecided: {counts:?}");
    counts
}

#[test]
fn simulated_drives_of_all_scenarios_are_never_told_wrong() {
    let seeds = seeds().map_or(sized(1, 2)..3, |most| 0..most.max(3));
    let drives = (seeds.end - seeds.start).min(2) as u32;
    let counts = count(&Scenario::ALL, seeds, |log, _| log);
    assert_eq!([counts[0][1], counts[1][1]], [0, 0], "{counts:?}");
    // Of six scenarios, motorways and queues turn too little; car parks are driven in reverse.
    assert!(2 * counts[0][0] >= 5 * drives && counts[1][0] >= 5 * drives, "{counts:?}");
}

/// With the yaw rate of another drive, which has nothing to do with what is seen.
fn unrelated(log: DriveLog, seed: u64) -> DriveLog {
    let options = DriveOptions { seed: seed + 1000, duration_s: 60.0, ..DriveOptions::default() };
    let motion = simulate_drive(&options).unwrap().log.motion;
    DriveLog { motion, ..log }
}

/// Among them the drives where chance looks most like a turn.
#[test]
fn a_yaw_rate_that_has_nothing_to_do_with_the_scans_tells_nothing() {
    for (scenario, seeds) in [(Scenario::City, [4, 7, 22]), (Scenario::DenseTraffic, [6, 16, 1])] {
        let counts = count(&[scenario], seeds.into_iter().take(sized(3, 2)), unrelated);
        assert_eq!(counts[0][..2], [0, 0], "{counts:?}");
    }
    if let Some(most) = seeds() {
        let counts = count(&Scenario::ALL, 0..most, unrelated);
        assert_eq!(counts[0][..2], [0, 0], "{counts:?}");
    }
}

/// All four ways of writing one log: each told right, or, where `sure` does not say so, not at all.
fn assert_told(what: &str, log: &DriveLog, sure: [bool; 2]) {
    for (azimuth, range_rate) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let found =
            found(&format!("{what} {azimuth} {range_rate}"), &turned(log, azimuth, range_rate));
        let of = [(found.azimuth, azimuth), (found.range_rate, range_rate)];
        for ((finding, sign), sure) in of.into_iter().zip(sure) {
            assert_ne!(finding.usual, Some(sign < 0.0), "{what}: {found:?}");
            assert!(!sure || finding.usual.is_some(), "{what}: {found:?}");
        }
    }
}

#[test]
fn a_real_front_radar_tells_both() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../recordings/delphi");
    let names = ["front_radar.csv.gz", "pose_10hz.csv.gz"];
    let bytes = names.map(|name| std::fs::read(folder.join(name)).unwrap());
    let files = [(names[0], &bytes[0][..]), (names[1], &bytes[1][..])];
    assert_told("delphi", &drive_log::open(&files, None).unwrap().log, [true, true]);
}

#[test]
fn a_sequence_of_radarscenes_tells_both_by_all_radars_and_by_each() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/radarscenes-105");
    let data = folder.join("sequence_105/radar_data.h5");
    if !data.is_file() {
        println!("skipped: {} is not here", data.display());
        return;
    }
    let sensors = std::fs::read(folder.join("sensors.json")).unwrap();
    let beside = Companions { scenes: None, sensors: Some(&sensors) };
    let log = read_path(&data, beside, &mut ReadReport::default()).unwrap();
    assert_told("all", &log, [true, true]);
    for sensor in log.sensors.clone().into_iter().take(sized(4, 1)) {
        let mut one = log.clone();
        one.sensors.retain(|other| other.id == sensor.id);
        assert_told(&format!("radar {}", sensor.id), &one, [false, false]);
        one.sensors[0].mounting = None;
        assert_told(&format!("radar {} without its place", sensor.id), &one, [false, false]);
    }
}

/// A car on a winding road past points that stand, in closed form: no noise but a point cloud that changes.
struct Road {
    speed_mps: f64,
    yaw_rate_radps: f64,
    mounting: Mounting,
    /// Whether detections have ranges.
    ranges: bool,
    speed_known: bool,
}

impl Default for Road {
    fn default() -> Self {
        Self {
            speed_mps: 8.0,
            yaw_rate_radps: 0.25,
            mounting: Mounting { x_m: 3.6, y_m: 0.5, yaw_rad: 0.4 },
            ranges: true,
            speed_known: true,
        }
    }
}

impl Road {
    fn log(&self) -> DriveLog {
        let mut random = Random::new(3, 0);
        let Mounting { x_m, y_m, yaw_rad } = self.mounting;
        let points: Vec<[f64; 2]> = (0..4000)
            .map(|_| [random.uniform(-400.0, 400.0), random.uniform(-400.0, 400.0)])
            .collect();
        let (mut log, mut pose) = (DriveLog::default(), [0.0_f64; 3]);
        log.sensors = vec![Sensor { id: 1, mounting: Some(self.mounting) }];
        for step in 0..6000 {
            let time_s = 0.01 * f64::from(step);
            let rate = self.yaw_rate_radps * (0.4 * time_s).sin();
            log.motion.push(MotionSample {
                time_s,
                yaw_rate_radps: rate,
                speed_mps: self.speed_known.then_some(self.speed_mps),
                pose: None,
            });
            if step % 7 == 0 {
                let (sin, cos) = pose[2].sin_cos();
                let radar = [pose[0] + cos * x_m - sin * y_m, pose[1] + sin * x_m + cos * y_m];
                let (sin, cos) = yaw_rad.sin_cos();
                let car = [self.speed_mps - rate * y_m, rate * x_m];
                let velocity = [cos * car[0] + sin * car[1], cos * car[1] - sin * car[0]];
                let seen = points.iter().filter_map(|point| {
                    let [x, y] = [point[0] - radar[0], point[1] - radar[1]];
                    let (range, azimuth) = (x.hypot(y), y.atan2(x) - pose[2] - yaw_rad);
                    let azimuth = azimuth.sin().atan2(azimuth.cos());
                    let rate = -velocity[0] * azimuth.cos() - velocity[1] * azimuth.sin();
                    (range < 60.0 && azimuth.abs() < 1.1).then_some(Detection {
                        azimuth_rad: azimuth as f32,
                        range_rate_mps: rate as f32,
                        range_m: if self.ranges { range as f32 } else { f32::NAN },
                        rcs_dbsm: 0.0,
                    })
                });
                let detections = seen.collect();
                log.scans.push(Scan { time_s, sensor: 1, detections, labels: vec![] });
            }
            pose[0] += 0.01 * self.speed_mps * pose[2].cos();
            pose[1] += 0.01 * self.speed_mps * pose[2].sin();
            pose[2] += 0.01 * rate;
        }
        log
    }
}

#[test]
fn a_winding_road_tells_both_with_ranges_alone_and_with_the_lever_arm_alone() {
    assert_told("both", &Road::default().log(), [true, true]);
    let mut placeless = Road::default().log();
    placeless.sensors[0].mounting = None;
    assert_told("ranges alone", &placeless, [true, true]);
    for yaw_rad in [0.0, 0.4, -1.4, 2.6] {
        let mounting = Mounting { x_m: 3.6, y_m: 0.5, yaw_rad };
        assert_told(
            &format!("lever arm alone, at {yaw_rad}"),
            &Road { ranges: false, mounting, ..Road::default() }.log(),
            [true, true],
        );
    }
    // Behind the rear axle the velocity turns the other way.
    let mounting = Mounting { x_m: -1.0, y_m: 0.5, yaw_rad: 2.6 };
    assert_told("behind", &Road { ranges: false, mounting, ..Road::default() }.log(), [true, true]);
    let reverse = Road { speed_mps: -6.0, ranges: false, ..Road::default() };
    assert_told("in reverse", &reverse.log(), [true, true]);
}

#[test]
fn what_a_drive_does_not_tell_it_does_not_tell() {
    let untold = |what: &str, log: &DriveLog| {
        let found = found(what, log);
        assert_eq!(found.azimuth.usual, None, "{what}");
        (found.azimuth.untold, found.range_rate.usual)
    };
    let straight = Road { yaw_rate_radps: 0.0, ..Road::default() }.log();
    assert_eq!(untold("straight", &straight), (Some(Untold::TooLittle), Some(true)));
    let mut alone = Road::default().log();
    alone.motion.clear();
    assert_eq!(untold("without motion", &alone), (Some(Untold::NoYawRate), Some(true)));
    let mut bare = Road { ranges: false, ..Road::default() }.log();
    bare.sensors[0].mounting = None;
    assert_eq!(untold("angles and rates alone", &bare), (Some(Untold::NoRanges), None));
    // A radar at the side on a straight road, mirrored: what looks like reversed range rates is not told.
    let mounting = Mounting { x_m: 3.6, y_m: 0.8, yaw_rad: 1.5 };
    let side = Road { yaw_rate_radps: 0.0, ranges: false, mounting, ..Road::default() }.log();
    assert_eq!(untold("mirrored at the side", &turned(&side, -1.0, 1.0)).1, None);
    let mut standing = Road { speed_mps: 0.0, yaw_rate_radps: 0.0, ..Road::default() }.log();
    assert_eq!(untold("standing", &standing), (Some(Untold::TooLittle), None));
    standing.sensors.clear();
    assert_eq!(untold("no radar", &standing).1, None);
    assert!(find_signs(&standing, 0.0).is_err() && find_signs(&standing, f64::NAN).is_err());
}

#[test]
fn a_yaw_rate_that_counts_to_the_right_is_no_mirrored_azimuth() {
    let mut log = Road::default().log();
    log.motion.iter_mut().for_each(|sample| sample.yaw_rate_radps *= -1.0);
    assert_eq!(found("reversed", &log).azimuth.untold, Some(Untold::YawRateReversed));
    let before = log.clone();
    let auto =
        SignOptions { azimuth_sign: AzimuthSign::Auto, range_rate_sign: RangeRateSign::Auto };
    let remarks = apply(&mut log, auto, GAP_S).unwrap();
    assert!(log == before);
    assert!(
        remarks.iter().all(|remark| remark.message.ends_with("nothing was changed")),
        "{remarks:?}"
    );
}

#[test]
fn logs_are_turned_as_asked_and_as_found() {
    let log = Road::default().log();
    let with = |azimuth_sign, range_rate_sign| SignOptions { azimuth_sign, range_rate_sign };
    let (left, receding) = (AzimuthSign::Left, RangeRateSign::Receding);
    let (right, approaching) = (AzimuthSign::Right, RangeRateSign::Approaching);
    let auto = with(AzimuthSign::Auto, RangeRateSign::Auto);
    for (options, azimuth, range_rate, codes) in [
        (with(left, receding), 1.0, 1.0, &[][..]),
        (with(right, receding), -1.0, 1.0, &[]),
        (with(left, approaching), 1.0, -1.0, &[]),
        (with(right, approaching), -1.0, -1.0, &[]),
        (auto, -1.0, -1.0, &["azimuth-sign", "range-rate-sign"]),
        (auto, 1.0, -1.0, &["azimuth-sign", "range-rate-sign"]),
        (auto, 1.0, 1.0, &["azimuth-sign", "range-rate-sign"]),
        (with(left, RangeRateSign::Auto), 1.0, -1.0, &["range-rate-sign"]),
    ] {
        let mut given = turned(&log, azimuth, range_rate);
        let remarks = apply(&mut given, options, GAP_S).unwrap();
        assert!(given == log, "{options:?}");
        assert_eq!(remarks.iter().map(|remark| remark.code).collect::<Vec<_>>(), codes);
    }
}
