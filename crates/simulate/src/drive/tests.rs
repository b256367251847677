use super::*;
use crate::digest::fnv1a;
use boresight_core::Diagnose;

fn options(scenario: Scenario, seed: u64, duration_s: f64) -> DriveOptions {
    DriveOptions { scenario, seed, duration_s, ..DriveOptions::default() }
}

fn noise_free() -> RadarNoise {
    RadarNoise {
        azimuth_sigma_rad: 0.0,
        range_rate_sigma_mps: 0.0,
        range_sigma_m: 0.0,
        coherent_interval_s: 0.0,
        ghost_share: 0.0,
        clutter: 0.0,
        ..RadarNoise::default()
    }
}

fn quantile(sorted: &[f64], q: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * q) as usize]
}

/// Share of moving detections in the scans of some radars taken at more than 1 m/s.
fn moving_share(drive: &SimulatedDrive, sensors: &[u8]) -> f64 {
    let (mut moving, mut all) = (0.0, 0.0);
    for (scan, flags) in drive.log.scans.iter().zip(&drive.moving) {
        let speed = motion::motion_at(&drive.truth.motion, scan.time_s).speed_mps.abs();
        if sensors.contains(&scan.sensor) && speed > trim::COUNTED_MPS {
            moving += flags.iter().filter(|m| **m).count() as f64;
            all += flags.len() as f64;
        }
    }
    moving / all
}

#[test]
fn drive_noise_free_static_detections_lie_on_the_curve_of_the_radars_motion() {
    for (scenario, slip_gradient) in [(Scenario::City, 0.0), (Scenario::CarPark, 0.004)] {
        let options = DriveOptions {
            noise: noise_free(),
            slip_gradient_rad: Some(slip_gradient),
            ..options(scenario, 3, 40.0)
        };
        let drive = simulate_drive(&options).unwrap();
        let mut seen = 0;
        for (scan, flags) in drive.log.scans.iter().zip(&drive.moving) {
            let (_, at) = drive.truth.sensors[usize::from(scan.sensor) - 1];
            let m = motion::motion_at(&drive.truth.motion, scan.time_s);
            // Written out anew: velocity of the mounting's place, then turned into its frame.
            let forward = m.speed_mps - m.yaw_rate_radps * at.y_m;
            let left = m.speed_mps * m.slip_rad.sin() + m.yaw_rate_radps * at.x_m;
            let vx = forward * at.yaw_rad.cos() + left * at.yaw_rad.sin();
            let vy = -forward * at.yaw_rad.sin() + left * at.yaw_rad.cos();
            for (detection, moving) in scan.detections.iter().zip(flags) {
                if *moving {
                    continue;
                }
                let a = f64::from(detection.azimuth_rad);
                let error = f64::from(detection.range_rate_mps) + vx * a.cos() + vy * a.sin();
                // Single precision of azimuth and range rate, and road users below 0.1 m/s.
                assert!(error.abs() < 0.21, "{error} at {}", scan.time_s);
                seen += usize::from(error.abs() < 1e-5);
            }
        }
        let all: usize = drive.moving.iter().flatten().filter(|m| !**m).count();
        assert!(seen as f64 > 0.97 * all as f64, "{seen} of {all}");
    }
}

#[test]
fn drive_poses_integrate_speed_yaw_rate_and_slip() {
    for scenario in Scenario::ALL {
        let options =
            DriveOptions { slip_gradient_rad: Some(0.003), ..options(scenario, 5, 120.0) };
        let truth = simulate_drive(&options).unwrap().truth.motion;
        for pair in truth.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            let yaw = 0.5 * (a.pose.yaw_rad + b.pose.yaw_rad) + 0.5 * (a.slip_rad + b.slip_rad);
            let step = 0.5 * (a.speed_mps + b.speed_mps) * MOTION_STEP_S;
            let dx = b.pose.x_m - a.pose.x_m - step * yaw.cos();
            let dy = b.pose.y_m - a.pose.y_m - step * yaw.sin();
            let turn = 0.5 * (a.yaw_rate_radps + b.yaw_rate_radps) * MOTION_STEP_S;
            let dyaw = b.pose.yaw_rad - a.pose.yaw_rad - turn;
            assert!(dx.abs() < 2e-4 && dy.abs() < 2e-4, "{scenario:?} {} {dx} {dy}", a.time_s);
            assert!(dyaw.abs() < 3e-4, "{scenario:?} {} {dyaw}", a.time_s);
        }
        let last = truth.last().unwrap();
        let turned: f64 = truth.iter().map(|m| m.yaw_rate_radps * MOTION_STEP_S).sum();
        let total = last.pose.yaw_rad - truth[0].pose.yaw_rad;
        assert!((turned - total).abs() < 0.02, "{scenario:?} {turned} {total}");
    }
}

