//! Ego-motion and mounting angle against numbers made with NumPy and SciPy from the definitions
//! (`reference/make.py`).

use crate::support::clean::without_real_errors;
use boresight_core::Detection;
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, Calibrator, FrameInput, Method, Motion,
};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn matrix(value: &Value) -> [f64; 4] {
    let rows: Vec<f64> = value.as_array().unwrap().iter().flat_map(numbers).collect();
    rows.try_into().unwrap()
}

fn reference() -> Value {
    serde_json::from_str(include_str!("../reference/reference.json")).unwrap()
}

/// Each frame's motion, and the estimate from all.
fn calibrate(reference: &Value, method: Method) -> (Vec<Motion>, AngleEstimate) {
    let number = |name: &str| reference[name].as_f64().unwrap();
    let options = CalibrationOptions {
        method,
        x_m: number("x_m"),
        y_m: number("y_m"),
        range_rate_sigma_mps: number("range_rate_sigma_mps"),
        azimuth_sigma_rad: number("azimuth_sigma_rad"),
        inlier_residual_mps: number("inlier_residual_mps"),
        ..without_real_errors(CalibrationOptions::default())
    };
    let mut calibrator = Calibrator::new(options).unwrap();
    let motions = reference["frames"].as_array().unwrap().iter().map(|frame| {
        let azimuths = numbers(&frame["azimuth_rad"]);
        let rates = numbers(&frame["range_rate_mps"]);
        let detections: Vec<Detection> = azimuths
            .iter()
            .zip(&rates)
            .map(|(&azimuth, &rate)| Detection {
                azimuth_rad: azimuth as f32,
                range_rate_mps: rate as f32,
                range_m: f32::NAN,
                rcs_dbsm: f32::NAN,
            })
            .collect();
        let input = FrameInput {
            // Within one block: what lasts is none of the definitions.
            time_s: 0.1 * frame["time_s"].as_f64().unwrap(),
            detections: &detections,
            yaw_rate_radps: frame["yaw_rate_radps"].as_f64(),
            speed_mps: frame["speed_mps"].as_f64(),
        };
        calibrator.add(input).unwrap().motion.unwrap()
    });
    let motions = motions.collect();
    (motions, calibrator.estimate())
}

fn assert_near(given: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((given - expected).abs() <= tolerance, "{what}: {given} for {expected}");
}

/// Matrices agree to a share of their larger diagonal entry.
fn assert_matrix(given: [[f64; 2]; 2], expected: &Value, share: f64, what: &str) {
    let expected = matrix(expected);
    let tolerance = share * expected[0].max(expected[3]);
    for (given, expected) in given.concat().into_iter().zip(expected) {
        assert_near(given, expected, tolerance, what);
    }
}

#[test]
fn motions_and_their_covariances_are_those_of_the_definitions() {
    let reference = reference();
    // Cosines are single precision here and double there: 6e-8 of 14 m/s. ODRPACK's covariance is of
    // the linearisation at its last step but one.
    for (method, motion, share) in [
        (Method::WeightedMean, "ransac", 1e-5),
        (Method::LeastSquares, "weighted-least-squares", 1e-5),
        (Method::OrthogonalDistance, "orthogonal-distance", 1e-2),
    ] {
        let (motions, _) = calibrate(&reference, method);
        for (given, frame) in motions.iter().zip(reference["frames"].as_array().unwrap()) {
            let expected = &frame["motions"][motion];
            let velocity = numbers(&expected["velocity_mps"]);
            for axis in 0..2 {
                assert_near(given.velocity_mps[axis], velocity[axis], 2e-6, motion);
            }
            assert_matrix(given.covariance, &expected["covariance"], share, motion);
            assert_eq!((given.inliers, given.detections), (24, 24));
        }
    }
}

#[test]
fn angle_scale_and_covariance_are_those_of_the_definitions() {
    let reference = reference();
    // Orthogonal distance rests on covariances that agree to 1 %: so do its weights, and its angle to
    // that share of its standard deviation.
    for (method, share, angle_rad) in [
        (Method::WeightedMean, 1e-5, 1e-7),
        (Method::Kabsch, 1e-5, 1e-7),
        (Method::LeastSquares, 1e-5, 1e-7),
        (Method::OrthogonalDistance, 1e-2, 5e-6),
    ] {
        let (_, e) = calibrate(&reference, method);
        let expected = &reference["angles"][method.name()];
        let solution = numbers(&expected["solution"]);
        assert_near(e.angle_rad, solution[0], angle_rad, method.name());
        assert_near(1.0 / e.scale, solution[1], 10.0 * angle_rad, method.name());
        if !expected["covariance"].is_null() {
            assert_matrix(e.covariance, &expected["covariance"], share, method.name());
        }
    }
}
