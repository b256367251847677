//! Data that are not what they are taken for, and drives that tell nothing: found out and said, never a confident number.

use crate::common::{Drive, detection};
use boresight_core::{Detection, Random};
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, Calibrator, FrameInput, Method, Remark,
};
use boresight_options::Named;
use std::f64::consts::PI;

/// A frame with its detections, to be changed.
struct Changed {
    detections: Vec<Detection>,
    yaw_rate_radps: f64,
    speed_mps: Option<f64>,
}

/// The estimate from a drive whose frames were changed.
fn estimate(drive: &Drive, change: impl FnMut(&mut Changed)) -> AngleEstimate {
    estimate_by(Method::default(), drive.angle_rad, drive, change)
}

/// The same by a method, from an angle that is taken for nominal.
fn estimate_by(
    method: Method,
    nominal_rad: f64,
    drive: &Drive,
    mut change: impl FnMut(&mut Changed),
) -> AngleEstimate {
    let options = CalibrationOptions {
        method,
        nominal_rad: Some(nominal_rad),
        x_m: drive.x_m,
        y_m: drive.y_m,
        ..CalibrationOptions::default()
    };
    let mut calibrator = Calibrator::new(options).unwrap();
    drive.run(|frame, _| {
        let mut changed = Changed {
            detections: frame.detections.to_vec(),
            yaw_rate_radps: frame.yaw_rate_radps.unwrap(),
            speed_mps: frame.speed_mps,
        };
        change(&mut changed);
        calibrator
            .add(FrameInput {
                time_s: frame.time_s,
                detections: &changed.detections,
                yaw_rate_radps: Some(changed.yaw_rate_radps),
                speed_mps: changed.speed_mps,
            })
            .unwrap();
    });
    calibrator.estimate()
}

fn assert_doubted(what: &str, e: &AngleEstimate, remark: Remark) {
    println!(
        "{what}: {:.2} +- {:.2} deg, scale {:.3}, {:?} {:?}",
        e.angle_rad.to_degrees(),
        e.sigma_rad.to_degrees(),
        e.scale,
        e.frames,
        e.remarks
    );
    assert!(e.remarks.contains(&remark), "{what}: {e:?}");
    assert!(!e.converged && e.sigma_rad > 1.0_f64.to_radians(), "{what}: {e:?}");
}

#[test]
fn what_is_right_is_not_doubted() {
    let doubts = [
        Remark::AzimuthMirrored,
        Remark::YawRateReversed,
        Remark::YawRateUnit,
        Remark::AzimuthUnit,
        Remark::StillWhileDriving,
        Remark::OffSpeed,
        Remark::FewFrames,
        Remark::Implausible,
        Remark::Changed,
    ];
    for seed in 0..20 {
        for angle_rad in [0.0, 0.436, -1.484, 3.1] {
            let drive = Drive { angle_rad, seed, moving: 0.4, ..Drive::default() };
            let e = estimate(&drive, |_| {});
            assert!(!e.remarks.iter().any(|remark| doubts.contains(remark)), "{e:?}");
            assert!(e.converged, "{e:?}");
        }
    }
}

#[test]
fn mirrored_azimuths_are_found_out() {
    for angle_rad in [0.436, -1.484] {
        let drive = Drive { angle_rad, ..Drive::default() };
        let e = estimate(&drive, |frame| {
            frame.detections.iter_mut().for_each(|d| d.azimuth_rad = -d.azimuth_rad);
        });
        assert_doubted("mirrored azimuths", &e, Remark::AzimuthMirrored);
    }
    // A radar that looks ahead is its own mirror image: only the yaw rate tells.
    let drive = Drive { angle_rad: 0.0, ..Drive::default() };
    let e = estimate(&drive, |frame| {
        frame.detections.iter_mut().for_each(|d| d.azimuth_rad = -d.azimuth_rad);
    });
    assert_doubted("mirrored azimuths ahead", &e, Remark::YawRateReversed);
}

#[test]
fn a_reversed_yaw_rate_is_found_out() {
    for angle_rad in [0.0, 0.436, -1.484] {
        let drive = Drive { angle_rad, ..Drive::default() };
        let e = estimate(&drive, |frame| frame.yaw_rate_radps = -frame.yaw_rate_radps);
        assert_doubted("reversed yaw rate", &e, Remark::YawRateReversed);
    }
}

