//! Simulated drives: Doppler point clouds of a car's radars and its own motion, with the truth
//! behind them, bit for bit the same natively and in wasm.
//!
//! A route is drawn for the scenario, a driver follows it, things stand along it and others drive
//! on it; each radar scans on its own clock. See `docs/simulated-drives.md`.

mod columns;
pub mod dataset;
mod inertial;
mod motion;
mod options;
mod profile;
mod radar;
mod realistic;
mod scenario;
mod traffic;
mod trim;
mod view;
pub mod wire;
mod world;

#[cfg(test)]
mod tests;

pub use columns::{TrueMotionColumns, TrueSensor, TruthColumns};
pub use inertial::YawRateErrors;
pub use motion::{MOTION_STEP_S, TrueMotion};
pub use options::{
    DriveOptions, MAX_DENSE_SENSOR_SECONDS, MAX_DURATION_S, MAX_MOVING_SHARE, MAX_SENSOR_SECONDS,
    RadarNoise,
};
pub use profile::{DriveProfile, YawRateSensor};
pub use radar::{CYCLE_S, MAX_DETECTIONS, STATIC_CLASS};
pub use realistic::CarErrors;
pub use scenario::Scenario;
pub use view::{FIELD_OF_VIEW_RAD, RANGE_M};
pub use wire::PlacedRadar;

use crate::error::SimulateError;
use boresight_core::Random;
use boresight_core::drive::{DriveLog, Mounting, Scan, Sensor};
use boresight_math::order::{sort_ascending, sort_by};
use std::ops::ControlFlow;

/// Streams of the seed.
const ROUTE: u64 = 0;
const DRIVER: u64 = 1;
const INERTIAL: u64 = 2;
const WORLD: u64 = 3;
const TRAFFIC: u64 = 4;
const TRIM: u64 = 5;
const REALISM: u64 = 6;
const RICH_WORLD: u64 = 7;
const SENSORS: u64 = 256;
const CLOCKS: u64 = 512;
const REALISM_OF_SENSORS: u64 = 768;

/// Streams of the car's number.
const CAR: u64 = 1024;
const BIASES: u64 = 1280;

/// What really happened.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveTruth {
    /// The car's motion, every [`MOTION_STEP_S`].
    pub motion: Vec<TrueMotion>,
    /// The radars by ascending number, where they truly sit and look.
    pub sensors: Vec<(u8, Mounting)>,
    /// For each radar, the root mean square of its azimuth bias within 55 deg, rad.
    pub azimuth_bias_rms_rad: Vec<f64>,
    /// What the yaw-rate sensor made of the true yaw rate.
    pub yaw_rate: YawRateErrors,
    /// How the car slips, and what its radars and its speed are late or off by.
    pub car: CarErrors,
}

/// A drive as logged, and the truth behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedDrive {
    /// What a log of the drive holds. Its mountings are nominal: their yaw is the true one less
    /// the misalignment.
    pub log: DriveLog,
    /// What really happened.
    pub truth: DriveTruth,
    /// For each scan and detection, whether it comes from a moving road user. False detections
    /// and detections of standing things with a random range rate count as not moving, as they
    /// are labelled.
    pub moving: Vec<Vec<bool>>,
    /// For each scan and detection, the number of the road user it comes from, or 0. Road users
    /// keep their number while they stand.
    pub tracks: Vec<Vec<u32>>,
}

/// Simulates a drive.
///
/// # Errors
/// [`SimulateError::Argument`] for options that [`DriveOptions::check`] refuses.
pub fn simulate_drive(options: &DriveOptions) -> Result<SimulatedDrive, SimulateError> {
    simulate_drive_reporting(options, |_, _| ControlFlow::Continue(()))
}

/// As [`simulate_drive`], calling `report` with the scans done and their number before each scan.
///
/// # Errors
/// As [`simulate_drive`]; [`SimulateError::Cancelled`] if `report` breaks.
pub fn simulate_drive_reporting(
    options: &DriveOptions,
    report: impl FnMut(usize, usize) -> ControlFlow<()>,
) -> Result<SimulatedDrive, SimulateError> {
    simulate(options, Variant { trimmed: true, cycle_factor: 1.0 }, report)
}

/// What a set of data has otherwise than a drive.
#[derive(Debug, Clone, Copy)]
struct Variant {
    /// Whether the moving share is brought to what was asked for; else it sets the traffic alone.
    trimmed: bool,
    /// Cycles over those of a drive, at most 1.
    cycle_factor: f64,
}

