//! One simulated drive.

use super::{CalibrationExperiment, PROFILES};
use crate::error::EvaluateError;
use boresight_core::Random;
use boresight_core::drive::{Mounting, RADARSCENES_SENSORS};
use boresight_mounting::CalibrationOptions;
use boresight_simulate::drive::{
    DriveOptions, DriveProfile, MOTION_STEP_S, Scenario, SimulatedDrive, TrueMotion, simulate_drive,
};
use boresight_validate::whole::{DRIVING_MPS, Drive, WholeRecord, run as run_whole};
use serde::{Deserialize, Serialize};

/// Radars are turned by up to this from the angle the log states, rad (2 deg).
const MISALIGNMENT_RAD: f64 = 0.034_906_585_039_886_59;

/// What is kept of one drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneRecord {
    /// Its number.
    pub scene: u64,
    /// Roads and traffic.
    pub scenario: String,
    /// Errors of radars and car.
    pub profile: DriveProfile,
    /// Whether it is one of those with 40 to 80 % moving detections.
    pub dense: bool,
    /// What came out.
    pub whole: WholeRecord,
}

/// Simulates a drive and runs every method.
///
/// # Errors
/// Those of the simulation and the calibration.
pub fn run(options: &CalibrationExperiment, scene: u64) -> Result<SceneRecord, EvaluateError> {
    // The same drives with each profile.
    let each = 2 * options.scenes;
    let (profile, number) = (PROFILES[(scene / each) as usize], scene % each);
    let mut random = Random::new(options.seed, number);
    let dense = number % 2 == 1;
    let kinds = Scenario::ALL.len() as u64;
    let scenario = match dense {
        true => Scenario::DenseTraffic,
        false => Scenario::ALL[((number / 2) % kinds) as usize],
    };
    let moving_share = if dense { random.uniform(0.4, 0.8) } else { random.uniform(0.0, 0.3) };
    let mut drive = simulate_drive(&DriveOptions {
        scenario,
        profile,
        // A car each.
        car: number,
        seed: random.bits(),
        duration_s: options.duration_s,
        moving_share: Some(moving_share),
        misalignment_rad: RADARSCENES_SENSORS
            .iter()
            .map(|(id, _)| (*id, random.uniform(-MISALIGNMENT_RAD, MISALIGNMENT_RAD)))
            .collect(),
        ..DriveOptions::default()
    })?;
    let moving_share = share(&drive);
    if options.standing {
        keep_what_stands(&mut drive);
    }
    let log = &drive.log;
    let nominal = |id: u8| log.sensors.iter().find(|s| s.id == id).and_then(|s| s.mounting);
    let whole = run_whole(
        &Drive {
            log,
            radars: drive
                .truth
                .sensors
                .iter()
                .map(|&(id, truth)| {
                    let stated = nominal(id).unwrap_or(truth);
                    (id, truth, told(profile, truth, stated.yaw_rad))
                })
                .collect(),
            pose_at: &|time_s| Some(truth_at(&drive, time_s).pose),
            speed_at: &|time_s| Some(truth_at(&drive, time_s).speed_mps),
            scale: Some(drive.truth.yaw_rate.scale),
        },
        Some(moving_share),
    )?;
    Ok(SceneRecord { scene, scenario: scenario.name().into(), profile, dense, whole })
}

/// The true motion nearest to a time.
fn truth_at(drive: &SimulatedDrive, time_s: f64) -> &TrueMotion {
    let motion = &drive.truth.motion;
    &motion[((time_s / MOTION_STEP_S).round().max(0.0) as usize).min(motion.len() - 1)]
}

/// Moving detections over all, of scans while driving.
fn share(drive: &SimulatedDrive) -> f64 {
    let (mut moving, mut all) = (0_usize, 0_usize);
    for (scan, labels) in drive.log.scans.iter().zip(&drive.moving) {
        if truth_at(drive, scan.time_s).speed_mps.abs() > DRIVING_MPS {
            moving += labels.iter().filter(|moves| **moves).count();
            all += labels.len();
        }
    }
    moving as f64 / (all as f64).max(1.0)
}

/// Takes detections that move out of the log.
fn keep_what_stands(drive: &mut SimulatedDrive) {
    for (scan, moving) in drive.log.scans.iter_mut().zip(&drive.moving) {
        let mut moves = moving.iter();
        scan.detections.retain(|_| moves.next() != Some(&true));
        let mut moves = moving.iter();
        scan.labels.retain(|_| moves.next() != Some(&true));
    }
}

/// The radar's options. Of drives with the clean profile it is known that they have no bias of azimuths, no slip, and that range rates are
/// measured within 40 ms.
fn told(profile: DriveProfile, place: Mounting, nominal_rad: f64) -> CalibrationOptions {
    let options = CalibrationOptions {
        x_m: place.x_m,
        y_m: place.y_m,
        nominal_rad: Some(nominal_rad),
        ..CalibrationOptions::default()
    };
    match profile {
        DriveProfile::Clean => CalibrationOptions {
            azimuth_bias_sigma_rad: 0.0,
            traffic_sigma_rad: 0.0,
            slip_gradient_rad: 0.0,
            delay_s: 0.02,
            ..options
        },
        DriveProfile::Radarscenes => options,
    }
}
