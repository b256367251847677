//! Records of drives, as `fleet run` makes them, and how far what they come to is off.

use boresight_core::drive::DriveLog;
use boresight_fleet::fleet::Fleet;
use boresight_fleet::gather::Gathered;
use boresight_fleet::record::{Done, Frames as Counts, RadarRecord, RadarResult, Record, Warning};
use boresight_fleet::schema::SCHEMA;
use boresight_fleet::{FleetOptions, merge, parallel};
use boresight_mounting::{CalibrationOptions, Car, Frames};
use boresight_options::remark::Coded;

/// The record of a drive.
pub fn record(
    vehicle: &str,
    drive: usize,
    log: &DriveLog,
    min_speed_mps: f64,
) -> Record<RadarResult> {
    let options = |sensor: &boresight_core::Sensor| {
        let mounting = sensor.mounting.unwrap();
        CalibrationOptions {
            x_m: mounting.x_m,
            y_m: mounting.y_m,
            nominal_rad: Some(mounting.yaw_rad),
            min_speed_mps,
            ..CalibrationOptions::default()
        }
    };
    let radars: Vec<_> = log.sensors.iter().map(|s| (s.id, options(s))).collect();
    let gap_s = radars[0].1.max_gap_s;
    let mut car = Car::apart(radars.clone(), None).unwrap();
    for (sensor, frame) in Frames::of(log, |_| true, gap_s) {
        car.add(sensor, frame).unwrap();
    }
    let told = |(sensor, options): &(u8, CalibrationOptions)| {
        let e = car.estimate(*sensor).unwrap();
        RadarRecord {
            sensor: *sensor,
            result: RadarResult {
                angle_deg: e.angle_rad.to_degrees(),
                sigma_deg: Some(e.sigma_rad.to_degrees()).filter(|sigma| sigma.is_finite()),
                nominal_deg: options.nominal_rad.map(f64::to_degrees),
                converged: e.converged,
                changed_s: e.changed_s,
                frames: Counts { given: e.frames.given, used: e.frames.used },
                warnings: e.remarks.iter().map(|r| Warning { code: r.code().into() }).collect(),
            },
            equations: car.normal_equations(*sensor),
        }
    };
    let ends = log.scans.first().zip(log.scans.last());
    Record {
        key: format!("{vehicle}-{drive}"),
        vehicle: vehicle.into(),
        drive: format!("drive {drive}"),
        time_s: None,
        path: format!("{vehicle}/{drive}"),
        done: Some(Done {
            format: "radarscenes".into(),
            duration_s: ends.map_or(0.0, |(first, last)| last.time_s - first.time_s),
            remarks: vec![],
            radars: radars.iter().map(told).collect(),
        }),
        failed: None,
        schema: SCHEMA,
        version: String::new(),
    }
}

/// What records come to.
pub fn merged(records: Vec<Record<RadarResult>>) -> Fleet {
    let gathered = Gathered { records, ..Gathered::default() };
    merge::merge(gathered, &FleetOptions::default(), 2).unwrap()
}

/// What `work` makes of each piece, over two threads, in any order.
pub fn each<P: Sync, R: Send>(pieces: &[P], work: impl Fn(&P) -> R + Sync) -> Vec<R> {
    let mut made = vec![];
    let take = |one| {
        made.push(one);
        Ok::<(), ()>(())
    };
    parallel::each(pieces, 2, work, take).unwrap();
    made
}

/// Root mean square of errors.
pub fn rms(errors: &[(f64, f64)]) -> f64 {
    (errors.iter().map(|(error, _)| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Shares within one and two stated deviations, of errors with those.
pub fn within(errors: &[(f64, f64)]) -> [f64; 2] {
    [1.0, 2.0].map(|times| {
        let inside = errors.iter().filter(|(error, sigma)| error.abs() <= times * sigma).count();
        inside as f64 / errors.len() as f64
    })
}
