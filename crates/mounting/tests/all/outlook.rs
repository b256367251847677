//! What driving on would bring, held against what it then brings.

use crate::common::Drive;
use boresight_mounting::{Alignment, CalibrationOptions, Manoeuvre, Method, Outlook};

/// A road with bends as in the forecast.
fn bends(seconds: f64, seed: u64) -> Drive {
    Drive {
        frames: (13.5 * seconds) as usize,
        speed_mps: 14.0,
        speed_swing: 0.0,
        turn_radps: 0.105,
        standing: 0,
        seed,
        ..Drive::default()
    }
}

fn options(drive: &Drive) -> CalibrationOptions {
    CalibrationOptions {
        nominal_rad: Some(drive.angle_rad + 0.004),
        ..drive.options(Method::Recursive)
    }
}

fn outlook(drive: &Drive, options: CalibrationOptions) -> Outlook {
    drive.calibrate(options).outlook().unwrap()
}

#[test]
fn a_minute_more_brings_what_was_foretold() {
    let (mut told, mut came) = (0.0, 0.0);
    for seed in 0..8 {
        let (begun, longer) = (bends(25.0, seed), bends(85.0, seed));
        let outlook = outlook(&begun, options(&begun));
        let forecast = outlook.forecasts.iter().find(|f| f.manoeuvre == Manoeuvre::Bends).unwrap();
        assert!(forecast.sigma_rad < outlook.sigma_rad, "{outlook:?}");
        told += forecast.sigma_rad.powi(2);
        came += longer.calibrate(options(&longer)).estimate().sigma_rad.powi(2);
    }
    let ratio = (told / came).sqrt();
    println!("foretold over come: {ratio:.2}");
    // The scatter of five blocks says the lasting error to about a third.
    assert!((0.67..1.5).contains(&ratio), "{ratio}");
}

#[test]
fn minutes_lead_to_what_is_needed() {
    let drive = bends(20.0, 3);
    let strict = CalibrationOptions { converged_rad: 0.02_f64.to_radians(), ..options(&drive) };
    let outlook = outlook(&drive, strict);
    assert!(outlook.sigma_rad > outlook.needed_rad, "{outlook:?}");
    let best = outlook.forecasts[0];
    let minutes = best.minutes.unwrap();
    assert!(minutes >= 1.0 && outlook.advice.contains(best.instruction), "{outlook:?}");
    // Sooner by no other manoeuvre, and none brings less than nothing.
    for forecast in &outlook.forecasts {
        assert!(forecast.minutes.is_none_or(|other| other >= minutes), "{outlook:?}");
        assert!(forecast.sigma_rad <= outlook.sigma_rad * (1.0 + 1e-9), "{outlook:?}");
    }
}

#[test]
fn what_is_enough_needs_no_more_and_what_no_drive_tells_is_said() {
    let drive = bends(120.0, 5);
    let calibrator = drive.calibrate(options(&drive));
    assert_eq!(calibrator.estimate().alignment, Some(Alignment::Aligned));
    assert!(calibrator.outlook().unwrap().advice.contains("enough"));
    // A tenth of a degree of the radar's own azimuths cannot be told from the mounting.
    let untold =
        CalibrationOptions { azimuth_bias_sigma_rad: 0.2_f64.to_radians(), ..options(&drive) };
    let outlook = outlook(&drive, untold);
    assert!(outlook.advice.starts_with("No drive decides"), "{outlook:?}");
    assert!(outlook.least_rad > outlook.needed_rad);
    // Near the limit of the alarm more is needed than to settle.
    let narrow = CalibrationOptions {
        nominal_rad: Some(drive.angle_rad + 1.05_f64.to_radians()),
        ..options(&drive)
    };
    let near = drive.calibrate(narrow);
    assert_eq!(near.estimate().alignment, Some(Alignment::Undecided));
    assert!(near.outlook().unwrap().needed_rad < 0.05_f64.to_radians());
    assert!(Drive::default().calibrate(drive.options(Method::Kabsch)).outlook().is_none());
}
