//! The direction of the radar's velocity in its own frame, and what the yaw rate does to it.
//!
//! A radar at `x_s` ahead of the rear axle, mounted at `theta`, moves in the direction `beta` with
//! `|V| sin(beta + theta) = w x_s`, and the rear axle slides outwards by the slip gradient `g` times `w v`. So `beta` follows
//! `psi = asin(w x_s / |V|) - g w v` with slope 1, and a mirrored one with slope -1. Fast cars slide as much as the
//! lever arm turns, at `v^2 = x_s / g`, about 30 m/s, where the slope would change its sign: frames of a radar ahead of the
//! axle count up to where the most slip a car has would take three quarters of it.

use super::tally::Tally;
use crate::angle::wrap;
use crate::statistics::frames::Frame;
use crate::statistics::robust::median;
use boresight_core::{DriveLog, Mounting};

/// Least lever arm that turns the velocity enough, m.
const LEAST_LEVER_M: f64 = 0.5;
/// Slip angle over lateral acceleration that is expected and the most there is, rad/(m/s^2).
const SLIP: f64 = 0.0035;
const MOST_SLIP: f64 = 0.008;
/// Share of the turn by the lever arm that the most slip takes back.
const MOST_SLIPPING: f64 = 0.75;
/// The velocity turns by no more than this, sine, nor does the angle differ from both lines by more, rad (10 deg).
const MOST_SINE: f64 = 0.9;
const GATE_RAD: f64 = 0.174_532_925_199_432_95;
/// Speeds of car and radar may differ by so much, m/s, and by a share of the speed.
const SPEED_MPS: f64 = 1.0;
const SPEED_SHARE: f64 = 0.05;
/// Frames of a block, in which the line's constant is free; s.
const BLOCK_S: f64 = 60.0;
/// Seconds whose frames err together, and the share of the directions' scatter that a line may leave.
const STRETCH_S: f64 = 3.0;
const MOST_REST: f64 = 0.5;
/// How many stretches must share the turns, if all turned alike.
const LEAST_STRETCHES: f64 = 4.0;
/// Scatter of frames beyond their own variance, rad^2 (0.4 deg), and frames that count as one on real drives.
const SCATTER: f64 = 5e-5;
const CORRELATED: f64 = 50.0;
/// A slope nearer to its sign than this is of one of both signs.
const OFF_SLOPE: f64 = 0.6;
/// Least cosine between the direction of travel and the expected one that tells forward from backward.
const TELLING: f64 = 0.5;
/// How near a mounting must be that speaks for itself, and how far its mirror image, rad (3 and 6 deg).
const NEAR_RAD: f64 = 0.052_359_877_559_829_88;
const FAR_RAD: f64 = 0.104_719_755_119_659_77;

/// What the directions of a radar's velocity say; deviations are positive for the usual sign.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lever {
    pub(super) azimuth: Option<f64>,
    /// That range rates count as usual, if azimuths count as usual, and if they are mirrored.
    pub(super) range_rate: [Option<f64>; 2],
    /// Whether the radar's place is known, and off the rear axle.
    pub(super) has_lever: bool,
    /// With slope -1 the angle is the nominal one, not its mirror image: the yaw rate counts the other way.
    pub(super) yaw_rate_reversed: bool,
}

/// Direction of the velocity, modulo half a turn about the radar's usual one, and what turns it.
struct Point {
    time_s: f64,
    turn_rad: f64,
    direction_rad: f64,
    variance: f64,
}

pub(super) fn lever(
    log: &DriveLog,
    frames: &[Frame],
    mounting: Option<Mounting>,
    max_gap_s: f64,
) -> Lever {
    let Some(mounting) = mounting else { return Lever::default() };
    let points = points(log, frames, mounting, max_gap_s);
    let mut found = Lever {
        range_rate: range_rate(log, frames, mounting, max_gap_s),
        has_lever: mounting.x_m.abs() >= LEAST_LEVER_M,
        ..Lever::default()
    };
    let Some((slope, sigma)) = slope(&points) else { return found };
    if (slope.abs() - 1.0).abs() < OFF_SLOPE {
        found.azimuth = Some(slope / sigma);
    }
    if slope < 0.0 {
        let level = level(&points, -1.0);
        let off = |sign: f64| axial(level + sign * mounting.yaw_rad).abs();
        found.yaw_rate_reversed = off(1.0) < NEAR_RAD && off(-1.0) > FAR_RAD;
    }
    found
}

/// An angle of a line that has no direction, within a quarter of a turn.
fn axial(angle_rad: f64) -> f64 {
    wrap(2.0 * angle_rad) / 2.0
}