fn simulate(
    options: &DriveOptions,
    variant: Variant,
    mut report: impl FnMut(usize, usize) -> ControlFlow<()>,
) -> Result<SimulatedDrive, SimulateError> {
    options.check()?;
    let stream = |stream: u64| Random::new(options.seed, stream);
    let scenario = options.scenario;
    let route = scenario::Route::new(scenario, options.duration_s, &mut stream(ROUTE));
    let realistic = options.profile == DriveProfile::Radarscenes;
    let mut realism = stream(REALISM);
    let car = if realistic {
        CarErrors::drawn(options, &mut Random::new(options.car, CAR), &mut realism)
    } else {
        CarErrors::clean(options)
    };
    let motion = motion::drive(&route, scenario, options.duration_s, &car, &mut stream(DRIVER));
    let mut inertial = stream(INERTIAL);
    let yaw_rate = YawRateErrors::new(options, &mut inertial);
    let measured = inertial::measure(&motion, &yaw_rate, &car, options, &mut inertial);
    let path = motion::Path::new(&motion);
    let mut world = world::World::new(&path, scenario, &mut stream(WORLD));
    let mut moving_share = options.moving_share;
    if realistic {
        world = realistic::world::enrich(world, &path, scenario, &mut stream(RICH_WORLD));
        moving_share = moving_share.or(Some(realistic::moving::draw_share(&mut realism)));
    }

    let mut sensors = options.sensors.clone();
    sort_ascending(&mut sensors, |(id, _)| f64::from(*id));
    let scene = realistic::SceneFactors::new(&mut realism);
    let mut radars: Vec<radar::Radar> = vec![];
    for (id, mounting) in &sensors {
        let id = u64::from(*id);
        let mut drawn = stream(REALISM_OF_SENSORS + id);
        let mut radar = radar::Radar {
            mounting: *mounting,
            options,
            motion: &motion,
            random: stream(SENSORS + id),
            delay_s: car.delay_s,
            realism: realistic.then(|| {
                let mut of_car = Random::new(options.car, BIASES + id);
                realistic::Realism::new(mounting.yaw_rad, &scene, &mut of_car, &mut drawn)
            }),
        };
        if realistic {
            let share = moving_share.unwrap_or(0.0);
            realistic::set_gain(&mut radar, &world, options.duration_s, share);
        }
        radars.push(radar);
    }
    let mut times: Vec<(f64, usize)> = vec![];
    for (i, (id, _)) in sensors.iter().enumerate() {
        let clock = &mut stream(CLOCKS + u64::from(*id));
        let scans = if realistic {
            realistic::clock::scan_times(options.duration_s, clock)
        } else {
            radar::scan_times(options.duration_s, clock)
        };
        times.extend(scans.into_iter().map(|t| (t * variant.cycle_factor, i)));
    }
    sort_by(&mut times, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));

    let mut traffic =
        traffic::Traffic::new(&path, &motion, scenario, moving_share, stream(TRAFFIC));
    let mut scans = Vec::with_capacity(times.len());
    for (done, &(time_s, i)) in times.iter().enumerate() {
        if report(done, times.len()).is_break() {
            return Err(SimulateError::Cancelled { done, total: times.len() });
        }
        traffic.advance(time_s - car.delay_s);
        scans.push(radars[i].scan(time_s, &world, &traffic));
    }
    if let Some(share) = moving_share.filter(|_| variant.trimmed) {
        let fast = |t: f64| motion::motion_at(&motion, t).speed_mps.abs() > trim::COUNTED_MPS;
        let mut random = stream(TRIM);
        // All radars together, or each by what it sees of the traffic.
        let groups: Vec<(f64, Option<usize>)> = if realistic {
            let share_of =
                |(_, at): &(u8, Mounting)| realistic::moving::share_of(share, at.yaw_rad);
            sensors.iter().map(share_of).zip((0..sensors.len()).map(Some)).collect()
        } else {
            vec![(share, None)]
        };
        for (share, only) in groups {
            let within = |i: usize| only.is_none_or(|only| only == i);
            let mut group: Vec<(&mut Vec<radar::Labelled>, bool)> = scans
                .iter_mut()
                .zip(&times)
                .filter(|(_, (_, i))| within(*i))
                .map(|(scan, (t, _))| (scan, fast(*t)))
                .collect();
            trim::trim(&mut group, share, &mut random);
        }
    }

    let rms = |radar: &radar::Radar| radar.realism.as_ref().map_or(0.0, |r| r.bias_rms_rad());
    let azimuth_bias_rms_rad = radars.iter().map(rms).collect();
    let mut drive = SimulatedDrive {
        log: DriveLog {
            sensors: sensors
                .iter()
                .map(|(id, mounting)| {
                    let yaw_rad = mounting.yaw_rad - options.misalignment(*id);
                    Sensor { id: *id, mounting: Some(Mounting { yaw_rad, ..*mounting }) }
                })
                .collect(),
            scans: Vec::with_capacity(times.len()),
            motion: measured,
        },
        truth: DriveTruth {
            motion: vec![],
            sensors: sensors.clone(),
            azimuth_bias_rms_rad,
            yaw_rate,
            car,
        },
        moving: Vec::with_capacity(times.len()),
        tracks: Vec::with_capacity(times.len()),
    };
    for (&(time_s, i), labelled) in times.iter().zip(scans) {
        drive.log.scans.push(Scan {
            time_s,
            sensor: sensors[i].0,
            detections: labelled.iter().map(|l| l.detection).collect(),
            labels: labelled.iter().map(|l| l.class).collect(),
        });
        drive.moving.push(labelled.iter().map(|l| l.moving).collect());
        drive.tracks.push(labelled.iter().map(|l| l.track).collect());
    }
    drive.truth.motion = motion;
    Ok(drive)
}
