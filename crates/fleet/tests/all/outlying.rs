//! Vehicles called outlying, against fleets that were drawn. `cargo test -p boresight-fleet --test all outlying:: -- --nocapture` prints the tables.

use boresight_core::Random;
use boresight_fleet::{Outlying, VehicleAngle};

/// A fleet about 0.3 with a spread of 0.2 or none, deg; deviations are alike, or unequal and some much more than the spread.
fn draw(vehicles: usize, spread: f64, unequal: bool, random: &mut Random) -> Vec<VehicleAngle> {
    let vehicle = |_| {
        let sigma: f64 = if unequal { 0.03 * 50_f64.powf(random.unit()) } else { 0.1 };
        let angle = 0.3 + spread * random.normal() + sigma * random.normal();
        VehicleAngle { angle_rad: angle.to_radians(), sigma_rad: sigma.to_radians() }
    };
    (0..vehicles).map(vehicle).collect()
}

fn called(fleet: &Outlying) -> usize {
    fleet.vehicles.iter().filter(|vehicle| vehicle.outlying).count()
}

/// Fleets of 5 to 500 vehicles.
const SIZES: [(usize, u64); 4] = [(5, 4000), (12, 4000), (50, 2000), (500, 300)];

#[test]
fn few_are_called_falsely() {
    println!("vehicles spread unequal | called per fleet, fleets with any | median spread deg");
    let mut high = false;
    for (k, (vehicles, count)) in SIZES.into_iter().enumerate() {
        for spread in [0.0, 0.2] {
            for unequal in [false, true] {
                let (mut calls, mut any, mut spreads) = (0, 0, Vec::new());
                for i in 0..count {
                    let mut random = Random::new(50 + k as u64, i);
                    let fleet = Outlying::of(&draw(vehicles, spread, unequal, &mut random));
                    calls += called(&fleet);
                    any += usize::from(called(&fleet) > 0);
                    spreads.push(fleet.spread_rad.to_degrees());
                }
                spreads.sort_by(f64::total_cmp);
                let median = spreads[spreads.len() / 2];
                let per_fleet = calls as f64 / count as f64;
                let any = any as f64 / count as f64;
                println!(
                    "{vehicles:4} {spread:4} {unequal:5} | {per_fleet:6.4} {any:6.4} | {median:6.3}"
                );
                // Calls are about a Poisson count: 0.05 a fleet, and four deviations of their mean number.
                let most = 0.05 + 4.0 * (0.05 / count as f64).sqrt();
                high |= per_fleet > most;
                if vehicles >= 50 && spread > 0.0 {
                    // A spread by 50 vehicles scatters by a tenth, and by unequal ones by a seventh; its median by far less.
                    assert!((median / spread - 1.0).abs() < 0.05, "{median}");
                }
            }
        }
    }
    assert!(!high);
}

/// Share of vehicles found that are 10 deviations off, of a share of the vehicles.
fn found(
    vehicles: usize,
    off: usize,
    one_side: bool,
    spread: f64,
    unequal: bool,
    seed: u64,
) -> f64 {
    const FLEETS: u64 = 100;
    let mut found = 0;
    for i in 0..FLEETS {
        let mut random = Random::new(seed, i);
        let mut fleet = draw(vehicles, spread, unequal, &mut random);
        for (j, vehicle) in fleet.iter_mut().take(off).enumerate() {
            let side = if one_side || j % 2 == 0 { 1.0 } else { -1.0 };
            vehicle.angle_rad += side * 10.0 * vehicle.sigma_rad.hypot(spread.to_radians());
        }
        let standing = Outlying::of(&fleet).vehicles;
        found += standing[..off].iter().filter(|vehicle| vehicle.outlying).count();
    }
    found as f64 / (FLEETS * off as u64) as f64
}