#[test]
fn drive_motion_stays_within_what_a_car_can_do() {
    for scenario in Scenario::ALL {
        let truth = simulate_drive(&options(scenario, 8, 240.0)).unwrap().truth.motion;
        for m in &truth {
            let lateral = m.speed_mps * m.yaw_rate_radps;
            assert!(lateral.abs() < 1.25 * scenario.lateral_mps2(), "{scenario:?} {lateral}");
            assert!(m.acceleration_mps2.abs() <= 3.01, "{scenario:?} {}", m.acceleration_mps2);
            assert!(m.speed_mps.abs() < 38.0, "{scenario:?} {}", m.speed_mps);
        }
        for pair in truth.windows(2) {
            let change = (pair[1].speed_mps - pair[0].speed_mps) / MOTION_STEP_S;
            assert!(change.abs() < 4.0, "{scenario:?} {change} at {}", pair[0].time_s);
        }
    }
}

#[test]
fn drive_yaw_rate_is_measured_with_scale_bias_and_noise() {
    let options = DriveOptions {
        yaw_rate_scale: Some(1.015),
        yaw_rate_bias_radps: Some(0.003),
        yaw_rate_sigma_radps: Some(0.002),
        speed_scale: Some(1.01),
        ..options(Scenario::City, 6, 200.0)
    };
    let drive = simulate_drive(&options).unwrap();
    let pairs: Vec<(f64, f64)> = drive
        .log
        .motion
        .iter()
        .zip(&drive.truth.motion)
        .map(|(m, t)| (t.yaw_rate_radps, m.yaw_rate_radps))
        .collect();
    let n = pairs.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>() / n;
    let (mx, my) = (mean(&|p| p.0), mean(&|p| p.1));
    let sxx = mean(&|p| (p.0 - mx) * (p.0 - mx));
    let scale = mean(&|p| (p.0 - mx) * (p.1 - my)) / sxx;
    let bias = my - scale * mx;
    let variance = mean(&|p| (p.1 - bias - scale * p.0) * (p.1 - bias - scale * p.0));
    // Five standard errors each of a regression line over 20000 samples.
    assert!((scale - 1.015).abs() < 5.0 * 0.002 / (n * sxx).sqrt(), "{scale}");
    assert!((bias - 0.003).abs() < 5.0 * 0.002 / n.sqrt() * (1.0 + mx.abs() / sxx.sqrt()));
    assert!((variance.sqrt() / 0.002 - 1.0).abs() < 5.0 / (2.0 * n).sqrt());
    for (m, t) in drive.log.motion.iter().zip(&drive.truth.motion) {
        assert_eq!(m.pose, Some(t.pose));
        assert!((m.speed_mps.unwrap() - 1.01 * t.speed_mps).abs() < 6.0 * 0.03);
        assert!(t.speed_mps != 0.0 || m.speed_mps == Some(0.0));
    }
    let drawn = simulate_drive(&self::options(Scenario::City, 6, 2.0)).unwrap().truth.yaw_rate;
    assert!((drawn.scale - 1.0).abs() <= 0.02 && drawn.bias_radps.abs() <= 0.0035);
}

#[test]
fn drive_scans_come_in_free_running_cycles_within_the_field_of_view() {
    let drive = simulate_drive(&options(Scenario::DenseTraffic, 1, 60.0)).unwrap();
    assert!(drive.log.scans.windows(2).all(|p| p[0].time_s <= p[1].time_s));
    for (id, _) in &drive.truth.sensors {
        let times: Vec<f64> =
            drive.log.scans.iter().filter(|s| s.sensor == *id).map(|s| s.time_s).collect();
        assert!((805..=820).contains(&times.len()), "{}", times.len());
        for pair in times.windows(2) {
            let cycle = pair[1] - pair[0];
            assert!((CYCLE_S[0] - 1e-9..=CYCLE_S[1] + 1e-9).contains(&cycle), "{cycle}");
        }
    }
    for scan in &drive.log.scans {
        assert!(scan.detections.len() <= MAX_DETECTIONS);
        assert_eq!(scan.labels.len(), scan.detections.len());
        for d in &scan.detections {
            assert!(f64::from(d.azimuth_rad).abs() <= FIELD_OF_VIEW_RAD);
            assert!((0.499..=100.001).contains(&d.range_m) && d.rcs_dbsm.is_finite());
        }
    }
    for ((scan, moving), tracks) in drive.log.scans.iter().zip(&drive.moving).zip(&drive.tracks) {
        for ((label, moving), track) in scan.labels.iter().zip(moving).zip(tracks) {
            assert_eq!(*moving, *label != STATIC_CLASS);
            assert!(!moving || *track > 0);
        }
    }
}

