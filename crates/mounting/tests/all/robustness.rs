//! Whatever comes in, a calibration answers with an estimate that claims no more than it knows, or with an
//! error that says what was wrong.

use crate::common::{BATCH, Drive, network};
use crate::size::sized;
use boresight_core::Detection;
use boresight_mounting::{CalibrationOptions, Calibrator, FrameInput, Method, MotionMethod};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Numbers as drives have them, and numbers as nothing has them.
fn number(ordinary: f32) -> impl Strategy<Value = f32> + Clone {
    let odd = vec![
        0.0,
        -0.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN_POSITIVE,
        1e30,
        -1e4,
        1e-20,
    ];
    prop_oneof![6 => -ordinary..ordinary, 1 => prop::sample::select(odd), 1 => any::<f32>()]
}

fn detections(copies: usize) -> impl Strategy<Value = Vec<Detection>> {
    let one = (number(1.2), number(20.0), number(50.0)).prop_map(
        |(azimuth_rad, range_rate_mps, range_m)| Detection {
            azimuth_rad,
            range_rate_mps,
            range_m,
            rcs_dbsm: f32::NAN,
        },
    );
    // Any, one, and many copies of a few.
    prop_oneof![
        3 => prop::collection::vec(one.clone(), 0..30),
        1 => prop::collection::vec(one.clone(), 1..2),
        1 => (prop::collection::vec(one, 1..4), 1..=copies)
            .prop_map(|(few, times)| few.repeat(times)),
    ]
}

#[derive(Debug, Clone)]
struct Frame {
    step_s: f32,
    detections: Vec<Detection>,
    yaw_rate: Option<f32>,
    speed: Option<f32>,
}

fn frames(copies: usize) -> impl Strategy<Value = Vec<Frame>> {
    let frame = (
        prop::sample::select(vec![0.0, 0.074f32, 0.3, 5.0]),
        detections(copies),
        prop::option::weighted(0.9, number(0.5)),
        prop::option::of(number(20.0)),
    )
        .prop_map(|(step_s, detections, yaw_rate, speed)| Frame {
            step_s,
            detections,
            yaw_rate,
            speed,
        });
    prop::collection::vec(frame, 0..40)
}

/// Every method on every motion it takes.
fn way() -> impl Strategy<Value = (Method, MotionMethod)> {
    prop::sample::select(
        BATCH
            .into_iter()
            .flat_map(|method| MotionMethod::ALL.map(|motion| (method, motion)))
            .chain([MotionMethod::Tracked, MotionMethod::Deepego].map(|m| (Method::Recursive, m)))
            .collect::<Vec<_>>(),
    )
}

/// Feeds the frames, checks every outcome and the estimate.
fn feed(calibrator: &mut Calibrator, frames: &[Frame]) -> Result<f64, TestCaseError> {
    let mut time_s = 0.0;
    let mut given = 0;
    for frame in frames {
        let next_s = time_s + f64::from(frame.step_s);
        let outcome = calibrator.add(FrameInput {
            time_s: next_s,
            detections: &frame.detections,
            yaw_rate_radps: frame.yaw_rate.map(f64::from),
            speed_mps: frame.speed.map(f64::from),
        });
        time_s = next_s;
        given += 1;
        let outcome = outcome.unwrap();
        prop_assert_eq!(outcome.weights.len(), frame.detections.len());
        prop_assert!(outcome.weights.iter().all(|w| (0.0..=1.0).contains(w)), "{:?}", outcome);
        prop_assert!(outcome.weight >= 0.0 && outcome.weight.is_finite(), "{:?}", outcome);
        if let Some(motion) = outcome.motion {
            let [[xx, xy], [yx, yy]] = motion.covariance;
            prop_assert!(motion.velocity_mps.iter().all(|v| v.is_finite()), "{:?}", motion);
            prop_assert!(xx > 0.0 && yy > 0.0 && xy == yx, "{:?}", motion);
            prop_assert!(xx * yy >= xy * xy * (1.0 - 1e-9), "{:?}", motion);
            prop_assert!(motion.inliers <= motion.detections, "{:?}", motion);
        }
        if let (Some(angle), Some(sigma)) = (outcome.angle_rad, outcome.angle_sigma_rad) {
            prop_assert!(angle.abs() <= PI && sigma > 0.0, "{:?}", outcome);
        }
    }
    let e = calibrator.estimate();
    prop_assert!(e.angle_rad.abs() <= PI && e.scale.is_finite(), "{:?}", e);
    prop_assert!(e.sigma_rad > 0.0 && e.scale_sigma >= 0.0, "{:?}", e);
    prop_assert!(e.bias_radps.is_finite() && e.bias_sigma_radps > 0.0, "{:?}", e);
    prop_assert!((0.0..=1.0).contains(&e.inlier_share), "{:?}", e);
    let f = e.frames;
    let counted =
        f.used + f.standing + f.slow + f.turning + f.sparse + f.off_speed + f.without_motion;
    prop_assert_eq!((f.given, counted), (given, given));
    Ok(time_s)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: sized(400, 80),
        rng_seed: proptest::test_runner::RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_frames_give_an_estimate_that_holds_together(
        way in way(),
        frames in frames(20),
        x_m in -5.0..5.0f64,
        nominal in prop::option::of(-PI..PI),
        min_speed_mps in prop::sample::select(vec![0.0, 1.0]),
    ) {
        let options = CalibrationOptions {
            method: way.0,
            motion: Some(way.1),
            x_m,
            nominal_rad: nominal,
            min_speed_mps,
            ..CalibrationOptions::default()
        };
        feed(&mut Calibrator::with_network(options, Some(&network())).unwrap(), &frames)?;
    }

    #[test]
    fn what_was_odd_before_does_not_make_the_drive_after_confidently_wrong(way in way(), frames in frames(1)) {
        let drive = Drive { frames: 300, detections: 40, ..Drive::default() };
        let options = CalibrationOptions {
            motion: Some(way.1),
            nominal_rad: Some(drive.angle_rad + 0.02),
            ..drive.options(way.0)
        };
        let mut calibrator = Calibrator::with_network(options, Some(&network())).unwrap();
        let after_s = feed(&mut calibrator, &frames)? + 10.0;
        drive.run(|frame, _| {
            calibrator.add(FrameInput { time_s: after_s + frame.time_s, ..frame }).unwrap();
        });
        let e = calibrator.estimate();
        prop_assert!((e.angle_rad - drive.angle_rad).abs() < 5.0 * e.sigma_rad, "{e:?}");
    }
}