fn points(log: &DriveLog, frames: &[Frame], mounting: Mounting, max_gap_s: f64) -> Vec<Point> {
    let x_m = mounting.x_m;
    if x_m.abs() < LEAST_LEVER_M {
        return Vec::new();
    }
    let most_mps = if x_m > 0.0 { (MOST_SLIPPING * x_m / MOST_SLIP).sqrt() } else { f64::INFINITY };
    // Where the log has no speed, the car drives the way that it drives in most frames.
    let axis = frames.iter().fold([0.0; 2], |sum, frame| {
        let polar = frame.motion.polar();
        let double = 2.0 * polar.direction_rad;
        [sum[0] + double.cos(), sum[1] + double.sin()]
    });
    let axis_rad = axis[1].atan2(axis[0]) / 2.0;
    let ahead = |direction: f64| (direction - axis_rad).cos() > 0.0;
    let most_ahead =
        2 * frames.iter().filter(|frame| ahead(frame.motion.polar().direction_rad)).count()
            >= frames.len();
    frames
        .iter()
        .filter_map(|frame| {
            let time_s = frame.scan.time_s;
            let polar = frame.motion.polar();
            let rate = log.yaw_rate_at(time_s, max_gap_s)?;
            let speed = log.speed_at(time_s, max_gap_s);
            let own = |speed: f64| (speed - rate * mounting.y_m).hypot(rate * x_m);
            let fits = speed.is_none_or(|speed| {
                (own(speed) - polar.speed_mps).abs() < SPEED_MPS + SPEED_SHARE * polar.speed_mps
            });
            let forward = match speed {
                Some(speed) => speed.signum(),
                None if ahead(polar.direction_rad) == most_ahead => 1.0,
                None => -1.0,
            };
            let sine = forward * rate * x_m / polar.speed_mps;
            let kept = fits && sine.abs() < MOST_SINE && polar.speed_mps < most_mps;
            kept.then(|| Point {
                time_s,
                turn_rad: sine.asin() - SLIP * rate * polar.speed_mps * forward,
                direction_rad: axis_rad + axial(polar.direction_rad - axis_rad),
                variance: polar.direction_variance + SCATTER,
            })
        })
        .collect()
}

/// The constant of the line with a slope.
fn level(points: &[Point], slope: f64) -> f64 {
    median(&points.iter().map(|p| p.direction_rad - slope * p.turn_rad).collect::<Vec<_>>())
}

/// Slope of direction on turn, with a constant of its own for each block, and its standard deviation: the larger of what the frames' scatter makes of
/// it and of what stretches of some seconds do, each of whose frames err together (the sandwich of Liang and Zeger 1986). Frames that lie far
/// from both lines of slope 1 and -1 are left out: they are of traffic. `None` where the line leaves more than it explains: then the
/// yaw rate is not that of the radar's car.
fn slope(points: &[Point]) -> Option<(f64, f64)> {
    let mut rows: Vec<[f64; 4]> = Vec::new();
    let mut freedom = 0.0;
    for block in points.chunk_by(|a, b| place(a, BLOCK_S) == place(b, BLOCK_S)) {
        let levels = [1.0, -1.0].map(|slope| (slope, level(block, slope)));
        let near = |point: &&Point| {
            levels.iter().any(|(slope, level)| {
                (point.direction_rad - slope * point.turn_rad - level).abs() < GATE_RAD
            })
        };
        let kept: Vec<&Point> = block.iter().filter(near).collect();
        let (mut total, mut means) = (0.0, [0.0; 2]);
        for point in &kept {
            total += 1.0 / point.variance;
            means[0] += point.turn_rad / point.variance;
            means[1] += point.direction_rad / point.variance;
        }
        let means = means.map(|mean| mean / total);
        freedom += kept.len() as f64 - 1.0;
        rows.extend(kept.iter().map(|point| {
            let [x, y] = [point.turn_rad - means[0], point.direction_rad - means[1]];
            [place(point, STRETCH_S), x, y, 1.0 / point.variance]
        }));
    }
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        rows.iter().map(|[_, x, y, weight]| weight * of(*x, *y)).sum()
    };
    let (xx, yy) = (sum(&|x, _| x * x), sum(&|_, y| y * y));
    let slope = sum(&|x, y| x * y) / xx;
    let rest = sum(&|x, y| (y - slope * x).powi(2));
    // Scatter below what frames have at least is luck.
    let by_frames = (rest / freedom).max(1.0) * CORRELATED / xx;
    let stretches = rows.chunk_by(|a, b| a[0] == b[0]).map(|stretch| {
        let score = |[_, x, y, weight]: &[f64; 4]| weight * x * (y - slope * x);
        stretch.iter().map(score).sum::<f64>().powi(2)
    });
    let by_stretches = stretches.sum::<f64>() / (xx * xx);
    let sigma = by_frames.max(by_stretches).sqrt();
    // Few stretches with most of the turn may turn as they should by chance.
    let weights = rows
        .chunk_by(|a, b| a[0] == b[0])
        .map(|stretch| stretch.iter().map(|[_, x, _, weight]| weight * x * x).sum::<f64>());
    let squares: f64 = weights.map(|weight| weight * weight).sum();
    let independent = xx * xx / squares;
    let told = freedom > CORRELATED && rest < MOST_REST * yy && independent > LEAST_STRETCHES;
    (told && slope.is_finite() && sigma.is_finite()).then_some((slope, sigma))
}

/// Number of the block of a length that a point lies in.
fn place(point: &Point, length_s: f64) -> f64 {
    (point.time_s / length_s).floor()
}

/// Deviations for receding range rates being positive, with azimuths as they are and mirrored: the radar's velocity should
/// point where the car drives.
fn range_rate(
    log: &DriveLog,
    frames: &[Frame],
    mounting: Mounting,
    max_gap_s: f64,
) -> [Option<f64>; 2] {
    [1.0, -1.0].map(|side| {
        let mut tally = Tally::default();
        for frame in frames {
            let time_s = frame.scan.time_s;
            let forward = log.speed_at(time_s, max_gap_s).map_or(1.0, f64::signum);
            let rate = log.yaw_rate_at(time_s, max_gap_s).unwrap_or(0.0);
            let polar = frame.motion.polar();
            let turn = (rate * mounting.x_m / polar.speed_mps).clamp(-MOST_SINE, MOST_SINE).asin();
            let along = (side * polar.direction_rad + mounting.yaw_rad - turn).cos() * forward;
            if along.abs() > TELLING {
                tally.add(time_s, along.signum());
            }
        }
        tally.deviations_from_chance()
    })
}
