//! Bird's-eye views and their measure against geometry done by hand.

#![allow(clippy::unwrap_used)]

use boresight_core::Diagnose;
use boresight_core::drive::Mounting;
use boresight_image::{
    BirdsEyeView, Gate, Grid, HiddenMeasure, ImageError, NO_RADAR, PointMeasure, PointsAtHalf,
    RadarPoints, RangeAzimuthDoppler, RangeAzimuthMap, Target, ViewGrid, birds_eye_view,
    hidden_measure, point_measure, sidelobe_measure,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

/// A map to 50 m by 0.5 m and 60 deg either way, with one target.
fn map(range_m: f64, azimuth_deg: f64, power: f64) -> RangeAzimuthMap {
    let grid = Grid::new([0.0, 50.0], 101, FRAC_PI_3, 201).unwrap();
    let mut image = RangeAzimuthDoppler::new(grid, None).unwrap();
    let azimuth_rad = azimuth_deg.to_radians();
    let target = Target { range_m, rate_mps: 0.0, azimuth_rad, power, confidence: 1.0 };
    image.add_target(&target).unwrap();
    image.to_map()
}

fn mounting(x_m: f64, y_m: f64, yaw_deg: f64) -> Mounting {
    Mounting { x_m, y_m, yaw_rad: yaw_deg.to_radians() }
}

fn ground() -> ViewGrid {
    ViewGrid::new([-30.0, 30.0], [-30.0, 30.0], 0.5).unwrap()
}

/// Middle of the strongest cell.
fn strongest(view: &BirdsEyeView) -> [f64; 2] {
    let best = view.power.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
    [view.grid.x_m.value(best.0), view.grid.y_m.value(best.1)]
}

#[test]
fn a_target_lies_where_mounting_range_and_azimuth_say() {
    for (place, range, azimuth) in [
        (mounting(3.6, 0.8, 85.0), 14.0, -20.0),
        (mounting(3.8, -0.7, -25.0), 22.0, 48.0),
        (mounting(0.0, 0.0, 180.0), 9.0, 10.0),
    ] {
        let map = map(range, azimuth, 1.0);
        let view = birds_eye_view(&[(&map, place)], ground()).unwrap();
        let angle = place.yaw_rad + azimuth.to_radians();
        let expected = [place.x_m + range * angle.cos(), place.y_m + range * angle.sin()];
        let found = strongest(&view);
        for (found, expected) in found.iter().zip(expected) {
            // Half a cell of the view and half of the map's range bins.
            assert!((found - expected).abs() < 0.5, "{found:?} {expected:?}");
        }
    }
}

#[test]
fn only_the_field_of_view_is_seen() {
    let map = map(10.0, 0.0, 1.0);
    let view = birds_eye_view(&[(&map, mounting(0.0, 0.0, 90.0))], ground()).unwrap();
    for ((i, k), &radar) in view.radar.indexed_iter() {
        let (x, y) = (view.grid.x_m.value(i), view.grid.y_m.value(k));
        let azimuth = y.atan2(x) - FRAC_PI_2;
        let sees = azimuth.sin().abs() <= FRAC_PI_3.sin() && y > 0.0;
        assert_eq!(radar != NO_RADAR, sees, "{x} {y}");
        assert!(sees || view.power[[i, k]] == 0.0);
    }
}

#[test]
fn the_stronger_radar_wins_where_two_see() {
    let (left, right) = (map(20.0, 0.0, 1.0), map(20.0, 0.0, 4.0));
    let radars = [(&left, mounting(0.0, 2.0, 0.0)), (&right, mounting(0.0, -2.0, 0.0))];
    let view = birds_eye_view(&radars, ground()).unwrap();
    let alone: Vec<_> =
        radars.iter().map(|&radar| birds_eye_view(&[radar], ground()).unwrap()).collect();
    for ((cell, &power), &radar) in view.power.indexed_iter().zip(&view.radar) {
        let powers = [alone[0].power[cell], alone[1].power[cell]];
        assert_eq!(power, powers[0].max(powers[1]));
        if powers[0] != powers[1] {
            assert_eq!(powers[radar as usize], power);
        }
    }
    assert_eq!(strongest(&view), strongest(&alone[1]));
}

#[test]
fn near_targets_do_not_fall_between_cells() {
    // At 4 m the map's points are 3.5 cm apart, the view's cells half a metre: samples at the
    // middles alone would miss most targets.
    for azimuth in 0..40 {
        let map = map(4.0, f64::from(azimuth) * 1.3 - 25.0, 1.0);
        let view = birds_eye_view(&[(&map, mounting(0.0, 0.0, 0.0))], ground()).unwrap();
        // The target's power over its area on the ground: 0.5 m by 3.5 cm or a little more.
        let energy: f32 = view.power.sum() * 0.25;
        let area = 0.5 * 4.0 * map.grid.sine.step() as f32;
        assert!((0.8..1.4).contains(&(energy / area)), "{azimuth}: {}", energy / area);
    }
}

/// Ones in two cells of a view, one radar at the origin looking ahead.
fn two_cells() -> BirdsEyeView {
    let map = map(20.0, 0.0, 0.0);
    let mut view = birds_eye_view(&[(&map, mounting(0.0, 0.0, 0.0))], ground()).unwrap();
    view.power[[100, 60]] = 3.0; // x = 20.25, y = 0.25
    view.power[[80, 70]] = 1.0; // x = 10.25, y = 5.25
    view
}

#[test]
fn what_is_outside_the_gates_is_measured() {
    let view = two_cells();
    for gate in [Gate::Circle { radius_m: 1.0 }, Gate::Resolution { range_m: 1.0, sine: 0.05 }] {
        let measure = sidelobe_measure(&view, &[[20.0, 0.0], [-9.0, 0.0]], gate).unwrap();
        assert!((measure.outside_db() - 10.0 * 0.25_f64.log10()).abs() < 1e-9, "{measure:?}");
        assert!((measure.peak_outside_db() - 10.0 * (1.0_f64 / 3.0).log10()).abs() < 1e-6);
        assert_eq!((measure.targets, measure.lit_targets), (1, 1.0));
        let seen = view.radar.iter().filter(|&&radar| radar != NO_RADAR).count() as f64;
        let ungated = seen * (1.0 - measure.gated);
        assert!((measure.lit_outside * ungated - 1.0).abs() < 1e-9);
        let both = sidelobe_measure(&view, &[[20.0, 0.0], [10.0, 5.0]], gate).unwrap();
        assert_eq!((both.outside_share, both.lit_outside), (0.0, 0.0));
        let none = sidelobe_measure(&view, &[], gate).unwrap();
        assert_eq!((none.outside_share, none.targets, none.gated), (1.0, 0, 0.0));
    }
}

#[test]
fn gates_of_resolution_widen_with_range_and_towards_the_edge() {
    let view = two_cells();
    let cells = |target| {
        let gate = Gate::Resolution { range_m: 1.0, sine: 0.1 };
        sidelobe_measure(&view, &[target], gate).unwrap().gated
    };
    // Areas of 2 m x 2 * 0.1 r / cos a, and half a cell's diagonal each side.
    let ratio = cells([24.0, 0.0]) / cells([8.0, 0.0]);
    let area = |r: f64| (2.0 + 0.707) * (0.2 * r + 0.707);
    assert!((ratio / (area(24.0) / area(8.0)) - 1.0).abs() < 0.15, "{ratio}");
    // At 46 deg the cross-range width grows by 1 / cos 46 deg = 1.44.
    assert!(cells([12.0, 12.5]) > 1.25 * cells([17.3, 0.0]));
}

#[test]
fn bad_arguments_are_refused() {
    let map = map(20.0, 0.0, 1.0);
    let place = mounting(0.0, 0.0, 0.0);
    let refused = |error: ImageError| (error.code(), error.details().what);
    let viewed = |radars: &[_]| refused(birds_eye_view(radars, ground()).unwrap_err());
    assert_eq!(viewed(&[]), ("out-of-range", "radars".into()));
    let nowhere = viewed(&[(&map, mounting(f64::NAN, 0.0, 0.0))]);
    assert_eq!(nowhere, ("not-finite", "mounting".into()));
    for (x_m, y_m, cell_m, what) in [
        ([0.0, 1e9], [0.0, 1e9], 0.1, "x_m"),
        ([0.0, 100.0], [0.0, 100.0], f64::NAN, "cell_m"),
        ([1.0, 0.0], [0.0, 100.0], 0.5, "points of x_m"),
    ] {
        let grid = refused(ViewGrid::new(x_m, y_m, cell_m).unwrap_err());
        assert_eq!(grid, ("out-of-range", what.into()));
    }
    let view = birds_eye_view(&[(&map, place)], ground()).unwrap();
    let measured = |targets: &[[f64; 2]], radius_m| {
        refused(sidelobe_measure(&view, targets, Gate::Circle { radius_m }).unwrap_err())
    };
    assert_eq!(measured(&[], 0.0), ("out-of-range", "gate_m".into()));
    assert_eq!(measured(&[[f64::NAN, 0.0]], 1.0), ("not-finite", "targets".into()));
}

#[test]
fn what_is_hidden_from_the_radar_that_shows_it_is_measured() {
    let view = two_cells();
    let gate = Gate::Circle { radius_m: 1.0 };
    let far = |radar: usize, [x, _]: [f64; 2]| radar == 0 && x > 8.0;
    // Of 4 of power, 1 lies beyond 8 m and in no gate; the cell with 3 is a target's.
    let measure = hidden_measure(&view, &[[20.0, 0.0]], gate, far).unwrap();
    assert!((measure.share - 0.25).abs() < 1e-9 && measure.lit_m2 == 0.25, "{measure:?}");
    let cells = view.radar.indexed_iter().filter(|&((i, k), &radar)| {
        let (x, y) = (view.grid.x_m.value(i), view.grid.y_m.value(k));
        let corner = 0.5 * std::f64::consts::FRAC_1_SQRT_2;
        radar != NO_RADAR && x > 8.0 && (x - 20.0).hypot(y) > 1.0 + corner
    });
    assert_eq!(measure.hidden_m2, 0.25 * cells.count() as f64);
    let all = hidden_measure(&view, &[], gate, far).unwrap();
    assert_eq!((all.share, all.lit_m2), (1.0, 0.5));
    let none = hidden_measure(&view, &[], gate, |radar, _| radar != 0).unwrap();
    assert_eq!(none, HiddenMeasure { share: 0.0, lit_m2: 0.0, hidden_m2: 0.0 });
    // 41 dB below the strongest a cell has power and is not lit.
    let mut faint = two_cells();
    faint.power[[80, 70]] = 3.0 * 10_f32.powf(-4.1);
    let measure = hidden_measure(&faint, &[[20.0, 0.0]], gate, far).unwrap();
    assert!(measure.share > 0.0 && measure.lit_m2 == 0.0, "{measure:?}");
}

#[test]
fn points_are_true_in_a_gate_false_beside_all_and_hidden_where_no_radar_sees() {
    let point = |range_m, azimuth_deg: f64, power, confidence| {
        let azimuth_rad = azimuth_deg.to_radians();
        Target { range_m, rate_mps: 0.0, azimuth_rad, power, confidence }
    };
    let radars = [
        // At (20, 0) and, at 30 deg, at (17.3, 10).
        RadarPoints {
            mounting: mounting(0.0, 0.0, 0.0),
            points: vec![point(20.4, 0.0, 3.0, 1.0), point(20.0, 30.0, 2.0, 0.5)],
        },
        // Turned left, 5 m ahead: at (5, 10) and at (-5, 10).
        RadarPoints {
            mounting: mounting(5.0, 0.0, 90.0),
            points: vec![point(200_f64.sqrt(), 45.0, 0.75, 1.0), point(10.0, 0.0, 0.9, 1.0)],
        },
    ];
    let targets = [[20.0, 0.0], [5.0, 9.5], [5.0, 10.5], [30.0, 0.0]];
    let hidden = |radar: usize, [x, y]: [f64; 2]| {
        assert!(radar == 0 && (x - 17.32).abs() < 0.01 && (y - 10.0).abs() < 0.01 || radar == 1);
        radar == 1 && x < 0.0
    };
    for gate in [Gate::Circle { radius_m: 0.6 }, Gate::Resolution { range_m: 0.6, sine: 0.05 }] {
        let measure = point_measure(&radars, &targets, gate, hidden).unwrap();
        let rounded = |share: f64| (share * 1e12).round() / 1e12;
        let expected = PointMeasure {
            points: 4,
            false_points: 2,
            false_share: rounded(1.75 / 5.65),
            hidden_points: 1,
            hidden_share: rounded(0.75 / 5.65),
            found_targets: 0.75,
            // By power: one of four targets, a false point, two targets at once, and one behind.
            at_half: Some(PointsAtHalf { points: 3, false_points: 1, hidden_points: 0 }),
        };
        let measure = PointMeasure {
            false_share: rounded(measure.false_share),
            hidden_share: rounded(measure.hidden_share),
            ..measure
        };
        assert_eq!(measure, expected);
    }
    // A gate of resolution is as deep at any azimuth, and as wide as the sine at its range: 0.02 of 20 m are 0.4 m.
    let found = |target| {
        let gate = Gate::Resolution { range_m: 1.0, sine: 0.02 };
        let radar = RadarPoints {
            mounting: mounting(0.0, 0.0, 0.0),
            points: vec![point(20.0, 0.0, 1.0, 1.0)],
        };
        point_measure(&[radar], &[target], gate, |_, _| false).unwrap().found_targets
    };
    assert_eq!(
        [[20.0, 0.38], [20.0, 0.42], [20.9, 0.0], [21.1, 0.0]].map(found),
        [1.0, 0.0, 1.0, 0.0]
    );
    // Half is reached with one of two, however many are found in the end.
    let both = RadarPoints {
        mounting: mounting(0.0, 0.0, 0.0),
        points: vec![point(30.0, 0.0, 1.0, 1.0), point(20.0, 0.0, 2.0, 1.0)],
    };
    let gate = Gate::Circle { radius_m: 0.6 };
    let measure = point_measure(&[both], &[[20.0, 0.0], [30.0, 0.0]], gate, |_, _| false).unwrap();
    let half = PointsAtHalf { points: 1, false_points: 0, hidden_points: 0 };
    assert_eq!((measure.found_targets, measure.at_half), (1.0, Some(half)));
    let nothing = point_measure(&[], &[], Gate::Circle { radius_m: 1.0 }, hidden).unwrap();
    assert_eq!((nothing.points, nothing.false_share, nothing.found_targets), (0, 0.0, 0.0));
    assert_eq!(nothing.at_half, None);
}
