//! Extreme finite numbers: no panic, no endless loop, and no converged result that is not a number.

use crate::common::{BATCH, Drive, network};
use boresight_core::{Detection, Random};
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, Calibrator, Car, DrivePart, FrameInput, Fusion, Joint,
    MergeOptions, Method, MotionEstimator, MotionMethod, NormalEquations, Recursive, merge,
    merge_drives,
};

/// Random cases; `BORESIGHT_CASES` asks for more.
fn cases() -> u64 {
    std::env::var("BORESIGHT_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(60)
}

/// A number that is often far out: huge, tiny, denormal or zero.
fn extreme(random: &mut Random) -> f64 {
    let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
    sign * match (8.0 * random.unit()) as u32 {
        0 => 0.0,
        1 => 5e-324,
        2 => 1e-310,
        3 => 10.0_f64.powf(random.uniform(-300.0, 300.0)),
        4 => 10.0_f64.powf(random.uniform(-40.0, 40.0)),
        5 => f64::MAX,
        _ => random.uniform(0.0, 30.0),
    }
}

fn seldom(random: &mut Random, usual: f64, share: f64) -> f64 {
    if random.unit() < share { extreme(random) } else { usual }
}

fn assert_sane(estimate: &AngleEstimate, what: &str) {
    if estimate.converged {
        let e = estimate;
        let numbers =
            [e.angle_rad, e.sigma_rad, e.scale, e.bias_radps, e.slip_gradient_rad, e.delay_s];
        assert!(numbers.iter().all(|number| number.is_finite()), "{what}: {estimate:?}");
    }
    let nan = [estimate.angle_rad, estimate.sigma_rad];
    assert!(!nan.iter().any(|number| number.is_nan()), "{what}: {estimate:?}");
}

/// Runs a short drive of which a share of all numbers is replaced.
fn spoilt(random: &mut Random, drive: &Drive, share: f64, mut add: impl FnMut(usize, FrameInput)) {
    let mut place = 0;
    let mut time_s = 0.0;
    drive.run(|frame, _| {
        // Steps of time are extreme, so that frames are not only rejected.
        time_s += seldom(random, 1.0 / 13.5, 0.1 * share).abs();
        let detections: Vec<Detection> = frame
            .detections
            .iter()
            .map(|d| Detection {
                azimuth_rad: seldom(random, d.azimuth_rad.into(), share) as f32,
                range_rate_mps: seldom(random, d.range_rate_mps.into(), share) as f32,
                range_m: seldom(random, 20.0, share) as f32,
                rcs_dbsm: seldom(random, 0.0, share) as f32,
            })
            .collect();
        let frame = FrameInput {
            time_s,
            detections: &detections,
            yaw_rate_radps: frame.yaw_rate_radps.map(|rate| seldom(random, rate, share)),
            speed_mps: frame.speed_mps.map(|speed| seldom(random, speed, share)),
        };
        add(place, frame);
        place += 1;
    });
}

fn spoilt_options(random: &mut Random, drive: &Drive, method: Method) -> CalibrationOptions {
    let share = if random.unit() < 0.5 { 0.0 } else { 0.15 };
    let usual = drive.options(method);
    let mut near = |value: f64| seldom(random, value, share);
    let spoilt = CalibrationOptions {
        x_m: near(usual.x_m),
        y_m: near(usual.y_m),
        nominal_rad: Some(near(drive.angle_rad)),
        range_rate_sigma_mps: near(usual.range_rate_sigma_mps),
        azimuth_sigma_rad: near(usual.azimuth_sigma_rad),
        lasting_sigma_rad: near(usual.lasting_sigma_rad),
        bias_sigma_radps: near(usual.bias_sigma_radps),
        scale_sigma: near(usual.scale_sigma),
        slip_gradient_sigma_rad: near(usual.slip_gradient_sigma_rad),
        delay_sigma_s: near(usual.delay_sigma_s),
        inlier_residual_mps: near(usual.inlier_residual_mps),
        ..usual
    };
    if spoilt.validate().is_ok() { spoilt } else { usual }
}

#[test]
fn calibrations_of_extreme_frames_are_numbers_or_not_converged() {
    let network = network();
    // A variance overflowed in the case 435.
    for case in (0..cases()).chain([435]) {
        let mut random = Random::new(case, 17);
        let drive =
            Drive { frames: 150, standing: 10, detections: 16, seed: case, ..Drive::default() };
        let share = [0.001, 0.02, 0.3, 1.0][(4.0 * random.unit()) as usize % 4];
        let methods: Vec<Method> = BATCH.into_iter().chain([Method::Recursive]).collect();
        for method in methods {
            let options = spoilt_options(&mut random, &drive, method);
            let motion = [None, Some(MotionMethod::Deepego), Some(MotionMethod::Tracked)];
            let options = CalibrationOptions {
                motion: motion[(3.0 * random.unit()) as usize % 3],
                ..options
            };
            let what = format!("case {case}, {options:?}");
            let mut calibrator = Calibrator::with_network(options, Some(&network)).unwrap();
            spoilt(&mut random, &drive, share, |place, frame| {
                let _ = calibrator.add(frame);
                if place % 50 == 49 {
                    assert_sane(&calibrator.estimate(), &what);
                    let _ = calibrator.outlook();
                }
                if place == 100 {
                    calibrator.restart();
                }
            });
            assert_sane(&calibrator.estimate(), &what);
            if let Ok(bytes) = calibrator.snapshot()
                && let Ok(restored) = Calibrator::restore(&bytes, Some(&network))
            {
                assert_sane(&restored.estimate(), &what);
            }
        }
    }
}

#[test]
fn joint_fused_and_merged_calibrations_of_extreme_frames_are_numbers_or_not_converged() {
    let network = network();
    for case in 0..cases() / 3 {
        let mut random = Random::new(case, 18);
        let drive =
            Drive { frames: 150, standing: 10, detections: 16, seed: case, ..Drive::default() };
        let share = [0.001, 0.02, 0.3, 1.0][(4.0 * random.unit()) as usize % 4];
        let what = format!("case {case}, share {share}");
        let options =
            [1, 2].map(|sensor| (sensor, spoilt_options(&mut random, &drive, Method::Recursive)));
        let mut joint = Joint::new(&options).unwrap();
        let mut car = Car::apart(options.to_vec(), None).unwrap();
        let mounted = options.map(|(sensor, o)| boresight_mounting::fusion::Mounted {
            sensor,
            angle_rad: drive.angle_rad,
            x_m: o.x_m,
            y_m: o.y_m,
        });
        let mut fusion = Fusion::new(&mounted, 0.003, &network).unwrap();
        let mut estimator =
            MotionEstimator::new(&options[0].1, MotionMethod::OrthogonalDistance).unwrap();
        let mut drives = [options[0]; 2].map(|(_, options)| Recursive::new(&options).unwrap());
        spoilt(&mut random, &drive, share, |place, frame| {
            let sensor = 1 + (place % 2) as u8;
            let _ = (joint.add(sensor, frame), car.add(sensor, frame));
            let _ = drives[place % 2].add(frame);
            if place < 40 {
                let _ = fusion.add(sensor, frame);
            }
            if let Some(motion) = estimator.estimate(frame.detections) {
                assert!(motion.velocity_mps.iter().all(|v| v.is_finite()), "{what}");
            }
        });
        for (_, estimate) in joint.estimate() {
            assert_sane(&estimate, &what);
        }
        for sensor in [1, 2] {
            assert_sane(&car.estimate(sensor).unwrap(), &what);
        }
        if let Ok(merged) = merge(&drives) {
            assert_sane(&merged, &what);
        }
    }
}

#[test]
fn extreme_equations_are_refused_or_give_numbers() {
    for case in 0..20 * cases() {
        let mut random = Random::new(case, 19);
        let count = 1 + (4.0 * random.unit()) as usize;
        let share = [0.02, 0.2, 1.0][(3.0 * random.unit()) as usize % 3];
        let drives: Vec<Vec<DrivePart>> = (0..count)
            .map(|_| {
                let mut near = |usual: f64| seldom(&mut random, usual, share);
                let reference = [0.4, 1.0, 0.0, 0.003, 0.04].map(&mut near);
                let mut information = [0.0; 15].map(&mut near);
                for diagonal in [0, 5, 9, 12, 14] {
                    information[diagonal] = near(1e5).abs();
                }
                let right = [0.0; 5].map(&mut near);
                let prior_information = [100.0, 2500.0, 3e5, 1e5, 1e3].map(|p| near(p).abs());
                let equations = NormalEquations {
                    reference,
                    information,
                    right,
                    prior: reference,
                    prior_information,
                    floor_rad: near(1e-3).abs(),
                    doubt_rad: 0.0,
                };
                vec![DrivePart { angle: 0, equations }]
            })
            .collect();
        if let Ok(merged) = merge_drives(&[0], &drives, &MergeOptions::default()) {
            let text = format!("{merged:?}");
            assert!(!text.contains("NaN"), "case {case}: {text}");
        }
    }
}
