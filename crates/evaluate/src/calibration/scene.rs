//! One drive: every method on every radar.

use super::{CANDIDATES, CalibrationExperiment, Candidate, DRIVING_TIMES_S, PROFILES};
use crate::EvaluateError;
use boresight_calibrate::trajectory::{TimedMotion, integrate, relative_error};
use boresight_calibrate::{
    AngleEstimate, CalibrationOptions, Calibrator, FrameInput, Frames, Joint, Method,
};
use boresight_core::Random;
use boresight_core::drive::{Mounting, Pose, RADARSCENES_SENSORS};
use boresight_simulate::drive::{
    CYCLE_S, DriveOptions, DriveProfile, MOTION_STEP_S, Scenario, SimulatedDrive, TrueMotion,
    simulate_drive,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Radars are turned by up to this from the angle the log states, rad (2 deg).
const MISALIGNMENT_RAD: f64 = 0.034_906_585_039_886_59;
/// Slower is not driving, m/s, as in Zhu et al.
const DRIVING_MPS: f64 = 1.0;
/// The radar of Figures 5 and 6.
pub const FIGURE_RADAR: u8 = 3;
/// Length of the segments of the relative trajectory error, m.
pub const SEGMENT_M: f64 = 50.0;

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
    /// Share of detections from moving road users, of scans at more than 1 m/s.
    pub moving_share: f64,
    /// Way driven, m.
    pub driven_m: f64,
    /// Time driven, s.
    pub driven_s: f64,
    /// The radars.
    pub radars: Vec<RadarRecord>,
}

/// What is kept of one radar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RadarRecord {
    /// Its number.
    pub sensor: u8,
    /// True mounting angle, deg.
    pub true_deg: f64,
    /// Relative trajectory error with the true angle, m.
    pub rte_true_m: Option<f64>,
    /// Estimates in the order of [`CANDIDATES`].
    pub estimates: Vec<EstimateRecord>,
    /// Estimates from parts of the drive, for each of the [`CANDIDATES`] that Figure 6 shows; of its radar only.
    pub parts: Vec<Vec<PartRecord>>,
}

/// An estimate from a whole drive. What is not finite is `None`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimateRecord {
    /// Estimated less true angle, deg; `None` where the method gave no angle.
    pub error_deg: Option<f64>,
    /// Its standard deviation as the method states it, deg.
    pub sigma_deg: Option<f64>,
    /// Estimated less true scale, and its standard deviation, where it was estimated.
    pub scale: Option<(f64, f64)>,
    /// Frames used.
    pub used: u64,
    /// Whether it called itself converged.
    pub converged: bool,
    /// Relative trajectory error with this angle, m.
    pub rte_m: Option<f64>,
}

/// Estimates from the parts of one length that a drive was cut into.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct PartRecord {
    /// Estimated less true angle, deg, of each part that gave one.
    pub errors_deg: Vec<f64>,
    /// Parts that gave none.
    pub without: usize,
}

/// A radar of a drive, ready for the methods.
struct Radar<'a> {
    sensor: u8,
    truth: Mounting,
    options: CalibrationOptions,
    frames: Vec<FrameInput<'a>>,
    /// Whether the car drove at each frame.
    driving: Vec<bool>,
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
    let drive = simulate_drive(&DriveOptions {
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
    let radars: Vec<Radar> =
        drive.truth.sensors.iter().map(|s| radar(&drive, profile, *s)).collect();
    let joint = joint(&drive, &radars)?;
    let step = |m: &TrueMotion| m.speed_mps.abs() > DRIVING_MPS;
    Ok(SceneRecord {
        scene,
        scenario: scenario.name().into(),
        profile,
        dense,
        moving_share: share(&drive),
        driven_m: drive.truth.motion.last().map_or(0.0, |m| m.travelled_m),
        driven_s: drive.truth.motion.iter().filter(|m| step(m)).count() as f64 * MOTION_STEP_S,
        radars: radars
            .iter()
            .zip(joint)
            .map(|(radar, joint)| record(&drive, radar, joint))
            .collect::<Result<_, _>>()?,
    })
}

fn radar(
    drive: &SimulatedDrive,
    profile: DriveProfile,
    (sensor, truth): (u8, Mounting),
) -> Radar<'_> {
    let log = &drive.log;
    let gap = CalibrationOptions::default().max_gap_s;
    let nominal = log.sensors.iter().find(|s| s.id == sensor).and_then(|s| s.mounting);
    let frames: Vec<FrameInput> =
        Frames::of(log, |id| id == sensor, gap).map(|(_, frame)| frame).collect();
    Radar {
        sensor,
        truth,
        options: options(
            profile,
            truth,
            nominal.map_or(truth.yaw_rad, |mounting| mounting.yaw_rad),
        ),
        driving: frames
            .iter()
            .map(|frame| truth_at(drive, frame.time_s).speed_mps.abs() > DRIVING_MPS)
            .collect(),
        frames,
    }
}

