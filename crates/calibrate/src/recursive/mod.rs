//! Recursive robust maximum likelihood: one frame at a time, in constant memory.
//!
//! All frames share five unknowns: the mounting angle, the inverse scale and the bias of the yaw
//! rate, the slip gradient of the rear axle (a turning car slides outwards in proportion to its
//! lateral acceleration), and the radar's delay (range rates are measured over tens of milliseconds
//! before the time a scan is stamped with). In a frame:
//!
//! 1. the speed that most detections agree on is searched for, given the angle so far, the yaw rate, and
//!    the car's own speed or the speed before (one unknown, where RANSAC has two: what moves rarely agrees on it);
//! 2. the radar's motion and each detection's probability of being static follow by expectation and
//!    maximisation, with noise in range rate and azimuth and the car's speed as one more observation;
//! 3. the direction of that motion gives an equation in the shared unknowns (`equation`).
//!
//! Equations are gathered in blocks of some seconds, whose frames share an error (`block`, `information`). The last blocks are held
//! against those before (`recent`): where the angle has changed, it is sought anew. What is older counts for less.

mod begin;
pub(crate) mod block;
mod conclude;
mod doubts;
mod equation;
pub(crate) mod information;
pub(crate) mod outlook;
mod recent;
mod snapshot;
mod speed;
mod standstill;
mod tracked;
mod vote;

use crate::angle::wrap;
use crate::calibrator::{check_time, tracked_only};
use crate::error::CalibrateError;
use crate::estimate::{AngleEstimate, FrameCounts};
use crate::frame::{FrameInput, FrameOutcome, Motion, Verdict};
use crate::motion::ransac::Ransac;
use crate::motion::{FrameMotion, MotionPlan};
use crate::network::MotionNetwork;
use crate::options::{CalibrationOptions, MotionMethod};
use block::{Block, Scatter};
use boresight_core::Detection;
use doubts::Doubts;
use equation::Equation;
use information::{Information, Vector};
use recent::Recent;
use serde::{Deserialize, Serialize};
use speed::Speed;
use std::sync::Arc;
use tracked::{Cloud, Fit, Limits, Prediction};
use vote::Vote;

/// Standard deviation of the angle about its start before any frame, rad (5 deg).
const ANGLE_PRIOR_RAD: f64 = 0.09;
/// Readings further apart than this do not say how fast the yaw rate changes, s, nor do changes of a car
/// exceed this, rad/s^2.
const CHANGE_GAP_S: f64 = 0.25;
const MAX_CHANGE: f64 = 1.0;
/// Share of a new frame in the scale of the detections' noise, which is learnt on the way.
const LEARNING_RATE: f64 = 0.01;
/// Scatter of frames of one block beyond their own variance before anything is known of it, rad (0.2 deg), how many frames count as one
/// then, and how many blocks this counts as and is at most learnt over.
const EXCESS_RAD: f64 = 0.003_490_658_503_988_66;
const CORRELATED: f64 = 4.0;
/// Error that the frames of a block share on real drives, rad (0.1 deg).
const LASTING_RAD: f64 = 0.001_745_329_251_994_33;
const SCATTER_BLOCKS: [f64; 2] = [1.0, 60.0];
/// Blocks before which each frame moves the angle at once.
const FIRST_BLOCKS: u64 = 3;
/// A frame whose angle lies further off all before is of something else, rad (20 deg).
const GATE_RAD: f64 = 0.35;
/// Frames used before which the motion is looked for without the prediction, too.
const START_FRAMES: u64 = 40;
/// A speed older than this is forgotten, s.
const SPEED_LIFE_S: f64 = 2.0;

/// The recursive estimator.
#[derive(Debug, Clone)]
pub struct Recursive {
    options: CalibrationOptions,
    limits: Limits,
    cloud: Cloud,
    alone: Ransac,
    alone_weights: Vec<f32>,
    /// What tells how likely detections are to stand.
    network: Option<Arc<MotionNetwork>>,
    state: State,
}

/// What a frame leaves behind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct State {
    /// Without the blocks of `recent`.
    before: Information,
    recent: Recent,
    block: Block,
    /// With all blocks, and at the beginning with the one that is not complete.
    now: Information,
    vote: Option<Vote>,
    misses: usize,
    time_s: Option<f64>,
    reading: Option<(f64, f64)>,
    speed: Option<(f64, f64)>,
    speed_scale: Speed,
    noise_scale: f64,
    /// Scatter of frames, and blocks that it was learnt from.
    scatter: (Scatter, f64),
    blocks: u64,
    /// Angles after the last blocks.
    angles: [Option<f64>; 3],
    bias_sum: [f64; 3],
    counts: FrameCounts,
    doubts: Doubts,
    inliers: f64,
    detections: f64,
    changed_s: Option<f64>,
}

