//! Statistics of logs: what a simulated drive has is found again, and what a log lacks is said.

use boresight_core::drive::STATIC_LABEL;
use boresight_core::{Detection, DriveLog};
use boresight_formats::ReadReport;
use boresight_formats::radarscenes::{Companions, read_path};
use boresight_mounting::signs::find_signs;
use boresight_mounting::statistics::{Row, SensorStatistics, log_statistics};
use boresight_simulate::drive::{DriveOptions, DriveProfile, Scenario, simulate_drive};
use std::path::Path;

const GAP_S: f64 = 0.25;

fn statistics(log: &DriveLog) -> Vec<SensorStatistics> {
    log_statistics(log, GAP_S).unwrap()
}

#[test]
fn white_noise_of_a_clean_drive_is_found_and_does_not_last() {
    let options = DriveOptions {
        scenario: Scenario::City,
        seed: 3,
        duration_s: 240.0,
        moving_share: Some(0.0),
        ..DriveOptions::default()
    };
    let drive = simulate_drive(&options).unwrap();
    for one in statistics(&drive.log) {
        let (noise, angles) = (&one.noise, &one.angles);
        assert!((one.counts.cycle_s - 0.074).abs() < 0.0005);
        assert!((one.counts.cycle_jitter_s - 0.0002).abs() < 4e-5);
        assert_eq!(one.counts.lost_share, 0.0);
        // Others go on while the car stands, and then count for no share.
        assert!(one.counts.moving_share < 0.03, "{}", one.counts.moving_share);
        // 1.2 % with a random range rate, and 0.5 of 25 to 50 from nowhere; a sixth of them near the curve.
        assert!((0.006..0.035).contains(&noise.outlier_share), "{noise:?}");
        // Radars that look ahead see along their way, where azimuth does not matter.
        if [2, 3].contains(&one.sensor) {
            assert!((noise.range_rate_sigma_mps - 0.05).abs() < 0.025, "{noise:?}");
        }
        for (at_deg, sigma) in [0.0, 30.0, 50.0].into_iter().zip(noise.azimuth_sigma_rad) {
            let expected = 0.35_f64.to_radians() * (1.0 + 2.0 * f64::powi(at_deg / 60.0, 2));
            // Together, on a slope of 10 m/s: speeds that are much alike hardly tell one from the other.
            let both = |rate: f64, azimuth: f64| rate.hypot(10.0 * azimuth);
            let found = both(noise.range_rate_sigma_mps, sigma) / both(0.05, expected);
            // Bins of 10 deg, a motion that follows the noise of few detections, and a growth with the speed
            // that takes part of it.
            assert!((found - 1.0).abs() < 0.4, "{at_deg} {found} {noise:?}");
        }
        assert!(noise.azimuth_sigma_rad[3].is_nan());
        // A correlation of some 3000 scans is good to 0.02; single scans of few detections vary in quality.
        assert!(angles.autocorrelation.abs() < 0.1, "{angles:?}");
        assert!((0.9..1.5).contains(&angles.scatter_over_formal), "{angles:?}");
        assert!(angles.offset_rad.abs() < 0.1_f64.to_radians(), "{angles:?}");
        assert!((one.speed_ratio - 1.0).abs() < 0.003, "{}", one.speed_ratio);
    }
}

#[test]
fn special_values_of_azimuth_change_neither_statistics_nor_signs() {
    let options = DriveOptions { seed: 3, duration_s: 40.0, ..DriveOptions::default() };
    let clean = simulate_drive(&options).unwrap().log;
    let mut marked = clean.clone();
    for scan in &mut marked.scans {
        scan.labels.extend((!scan.labels.is_empty()).then_some(STATIC_LABEL));
        let azimuth_rad = 655.35_f32.to_radians();
        let marker =
            scan.detections.first().map(|first| Detection { azimuth_rad, ..*first }).unwrap();
        scan.detections.push(marker);
    }
    for (expected, found) in statistics(&clean).iter().zip(statistics(&marked)) {
        assert_eq!(found.counts.azimuth_span_rad, expected.counts.azimuth_span_rad);
        assert_eq!(format!("{:?}", found.noise), format!("{:?}", expected.noise));
        assert_eq!(format!("{:?}", found.angles), format!("{:?}", expected.angles));
        assert_eq!(found.counts.detections, expected.counts.detections + expected.counts.scans);
    }
    let signs = |log: &DriveLog| format!("{:?}", find_signs(log, GAP_S).unwrap());
    assert_eq!(signs(&marked), signs(&clean));
}

