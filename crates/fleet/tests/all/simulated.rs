//! What a simulated fleet's records come to, whose truth is known.
//!
//! `FLEET_VEHICLES`, `FLEET_DRIVES` and `FLEET_SECONDS` make the fleet larger than the test needs.

use crate::size::sized;
use crate::support::drive::{each, merged, record, rms, within};
use boresight_core::drive::{Mounting, RADARSCENES_SENSORS};
use boresight_simulate::drive::DriveProfile;
use boresight_simulate::{DriveOptions, simulate_drive};

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// A car's angles, deg, off nominal: every third vehicle is knocked at one radar halfway.
fn misalignment_deg(vehicle: u64, sensor: u8, after: bool) -> f64 {
    let own = 0.3 * (1.7 * vehicle as f64 + f64::from(sensor)).sin();
    let knocked = vehicle % 3 == 2 && u64::from(sensor) == 1 + vehicle / 3 % 4 && after;
    own + if knocked { 0.8 } else { 0.0 }
}

#[test]
fn the_angles_of_a_simulated_fleet_keep_their_deviations_and_knocks_are_found() {
    let vehicles = setting("FLEET_VEHICLES", sized(6, 3));
    let drives = setting("FLEET_DRIVES", 8);
    let duration_s = setting("FLEET_SECONDS", sized(30, 20)) as f64;
    let all: Vec<(u64, u64)> =
        (0..vehicles).flat_map(|vehicle| (0..drives).map(move |drive| (vehicle, drive))).collect();
    let halfway = drives.div_ceil(2);
    let records = each(&all, |&(vehicle, drive)| {
        // The log states the same nominal angles whatever happens to the car.
        let off = |sensor| misalignment_deg(vehicle, sensor, drive >= halfway).to_radians();
        let placed = |(sensor, mounting): (u8, Mounting)| {
            (sensor, Mounting { yaw_rad: mounting.yaw_rad + off(sensor), ..mounting })
        };
        let options = DriveOptions {
            profile: DriveProfile::Radarscenes,
            seed: 1 + 1000 * vehicle + drive,
            car: 1 + vehicle,
            duration_s,
            sensors: RADARSCENES_SENSORS.map(placed).into(),
            misalignment_rad: (1..=4).map(|sensor| (sensor, off(sensor))).collect(),
            ..DriveOptions::default()
        };
        let log = simulate_drive(&options).unwrap().log;
        record(&format!("car {vehicle}"), drive as usize, &log, 1.0)
    });
    let fleet = merged(records);
    let (mut now, mut alone, mut steps) = (vec![], vec![], vec![]);
    let (mut expected, mut false_knocks, mut drifts) = (0, 0, 0);
    for vehicle in &fleet.vehicles {
        let number: u64 = vehicle.name[4..].parse().unwrap();
        for radar in &vehicle.radars {
            let nominal = RADARSCENES_SENSORS[usize::from(radar.sensor) - 1].1.yaw_rad;
            let truth = |after| misalignment_deg(number, radar.sensor, after);
            let error = |angle: f64, after| (angle - nominal).to_degrees() - truth(after);
            now.push((error(radar.angle_rad, true), radar.sigma_rad.to_degrees()));
            for drive in &radar.drives {
                let after = drive.drive as u64 >= halfway;
                alone.push((error(drive.angle_rad, after), drive.sigma_rad.to_degrees()));
            }
            let knocked = truth(true) - truth(false);
            expected += usize::from(knocked != 0.0);
            if knocked != 0.0 && !radar.knocks.iter().any(|k| k.drive as u64 == halfway) {
                let angles = radar.drives.iter().map(|drive| {
                    let angle = error(drive.angle_rad, false);
                    format!("{angle:.2} +- {:.2}", drive.sigma_rad.to_degrees())
                });
                let angles: Vec<String> = angles.collect();
                println!("missed: {}, radar {}: {}", vehicle.name, radar.sensor, angles.join(", "));
                println!("  told {:?} {:?} {:?}", radar.knocks, radar.drift, radar.source);
            }
            for knock in &radar.knocks {
                let at_its_place = knocked != 0.0 && knock.drive as u64 == halfway;
                false_knocks += usize::from(!at_its_place);
                let step = (knock.step_rad.to_degrees() - knocked, knock.sigma_rad.to_degrees());
                steps.extend(at_its_place.then_some(step));
            }
            drifts += usize::from(radar.drift.is_some());
        }
    }
    let stated = now.iter().map(|(_, sigma)| (*sigma, 0.0)).collect::<Vec<_>>();
    println!(
        "{vehicles} vehicles, {drives} drives of {duration_s} s: now {:.3} deg rms (stated {:.3}), a drive alone {:.3}",
        rms(&now),
        rms(&stated),
        rms(&alone)
    );
    println!("  within one and two: now {:.2?}, drives {:.2?}", within(&now), within(&alone));
    println!(
        "  knocks {} of {expected} at their place, {false_knocks} false; drifts {drifts}",
        steps.len()
    );
    println!("  steps {:.3} deg rms, within one and two {:.2?}", rms(&steps), within(&steps));
    let outlying: usize = fleet.radars.iter().map(|radar| radar.outlying.len()).sum();
    println!("  radars called outlying: {outlying}; shared {:.4?}", fleet.vehicles[0].shared);
    // Shares within one and two deviations, less three deviations of such shares.
    let [one, two] = within(&now);
    let deviation = |p: f64| (p * (1.0 - p) / now.len() as f64).sqrt();
    assert!(one > 0.683 - 3.0 * deviation(0.683), "{one}");
    assert!(two > 0.954 - 3.0 * deviation(0.954), "{two}");
    assert!(rms(&now) < 0.75 * rms(&alone), "together they tell no more than each alone");
    // A knock of 0.8 deg between four drives and four is some ten deviations; a drive that is far off beside it may hide one of ten.
    assert!(steps.len() >= expected - expected / 8, "{} of {expected}", steps.len());
    assert!(false_knocks <= 1 && drifts <= 1, "{false_knocks} {drifts}");
}