impl MotionPlan for Recursive {
    /// The tracked motion has been judged already, and has one verdict more: a frame that went into the vote on the
    /// angle's start is sparse.
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, CalibrateError> {
        let outcome = self.add(frame)?;
        *weights = outcome.weights;
        Ok(FrameMotion { motion: outcome.motion, verdict: outcome.verdict })
    }
}

impl Recursive {
    /// An estimator with nothing seen yet. Without a nominal angle it begins with a vote of frames
    /// whose motion RANSAC finds; the same vote is taken where the frames do not agree with the nominal
    /// angle.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`].
    pub fn new(options: &CalibrationOptions) -> Result<Self, CalibrateError> {
        let own = CalibrationOptions { motion: None, ..*options };
        Self::with_network(&own, None)
    }

    /// The same, with DeepEgo's weights of detections where the options name its motion.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`]; [`boresight_core::CoreError::Unknown`] for other motions,
    /// [`CalibrateError::NeedsNetwork`] for DeepEgo's without a network.
    pub fn with_network(
        options: &CalibrationOptions,
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, CalibrateError> {
        options.validate()?;
        let network = Self::network_of(options, network)?;
        let start = prior(options.nominal_rad.unwrap_or(0.0), options);
        let state = State {
            before: start,
            recent: Recent::default(),
            block: Block::default(),
            now: start,
            vote: options.nominal_rad.is_none().then(Vote::new),
            misses: 0,
            time_s: None,
            reading: None,
            speed: None,
            speed_scale: Speed::default(),
            noise_scale: 1.0,
            scatter: (
                Scatter { excess: EXCESS_RAD * EXCESS_RAD, correlated: correlated(options) },
                SCATTER_BLOCKS[0],
            ),
            blocks: 0,
            angles: [None; 3],
            bias_sum: [0.0; 3],
            counts: FrameCounts::default(),
            doubts: Doubts::default(),
            inliers: 0.0,
            detections: 0.0,
            changed_s: None,
        };
        Ok(Self::with_state(options, network, state))
    }

    /// The network that options ask for.
    fn network_of(
        options: &CalibrationOptions,
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Option<Arc<MotionNetwork>>, CalibrateError> {
        match (options.motion, network) {
            (None | Some(MotionMethod::Tracked), _) => Ok(None),
            (Some(MotionMethod::Deepego), Some(network)) => Ok(Some(network.clone())),
            (Some(MotionMethod::Deepego), None) => Err(CalibrateError::NeedsNetwork {
                motion: MotionMethod::Deepego.name(),
                given: "none",
            }),
            (Some(motion), _) => Err(tracked_only(motion.name())),
        }
    }

    fn with_state(
        options: &CalibrationOptions,
        network: Option<Arc<MotionNetwork>>,
        state: State,
    ) -> Self {
        Self {
            options: *options,
            network,
            limits: Limits {
                range_rate_sigma_mps: options.range_rate_sigma_mps,
                azimuth_sigma_rad: options.azimuth_sigma_rad,
                inlier_threshold: options.inlier_threshold,
                min_inliers: options.min_inliers,
            },
            cloud: Cloud::default(),
            alone: Ransac::new(options),
            alone_weights: Vec::new(),
            state,
        }
    }

    /// Takes one frame.
    ///
    /// # Errors
    /// [`CalibrateError::TimeBackwards`], and [`boresight_core::CoreError::NotFinite`] for a time that
    /// is no number; the frame is then not counted.
    pub fn add(&mut self, frame: FrameInput) -> Result<FrameOutcome, CalibrateError> {
        check_time(self.state.time_s, frame.time_s)?;
        self.state.time_s = Some(frame.time_s);
        let mut outcome = FrameOutcome {
            verdict: Verdict::Sparse,
            motion: None,
            angle_rad: None,
            angle_sigma_rad: None,
            weight: 0.0,
            weights: vec![0.0; frame.detections.len()],
        };
        outcome.verdict = self.take(&frame, &mut outcome);
        self.state.counts.add(outcome.verdict);
        match outcome.verdict {
            Verdict::Used | Verdict::Sparse | Verdict::OffSpeed => {
                self.state.doubts.tried(outcome.verdict, frame.speed_mps.is_some());
            }
            _ => {}
        }
        Ok(outcome)
    }

    fn take(&mut self, frame: &FrameInput, outcome: &mut FrameOutcome) -> Verdict {
        self.cloud.set(frame.detections);
        if let Some(network) = &self.network {
            self.cloud.trust(&network.single().motion(frame.detections).weights);
        }
        let at_rest = self.cloud.share_at_rest(&self.limits);
        self.state.doubts.look(frame, at_rest);
        let Some(measured) = frame.yaw_rate_radps.filter(|rate| rate.is_finite()) else {
            return Verdict::WithoutMotion;
        };
        if measured.abs() > self.options.max_yaw_rate_radps {
            return Verdict::Turning;
        }
        let change = self.change(frame.time_s, measured);
        let evidence = frame
            .speed_mps
            .filter(|speed| speed.is_finite())
            .map(|speed| self.state.speed_scale.evidence(frame.time_s, speed));
        let age = self.state.speed.map(|(_, time)| frame.time_s - time);
        if age.is_some_and(|age| age > SPEED_LIFE_S) {
            self.state.speed = None;
        }
        if self.stands(measured, at_rest, evidence.as_ref()) {
            self.state.speed = Some((0.0, frame.time_s));
            self.learn_bias(measured);
            outcome.motion = Some(self.at_rest(frame.detections.len(), at_rest));
            return Verdict::Standing;
        }
        if self.state.vote.is_some() {
            return self.begin(frame, measured, evidence.as_ref(), outcome);
        }
        let x = self.state.now.mean();
        let reading = measured - x[4] * change;
        let prediction = Prediction {
            angle_rad: x[0],
            angle_variance: self.state.now.covariance()[0][0],
            reading_radps: reading,
            change,
            yaw_rate_radps: x[1] * reading - x[2],
            slip: x[3],
            x_m: self.options.x_m,
            y_m: self.options.y_m,
            speed: self.state.speed.map(|(speed, time)| (speed, frame.time_s - time)),
            measured_speed: evidence,
        };
        let Some(fit) = self.fit(&prediction, frame.detections) else {
            self.miss();
            return Verdict::Sparse;
        };
        for (&index, &weight) in self.cloud.index.iter().zip(&self.cloud.weight) {
            outcome.weights[index] = weight as f32;
        }
        let motion = Motion {
            velocity_mps: fit.velocity,
            covariance: fit.covariance,
            inliers: fit.inliers,
            detections: frame.detections.len(),
        };
        if let Some(evidence) = evidence {
            if evidence.rules_out(fit.speed) {
                self.miss();
                outcome.weights.fill(0.0);
                return Verdict::OffSpeed;
            }
            self.state.speed_scale.add(fit.speed, &evidence);
        }
        outcome.motion = Some(motion);
        self.state.speed = Some((fit.speed, frame.time_s));
        let polar = motion.polar();
        if polar.speed_mps < self.options.min_speed_mps {
            return Verdict::Slow;
        }
        let step = LEARNING_RATE * (fit.reduced_squares.clamp(0.2, 5.0) - 1.0);
        self.state.noise_scale = (self.state.noise_scale * step.exp()).clamp(1e-4, 1e4);
        let reference = *self.state.now.reference();
        let Some(equation) = Equation::new(&polar, fit.speed, &prediction, &x, &reference) else {
            return Verdict::Turning;
        };
        if equation.innovation.abs() > GATE_RAD {
            self.miss();
            outcome.weights.fill(0.0);
            return Verdict::Sparse;
        }
        self.inform(frame.time_s, fit.speed, &equation, outcome);
        self.state.inliers += fit.inliers as f64;
        self.state.detections += frame.detections.len() as f64;
        Verdict::Used
    }

    /// The frame's motion. While the angle is new and nothing tells the car's speed, a queue of cars may fit
    /// the prediction better than the standing world does, so that RANSAC's motion is tried as well and
    /// the more likely one taken.
    fn fit(&mut self, prediction: &Prediction, detections: &[Detection]) -> Option<Fit> {
        let noise_scale = self.state.noise_scale;
        let predicted = self.cloud.fit(prediction, &self.limits, noise_scale, None);
        if self.state.counts.used >= START_FRAMES || prediction.measured_speed.is_some() {
            return predicted;
        }
        let start = self.motion_alone(detections).map(|motion| motion.velocity_mps);
        let found = start.and_then(|velocity| {
            self.cloud.fit(prediction, &self.limits, noise_scale, Some(velocity))
        });
        match (&predicted, &found) {
            (Some(a), Some(b)) if b.likelihood > a.likelihood => found,
            (None, _) => found,
            _ => self.cloud.fit(prediction, &self.limits, noise_scale, None),
        }
    }

    /// RANSAC's motion, by draws that depend on the number of frames so far alone, so that a restored calibration goes on as if it
    /// had not stopped.
    fn motion_alone(&mut self, detections: &[Detection]) -> Option<Motion> {
        self.alone.draw_for(self.state.counts.given);
        self.alone.motion(detections, &mut self.alone_weights)
    }

    /// How fast the yaw rate changes, rad/s^2, from this reading and the one before.
    fn change(&mut self, time_s: f64, measured: f64) -> f64 {
        let before = self.state.reading.replace((time_s, measured));
        let apart = before.map(|(time, reading)| (time_s - time, measured - reading));
        match apart {
            Some((gap, change)) if gap > 0.0 && gap <= CHANGE_GAP_S => {
                (change / gap).clamp(-MAX_CHANGE, MAX_CHANGE)
            }
            _ => 0.0,
        }
    }

    /// Adds the frame's equation.
    fn inform(
        &mut self,
        time_s: f64,
        speed_mps: f64,
        equation: &Equation,
        outcome: &mut FrameOutcome,
    ) {
        if let Some(driven_s) = self.state.block.ends_before(time_s, speed_mps) {
            self.end_block(time_s, driven_s);
        }
        self.state.block.add(equation.row);
        let state = &self.state;
        let variance = equation.row.variance + state.scatter.0.excess;
        outcome.angle_rad = Some(wrap(state.now.mean()[0] + equation.innovation));
        outcome.angle_sigma_rad = Some((variance + state.now.lasting()).sqrt());
        outcome.weight = 1.0 / variance;
        if state.blocks < FIRST_BLOCKS {
            self.state.now = self.complete();
        }
    }

    /// What is known with all blocks, and with the one that is not complete.
    fn complete(&self) -> Information {
        let state = &self.state;
        let mut known = state.before;
        for block in state.recent.iter() {
            known.add(block);
        }
        known.with(&state.block.sum(&offset(&known), state.scatter.0))
    }

    fn end_block(&mut self, time_s: f64, driven_s: f64) {
        let state = &mut self.state;
        let block = state.block.sum(&offset(&state.now), state.scatter.0);
        state.doubts.free_scale.add(&state.block);
        state.block.clear();
        state.speed_scale.end_block();
        state.blocks += 1;
        let (Scatter { excess, correlated }, blocks) = &mut state.scatter;
        *excess = (*excess + (block.excess - *excess) / (*blocks + 1.0)).max(1e-8);
        *correlated += (block.correlated.unwrap_or(*correlated) - *correlated) / (*blocks + 1.0);
        *blocks = (*blocks + 1.0).min(SCATTER_BLOCKS[1]);
        if let Some(old) = state.recent.push(block) {
            state.before.add(&old);
            state.before.forget((-driven_s / self.options.memory_s).exp());
        }
        if let Some(angle) = state.recent.changed(&state.before) {
            state.before.reset_angle(angle, ANGLE_PRIOR_RAD);
            state.changed_s = Some(time_s);
        }
        self.state.now = self.complete();
        let angles = &mut self.state.angles;
        *angles = [Some(self.state.now.mean()[0]), angles[0], angles[1]];
    }

    /// The angle as it stands.
    pub fn estimate(&self) -> AngleEstimate {
        let known = self.complete();
        self.conclude(&known, &known.mean(), known.covariance())
    }

    /// What it was begun with.
    pub fn options(&self) -> &CalibrationOptions {
        &self.options
    }

    /// Adds the counts of another drive with the same radar.
    pub(crate) fn absorb(&mut self, other: &Self) {
        let (state, other) = (&mut self.state, &other.state);
        state.counts += other.counts;
        state.doubts += other.doubts;
        state.inliers += other.inliers;
        state.detections += other.detections;
        state.speed_scale.absorb(&other.speed_scale);
        state.changed_s = None;
    }

    /// Takes an angle as the one that was there all the time.
    pub(crate) fn settle(&mut self, angle_rad: f64) {
        self.state.angles = [Some(angle_rad); 3];
    }

    /// The car's speed at the last frame that had one, m/s, and its time, s.
    pub(crate) fn speed(&self) -> Option<(f64, f64)> {
        self.state.speed
    }

    /// A later speed of the car, from elsewhere.
    pub(crate) fn tell_speed(&mut self, speed: (f64, f64)) {
        if self.state.speed.is_none_or(|own| own.1 < speed.1) {
            self.state.speed = Some(speed);
        }
    }

    /// What the frames say of the shared unknowns.
    pub(crate) fn information(&self) -> Information {
        self.complete()
    }
}

/// Unknowns less what blocks' equations are written about.
fn offset(known: &Information) -> Vector {
    std::array::from_fn(|i| known.mean()[i] - known.reference()[i])
}

/// How many frames are expected to count as one: fewer where errors are said to last less than those of real drives.
fn correlated(options: &CalibrationOptions) -> f64 {
    let share = (options.lasting_sigma_rad / LASTING_RAD).min(1.0);
    1.0 + (CORRELATED - 1.0) * share
}

fn prior(angle_rad: f64, options: &CalibrationOptions) -> Information {
    let o = options;
    Information::new(
        [angle_rad, 1.0, 0.0, o.slip_gradient_rad, o.delay_s],
        [
            ANGLE_PRIOR_RAD,
            o.scale_sigma,
            o.bias_sigma_radps,
            o.slip_gradient_sigma_rad,
            o.delay_sigma_s,
        ],
        o.lasting_sigma_rad,
    )
}
