//! Cuts a drive into windows, and sets how much moves in each.

use super::{DatasetNoise, WINDOW};
use crate::drive::motion::{TrueMotion, motion_at};
use crate::drive::radar::{Labelled, STATIC_CLASS};
use crate::drive::{RadarNoise, Scenario, SimulatedDrive, trim};
use boresight_core::Random;
use boresight_core::drive::{Detection, Mounting};
use std::f64::consts::PI;

const DEG: f64 = PI / 180.0;

/// Moving shares that windows are brought to: share of the windows, from, to.
const SHARES: [[f64; 3]; 3] = [[0.45, 0.0, 0.3], [0.3, 0.3, 0.6], [0.25, 0.6, 0.85]];

/// So many detections of standing things a scan are left where movers are too few for a share.
const STANDING_LEFT: f64 = 25.0;

/// Share of windows with movers in which all have one speed; share of these where it is near the
/// car's; that speed over the car's from and to, near and otherwise.
const QUEUES: f64 = 0.12;
const QUEUES_NEAR: f64 = 0.5;
const NEAR: [f64; 2] = [0.92, 1.05];
const FAR: [f64; 2] = [0.5, 1.3];

/// Share of the frames that have nothing that stands, and fewest movers' detections a scan of those.
const NOTHING_STATIC: f64 = 0.05;
const FEWEST_MOVING: usize = 4;

/// A radar that is slower stands, m/s; one in so many windows in which it does is kept.
const STANDS_MPS: f64 = 0.3;
const STANDING_KEPT: f64 = 0.15;

/// White noise of the noise "laplace" but that of azimuth, which comes after.
pub(super) const LAPLACE_NOISE: RadarNoise = RadarNoise {
    azimuth_sigma_rad: 0.0,
    azimuth_growth: 0.0,
    range_rate_sigma_mps: 0.08,
    range_sigma_m: 0.2,
    coherent_interval_s: 0.04,
    ghost_share: 0.04,
    clutter: 1.0,
};
/// Standard deviation of azimuth, rad, azimuths seen, rad, and mean detections a scan of "laplace".
const LAPLACE_SIGMA_RAD: f64 = 0.5 * DEG;
const LAPLACE_WITHIN_RAD: f64 = 45.0 * DEG;
const LAPLACE_COUNT: f64 = 30.0;

/// What a window was made like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Condition {
    /// Traffic as simulated.
    Traffic = 0,
    /// All movers have one speed.
    Queue = 1,
    /// All detections that do not come from movers are left out.
    NothingStatic = 2,
}

/// One scan of a radar and the motion that its range rates show.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time since the window's frame before; 0 in the first, s.
    pub dt_s: f64,
    /// Velocity of the radar in its own frame, along boresight and to its left, at the middle of the time
    /// that range rates are measured over (the delay before the stamp), m/s.
    pub velocity_mps: [f64; 2],
    /// Yaw rate then, rad/s.
    pub yaw_rate_radps: f64,
    /// Detections and whether each comes from a moving road user.
    pub detections: Vec<(Detection, bool)>,
}

/// Successive frames of one radar.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Number of the drive.
    pub drive: u64,
    /// Roads of the drive.
    pub scenario: Scenario,
    /// What it was made like.
    pub condition: Condition,
    /// Direction that the radar looks in, rad to the left of the car's.
    pub yaw_rad: f64,
    /// The frames, [`WINDOW`] of them.
    pub frames: Vec<Frame>,
}

/// How many windows there were, and how many without anything static.
#[derive(Debug, Default)]
pub(super) struct Shares {
    windows: u64,
    nothing_static: u64,
}

/// A moving share.
pub(super) fn draw_share(random: &mut Random) -> f64 {
    let mut draw = random.unit();
    let within = random.unit();
    for [weight, from, to] in SHARES {
        if draw < weight {
            return from + (to - from) * within;
        }
        draw -= weight;
    }
    0.0
}

