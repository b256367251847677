//! Images of simulated streets: their measures on points put by hand, and the experiment on one street.

#![allow(clippy::unwrap_used)]

use boresight_cli::street::{CHAIN, Maker, StreetFrames};
use boresight_core::Diagnose;
use boresight_experiments::images::{ImagesExperiment, ImagesReport, ImagesResult};
use boresight_experiments::{Entrants, EvaluateError};
use boresight_image::{PointMeasure, Target, ViewGrid};
use boresight_simulate::street::StreetKind;
use boresight_simulate::{Street, StreetOptions, VisibleTarget};
use boresight_validate::experiment::{How, Report as _, run};
use std::ops::ControlFlow;

/// Points put for what the radars that look right and back see, in place of what the chain detects.
fn measure(place: impl Fn(&Street, &VisibleTarget) -> Option<Target>) -> PointMeasure {
    let street = Street::new(StreetOptions { seed: 1, ..StreetOptions::default() }).unwrap();
    let mut frames = StreetFrames::new(street.clone(), &[0, 4]).unwrap();
    for frame in &mut frames.frames {
        let seen = frame.targets.iter();
        frame.detections = seen.filter_map(|seen| place(&street, seen)).collect();
    }
    let grid = ViewGrid::new([-45.0, 80.0], [-25.0, 25.0], 0.5).unwrap();
    let image = frames.image(&Maker::Chain, grid).unwrap();
    frames.figures(&image).unwrap().points.unwrap()
}

fn target(seen: &VisibleTarget, range_m: f64) -> Target {
    let azimuth_rad = seen.echo.direction.azimuth_rad;
    Target { range_m, rate_mps: 0.0, azimuth_rad, power: 1.0, confidence: 1.0 }
}

#[test]
fn points_where_targets_are_are_true_and_points_beyond_house_fronts_behind_walls() {
    let truth = measure(|_, seen| Some(target(seen, seen.echo.range_m)));
    assert!(truth.points > 100, "{truth:?}");
    assert_eq!((truth.false_points, truth.hidden_points, truth.found_targets), (0, 0, 1.0));
    // Each point of the house fronts 3 m farther off, 3 cm before the front: behind it but for the ends of fronts.
    let beyond = measure(|street, seen| {
        let is_wall = street.targets[seen.target].kind == StreetKind::Wall;
        is_wall.then(|| target(seen, seen.echo.range_m + 3.0))
    });
    assert!(beyond.points > 20 && beyond.hidden_points == beyond.false_points, "{beyond:?}");
    assert!(beyond.hidden_points as f64 > 0.8 * beyond.points as f64, "{beyond:?}");
    // And 3 m nearer, where some lie among parked cars: before all fronts.
    let before = measure(|street, seen| {
        let is_wall = street.targets[seen.target].kind == StreetKind::Wall;
        is_wall.then(|| target(seen, seen.echo.range_m - 3.0))
    });
    assert!(before.false_points > 0 && before.hidden_points == 0, "{before:?}");
}

#[test]
fn points_beside_the_field_of_view_do_not_count() {
    // The maps reach to 60 deg.
    let beside = measure(|_, seen| {
        Some(Target { azimuth_rad: 61_f64.to_radians(), ..target(seen, seen.echo.range_m) })
    });
    assert_eq!((beside.points, beside.found_targets), (0, 0.0));
}

fn report(streets: u64, methods: &[&str]) -> Result<ImagesReport, EvaluateError> {
    let entrants = Entrants::new(methods.iter().map(|&name| name.into()).collect(), vec![]);
    let options = ImagesExperiment { streets, seed: 1, entrants };
    run(&options, How { threads: 1, folder: None }, |_| ControlFlow::Continue(()))
}

#[test]
fn spectra_stand_beside_spectra_and_targets_beside_targets() {
    let report = report(1, &["bartlett", "iaa", "nomp", CHAIN, "iaa"]).unwrap();
    let names = |results: &[ImagesResult]| -> Vec<String> {
        results.iter().map(|result| result.name.clone()).collect()
    };
    assert_eq!(names(&report.spectra), ["bartlett", "iaa"]);
    assert_eq!(names(&report.targets), ["bartlett", "iaa", "nomp", CHAIN]);
    for result in report.spectra.iter().chain(&report.targets) {
        assert_eq!(result.images.len(), 1, "{}", result.name);
    }
    let of = |results: &[ImagesResult], name: &str| {
        let result = results.iter().find(|result| result.name == name).unwrap();
        result.images[0].clone()
    };
    // The FFT's sidelobes, 14.5 dB down, lie around on the ranges of all targets, behind walls too; IAA has none.
    let [fft, iaa] = ["bartlett", "iaa"].map(|name| of(&report.spectra, name));
    assert!(fft.points.is_none() && iaa.points.is_none());
    assert!(fft.outside_share > 30.0 * iaa.outside_share, "{fft:?} {iaa:?}");
    assert!(fft.behind_walls.share > 30.0 * iaa.behind_walls.share, "{fft:?} {iaa:?}");
    // Peaks of the FFT alone have no such sidelobes: a part of its lead was in what the image was made of.
    let peaks = of(&report.targets, "bartlett");
    assert!(peaks.outside_share < 0.01 * fft.outside_share, "{peaks:?}");
    // The chain gives out one detection a peak where images take every cell.
    let points = |name| of(&report.targets, name).points.unwrap();
    let [fft, chain] = ["bartlett", CHAIN].map(points);
    assert!(4 * chain.points < fft.points && chain.points > 50, "{chain:?} {fft:?}");
    assert!(chain.found_targets < fft.found_targets, "{chain:?} {fft:?}");
    for points in [fft, chain, points("nomp"), points("iaa")] {
        assert!(points.hidden_points <= points.false_points && points.false_points < points.points);
        assert!(points.hidden_share <= points.false_share && points.false_share < 0.5);
    }
    let tables = report.tables().to_string();
    assert_eq!(tables.matches("\n| iaa |").count(), 3, "{tables}");
    assert_eq!(report.csv().lines().count(), 7);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    for (streets, methods, what) in
        [(0, &["iaa"][..], "streets"), (1, &["magic"][..], "method"), (1, &[][..], "methods")]
    {
        assert_eq!(report(streets, methods).unwrap_err().details().what, what);
    }
}
