//! The mounting angle of whole drives.

use crate::common::{BATCH, Drive};
use boresight_mounting::{Calibrator, Method, Remark};

#[test]
fn a_noise_free_drive_gives_the_angle_anywhere_on_the_circle() {
    for degrees in [0.0_f64, 85.0, -24.99, 179.9, -179.9] {
        let drive = Drive {
            angle_rad: degrees.to_radians(),
            bias_radps: 0.01,
            yaw_noise_radps: 0.0,
            range_rate_sigma_mps: 0.0,
            azimuth_sigma_rad: 0.0,
            ..Drive::default()
        };
        for method in BATCH {
            let e = drive.calibrate(drive.options(method)).estimate();
            // Detections are single precision: 6e-8 of the range rate, averaged over the frames.
            let error = (e.angle_rad - drive.angle_rad).abs();
            assert!(error < 1e-7, "{method:?} at {degrees}: {error}");
            assert!((e.bias_radps - 0.01).abs() < 1e-12);
            assert_eq!((e.frames.standing, e.frames.used), (50, 550), "{method:?}");
        }
    }
}

#[test]
fn the_scale_is_found_by_those_that_look_for_it() {
    let drive = Drive { scale: 1.05, ..Drive::default() };
    for method in [Method::LeastSquares, Method::OrthogonalDistance] {
        let e = drive.calibrate(drive.options(method)).estimate();
        assert!((e.scale - 1.05).abs() < 4.0 * e.scale_sigma, "{method:?} {e:?}");
        assert!(e.scale_sigma < 0.01, "{method:?} {e:?}");
        assert!((e.angle_rad - drive.angle_rad).abs() < 4.0 * e.sigma_rad, "{method:?} {e:?}");
        assert!(!e.remarks.contains(&Remark::ScaleUndetermined));
    }
}

#[test]
fn without_frames_the_angle_is_nominal_and_nothing_is_claimed() {
    let drive = Drive::default();
    for method in BATCH {
        let mut options = drive.options(method);
        options.nominal_rad = Some(0.3);
        let e = Calibrator::new(options).unwrap().estimate();
        assert_eq!((e.angle_rad, e.sigma_rad), (0.3, f64::INFINITY));
        assert!(e.remarks.contains(&Remark::NoFrames) && !e.converged);
        assert_eq!(e.misaligned, Some(false));
    }
}

#[test]
fn time_backwards_is_an_error_and_the_frame_is_not_counted() {
    let drive = Drive::default();
    let mut calibrator = drive.calibrate(drive.options(Method::LeastSquares));
    let frame = boresight_mounting::FrameInput {
        time_s: 1.0,
        detections: &[],
        yaw_rate_radps: None,
        speed_mps: None,
    };
    let error = calibrator.add(frame).unwrap_err();
    assert!(matches!(error, boresight_mounting::MountingError::TimeBackwards { .. }));
    assert_eq!(calibrator.estimate().frames.given, 600);
}
