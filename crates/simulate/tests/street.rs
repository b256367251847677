//! The street: what radars see of it, and that frames hold what they see.

#![allow(clippy::unwrap_used)]

use boresight_core::Diagnose;
use boresight_simulate::street::StreetKind;
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
fn seeds_lay_out_other_streets_and_bad_options_are_refused() {
    let other = Street::new(StreetOptions { seed: 5, ..StreetOptions::default() }).unwrap();
    assert_ne!(other.targets, street().targets);
    assert_eq!(street(), street());
    for speed in [f64::NAN, 31.0] {
        let options = StreetOptions { ego_speed_mps: speed, ..StreetOptions::default() };
        assert_eq!(Street::new(options).unwrap_err().details().what, "ego_speed_mps");
    }
    assert_eq!(street().visible(4).unwrap_err().details().what, "radar");
}
