//! A real front radar in traffic, 600 s, against the angle its makers state: -1.96 deg.

use boresight_core::DriveLog;
use boresight_formats::drive_log;
use boresight_mounting::trajectory::{TimedMotion, integrate, relative_error};
use boresight_mounting::{AngleEstimate, CalibrationOptions, Calibrator, Frames, Method};
use std::path::Path;

const STATED_DEG: f64 = -1.96;

fn log() -> DriveLog {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../recordings/delphi");
    let names = ["front_radar.csv.gz", "pose_10hz.csv.gz"];
    let bytes = names.map(|name| std::fs::read(folder.join(name)).unwrap());
    let files = [(names[0], &bytes[0][..]), (names[1], &bytes[1][..])];
    drive_log::open(&files, None).unwrap().log
}

fn calibrate(log: &DriveLog, method: Method, from_s: f64, to_s: f64) -> AngleEstimate {
    let mounting = log.sensors[0].mounting.unwrap();
    let options = CalibrationOptions {
        method,
        x_m: mounting.x_m,
        nominal_rad: Some(mounting.yaw_rad),
        min_speed_mps: 3.0,
        ..CalibrationOptions::default()
    };
    let mut calibrator = Calibrator::new(options).unwrap();
    let frames = Frames::of(log, |_| true, options.max_gap_s).map(|(_, frame)| frame);
    for frame in frames.filter(|frame| frame.time_s >= from_s && frame.time_s < to_s) {
        calibrator.add(frame).unwrap();
    }
    calibrator.estimate()
}

/// Spread of six pieces of 100 s, and the standard deviation they claim (root mean square), deg.
fn pieces(log: &DriveLog, method: Method) -> (f64, f64) {
    let all: Vec<(f64, f64)> = (0..6)
        .map(|k| {
            let from_s = 100.0 * f64::from(k);
            let e = calibrate(log, method, from_s, from_s + 100.0);
            println!(
                "  {from_s:3} s: {:.3} +- {:.3} deg, scale {:.3} +- {:.3}, {} of {} frames",
                e.angle_rad.to_degrees(),
                e.sigma_rad.to_degrees(),
                e.scale,
                e.scale_sigma,
                e.frames.used,
                e.frames.given
            );
            (e.angle_rad.to_degrees(), e.sigma_rad.to_degrees())
        })
        .collect();
    let mean = all.iter().map(|p| p.0).sum::<f64>() / 6.0;
    let spread = (all.iter().map(|p| (p.0 - mean).powi(2)).sum::<f64>() / 5.0).sqrt();
    let claimed = (all.iter().map(|p| p.1 * p.1).sum::<f64>() / 6.0).sqrt();
    println!("  spread {spread:.3}, claimed {claimed:.3}, ratio {:.2}", spread / claimed);
    (spread, claimed)
}

#[test]
fn the_recursive_method_finds_the_stated_angle_with_an_honest_deviation() {
    let log = log();
    let mut spreads = Vec::new();
    for method in Method::ALL {
        let e = calibrate(&log, method, 0.0, f64::INFINITY);
        let angle_deg = e.angle_rad.to_degrees();
        println!(
            "{}: {angle_deg:.3} +- {:.3} deg, scale {:.3} +- {:.3}, inliers {:.2}",
            method.name(),
            e.sigma_rad.to_degrees(),
            e.scale,
            e.scale_sigma,
            e.inlier_share
        );
        let (spread, claimed) = pieces(&log, method);
        spreads.push((method, spread));
        if method == Method::Recursive {
            assert!((angle_deg - STATED_DEG).abs() < 0.15, "{e:?}");
            assert!(spread < 2.5 * claimed, "{spread} {claimed}");
        }
    }
    let of = |wanted| spreads.iter().find(|(method, _)| *method == wanted).unwrap().1;
    println!(
        "recursive {:.3}, weighted mean {:.3}",
        of(Method::Recursive),
        of(Method::WeightedMean)
    );
}

#[test]
fn the_log_drives_where_it_looks() {
    let log = log();
    let mut offsets: Vec<f64> = log
        .motion
        .windows(3)
        .filter(|w| w[1].speed_mps.unwrap() > 5.0 && w[1].yaw_rate_radps.abs() < 0.01)
        .map(|w| {
            let (a, b) = (w[0].pose.unwrap(), w[2].pose.unwrap());
            let way = (b.y_m - a.y_m).atan2(b.x_m - a.x_m) - w[1].pose.unwrap().yaw_rad;
            way.sin().asin().to_degrees()
        })
        .collect();
    offsets.sort_by(f64::total_cmp);
    let median = offsets[offsets.len() / 2];
    assert!(offsets.len() > 2000 && median.abs() < 0.05, "{median}");
}

#[test]
fn the_angle_found_takes_the_car_where_it_went() {
    let log = log();
    let estimate = calibrate(&log, Method::Recursive, 0.0, 600.0);
    let mounting = log.sensors[0].mounting.unwrap();
    let options = CalibrationOptions {
        x_m: mounting.x_m,
        nominal_rad: Some(mounting.yaw_rad),
        ..CalibrationOptions::default()
    };
    let mut calibrator = Calibrator::new(options).unwrap();
    let (mut motions, mut truth) = (vec![], vec![]);
    for (_, frame) in Frames::of(&log, |_| true, options.max_gap_s) {
        let time_s = frame.time_s;
        let yaw_rate_radps = frame.yaw_rate_radps;
        let outcome = calibrator.add(frame).unwrap();
        if let (Some(motion), Some(pose)) = (outcome.motion, log.pose_at(time_s, 0.25)) {
            let velocity_mps = motion.velocity_mps;
            motions.push(TimedMotion { time_s, velocity_mps, yaw_rate_radps });
            truth.push(pose);
        }
    }
    let error = |angle_rad: f64| {
        let poses = integrate(&motions, angle_rad, mounting.x_m, 0.0).unwrap();
        relative_error(poses.into_iter().zip(truth.iter().copied()), 50.0).unwrap()
    };
    let (found, nominal) = (error(estimate.angle_rad), error(0.0));
    println!(
        "after 50 m {found:.3} m off with the angle found, {nominal:.3} m with the nominal one"
    );
    // 1.94 deg of 50 m are 1.7 m to the side; tracks that lag leave the rest along the way.
    assert!(found < 0.8 && nominal > 1.4, "{found} {nominal}");
}
