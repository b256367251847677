//! The street: what radars see of it, and that frames hold what they see.

#![allow(clippy::unwrap_used)]

use boresight_core::Diagnose;
use boresight_simulate::street::{StreetKind, StreetOutline};
use boresight_simulate::{Street, StreetOptions};

fn street() -> Street {
    Street::new(StreetOptions { seed: 4, ..StreetOptions::default() }).unwrap()
}

#[test]
fn points_are_seen_where_geometry_says() {
    let street = street();
    for (index, radar) in street.radars.iter().enumerate() {
        let seen = street.visible(index).unwrap();
        assert!(seen.len() > 30, "{}: {}", radar.name, seen.len());
        for visible in seen {
            let (target, echo) = (&street.targets[visible.target], visible.echo);
            let angle = radar.mounting.yaw_rad + echo.direction.azimuth_rad;
            let x = radar.mounting.x_m + echo.range_m * angle.cos();
            let y = radar.mounting.y_m + echo.range_m * angle.sin();
            assert!((x - target.x_m).hypot(y - target.y_m) < 1e-9);
            assert!(echo.direction.azimuth_rad.abs() <= radar.field_of_view_rad);
            // What stands closes in by the car's speed along the line of sight; nothing aliases.
            if target.kind == StreetKind::Wall {
                assert!((echo.rate_mps + 6.0 * angle.cos()).abs() < 1e-9);
            }
            assert!(echo.rate_mps.abs() < radar.waveform.max_rate_mps(), "{echo:?}");
        }
    }
}

#[test]
fn what_stands_behind_a_car_is_weaker_and_behind_two_gone() {
    let mut street = street();
    let car = street.outlines.iter().find(|o| o.kind == StreetKind::ParkedCar).unwrap().clone();
    let mut point = street.targets[0];
    (point.x_m, point.y_m) = (30.0, 0.0);
    street.targets = vec![point];
    let shifted = |x_m: f64| {
        let mut car = car.clone();
        let (cx, cy) = (car.corners_m[0][0], car.corners_m[0][1] - 0.5);
        car.corners_m.iter_mut().for_each(|c| *c = [c[0] - cx + x_m, c[1] - cy]);
        car
    };
    let mut powers = vec![];
    for cars in 0..=3 {
        street.outlines = (0..cars).map(|k| shifted(12.0 + 6.0 * f64::from(k))).collect();
        powers.push(street.visible(2).unwrap().first().map(|v| v.echo.power_db));
    }
    let free = powers[0].unwrap();
    assert!((free - powers[1].unwrap() - 10.0).abs() < 1e-9);
    assert!((free - powers[2].unwrap() - 20.0).abs() < 1e-9);
    assert_eq!(powers[3], None);
}

#[test]
fn some_radar_looks_everywhere_but_beside_the_rear_doors() {
    let street = street();
    let sees = |x: f64, y: f64| {
        street.radars.iter().any(|radar| {
            let (dx, dy) = (x - radar.mounting.x_m, y - radar.mounting.y_m);
            let (sin, cos) = radar.mounting.yaw_rad.sin_cos();
            let azimuth = (dy * cos - dx * sin).atan2(dx * cos + dy * sin);
            azimuth.abs() <= radar.field_of_view_rad
        })
    };
    // Beside the rear doors the fields of view meet 6.9 m from the centre line, where the edge of a
    // side radar at (3.663, 0.873), 145.0 deg, cuts that of the rear one at (-1, 0), 120 deg.
    for degree in 0..3600 {
        let (sin, cos) = (f64::from(degree) * 0.1_f64).to_radians().sin_cos();
        assert!(sees(10.0 * cos, 10.0 * sin), "{degree}");
    }
    assert!(sees(-3.0, 3.2) && !sees(-3.0, 4.0) && !sees(-3.0, 5.0) && sees(-3.0, 5.8));
    assert!(sees(-2.0, 0.0) && sees(-4.9, 7.0) && !sees(-4.9, 6.82));
}

#[test]
fn a_place_is_behind_a_wall_where_the_line_of_sight_crosses_it() {
    let mut street = street();
    let of = |kind, corners_m: &[[f64; 2]]| StreetOutline { kind, corners_m: corners_m.to_vec() };
    // Fronts from x = 0 to 10 and from 12 to 20, a car and a rail, which hide nothing as walls do.
    street.outlines = vec![
        of(StreetKind::Wall, &[[0.0, -7.0], [10.0, -7.0]]),
        of(StreetKind::Wall, &[[12.0, -7.0], [20.0, -7.0]]),
        of(StreetKind::ParkedCar, &[[2.0, 3.0], [6.0, 3.0], [6.0, 5.0], [2.0, 5.0]]),
        of(StreetKind::GuardRail, &[[0.0, 6.0], [20.0, 6.0]]),
    ];
    let behind = |x, y| street.is_behind_wall([4.0, 0.0], [x, y]);
    assert!(behind(4.0, -7.1) && behind(4.0, -50.0) && behind(25.0, -12.0));
    assert!(!behind(4.0, -6.9) && !behind(4.0, 20.0));
    // Through the passage: at y = -7 the line to (18, -14) has come to x = 11, to (12, -14) to 8, to (26, -14) to 15.
    assert!(!behind(18.0, -14.0) && behind(12.0, -14.0) && behind(26.0, -14.0));
    // Past the end: at y = -7 the line to (-6, -14) has come to x = -1.
    assert!(!behind(-6.0, -14.0));
}

#[test]
fn no_radar_sees_a_point_behind_a_wall() {
    let street = street();
    for (index, radar) in street.radars.iter().enumerate() {
        let from = [radar.mounting.x_m, radar.mounting.y_m];
        for visible in street.visible(index).unwrap() {
            let target = &street.targets[visible.target];
            assert!(!street.is_behind_wall(from, [target.x_m, target.y_m]), "{target:?}");
        }
    }
}

#[test]
fn seeds_lay_out_other_streets_and_bad_options_are_refused() {
    let other = Street::new(StreetOptions { seed: 5, ..StreetOptions::default() }).unwrap();
    assert_ne!(other.targets, street().targets);
    assert_eq!(street(), street());
    for speed in [f64::NAN, 31.0] {
        let options = StreetOptions { ego_speed_mps: speed, ..StreetOptions::default() };
        assert_eq!(Street::new(options).unwrap_err().details().what, "ego_speed_mps");
    }
    assert_eq!(street().visible(5).unwrap_err().details().what, "radar");
}
