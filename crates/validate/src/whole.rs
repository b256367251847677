//! A drive whose true angles are known: every method on every radar.

use crate::candidates::{CANDIDATES, Candidate, DRIVING_TIMES_S, SEGMENTS_M, network};
use crate::error::ValidateError;
use boresight_core::DriveLog;
use boresight_core::drive::{Mounting, Pose};
use boresight_mounting::trajectory::{TimedMotion, integrate, relative_error};
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, Calibrator, FrameInput, FrameOutcome, Frames, Joint, Method,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Slower is not driving, m/s, as in Zhu et al.
pub const DRIVING_MPS: f64 = 1.0;
/// The radar of Figures 5 and 6.
pub const FIGURE_RADAR: u8 = 3;
/// Width of a bin of speeds, m/s, and of accelerations, m/s^2, of Figure 4.
pub const BINS: [f64; 2] = [1.0, 0.2];
/// Bins of each; of accelerations half are below zero. What lies beyond is in the last ones.
pub const BIN_COUNT: usize = 60;
/// An acceleration is the speed's change over this, s.
const ACCELERATION_S: f64 = 0.5;
/// Errors of the angle in whose steps trajectories' errors are kept: near zero a hundredth of a degree apart, then in proportion.
const ERROR_STEPS: i32 = 60;

/// What is known of a drive beside its log.
pub struct Drive<'a> {
    /// The log.
    pub log: &'a DriveLog,
    /// Radars: number, true mounting, options.
    pub radars: Vec<(u8, Mounting, CalibrationOptions)>,
    /// The car's pose.
    pub pose_at: &'a dyn Fn(f64) -> Option<Pose>,
    /// Its speed, m/s.
    pub speed_at: &'a dyn Fn(f64) -> Option<f64>,
    /// Scale of the yaw rate, where it is known.
    pub scale: Option<f64>,
}

/// What is kept of a drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WholeRecord {
    /// Share of detections from moving road users, of scans at more than 1 m/s; `None` where the log does not tell them.
    pub moving_share: Option<f64>,
    /// Way driven, m.
    pub driven_m: f64,
    /// Time driven, s.
    pub driven_s: f64,
    /// Scans of all radars by the car's speed, then by its acceleration, in [`BIN_COUNT`] bins each.
    pub states: [Vec<u64>; 2],
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
    /// Relative trajectory errors with the true angle, m, by [`SEGMENTS_M`].
    pub rte_true_m: [Option<f64>; SEGMENTS_M.len()],
    /// The same with angles off by [`error_steps_deg`].
    pub rte_off_m: [Vec<f32>; SEGMENTS_M.len()],
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
    /// Estimated less true scale, and its standard deviation, where it was estimated and is known.
    pub scale: Option<(f64, f64)>,
    /// Frames used.
    pub used: u64,
    /// Whether it called itself converged.
    pub converged: bool,
    /// Relative trajectory errors with this angle, m, by [`SEGMENTS_M`].
    pub rte_m: [Option<f64>; SEGMENTS_M.len()],
}

/// Estimates from the parts of one length that a drive was cut into.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct PartRecord {
    /// Of each part that gave an angle.
    pub answers: Vec<Answer>,
    /// Parts that gave none.
    pub without: usize,
}

/// An angle from a part of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Estimated less true angle, deg.
    pub error_deg: f64,
    /// Its standard deviation as the method states it, deg.
    pub sigma_deg: f64,
    /// Whether the method called itself converged.
    pub converged: bool,
}

impl Answer {
    /// Of an estimate; `None` where it has no angle.
    pub fn of(true_rad: f64, estimate: &AngleEstimate) -> Option<Self> {
        let error = (estimate.angle_rad - true_rad + PI).rem_euclid(TAU) - PI;
        (error.is_finite() && estimate.sigma_rad.is_finite()).then(|| Self {
            error_deg: error.to_degrees(),
            sigma_deg: estimate.sigma_rad.to_degrees(),
            converged: estimate.converged,
        })
    }

    /// Whether it is called converged and lies more than three of its standard deviations off.
    pub fn confidently_wrong(&self) -> bool {
        self.converged && self.error_deg.abs() > 3.0 * self.sigma_deg
    }
}

impl EstimateRecord {
    /// Its angle as that of a part.
    pub fn answer(&self) -> Option<Answer> {
        let (error_deg, sigma_deg) = self.error_deg.zip(self.sigma_deg)?;
        Some(Answer { error_deg, sigma_deg, converged: self.converged })
    }
}

/// Errors of the angle at which trajectories' errors are kept, deg, ascending: up to 10 deg either way.
pub fn error_steps_deg() -> impl Iterator<Item = f64> {
    (-ERROR_STEPS..=ERROR_STEPS).map(|step| 0.05 * (0.1 * f64::from(step)).sinh())
}

