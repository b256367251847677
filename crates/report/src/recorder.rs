//! What a report needs to know of a drive, gathered frame by frame in constant memory.

use boresight_mounting::{AngleEstimate, FrameInput, FrameOutcome};

/// Most points of a line; beyond, every second is dropped and they come half as often.
const MOST_POINTS: usize = 800;
/// The car's state is noted this often at first, s.
const STEP_S: f64 = 0.25;
/// Frames further apart are a gap, s.
const GAP_S: f64 = 1.0;
/// The angle is worth a look after so many frames, and after such a share of all before: methods that weigh all frames take time in
/// proportion to their number.
const LOOK_FRAMES: u64 = 13;
const LOOK_SHARE: f64 = 0.01;

/// Points in order of time, thinned as they become too many.
#[derive(Debug, Clone, Default)]
struct Line {
    points: Vec<[f64; 3]>,
    step_s: f64,
}

impl Line {
    fn new(step_s: f64) -> Self {
        Self { points: vec![], step_s }
    }

    fn add(&mut self, point: [f64; 3]) {
        if self.points.last().is_some_and(|last| point[0] - last[0] < self.step_s) {
            return;
        }
        if self.points.len() == MOST_POINTS {
            let mut at = 0;
            self.points.retain(|_| {
                at += 1;
                at % 2 == 1
            });
            self.step_s = 2.0 * self.step_s.max(1e-3);
        }
        self.points.push(point);
    }
}

/// Conditions of a drive, and the angle as it went.
#[derive(Debug, Clone)]
pub struct Recorder {
    history: Line,
    state: Line,
    first_s: Option<f64>,
    last: Option<(f64, f64)>,
    detections: u64,
    frames: u64,
    looked: u64,
    driven_m: f64,
    fastest_mps: f64,
    fastest_turn_radps: f64,
}

impl Default for Recorder {
    fn default() -> Self {
        Self {
            history: Line::new(0.0),
            state: Line::new(STEP_S),
            first_s: None,
            last: None,
            detections: 0,
            frames: 0,
            looked: 0,
            driven_m: 0.0,
            fastest_mps: 0.0,
            fastest_turn_radps: 0.0,
        }
    }
}

impl Recorder {
    /// Takes a frame and what became of it; whether the angle is worth a [`Self::look`] again.
    pub fn add(&mut self, frame: &FrameInput, outcome: &FrameOutcome) -> bool {
        let time_s = frame.time_s;
        self.first_s.get_or_insert(time_s);
        self.frames += 1;
        self.detections += frame.detections.len() as u64;
        let seen =
            outcome.motion.map(|motion| motion.velocity_mps[0].hypot(motion.velocity_mps[1]));
        let speed = frame.speed_mps.map(f64::abs).or(seen).filter(|speed| speed.is_finite());
        let turn = frame.yaw_rate_radps.filter(|rate| rate.is_finite());
        if let Some((before_s, before)) = self.last
            && time_s - before_s <= GAP_S
        {
            self.driven_m += before * (time_s - before_s);
        }
        if let Some(speed) = speed {
            self.last = Some((time_s, speed));
            self.fastest_mps = self.fastest_mps.max(speed);
        }
        if let Some(turn) = turn {
            self.fastest_turn_radps = self.fastest_turn_radps.max(turn.abs());
        }
        self.state.add([time_s, speed.unwrap_or(f64::NAN), turn.unwrap_or(f64::NAN).to_degrees()]);
        let since = self.frames - self.looked;
        since >= LOOK_FRAMES && since as f64 >= LOOK_SHARE * self.frames as f64
    }

    /// Takes the angle at a time, as far as it is known then.
    pub fn look(&mut self, time_s: f64, estimate: &AngleEstimate) {
        self.looked = self.frames;
        let [angle, sigma] = [estimate.angle_rad, estimate.sigma_rad].map(f64::to_degrees);
        self.history.add([time_s, angle, sigma]);
    }

    /// Angles and their standard deviations, deg, at times after the first frame, s.
    pub(crate) fn history(&self) -> impl Iterator<Item = [f64; 3]> {
        self.after_start(&self.history)
    }

    /// Speeds, m/s, and yaw rates, deg/s, at times after the first frame, s; NaN where one is not known.
    pub(crate) fn states(&self) -> impl Iterator<Item = [f64; 3]> {
        self.after_start(&self.state)
    }

    fn after_start(&self, line: &Line) -> impl Iterator<Item = [f64; 3]> {
        let start_s = self.first_s.unwrap_or(0.0);
        line.points.iter().map(move |[time_s, a, b]| [time_s - start_s, *a, *b])
    }

    /// The drive's conditions, by name.
    pub(crate) fn conditions(&self) -> Vec<(&'static str, String)> {
        let last_s = self.state.points.last().map_or(0.0, |point| point[0]);
        let lasts = self.first_s.map_or(0.0, |first| last_s - first);
        vec![
            ("Duration", format!("{lasts:.0} s, {} frames", self.frames)),
            ("Way driven", format!("{:.2} km", self.driven_m / 1e3)),
            ("Fastest", format!("{:.1} m/s", self.fastest_mps)),
            ("Fastest turn", format!("{:.1} deg/s", self.fastest_turn_radps.to_degrees())),
            (
                "Detections a frame",
                format!("{:.0}", self.detections as f64 / self.frames.max(1) as f64),
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_thinned_evenly_and_keep_their_ends() {
        let mut line = Line::new(0.25);
        for i in 0..40_000 {
            line.add([f64::from(i) * 0.1, f64::from(i), 0.0]);
        }
        assert!(line.points.len() <= MOST_POINTS && line.points.len() > MOST_POINTS / 3);
        assert_eq!(line.points[0][0], 0.0);
        let gaps: Vec<f64> = line.points.windows(2).map(|w| w[1][0] - w[0][0]).collect();
        let longest = gaps.iter().copied().fold(0.0, f64::max);
        assert!(longest < 2.1 * line.step_s, "{longest} {}", line.step_s);
        assert!(3999.0 - line.points[line.points.len() - 1][0] < 2.0 * line.step_s);
    }
}