#[test]
fn vehicles_far_off_are_found_though_they_are_many() {
    println!("vehicles off one-side spread unequal | found");
    let (mut seed, mut low) = (60, false);
    for (vehicles, off, least) in [
        (5, 1, 0.5),
        (12, 1, 0.95),
        (12, 2, 0.8),
        (50, 1, 0.99),
        (50, 10, 0.97),
        (300, 1, 0.99),
        (300, 60, 0.99),
    ] {
        for one_side in [true, false] {
            for (spread, unequal) in [(0.0, false), (0.2, false), (0.2, true)] {
                seed += 1;
                let share = found(vehicles, off, one_side, spread, unequal, seed);
                println!("{vehicles:4} {off:3} {one_side:5} {spread:4} {unequal:5} | {share:5.3}");
                // Of unequal vehicles those off may be the few precise ones that tell the spread.
                let least = if unequal && vehicles < 50 { 0.5 } else { least };
                low |= share < least;
            }
        }
    }
    assert!(!low);
}

#[test]
fn few_vehicles_say_nothing() {
    let vehicle = |angle_rad| VehicleAngle { angle_rad, sigma_rad: 0.001 };
    for angles in [&[][..], &[1.0], &[0.0, 1.0], &[0.0, 0.001, 1.0]] {
        let fleet: Vec<VehicleAngle> = angles.iter().copied().map(vehicle).collect();
        let result = Outlying::of(&fleet);
        assert_eq!(called(&result), 0);
        assert_eq!(result.threshold, f64::INFINITY);
        assert!(result.vehicles.iter().all(|v| v.deviations.is_nan()));
        assert_eq!(result.centre_rad.is_nan(), angles.is_empty());
        assert_eq!(result.spread_rad.is_nan(), angles.len() < 2);
    }
}

/// Of equal deviations the spread is that of the sample less the deviations, and a vehicle's distance is Student's of one degree of freedom
/// less than there are others.
#[test]
fn equal_vehicles_are_as_in_textbooks() {
    let angles = [0.9, 1.3, 1.1, 0.7, 1.5, 1.0, 1.2, 0.8, 5.0];
    let fleet: Vec<VehicleAngle> =
        angles.iter().map(|&angle_rad| VehicleAngle { angle_rad, sigma_rad: 0.1 }).collect();
    let result = Outlying::of(&fleet);
    let mean = angles[..8].iter().sum::<f64>() / 8.0;
    let variance = angles[..8].iter().map(|a| (a - mean).powi(2)).sum::<f64>() / 7.0;
    assert!((result.centre_rad - mean).abs() < 1e-12);
    assert!((result.spread_rad - (variance - 0.01).sqrt()).abs() < 1e-4);
    let deviations = (5.0 - mean) / (variance * (1.0 + 1.0 / 8.0)).sqrt();
    assert!((result.vehicles[8].deviations / deviations - 1.0).abs() < 1e-3);
    assert!(result.vehicles[8].outlying && called(&result) == 1);
    // 0.05 / 9 of Student's distribution of 7 degrees of freedom lie beyond: between its 0.01 (3.499) and 0.005 (4.029).
    assert!((3.9..4.0).contains(&result.threshold), "{}", result.threshold);
}

#[test]
fn any_input_gives_an_answer() {
    const ODD: [f64; 11] =
        [0.0, -0.0, 1.0, -1.0, 1e-12, 1e-300, 1e17, 1e300, f64::MAX, f64::NAN, f64::INFINITY];
    for i in 0..2000 {
        let mut random = Random::new(9, i);
        let mut odd = || {
            let any = ODD[random.integer(0, 10) as usize];
            if random.unit() < 0.3 { any } else { random.unit() }
        };
        let fleet: Vec<VehicleAngle> = (0..i as usize % 11)
            .map(|_| VehicleAngle { angle_rad: odd(), sigma_rad: odd() })
            .collect();
        let result = Outlying::of(&fleet);
        let says = |v: &VehicleAngle| (0.0..7.0).contains(&v.sigma_rad) && v.angle_rad.abs() < 7.0;
        for (standing, vehicle) in result.vehicles.iter().zip(&fleet) {
            assert_eq!(
                standing.deviations.is_nan(),
                !says(vehicle) || fleet.iter().filter(|v| says(v)).count() < 4
            );
        }
        assert_eq!(result.centre_rad.is_finite(), fleet.iter().any(says));
        assert!(!result.threshold.is_nan() && result.vehicles.len() == fleet.len());
    }
}