/// A radar of a drive, ready for the methods.
pub struct Radar<'a> {
    /// Its number.
    pub sensor: u8,
    /// True mounting.
    pub truth: Mounting,
    /// Options of all methods.
    pub options: CalibrationOptions,
    /// Its frames.
    pub frames: Vec<FrameInput<'a>>,
}

impl<'a> Radar<'a> {
    /// With its frames of a log, as far as they lie between two times, s.
    pub fn new(
        log: &'a DriveLog,
        (sensor, truth, options): (u8, Mounting, CalibrationOptions),
        [begin_s, end_s]: [f64; 2],
    ) -> Self {
        let frames = Frames::of(log, |id| id == sensor, options.max_gap_s)
            .map(|(_, frame)| frame)
            .filter(|frame| (begin_s..end_s).contains(&frame.time_s))
            .collect();
        Self { sensor, truth, options, frames }
    }

    /// The estimate from its frames.
    pub fn calibrate(
        &self,
        candidate: &Candidate,
        frames: &[FrameInput],
    ) -> Result<AngleEstimate, ValidateError> {
        let options = candidate.options(&self.options);
        let mut calibrator = Calibrator::with_network(options, Some(&network()))?;
        for frame in frames {
            calibrator.add(candidate.seen(frame))?;
        }
        Ok(calibrator.estimate())
    }
}

/// Estimates of radars together, in their order, from the frames of a log between two times, s.
pub fn joint_estimates(
    candidate: &Candidate,
    radars: &[Radar],
    log: &DriveLog,
    [begin_s, end_s]: [f64; 2],
) -> Result<Vec<AngleEstimate>, ValidateError> {
    let named: Vec<_> = radars.iter().map(|r| (r.sensor, candidate.options(&r.options))).collect();
    let mut joint = Joint::new(&named)?;
    let gap_s = CalibrationOptions::default().max_gap_s;
    for (sensor, frame) in Frames::of(log, |id| radars.iter().any(|r| r.sensor == id), gap_s) {
        if (begin_s..end_s).contains(&frame.time_s) {
            joint.add(sensor, candidate.seen(&frame))?;
        }
    }
    Ok(joint.estimate().into_iter().map(|(_, estimate)| estimate).collect())
}

/// Runs every method on every radar.
///
/// # Errors
/// Those of the calibration.
pub fn run(drive: &Drive, moving_share: Option<f64>) -> Result<WholeRecord, ValidateError> {
    const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let radars: Vec<Radar> =
        drive.radars.iter().map(|radar| Radar::new(drive.log, *radar, ALL)).collect();
    let joint = match CANDIDATES.iter().find(|candidate| candidate.joint) {
        Some(candidate) => joint_estimates(candidate, &radars, drive.log, ALL)?,
        None => vec![],
    };
    let (driven_m, driven_s) = driven(drive);
    Ok(WholeRecord {
        moving_share,
        driven_m,
        driven_s,
        states: states(drive, &radars),
        radars: radars
            .iter()
            .zip(joint)
            .map(|(radar, joint)| record(drive, radar, &joint))
            .collect::<Result<_, _>>()?,
    })
}

/// Way and time of driving, m and s.
fn driven(drive: &Drive) -> (f64, f64) {
    let gap_s = CalibrationOptions::default().max_gap_s;
    drive.log.motion.windows(2).fold((0.0, 0.0), |(way, time), pair| {
        let step_s = pair[1].time_s - pair[0].time_s;
        let speed = (drive.speed_at)(pair[0].time_s).map_or(0.0, f64::abs);
        let drives = f64::from(speed > DRIVING_MPS && step_s <= gap_s);
        (way + drives * speed * step_s, time + drives * step_s)
    })
}

/// How often the car had which speed and acceleration.
fn states(drive: &Drive, radars: &[Radar]) -> [Vec<u64>; 2] {
    let mut counts = [vec![0; BIN_COUNT], vec![0; BIN_COUNT]];
    let last = BIN_COUNT as f64 - 1.0;
    for frame in radars.iter().flat_map(|radar| &radar.frames) {
        let speed = |after_s: f64| (drive.speed_at)(frame.time_s + after_s);
        let half_s = 0.5 * ACCELERATION_S;
        let (Some(now), Some(before), Some(after)) = (speed(0.0), speed(-half_s), speed(half_s))
        else {
            continue;
        };
        let acceleration = (after - before) / ACCELERATION_S;
        counts[0][(now.abs() / BINS[0]).clamp(0.0, last) as usize] += 1;
        let middle = BIN_COUNT as f64 / 2.0;
        counts[1][(acceleration / BINS[1] + middle).clamp(0.0, last) as usize] += 1;
    }
    counts
}