#[test]
fn degrees_for_radians_are_found_out() {
    let drive = Drive { turn_radps: 0.03, frames: 1200, ..Drive::default() };
    let e = estimate(&drive, |frame| frame.yaw_rate_radps = frame.yaw_rate_radps.to_degrees());
    assert_doubted("yaw rate in degrees", &e, Remark::YawRateUnit);
    let e = estimate(&drive, |frame| {
        frame.detections.iter_mut().for_each(|d| d.azimuth_rad = d.azimuth_rad.to_degrees());
    });
    assert_doubted("azimuths in degrees", &e, Remark::AzimuthUnit);
}

#[test]
fn compensated_range_rates_are_found_out() {
    let drive = Drive::default();
    let mut calibrator = 0;
    let e = estimate(&drive, |frame| {
        calibrator += 1;
        let mut random = Random::new(5, calibrator);
        for d in &mut frame.detections {
            d.range_rate_mps = (0.1 * random.normal()) as f32;
        }
    });
    assert_doubted("compensated range rates", &e, Remark::StillWhileDriving);
}

#[test]
fn a_speed_in_other_units_is_found_out() {
    let e = estimate(&Drive::default(), |frame| {
        frame.speed_mps = frame.speed_mps.map(|speed| 3.6 * speed);
    });
    assert_doubted("speed in km/h", &e, Remark::OffSpeed);
}

#[test]
fn a_nominal_angle_that_is_turned_round_makes_no_method_sure_of_a_wrong_one() {
    let drive = Drive::default();
    for &method in Method::VARIANTS {
        let e = estimate_by(method, drive.angle_rad - PI, &drive, |_| {});
        let off = (e.angle_rad - drive.angle_rad + PI).rem_euclid(2.0 * PI) - PI;
        println!("{method:?}: {:.2} deg off, {:?}", off.to_degrees(), e.remarks);
        assert!(!e.converged || off.abs() < 1.0_f64.to_radians(), "{method:?}: {e:?}");
        let told = [Remark::NotConverged, Remark::Misaligned]
            .iter()
            .any(|remark| e.remarks.contains(remark));
        assert!(told, "{method:?}: {e:?}");
    }
}

/// A convoy on a straight road: one detection in seven stands, the others drive with the car.
fn convoy(seed: u64, detections: usize, speed_known: bool) -> AngleEstimate {
    let drive = Drive {
        seed,
        angle_rad: 0.0,
        turn_radps: 0.0,
        speed_mps: 30.0,
        standing: 0,
        detections: 7,
        ..Drive::default()
    };
    let mut frame_number = 0;
    estimate(&drive, |frame| {
        frame_number += 1;
        let mut random = Random::new(seed, frame_number);
        frame.detections = (0..detections)
            .map(|i| {
                let azimuth: f64 = random.uniform(-0.5, 0.5);
                let own = if i % 7 == 0 { 0.0 } else { 30.0 + 0.7 * random.normal() };
                let rate = (own - 30.0) * azimuth.cos();
                detection(azimuth as f32, (rate + 0.1 * random.normal()) as f32)
            })
            .collect();
        if !speed_known {
            frame.speed_mps = None;
        }
    })
}

#[test]
fn a_convoy_tells_no_angle() {
    for seed in 0..10 {
        for detections in [7, 14, 28, 70] {
            for speed_known in [true, false] {
                let e = convoy(seed, detections, speed_known);
                println!(
                    "{detections} detections, speed {speed_known}: {:.2} +- {:.2} deg {:?} {:?}",
                    e.angle_rad.to_degrees(),
                    e.sigma_rad.to_degrees(),
                    e.frames,
                    e.remarks
                );
                let sure = e.sigma_rad < 0.5_f64.to_radians();
                assert!(!sure || e.angle_rad.abs() < 3.0 * e.sigma_rad, "{e:?}");
                assert!(e.angle_rad.abs() < PI / 18.0, "{e:?}");
                if detections < 20 {
                    assert!(!e.converged && e.sigma_rad > 1.0_f64.to_radians(), "{e:?}");
                    assert!(e.remarks.contains(&Remark::NotConverged));
                }
            }
        }
    }
}