#[test]
fn drive_moving_share_is_what_was_asked_for() {
    for scenario in Scenario::ALL {
        for share in [0.0, 0.3] {
            let options = DriveOptions { moving_share: Some(share), ..options(scenario, 11, 60.0) };
            let drive = simulate_drive(&options).unwrap();
            let given = moving_share(&drive, &[1, 2, 3, 4]);
            // Only the trimmed detections are random: at most a binomial of some thousands.
            assert!((given - share).abs() < 0.02, "{scenario:?} {share} {given}");
        }
    }
    let options =
        DriveOptions { moving_share: Some(0.8), ..options(Scenario::DenseTraffic, 2, 60.0) };
    let drive = simulate_drive(&options).unwrap();
    assert!((moving_share(&drive, &[1, 2, 3, 4]) - 0.8).abs() < 0.02);
    let detections: usize = drive.log.scans.iter().map(|s| s.detections.len()).sum();
    assert!(detections > 20 * drive.log.scans.len(), "{detections}");
}

#[test]
fn drive_nominal_mountings_differ_by_the_misalignment() {
    let options =
        DriveOptions { misalignment_rad: vec![(3, 0.05)], ..options(Scenario::City, 1, 5.0) };
    let drive = simulate_drive(&options).unwrap();
    for (sensor, (id, truth)) in drive.log.sensors.iter().zip(&drive.truth.sensors) {
        let nominal = sensor.mounting.unwrap();
        let off = if *id == 3 { 0.05 } else { 0.0 };
        assert_eq!(nominal.yaw_rad, truth.yaw_rad - off);
    }
}

#[test]
fn drive_repeats_bit_for_bit_and_seeds_differ() {
    let digest = |seed| crate::digest::drive_digest(&options(Scenario::City, seed, 8.0)).unwrap();
    assert_eq!(digest(4), digest(4));
    assert_ne!(digest(4), digest(5));
    assert_ne!(fnv1a([digest(4)]), 0);
}

#[test]
fn drive_bad_options_are_typed_errors() {
    let good = || options(Scenario::City, 0, 5.0);
    let bad: [(DriveOptions, &str); 14] = [
        (DriveOptions { duration_s: 0.0, ..good() }, "out-of-range"),
        (DriveOptions { duration_s: f64::NAN, ..good() }, "out-of-range"),
        (DriveOptions { duration_s: 1e9, ..good() }, "out-of-range"),
        (DriveOptions { duration_s: 7000.0, ..good() }, "out-of-range"),
        (
            DriveOptions { profile: DriveProfile::Radarscenes, duration_s: 1201.0, ..good() },
            "out-of-range",
        ),
        (DriveOptions { sensors: vec![], ..good() }, "empty"),
        (
            DriveOptions {
                sensors: [&good().sensors[..], &good().sensors[..1]].concat(),
                ..good()
            },
            "out-of-range",
        ),
        (DriveOptions { misalignment_rad: vec![(9, 0.1)], ..good() }, "out-of-range"),
        (DriveOptions { misalignment_rad: vec![(1, 9.1)], ..good() }, "out-of-range"),
        (DriveOptions { moving_share: Some(0.9), ..good() }, "out-of-range"),
        (DriveOptions { slip_gradient_rad: Some(f64::INFINITY), ..good() }, "out-of-range"),
        (DriveOptions { yaw_rate_scale: Some(0.0), ..good() }, "out-of-range"),
        (
            DriveOptions {
                noise: RadarNoise { azimuth_sigma_rad: -1.0, ..RadarNoise::default() },
                ..good()
            },
            "out-of-range",
        ),
        (
            DriveOptions {
                profile: DriveProfile::Radarscenes,
                noise: RadarNoise { clutter: 2.0, ..RadarNoise::default() },
                ..good()
            },
            "incompatible",
        ),
    ];
    for (options, code) in bad {
        assert_eq!(simulate_drive(&options).unwrap_err().code(), code, "{options:?}");
    }
    assert_eq!(Scenario::from_name("moon").unwrap_err().code(), "unknown-name");
    for scenario in Scenario::ALL {
        assert_eq!(Scenario::from_name(scenario.name()), Ok(scenario));
    }
}

