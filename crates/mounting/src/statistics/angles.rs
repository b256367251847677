//! What frames say of the mounting angle one by one: their scatter, how long their errors last, and
//! what of them is slip and delay.

use super::frames::Frame;
use super::robust::{deviation, median};
use super::{Angles, Row, Untold};
use boresight_core::{DriveLog, Mounting};
use boresight_math::linalg::small::{add_outer, inverse, times};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Delays tried, s, and the step between them.
const DELAYS_S: [f64; 2] = [-0.1, 0.25];
const DELAY_STEP_S: f64 = 0.005;

/// A delay less well known than this is not told, s.
const MOST_DELAY_SIGMA_S: f64 = 0.02;

/// Fewest frames for a line through their angles.
const LEAST_FRAMES: usize = 50;

/// Angles further from the rest than this many standard deviations are left out of the line.
const CLIP: f64 = 3.0;

/// Lag of the autocorrelation, s, and how far the times of a pair may miss it.
const LAG_S: f64 = 1.0;
const LAG_WITHIN_S: f64 = 0.05;

/// The angle by one frame less the nominal one, and what it may depend on.
#[derive(Clone, Copy)]
struct FrameAngle {
    time_s: f64,
    error_rad: f64,
    /// Standard deviation by the covariance of the motion (equation 3).
    formal_rad: f64,
    /// Lateral acceleration, m/s^2.
    lateral_mps2: f64,
}

/// A line through the angles.
struct Line {
    offset_rad: f64,
    slope_rad: f64,
    scatter_rad: f64,
}

/// Statistics of the frames' angles. The delay is the one by which the yaw rate, looked up that much
/// earlier, leaves the least quick scatter about a line in lateral acceleration, whose slope is the
/// gradient of the slip.
pub(super) fn angles(
    log: &DriveLog,
    frames: &[Frame],
    mounting: Option<Mounting>,
    max_gap_s: f64,
    untold: &mut Vec<Untold>,
) -> Angles {
    let mut tell = |why: &str| {
        for row in [Row::Angles, Row::Delay] {
            untold.push(Untold::new(row, why));
        }
        Angles::unknown()
    };
    let Some(mounting) = mounting else {
        return tell("the log does not state where the radar sits");
    };
    if log.motion.is_empty() {
        return tell("the log has no yaw rate");
    }
    let count = ((DELAYS_S[1] - DELAYS_S[0]) / DELAY_STEP_S).round() as usize;
    let tried: Vec<(f64, f64)> = (0..=count)
        .filter_map(|i| {
            let delay_s = DELAYS_S[0] + DELAY_STEP_S * i as f64;
            let angles = at_delay(log, frames, mounting, delay_s, max_gap_s);
            Some((delay_s, left_quickly(&angles, &line(&angles)?)))
        })
        .collect();
    let Some(lowest) = lowest(&tried) else {
        return tell("fewer than 50 scans at more than 3 m/s have a yaw rate");
    };
    let angles = at_delay(log, frames, mounting, lowest.delay_s, max_gap_s);
    let Some(line) = line(&angles) else {
        return tell("fewer than 50 scans at more than 3 m/s have a yaw rate");
    };
    let delay_sigma_s = lowest.sigma_s(angles.len());
    let delay_s = if delay_sigma_s < MOST_DELAY_SIGMA_S { lowest.delay_s } else { f64::NAN };
    if delay_s.is_nan() {
        untold.push(Untold::new(Row::Delay, "the yaw rate changes too little"));
    }
    let rest: Vec<f64> = angles.iter().map(|angle| line.rest(angle)).collect();
    let normalised: Vec<f64> =
        angles.iter().zip(&rest).map(|(angle, rest)| rest / angle.formal_rad).collect();
    let formal: Vec<f64> = angles.iter().map(|angle| angle.formal_rad).collect();
    Angles {
        offset_rad: line.offset_rad,
        scatter_rad: line.scatter_rad,
        formal_rad: median(&formal),
        scatter_over_formal: deviation(&normalised, 0.0),
        autocorrelation: autocorrelation(&angles, &rest, line.scatter_rad),
        slip_gradient_rad: line.slope_rad,
        delay_s,
    }
}

fn at_delay(
    log: &DriveLog,
    frames: &[Frame],
    mounting: Mounting,
    delay_s: f64,
    max_gap_s: f64,
) -> Vec<FrameAngle> {
    // The same frames at every delay.
    let covered = |time_s: f64| {
        DELAYS_S.iter().all(|delay| log.yaw_rate_at(time_s - delay, max_gap_s).is_some())
    };
    frames
        .iter()
        .filter(|frame| covered(frame.scan.time_s))
        .filter_map(|frame| {
            let yaw_rate = log.yaw_rate_at(frame.scan.time_s - delay_s, max_gap_s)?;
            let [vx, vy] = frame.motion.velocity_mps;
            let speed = frame.speed_mps();
            let sine = yaw_rate * mounting.x_m / speed;
            if sine.abs() > 0.7 {
                return None;
            }
            let beta = vy.atan2(vx);
            let turned = wrapped(sine.asin() - beta - mounting.yaw_rad);
            // In reverse everything looks the other way.
            let (error_rad, direction) = if turned.abs() > FRAC_PI_2 {
                (wrapped(PI - sine.asin() - beta - mounting.yaw_rad), -1.0)
            } else {
                (turned, 1.0)
            };
            let [[xx, xy], [_, yy]] = frame.motion.covariance;
            let variance = (vy * vy * xx - 2.0 * vx * vy * xy + vx * vx * yy) / speed.powi(4);
            Some(FrameAngle {
                time_s: frame.scan.time_s,
                error_rad,
                formal_rad: variance.sqrt(),
                lateral_mps2: direction * speed * yaw_rate,
            })
        })
        .filter(|angle| angle.formal_rad > 0.0)
        .collect()
}

fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - TAU * (angle_rad / TAU).round()
}

impl Line {
    fn rest(&self, angle: &FrameAngle) -> f64 {
        angle.error_rad - self.offset_rad - self.slope_rad * angle.lateral_mps2
    }
}

/// Least squares on what lies near the line, a few times over.
fn line(angles: &[FrameAngle]) -> Option<Line> {
    if angles.len() < LEAST_FRAMES {
        return None;
    }
    let errors: Vec<f64> = angles.iter().map(|angle| angle.error_rad).collect();
    let offset_rad = median(&errors);
    let mut line = Line { offset_rad, slope_rad: 0.0, scatter_rad: deviation(&errors, offset_rad) };
    for _ in 0..6 {
        let (mut normal, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
        for angle in angles {
            if line.rest(angle).abs() <= CLIP * line.scatter_rad {
                let row = [1.0, angle.lateral_mps2];
                add_outer(&mut normal, &row, 1.0);
                right[0] += row[0] * angle.error_rad;
                right[1] += row[1] * angle.error_rad;
            }
        }
        let [offset_rad, slope_rad] = times(&inverse(&normal)?, &right);
        line = Line { offset_rad, slope_rad, ..line };
        let rest: Vec<f64> = angles.iter().map(|angle| line.rest(angle)).collect();
        line.scatter_rad = deviation(&rest, 0.0);
    }
    Some(line)
}

/// Mean square of what the line leaves of the angles less its own mean over a second on either side,
/// large ones cut. Errors that last drop out, so that the quick changes of the yaw rate tell.
fn left_quickly(angles: &[FrameAngle], line: &Line) -> f64 {
    let limit = CLIP * line.scatter_rad;
    let rest: Vec<f64> = angles.iter().map(|angle| line.rest(angle).clamp(-limit, limit)).collect();
    let (mut from, mut to, mut sum, mut squares) = (0, 0, 0.0, 0.0);
    for (angle, value) in angles.iter().zip(&rest) {
        while to < angles.len() && angles[to].time_s <= angle.time_s + LAG_S {
            sum += rest[to];
            to += 1;
        }
        while angles[from].time_s < angle.time_s - LAG_S {
            sum -= rest[from];
            from += 1;
        }
        squares += (value - sum / (to - from) as f64).powi(2);
    }
    squares / rest.len() as f64
}

/// A delay at which the values are lowest.
struct Lowest {
    delay_s: f64,
    value: f64,
    /// Second derivative by the delay; 0 where it is not to be told.
    bend: f64,
}

impl Lowest {
    /// Standard deviation of the delay by the second derivative of a mean of `count` squares; of
    /// those, neighbours are taken to tell the same in pairs.
    fn sigma_s(&self, count: usize) -> f64 {
        (4.0 * self.value / (count as f64 * self.bend)).sqrt()
    }
}

/// Where the values are lowest, by a parabola through the lowest and what lies four steps beside it.
fn lowest(tried: &[(f64, f64)]) -> Option<Lowest> {
    const BESIDE: usize = 4;
    let at = (0..tried.len()).min_by(|a, b| tried[*a].1.total_cmp(&tried[*b].1))?;
    let (delay_s, value) = tried[at];
    let beside = |i: Option<usize>| i.and_then(|i| tried.get(i)).map(|one| one.1);
    let (before, after) = (beside(at.checked_sub(BESIDE)), beside(at.checked_add(BESIDE)));
    let (Some(before), Some(after)) = (before, after) else {
        return Some(Lowest { delay_s, value, bend: 0.0 });
    };
    let step_s = BESIDE as f64 * DELAY_STEP_S;
    let bend = (before - 2.0 * value + after) / (step_s * step_s);
    let shift = if bend > 0.0 { 0.5 * (before - after) / (step_s * bend) } else { 0.0 };
    Some(Lowest { delay_s: delay_s + shift.clamp(-step_s, step_s), value, bend })
}

/// Correlation of what is left of the angles a second apart; NaN without such pairs.
fn autocorrelation(angles: &[FrameAngle], rest: &[f64], scatter_rad: f64) -> f64 {
    let limit = CLIP * scatter_rad;
    let (mut product, mut squares) = (0.0, 0.0);
    let mut later = 0;
    for (i, angle) in angles.iter().enumerate() {
        while later < angles.len() && angles[later].time_s < angle.time_s + LAG_S - LAG_WITHIN_S {
            later += 1;
        }
        let paired = angles
            .get(later)
            .is_some_and(|other| other.time_s < angle.time_s + LAG_S + LAG_WITHIN_S);
        if paired {
            let [a, b] = [rest[i], rest[later]].map(|value| value.clamp(-limit, limit));
            product += a * b;
            squares += 0.5 * (a * a + b * b);
        }
    }
    product / squares
}