#[test]
fn slip_delay_and_lasting_errors_of_a_drive_as_radarscenes_are_found() {
    let options = DriveOptions {
        profile: DriveProfile::Radarscenes,
        scenario: Scenario::City,
        seed: 4,
        duration_s: 120.0,
        moving_share: Some(0.03),
        slip_gradient_rad: Some(0.006),
        speed_scale: Some(1.01),
        ..DriveOptions::default()
    };
    let drive = simulate_drive(&options).unwrap();
    let car = drive.truth.car;
    let mut delays = 0;
    for one in statistics(&drive.log) {
        let angles = &one.angles;
        println!("{one:?}");
        // Errors that last a second leave 120 independent ones of up to 4 mrad, and turns of 1 to 2 m/s^2.
        assert!((angles.slip_gradient_rad - 0.006).abs() < 0.0012, "{angles:?}");
        if angles.delay_s.is_finite() {
            delays += 1;
            let expected = car.delay_s - car.yaw_rate_lag_s;
            assert!((angles.delay_s - expected).abs() < 0.04, "{} {expected}", angles.delay_s);
        }
        assert!(angles.autocorrelation > 0.2, "{angles:?}");
        assert!(angles.scatter_over_formal > 1.6, "{angles:?}");
        // Heights shorten range rates by some tenths of a percent.
        assert!((one.speed_ratio - 1.01).abs() < 0.006, "{}", one.speed_ratio);
    }
    assert!(delays >= 2, "{delays}");
}

#[test]
fn what_a_log_lacks_is_said_and_why() {
    let options = DriveOptions { duration_s: 20.0, seed: 1, ..DriveOptions::default() };
    let log = simulate_drive(&options).unwrap().log;
    let untold = |change: &dyn Fn(&mut DriveLog)| -> Vec<(Row, String)> {
        let mut log = log.clone();
        change(&mut log);
        let all = statistics(&log);
        all[0].untold.iter().map(|one| (one.row, one.why.clone())).collect()
    };
    let says = |found: &[(Row, String)], row: Row, why: &str| {
        assert!(found.iter().any(|one| one.0 == row && one.1.contains(why)), "{found:?}");
    };
    let without_labels = untold(&|log| log.scans.iter_mut().for_each(|scan| scan.labels.clear()));
    says(&without_labels, Row::MovingShare, "labels");
    let without_motion = untold(&|log| log.motion.clear());
    says(&without_motion, Row::Angles, "yaw rate");
    says(&without_motion, Row::Delay, "yaw rate");
    says(&without_motion, Row::Speed, "speed");
    let without_mounting = untold(&|log| log.sensors[0].mounting = None);
    says(&without_mounting, Row::Angles, "where the radar sits");
    let without_speed =
        untold(&|log| log.motion.iter_mut().for_each(|sample| sample.speed_mps = None));
    assert!(without_speed.iter().all(|one| one.0 != Row::Angles), "{without_speed:?}");
    says(&without_speed, Row::Speed, "no speed");
    let empty = untold(&|log| log.scans.clear());
    for row in [Row::Cycle, Row::MovingShare, Row::Outliers, Row::Noise, Row::Angles, Row::Speed] {
        assert!(empty.iter().any(|one| one.0 == row), "{row}: {empty:?}");
    }
    for gap in [0.0, -1.0, f64::NAN] {
        assert!(log_statistics(&log, gap).is_err());
    }
    assert_eq!(statistics(&DriveLog::default()), []);
}

/// Of a sequence that is not part of the project.
#[test]
fn sequence_105_is_as_it_was_measured_elsewhere() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/radarscenes-105");
    let sequence = folder.join("sequence_105");
    if !sequence.is_dir() {
        println!("skipped: {} is not there", sequence.display());
        return;
    }
    let read = |path: &Path| std::fs::read(path).unwrap();
    let (scenes, sensors) =
        (read(&sequence.join("scenes.json")), read(&folder.join("sensors.json")));
    let beside = Companions { scenes: Some(&scenes), sensors: Some(&sensors) };
    let mut report = ReadReport::default();
    let log = read_path(&sequence.join("radar_data.h5"), beside, &mut report).unwrap();
    let slips = [0.0047, 0.0044, 0.0041, 0.0044];
    let scatters_deg = [0.09, 0.185, 0.185, 0.10];
    for ((one, slip), scatter_deg) in statistics(&log).iter().zip(slips).zip(scatters_deg) {
        let angles = &one.angles;
        // Another program, with other clipping and without the delay.
        assert!((angles.slip_gradient_rad - slip).abs() < 0.0006, "{angles:?}");
        assert!(
            (0.65..1.2).contains(&(angles.scatter_rad.to_degrees() / scatter_deg)),
            "{angles:?}"
        );
        assert!((2.0..3.7).contains(&angles.scatter_over_formal), "{angles:?}");
        assert!((0.35..0.8).contains(&angles.autocorrelation), "{angles:?}");
        assert!((0.04..0.14).contains(&one.noise.outlier_share), "{:?}", one.noise);
    }
}