fn record(
    drive: &Drive,
    radar: &Radar,
    joint: &AngleEstimate,
) -> Result<RadarRecord, ValidateError> {
    let track = Track::new(drive, radar)?;
    let mut estimates = Vec::with_capacity(CANDIDATES.len());
    let mut parts = vec![];
    for candidate in &CANDIDATES {
        let estimate = match candidate.joint {
            true => joint.clone(),
            false => radar.calibrate(candidate, &radar.frames)?,
        };
        let answer = Answer::of(radar.truth.yaw_rad, &estimate);
        let scaled = estimate.scale_sigma > 0.0 && estimate.scale_sigma.is_finite();
        estimates.push(EstimateRecord {
            error_deg: answer.map(|answer| answer.error_deg),
            sigma_deg: answer.map(|answer| answer.sigma_deg),
            scale: drive
                .scale
                .filter(|_| scaled)
                .map(|scale| (estimate.scale - scale, estimate.scale_sigma)),
            used: estimate.frames.used,
            converged: estimate.converged,
            rte_m: track.errors_m(answer.map_or(f64::NAN, |_| estimate.angle_rad)),
        });
        if candidate.convergence && radar.sensor == FIGURE_RADAR {
            let driving: Vec<bool> = radar
                .frames
                .iter()
                .map(|frame| (drive.speed_at)(frame.time_s).is_some_and(|v| v.abs() > DRIVING_MPS))
                .collect();
            parts.push(
                DRIVING_TIMES_S
                    .iter()
                    .map(|&length_s| cut(candidate, radar, &driving, length_s))
                    .collect::<Result<_, _>>()?,
            );
        }
    }
    let mut rte_off_m = [const { vec![] }; SEGMENTS_M.len()];
    for off_deg in error_steps_deg() {
        let errors = track.errors_m(radar.truth.yaw_rad + off_deg.to_radians());
        for (all, error) in rte_off_m.iter_mut().zip(errors) {
            all.extend(error.map(|error| error as f32));
        }
    }
    Ok(RadarRecord {
        sensor: radar.sensor,
        true_deg: radar.truth.yaw_rad.to_degrees(),
        rte_true_m: track.errors_m(radar.truth.yaw_rad),
        rte_off_m,
        estimates,
        parts,
    })
}

/// Cuts the drive into parts with `length_s` of driving, and estimates from each.
fn cut(
    candidate: &Candidate,
    radar: &Radar,
    driving: &[bool],
    length_s: f64,
) -> Result<PartRecord, ValidateError> {
    let frames_a_part = (length_s / cycle_s(&radar.frames)).round().max(1.0) as usize;
    let mut part = PartRecord::default();
    let (mut start, mut driven) = (0, 0);
    for (i, driving) in driving.iter().enumerate() {
        driven += usize::from(*driving);
        if driven == frames_a_part {
            let estimate = radar.calibrate(candidate, &radar.frames[start..=i])?;
            match Answer::of(radar.truth.yaw_rad, &estimate) {
                Some(answer) => part.answers.push(answer),
                None => part.without += 1,
            }
            (start, driven) = (i + 1, 0);
        }
    }
    Ok(part)
}

/// Median time from one frame to the next, s.
fn cycle_s(frames: &[FrameInput]) -> f64 {
    let mut gaps: Vec<f64> = frames.windows(2).map(|w| w[1].time_s - w[0].time_s).collect();
    gaps.sort_by(f64::total_cmp);
    gaps.get(gaps.len() / 2).map_or(f64::INFINITY, |gap| gap.max(1e-3))
}

/// The radar's motion as tracked, and where the car truly was: the motion is the same for all
/// angles.
struct Track {
    motions: Vec<TimedMotion>,
    truth: Vec<Pose>,
    mounting: Mounting,
}

impl Track {
    fn new(drive: &Drive, radar: &Radar) -> Result<Self, ValidateError> {
        let tracked = CANDIDATES.iter().find(|c| c.method == Method::Recursive && c.speed);
        let mut track = Self { motions: vec![], truth: vec![], mounting: radar.truth };
        let Some(tracked) = tracked else { return Ok(track) };
        let mut calibrator = Calibrator::new(tracked.options(&radar.options))?;
        for &frame in &radar.frames {
            let FrameOutcome { time_s, motion, .. } = calibrator.add(frame)?;
            if let (Some(motion), Some(pose)) = (motion, (drive.pose_at)(time_s)) {
                let velocity_mps = motion.velocity_mps;
                track.motions.push(TimedMotion { time_s, velocity_mps, yaw_rate_radps: None });
                track.truth.push(pose);
            }
        }
        Ok(track)
    }

    /// Relative trajectory errors with an angle, by [`SEGMENTS_M`].
    fn errors_m(&self, angle_rad: f64) -> [Option<f64>; SEGMENTS_M.len()] {
        let poses = integrate(&self.motions, angle_rad, self.mounting.x_m, self.mounting.y_m);
        SEGMENTS_M.map(|segment_m| {
            let poses = poses.as_ref()?.iter().copied();
            relative_error(poses.zip(self.truth.iter().copied()), segment_m)
        })
    }
}