/// The windows of a drive, radar by radar.
pub(super) fn windows(
    drive: &SimulatedDrive,
    number: u64,
    scenario: Scenario,
    noise: DatasetNoise,
    shares: &mut Shares,
    random: &mut Random,
) -> Vec<Window> {
    let mut all = vec![];
    for (id, mounting) in &drive.truth.sensors {
        let scans: Vec<usize> =
            (0..drive.log.scans.len()).filter(|i| drive.log.scans[*i].sensor == *id).collect();
        for chosen in scans.chunks_exact(WINDOW) {
            let motion = |i: &usize| {
                let time_s = drive.log.scans[*i].time_s - drive.truth.car.delay_s;
                motion_at(&drive.truth.motion, time_s)
            };
            let motions: Vec<TrueMotion> = chosen.iter().map(motion).collect();
            let stands = motions.iter().all(|m| m.speed_mps.abs() < STANDS_MPS);
            if stands && random.unit() >= STANDING_KEPT {
                continue;
            }
            let mut scans: Vec<Vec<Labelled>> =
                chosen.iter().map(|i| labelled(drive, *i)).collect();
            if noise == DatasetNoise::Laplace {
                make_laplace(&mut scans, random);
            }
            let condition = arrange(&mut scans, &motions, mounting, shares, random);
            let frames = (0..WINDOW)
                .map(|k| Frame {
                    dt_s: if k == 0 { 0.0 } else { motions[k].time_s - motions[k - 1].time_s },
                    velocity_mps: motions[k].radar_velocity(mounting),
                    yaw_rate_radps: motions[k].yaw_rate_radps,
                    detections: scans[k].iter().map(|one| (one.detection, one.moving)).collect(),
                })
                .collect();
            let yaw_rad = mounting.yaw_rad;
            all.push(Window { drive: number, scenario, condition, yaw_rad, frames });
        }
    }
    all
}

fn labelled(drive: &SimulatedDrive, i: usize) -> Vec<Labelled> {
    let (moving, tracks) = (&drive.moving[i], &drive.tracks[i]);
    let scan = &drive.log.scans[i];
    (0..scan.detections.len())
        .map(|k| Labelled {
            detection: scan.detections[k],
            class: STATIC_CLASS,
            moving: moving[k],
            track: tracks[k],
            strength_db: 0.0,
        })
        .collect()
}

/// Brings the moving share of a window to one that is drawn, or nearer to it, and says what else was done.
fn arrange(
    scans: &mut [Vec<Labelled>],
    motions: &[TrueMotion],
    mounting: &Mounting,
    shares: &mut Shares,
    random: &mut Random,
) -> Condition {
    shares.windows += 1;
    let count =
        |moving: bool, scan: &Vec<Labelled>| scan.iter().filter(|one| one.moving == moving).count();
    let wanted = NOTHING_STATIC * shares.windows as f64;
    let enough = scans.iter().all(|scan| count(true, scan) >= FEWEST_MOVING);
    if enough && (shares.nothing_static as f64) < wanted {
        shares.nothing_static += 1;
        scans.iter_mut().for_each(|scan| scan.retain(|one| one.moving));
        return Condition::NothingStatic;
    }
    let moving: usize = scans.iter().map(|scan| count(true, scan)).sum();
    let standing: usize = scans.iter().map(|scan| count(false, scan)).sum();
    let least = (STANDING_LEFT * scans.len() as f64).min(standing as f64);
    let most = moving as f64 / (moving as f64 + least).max(1.0);
    let share = draw_share(random).min(most);
    let mut group: Vec<_> = scans.iter_mut().map(|scan| (scan, true)).collect();
    trim::trim(&mut group, share, random);
    if moving > 0 && random.unit() < QUEUES {
        let [from, to] = if random.unit() < QUEUES_NEAR { NEAR } else { FAR };
        let pace = random.uniform(from, to);
        for (scan, motion) in scans.iter_mut().zip(motions) {
            queue(scan, motion, mounting, pace, random);
        }
        return Condition::Queue;
    }
    Condition::Traffic
}

/// Gives all movers the car's velocity times `pace`.
fn queue(
    scan: &mut [Labelled],
    motion: &TrueMotion,
    mounting: &Mounting,
    pace: f64,
    random: &mut Random,
) {
    let radar = motion.radar_velocity(mounting);
    let (sin, cos) = libm::sincos(mounting.yaw_rad);
    let own = [pace * motion.speed_mps * cos, -pace * motion.speed_mps * sin];
    for one in scan.iter_mut().filter(|one| one.moving) {
        let (sin, cos) = libm::sincos(f64::from(one.detection.azimuth_rad));
        let rate = (own[0] - radar[0]) * cos + (own[1] - radar[1]) * sin;
        one.detection.range_rate_mps = (rate + 0.05 * random.normal()) as f32;
    }
}

/// Makes scans those of the sparse radar.
fn make_laplace(scans: &mut [Vec<Labelled>], random: &mut Random) {
    let scale = LAPLACE_SIGMA_RAD / std::f64::consts::SQRT_2;
    for scan in scans {
        let keep = LAPLACE_COUNT * random.uniform(0.6, 1.4) / (scan.len() as f64).max(1.0);
        scan.retain(|_| random.unit() < keep);
        for one in scan.iter_mut() {
            let draw = random.uniform(-1.0, 1.0);
            let error = -scale * libm::log1p(-draw.abs()).copysign(-draw);
            one.detection.azimuth_rad += error as f32;
        }
        scan.retain(|one| f64::from(one.detection.azimuth_rad).abs() < LAPLACE_WITHIN_RAD);
    }
}
