//! A vehicle's radars over its drives.

use crate::error::FleetError;
use crate::fleet::{AngleSource, CarValues, Drive, DriveAngle, Vehicle, VehicleRadar};
use crate::history::{History, HistoryPoint};
use crate::options::FleetOptions;
use crate::pattern::natural_order;
use crate::record::{Done, RadarRecord, RadarResult, Record};
use boresight_mounting::merge::{CarUnknowns, DrivePart, MergedAngle, MergedVehicle, merge_drives};
use boresight_mounting::{Alignment, CalibrationOptions, wrap};

const DAY_S: f64 = 86_400.0;
/// Standard deviations by which the joint estimate may differ from the angle that the history has now.
const APART: f64 = 2.0;

/// The vehicle that records of its drives come to.
///
/// # Errors
/// Those of [`merge_drives`].
pub(crate) fn vehicle(
    name: &str,
    records: &[Record<RadarResult>],
    options: &FleetOptions,
) -> Result<Vehicle, FleetError> {
    let mut done: Vec<(&Record<RadarResult>, &Done<RadarResult>)> =
        records.iter().filter_map(|record| Some((record, record.done.as_ref()?))).collect();
    let timed = done.iter().all(|(record, _)| record.time_s.is_some_and(f64::is_finite));
    let time =
        |record: &Record<RadarResult>| if timed { record.time_s.unwrap_or(0.0) } else { 0.0 };
    done.sort_by(|(a, _), (b, _)| {
        time(a)
            .total_cmp(&time(b))
            .then_with(|| natural_order(&a.drive, &b.drive))
            .then_with(|| natural_order(&a.path, &b.path))
            .then_with(|| a.key.cmp(&b.key))
    });
    let start = done.first().map_or(0.0, |(record, _)| time(record));
    let mut drives: Vec<Drive> = done
        .iter()
        .enumerate()
        .map(|(index, (record, done))| Drive {
            name: record.drive.clone(),
            path: record.path.clone(),
            time_s: record.time_s,
            at: if timed { (time(record) - start) / DAY_S } else { index as f64 },
            duration_s: done.duration_s,
            ..Drive::default()
        })
        .collect();
    let mut numbers: Vec<u8> =
        done.iter().flat_map(|(_, done)| done.radars.iter().map(|radar| radar.sensor)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let mut followed: Vec<Followed> =
        numbers.into_iter().map(|sensor| Followed::of(sensor, &done, &drives, options)).collect();
    let mut first = 0;
    for radar in &mut followed {
        radar.angles = first;
        first += radar.history.knocks.len() + 1;
    }
    let joint = joint(&followed, &done, options)?;
    for (drive, merged) in drives.iter_mut().zip(&joint.drives) {
        drive.own = unknowns(&merged.own);
    }
    let radars = followed.iter().map(|radar| radar.conclude(&joint, options)).collect();
    let told = joint.angles.iter().any(|angle| angle.drives > 0);
    let shared = told.then(|| unknowns(&joint.shared));
    Ok(Vehicle { name: name.into(), drives, timed, radars, shared })
}

/// A radar over the drives that saw it.
struct Followed<'a> {
    sensor: u8,
    /// Index of the drive, and what it says.
    seen: Vec<(usize, &'a RadarRecord<RadarResult>)>,
    history: History,
    /// First of its angles among those of the joint estimate.
    angles: usize,
}

impl<'a> Followed<'a> {
    fn of(
        sensor: u8,
        done: &[(&Record<RadarResult>, &'a Done<RadarResult>)],
        drives: &[Drive],
        options: &FleetOptions,
    ) -> Self {
        let seen: Vec<(usize, &RadarRecord<RadarResult>)> = done
            .iter()
            .enumerate()
            .filter_map(|(at, (_, done))| {
                Some((at, done.radars.iter().find(|radar| radar.sensor == sensor)?))
            })
            .collect();
        let points: Vec<HistoryPoint> = seen
            .iter()
            .map(|(at, radar)| HistoryPoint {
                time: drives[*at].at,
                angle_rad: radar.result.angle_deg.to_radians(),
                sigma_rad: sigma_rad(&radar.result),
                floor_rad: radar.equations.map_or(0.0, |equations| equations.floor_rad),
            })
            .collect();
        Self { sensor, history: History::of(&points, &options.history()), seen, angles: 0 }
    }

    /// After which knock a drive that saw it was, from 0.
    fn segment(&self, place: usize) -> usize {
        self.history.knocks.iter().filter(|knock| knock.drive <= place).count()
    }

    fn conclude(&self, joint: &MergedVehicle, options: &FleetOptions) -> VehicleRadar {
        let last = self.angles + self.history.knocks.len();
        let merged = joint.angles.get(last).filter(|angle| angle.drives > 0);
        // The joint estimate has one angle from knock to knock. Where the history, which weighs whether there were knocks that are not told, is
        // elsewhere, that does not hold.
        let holds = |merged: &MergedAngle| {
            let apart = wrap(merged.angle_rad - self.history.angle_rad).abs();
            joint.converged
                && self.history.drift.is_none()
                && apart <= APART * merged.sigma_rad.hypot(self.history.sigma_rad)
        };
        let (source, angle_rad, sigma_rad) = match merged.filter(|merged| holds(merged)) {
            Some(merged) => (AngleSource::Joint, merged.angle_rad, merged.sigma_rad),
            None => (AngleSource::History, self.history.angle_rad, self.history.sigma_rad),
        };
        let nominal_rad = self
            .seen
            .iter()
            .rev()
            .find_map(|(_, radar)| radar.result.nominal_deg)
            .map(f64::to_radians);
        let limits = CalibrationOptions {
            nominal_rad,
            alarm_rad: options.alarm_rad,
            ..CalibrationOptions::default()
        };
        let mut knocks = self.history.knocks.clone();
        for knock in &mut knocks {
            knock.drive = self.seen[knock.drive].0;
        }
        VehicleRadar {
            sensor: self.sensor,
            nominal_rad,
            angle_rad,
            sigma_rad,
            source,
            alignment: Alignment::of(angle_rad, sigma_rad, &limits),
            drives: self.drive_angles(),
            knocks,
            drift: self.history.drift,
            scatter: self.history.scatter,
            outlying: None,
        }
    }

    fn drive_angles(&self) -> Vec<DriveAngle> {
        let told = self.history.outlying.iter().zip(&self.history.fitted_rad);
        self.seen
            .iter()
            .zip(told)
            .map(|((at, radar), (outlying, fitted_rad))| DriveAngle {
                drive: *at,
                angle_rad: radar.result.angle_deg.to_radians(),
                sigma_rad: sigma_rad(&radar.result),
                fitted_rad: *fitted_rad,
                converged: radar.result.converged,
                outlying: *outlying,
                warnings: radar.result.warnings.iter().map(|w| w.code.clone()).collect(),
            })
            .collect()
    }
}

fn sigma_rad(result: &RadarResult) -> f64 {
    result.sigma_deg.map_or(f64::INFINITY, f64::to_radians)
}

fn joint(
    followed: &[Followed],
    done: &[(&Record<RadarResult>, &Done<RadarResult>)],
    options: &FleetOptions,
) -> Result<MergedVehicle, FleetError> {
    let mut numbers = vec![];
    let mut parts: Vec<Vec<DrivePart>> = vec![vec![]; done.len()];
    for radar in followed {
        numbers.extend(std::iter::repeat_n(radar.sensor, radar.history.knocks.len() + 1));
        for (place, (at, record)) in radar.seen.iter().enumerate() {
            let angle = radar.angles + radar.segment(place);
            parts[*at].extend(record.equations.map(|equations| DrivePart { angle, equations }));
        }
    }
    Ok(merge_drives(&numbers, &parts, &options.joint)?)
}

fn unknowns(told: &CarUnknowns) -> CarValues {
    let value = |of: Option<boresight_mounting::merge::Told>| of.map(|told| told.value);
    let sigma = |of: Option<boresight_mounting::merge::Told>| of.map(|told| told.sigma);
    CarValues {
        scale: value(told.scale),
        scale_sigma: sigma(told.scale),
        bias_radps: value(told.bias_radps),
        bias_sigma_radps: sigma(told.bias_radps),
        slip_gradient_rad: value(told.slip_gradient_rad),
        slip_gradient_sigma_rad: sigma(told.slip_gradient_rad),
        delay_s: value(told.delay_s),
        delay_sigma_s: sigma(told.delay_s),
    }
}