/// Prints what the scenarios are like, and holds them to what they promise.
#[test]
fn drive_scenarios_are_like_their_roads() {
    println!(
        "scenario         detections of 1..4      moving % of 1..4     speed m/s 5/50/95 %   stands %  yaw rate deg/s 5/50|.|/max  |a|>1.5 %  ghosts %"
    );
    let mut all = vec![];
    for scenario in Scenario::ALL {
        let drive = simulate_drive(&options(scenario, 21, 300.0)).unwrap();
        let count = |id: u8| {
            let counts: Vec<usize> = drive
                .log
                .scans
                .iter()
                .filter(|s| s.sensor == id)
                .map(|s| s.detections.len())
                .collect();
            counts.iter().sum::<usize>() as f64 / counts.len() as f64
        };
        let counts: Vec<f64> = (1..=4).map(count).collect();
        let shares: Vec<f64> = (1..=4).map(|id| moving_share(&drive, &[id])).collect();
        let truth = &drive.truth.motion;
        let mut speeds: Vec<f64> = truth.iter().map(|m| m.speed_mps).collect();
        speeds.sort_by(f64::total_cmp);
        let mut rates: Vec<f64> =
            truth.iter().map(|m| m.yaw_rate_radps.abs().to_degrees()).collect();
        rates.sort_by(f64::total_cmp);
        let n = truth.len() as f64;
        let stands = truth.iter().filter(|m| m.speed_mps == 0.0).count() as f64 / n;
        let reverse = truth.iter().filter(|m| m.speed_mps < 0.0).count() as f64 / n;
        let hard = truth.iter().filter(|m| m.acceleration_mps2.abs() > 1.5).count() as f64 / n;
        let (mut odd, mut standing) = (0.0, 0.0);
        for (scan, flags) in drive.log.scans.iter().zip(&drive.moving) {
            let (_, at) = drive.truth.sensors[usize::from(scan.sensor) - 1];
            let [vx, vy] = motion::motion_at(truth, scan.time_s).radar_velocity(&at);
            for (d, _) in scan.detections.iter().zip(flags).filter(|(_, moving)| !**moving) {
                let a = f64::from(d.azimuth_rad);
                let error = f64::from(d.range_rate_mps) + vx * a.cos() + vy * a.sin();
                standing += 1.0;
                odd += f64::from(u8::from(error.abs() > 1.0));
            }
        }
        println!(
            "{:14} {:6.1}{:6.1}{:6.1}{:6.1}  {:5.1}{:5.1}{:5.1}{:5.1}  {:6.1}{:6.1}{:6.1}  {:6.1} rev {:4.1}  {:6.2}{:6.2}{:6.1}{:6.1}  {:5.1}  {:5.2}",
            scenario.name(),
            counts[0],
            counts[1],
            counts[2],
            counts[3],
            100.0 * shares[0],
            100.0 * shares[1],
            100.0 * shares[2],
            100.0 * shares[3],
            quantile(&speeds, 0.05),
            quantile(&speeds, 0.5),
            quantile(&speeds, 0.95),
            100.0 * stands,
            100.0 * reverse,
            quantile(&rates, 0.5),
            quantile(&rates, 0.8),
            quantile(&rates, 0.95),
            quantile(&rates, 1.0),
            100.0 * hard,
            100.0 * odd / standing,
        );
        all.push((scenario, counts, stands, reverse, odd / standing));
    }
    for (scenario, counts, stands, reverse, odd) in all {
        for c in counts {
            assert!((20.0..=200.0).contains(&c), "{scenario:?} {c}");
        }
        let promised = match scenario {
            Scenario::City => 0.05..0.5,
            Scenario::StopAndGo => 0.2..0.8,
            Scenario::DenseTraffic => 0.01..0.4,
            Scenario::CarPark => 0.03..0.6,
            Scenario::Motorway => -0.1..0.001,
            Scenario::CountryRoad => -0.1..0.1,
        };
        assert!(promised.contains(&stands), "{scenario:?} stands {stands}");
        assert!((reverse > 0.02) == (scenario == Scenario::CarPark), "{scenario:?} {reverse}");
        assert!((0.005..0.04).contains(&(odd)), "{scenario:?} {}", odd);
    }
}
