//! Made-up fleets, as they come out of merging.

use boresight_core::Random;
use boresight_fleet::fleet::{
    AngleSource, CarValues, Drift, Drive, DriveAngle, FailureCount, Fleet, FleetRadar, Knock,
    LogCounts, Vehicle, VehicleRadar,
};
use boresight_mounting::Alignment;

const SIGMA_DEG: f64 = 0.06;
/// 2026-01-02, s since 1970.
const START_S: f64 = 1_767_312_000.0;

/// A radar mounted at 22.9 deg, so many degrees off, over so many drives.
pub fn radar(sensor: u8, drives: usize, off_deg: f64, random: &mut Random) -> VehicleRadar {
    let nominal = 22.9_f64;
    let angles = (0..drives).map(|drive| DriveAngle {
        drive,
        angle_rad: (nominal + off_deg + SIGMA_DEG * random.normal()).to_radians(),
        sigma_rad: SIGMA_DEG.to_radians(),
        fitted_rad: (nominal + off_deg).to_radians(),
        converged: true,
        ..DriveAngle::default()
    });
    VehicleRadar {
        sensor,
        nominal_rad: Some(nominal.to_radians()),
        drives: angles.collect(),
        angle_rad: (nominal + off_deg).to_radians(),
        sigma_rad: (SIGMA_DEG / (drives.max(1) as f64).sqrt()).to_radians(),
        source: AngleSource::Joint,
        alignment: Some(Alignment::Aligned),
        scatter: 1.0,
        ..VehicleRadar::default()
    }
}

/// Changes the angle by so much from a drive on.
pub fn knock(radar: &mut VehicleRadar, drive: usize, step_deg: f64) {
    for angle in &mut radar.drives[drive..] {
        angle.angle_rad += step_deg.to_radians();
        angle.fitted_rad += step_deg.to_radians();
    }
    radar.angle_rad += step_deg.to_radians();
    radar.knocks.push(Knock {
        drive,
        after: drive as f64 - 1.0,
        before: drive as f64,
        step_rad: step_deg.to_radians(),
        sigma_rad: 0.02_f64.to_radians(),
    });
}

/// A vehicle whose drives are a day apart.
pub fn vehicle(name: &str, drives: usize, radars: Vec<VehicleRadar>) -> Vehicle {
    let drives = (0..drives).map(|drive| Drive {
        name: format!("drive {drive}"),
        path: format!("{name}/{drive}.mcap"),
        time_s: Some(START_S + 86_400.0 * drive as f64),
        at: drive as f64,
        duration_s: 1800.0,
        ..Drive::default()
    });
    let shared = CarValues {
        scale: Some(1.0021),
        scale_sigma: Some(0.0004),
        delay_s: Some(0.043),
        delay_sigma_s: Some(0.002),
        ..CarValues::default()
    };
    let (name, shared) = (name.into(), Some(shared));
    Vehicle { name, drives: drives.collect(), timed: true, radars, shared }
}

/// A fleet of six vehicles, of which each but the first needs attention for one reason.
pub fn small() -> Fleet {
    let random = &mut Random::new(7, 0);
    let calm = radar(1, 40, 0.1, random);
    let mut misaligned = radar(1, 40, 1.4, random);
    misaligned.alignment = Some(Alignment::Misaligned);
    let mut knocked = radar(1, 40, 0.1, random);
    knock(&mut knocked, 25, 0.45);
    let mut drifting = radar(1, 40, 0.0, random);
    for (drive, angle) in drifting.drives.iter_mut().enumerate() {
        let moved = 0.012_f64.to_radians() * drive as f64;
        angle.angle_rad += moved;
        angle.fitted_rad += moved;
        drifting.angle_rad = angle.fitted_rad;
    }
    drifting.source = AngleSource::History;
    drifting.drift =
        Some(Drift { rate_rad: 0.012_f64.to_radians(), sigma_rad: 0.0009_f64.to_radians() });
    let mut unlike = radar(1, 40, 0.8, random);
    unlike.outlying = Some(6.3);
    unlike.drives[30].angle_rad += 0.5_f64.to_radians();
    unlike.drives[30].outlying = true;
    let mut undecided = radar(1, 2, 0.97, random);
    undecided.alignment = Some(Alignment::Undecided);
    let of = [
        ("calm", 40, calm),
        ("undecided", 2, undecided),
        ("unlike", 40, unlike),
        ("drifting", 40, drifting),
        ("knocked", 40, knocked),
        ("misaligned", 40, misaligned),
    ];
    Fleet {
        logs: LogCounts { planned: 206, done: 202, failed: 3, missing: 1, ..LogCounts::default() },
        failures: vec![FailureCount {
            code: "log/no-radar".into(),
            count: 3,
            message: "no radar has detections".into(),
            path: "calm/77.mcap".into(),
        }],
        vehicles: of
            .into_iter()
            .map(|(name, drives, radar)| vehicle(name, drives, vec![radar]))
            .collect(),
        radars: vec![FleetRadar {
            sensor: 1,
            vehicles: 6,
            centre_rad: 0.12_f64.to_radians(),
            spread_rad: 0.1_f64.to_radians(),
            threshold: 3.4,
            outlying: vec!["unlike".into()],
        }],
    }
}

/// A fleet of so many vehicles with two radars and so many drives each; the last 100 vehicles are misaligned.
pub fn large(vehicles: usize, drives: usize) -> Fleet {
    let random = &mut Random::new(8, 0);
    let all = (0..vehicles).map(|number| {
        let mut radars = vec![radar(1, drives, 0.1, random), radar(2, drives, 0.0, random)];
        if number + 100 >= vehicles {
            radars[1].alignment = Some(Alignment::Misaligned);
        }
        vehicle(&format!("car-{number}"), drives, radars)
    });
    let names = |count: usize| (0..count).map(|number| format!("car-{number}")).collect();
    let failure = |number: usize| FailureCount {
        code: format!("code-{number}"),
        count: 1,
        message: "m".repeat(100_000),
        path: "p".repeat(100_000),
    };
    Fleet {
        vehicles: all.collect(),
        failures: (0..200).map(failure).collect(),
        radars: (0..=255)
            .map(|sensor| FleetRadar { sensor, outlying: names(1000), ..FleetRadar::default() })
            .collect(),
        ..Fleet::default()
    }
}
