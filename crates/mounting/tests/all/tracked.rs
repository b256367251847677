//! The motion tracked over frames, and the methods that weigh all frames at once on top of it.

use crate::common::{BATCH, Drive, network};
use boresight_core::InputError;
use boresight_mounting::{
    CalibrationOptions, Calibrator, Method, MotionMethod, MountingError, Verdict,
};

fn tracked(drive: &Drive, method: Method) -> CalibrationOptions {
    CalibrationOptions {
        motion: Some(MotionMethod::Tracked),
        nominal_rad: Some(drive.angle_rad + 0.02),
        ..drive.options(method)
    }
}

#[test]
fn its_covariance_is_that_of_its_errors_with_half_of_the_detections_moving() {
    let (mut squares, mut frames, mut variances, mut formal) = (0.0, 0usize, [0.0; 2], [0.0; 2]);
    for seed in 0..4 {
        let drive = Drive { moving: 0.5, seed, frames: 300, ..Drive::default() };
        let mut calibrator = Calibrator::new(tracked(&drive, Method::LeastSquares)).unwrap();
        drive.run(|frame, truth| {
            let outcome = calibrator.add(frame).unwrap();
            if outcome.verdict != Verdict::Used {
                return;
            }
            let motion = outcome.motion.unwrap();
            let [[xx, xy], [_, yy]] = motion.covariance;
            let error: [f64; 2] = std::array::from_fn(|i| motion.velocity_mps[i] - truth[i]);
            let determinant = xx * yy - xy * xy;
            squares += (error[0] * error[0] * yy - 2.0 * error[0] * error[1] * xy
                + error[1] * error[1] * xx)
                / determinant;
            frames += 1;
            for i in 0..2 {
                variances[i] += error[i] * error[i];
                formal[i] += motion.covariance[i][i];
            }
        });
    }
    let mean = squares / frames as f64;
    println!("{frames} frames, normalised squared error {mean:.3}, {variances:?} {formal:?}");
    assert!(frames > 950);
    // A chi-square of two degrees of freedom, averaged over 1000 frames, scatters by 0.063; moving
    // detections that pass for static ones come on top.
    assert!((1.75..2.5).contains(&mean), "{mean}");
}

#[test]
fn every_method_finds_the_angle_on_it_in_traffic() {
    for method in BATCH {
        let drive = Drive { moving: 0.6, ..Drive::default() };
        let e = drive.calibrate(tracked(&drive, method)).estimate();
        let error = e.angle_rad - drive.angle_rad;
        println!(
            "{}: {:.4} +- {:.4} deg",
            method.name(),
            error.to_degrees(),
            e.sigma_rad.to_degrees()
        );
        assert!(error.abs() < 4.0 * e.sigma_rad, "{method:?} {e:?}");
        assert!(e.sigma_rad < 0.1_f64.to_radians(), "{method:?} {e:?}");
        // Where 60 % of what is seen moves, the measured speed tells that the car stands.
        assert_eq!((e.frames.standing, e.frames.given), (50, 600), "{method:?} {e:?}");
        assert!(e.frames.used > 500, "{method:?} {e:?}");
    }
}

#[test]
fn it_gives_the_bias_from_standstill_and_without_a_nominal_angle_begins_with_a_vote() {
    let drive = Drive { moving: 0.3, bias_radps: 0.005, ..Drive::default() };
    for method in BATCH {
        let options = CalibrationOptions { nominal_rad: None, ..tracked(&drive, method) };
        let e = drive.calibrate(options).estimate();
        assert_eq!(e.frames.standing, 50, "{method:?} {e:?}");
        assert!((e.bias_radps - 0.005).abs() < 4.0 * e.bias_sigma_radps, "{method:?} {e:?}");
        assert!((e.angle_rad - drive.angle_rad).abs() < 4.0 * e.sigma_rad, "{method:?} {e:?}");
        // A vote takes twelve frames or some more.
        assert!((12..40).contains(&e.frames.sparse), "{method:?} {e:?}");
    }
}

#[test]
fn the_recursive_method_takes_no_other_motion() {
    for motion in MotionMethod::ALL {
        let options = CalibrationOptions { motion: Some(motion), ..CalibrationOptions::default() };
        match Calibrator::new(options) {
            Ok(_) => assert_eq!(motion, MotionMethod::Tracked),
            Err(MountingError::NeedsNetwork { motion: "deepego", .. }) => {
                assert_eq!(motion, MotionMethod::Deepego);
                Calibrator::with_network(options, Some(&network())).unwrap();
            }
            Err(error) => assert!(
                matches!(&error, MountingError::Core(InputError::Incompatible { given, .. }) if given == motion.name()),
                "{error}"
            ),
        }
    }
}