/// The true motion nearest to a time.
fn truth_at(drive: &SimulatedDrive, time_s: f64) -> &TrueMotion {
    let motion = &drive.truth.motion;
    &motion[((time_s / MOTION_STEP_S).round() as usize).min(motion.len() - 1)]
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

/// The radar's options. Of drives with the clean profile it is known that they have no bias of azimuths, no slip, and that range rates are
/// measured within 40 ms.
fn options(profile: DriveProfile, place: Mounting, nominal_rad: f64) -> CalibrationOptions {
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

fn calibrate(
    candidate: &Candidate,
    radar: &Radar,
    frames: &[FrameInput],
) -> Result<AngleEstimate, EvaluateError> {
    let mut calibrator = Calibrator::new(candidate.options(&radar.options))?;
    for frame in frames {
        calibrator.add(candidate.told(frame))?;
    }
    Ok(calibrator.estimate())
}

/// The estimate of all radars together, in their order.
fn joint(drive: &SimulatedDrive, radars: &[Radar]) -> Result<Vec<AngleEstimate>, EvaluateError> {
    let Some(candidate) = CANDIDATES.iter().find(|candidate| candidate.joint) else {
        return Ok(vec![]);
    };
    let named: Vec<_> = radars.iter().map(|r| (r.sensor, candidate.options(&r.options))).collect();
    let gap = CalibrationOptions::default().max_gap_s;
    joint_estimates(candidate, &named, Frames::of(&drive.log, |_| true, gap))
}

/// Estimates of radars together from the frames of a log, in the order of the radars; frames of others are left out.
pub(super) fn joint_estimates<'a>(
    candidate: &Candidate,
    radars: &[(u8, CalibrationOptions)],
    frames: impl Iterator<Item = (u8, FrameInput<'a>)>,
) -> Result<Vec<AngleEstimate>, EvaluateError> {
    let mut joint = Joint::new(radars)?;
    for (sensor, frame) in frames {
        if radars.iter().any(|(id, _)| *id == sensor) {
            joint.add(sensor, candidate.told(&frame))?;
        }
    }
    Ok(joint.estimate().into_iter().map(|(_, estimate)| estimate).collect())
}

fn record(
    drive: &SimulatedDrive,
    radar: &Radar,
    joint: AngleEstimate,
) -> Result<RadarRecord, EvaluateError> {
    let track = Track::new(drive, radar)?;
    let mut estimates = Vec::with_capacity(CANDIDATES.len());
    let mut parts = vec![];
    for candidate in &CANDIDATES {
        let estimate = if candidate.joint {
            joint.clone()
        } else {
            calibrate(candidate, radar, &radar.frames)?
        };
        let error_deg = error_deg(radar.truth.yaw_rad, &estimate);
        estimates.push(EstimateRecord {
            error_deg,
            sigma_deg: error_deg.map(|_| estimate.sigma_rad.to_degrees()),
            scale: (estimate.scale_sigma > 0.0 && estimate.scale_sigma.is_finite())
                .then_some((estimate.scale - drive.truth.yaw_rate.scale, estimate.scale_sigma)),
            used: estimate.frames.used,
            converged: estimate.converged,
            rte_m: error_deg.and_then(|_| track.error_m(estimate.angle_rad)),
        });
        if candidate.convergence && radar.sensor == FIGURE_RADAR {
            parts.push(
                DRIVING_TIMES_S
                    .iter()
                    .map(|&length_s| cut(candidate, radar, length_s))
                    .collect::<Result<_, _>>()?,
            );
        }
    }
    Ok(RadarRecord {
        sensor: radar.sensor,
        true_deg: radar.truth.yaw_rad.to_degrees(),
        rte_true_m: track.error_m(radar.truth.yaw_rad),
        estimates,
        parts,
    })
}

/// Estimated less true angle, deg; `None` where there is no estimate.
pub(super) fn error_deg(true_rad: f64, estimate: &AngleEstimate) -> Option<f64> {
    let error = (estimate.angle_rad - true_rad + PI).rem_euclid(TAU) - PI;
    (error.is_finite() && estimate.sigma_rad.is_finite()).then(|| error.to_degrees())
}

/// Cuts the drive into parts with `length_s` of driving, and estimates from each.
fn cut(candidate: &Candidate, radar: &Radar, length_s: f64) -> Result<PartRecord, EvaluateError> {
    let cycle_s = 0.5 * (CYCLE_S[0] + CYCLE_S[1]);
    let frames_a_part = (length_s / cycle_s).round() as usize;
    let mut part = PartRecord::default();
    let (mut start, mut driven) = (0, 0);
    for (i, driving) in radar.driving.iter().enumerate() {
        driven += usize::from(*driving);
        if driven == frames_a_part {
            let estimate = calibrate(candidate, radar, &radar.frames[start..=i])?;
            match error_deg(radar.truth.yaw_rad, &estimate) {
                Some(error) => part.errors_deg.push(error),
                None => part.without += 1,
            }
            (start, driven) = (i + 1, 0);
        }
    }
    Ok(part)
}

/// The radar's motion as tracked, and where the car truly was: the motion is the same for all
/// angles.
struct Track {
    motions: Vec<TimedMotion>,
    truth: Vec<Pose>,
    mounting: Mounting,
}

impl Track {
    fn new(drive: &SimulatedDrive, radar: &Radar) -> Result<Self, EvaluateError> {
        let tracked = CANDIDATES.iter().find(|c| c.method == Method::Recursive && c.speed);
        let mut track = Self { motions: vec![], truth: vec![], mounting: radar.truth };
        let Some(tracked) = tracked else { return Ok(track) };
        let mut calibrator = Calibrator::new(tracked.options(&radar.options))?;
        for &frame in &radar.frames {
            if let Some(motion) = calibrator.add(frame)?.motion {
                let velocity_mps = motion.velocity_mps;
                track.motions.push(TimedMotion {
                    time_s: frame.time_s,
                    velocity_mps,
                    yaw_rate_radps: None,
                });
                track.truth.push(truth_at(drive, frame.time_s).pose);
            }
        }
        Ok(track)
    }

    fn error_m(&self, angle_rad: f64) -> Option<f64> {
        let poses = integrate(&self.motions, angle_rad, self.mounting.x_m, self.mounting.y_m)?;
        relative_error(poses.into_iter().zip(self.truth.iter().copied()), SEGMENT_M)
    }
}
