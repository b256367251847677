//! Recursive robust maximum likelihood: one frame at a time, in constant memory.
//!
//! All frames share five unknowns: the mounting angle, the inverse scale and the bias of the yaw
//! rate, the slip gradient of the rear axle (a turning car slides outwards in proportion to its
//! lateral acceleration), and the radar's delay (range rates are measured over tens of milliseconds
//! before the time a scan is stamped with). In a frame (`frame`):
//!
//! 1. the speed that most detections agree on is searched for, given the angle so far, the yaw rate, and
//!    the car's own speed or the speed before (one unknown, where RANSAC has two: what moves rarely agrees on it);
//! 2. the radar's motion and each detection's probability of being static follow by expectation and
//!    maximisation, with noise in range rate and azimuth and the car's speed as one more observation;
//! 3. the direction of that motion gives an equation in the shared unknowns (`equation`).
//!
//! Equations are gathered (`gather`) in blocks of some seconds, whose frames share an error (`block`, `information`). The last blocks are held
//! against those before (`recent`): where the angle has changed, it is sought anew. What is older counts for less.

mod begin;
pub(crate) mod block;
pub(crate) mod conclude;
mod doubts;
mod equation;
mod frame;
mod gather;
pub(crate) mod information;
pub(crate) mod outlook;
mod recent;
mod snapshot;
mod speed;
mod standstill;
mod tracked;
mod vote;

use crate::error::MountingError;
use crate::error::tracked_only;
use crate::estimate::{AngleEstimate, FrameCounts};
use crate::frame::{FrameInput, FrameOutcome, Verdict};
use crate::intake::{Admission, Intake};
use crate::motion::ransac::Ransac;
use crate::motion::weighed::needed;
use crate::motion::{FrameMotion, MotionPlan};
use crate::network::MotionNetwork;
use crate::options::{CalibrationOptions, MotionMethod};
use block::{Block, Scatter};
use doubts::Doubts;
use information::{DELAY, Information};
use recent::Recent;
use serde::{Deserialize, Serialize};
use speed::Speed;
use std::sync::Arc;
use tracked::{Cloud, Limits};
use vote::Vote;

/// Standard deviation of the angle about its start before any frame, rad (5 deg).
const ANGLE_PRIOR_RAD: f64 = 0.09;
/// Scatter of frames of one block beyond their own variance before anything is known of it, rad (0.2 deg), how many frames count as one
/// then, and how many blocks this counts as and is at most learnt over.
const EXCESS_RAD: f64 = 0.003_490_658_503_988_66;
const CORRELATED: f64 = 4.0;
/// Error that the frames of a block share on real drives, rad (0.1 deg).
const LASTING_RAD: f64 = 0.001_745_329_251_994_33;
const FIRST_SCATTER_BLOCKS: f64 = 1.0;
const MOST_SCATTER_BLOCKS: f64 = 60.0;

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
    intake: Intake,
}

/// What a frame leaves behind. Its layout is that of snapshots.
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
    /// Last reading of the yaw rate, rad/s.
    reading: Option<Reading>,
    /// Speed of the car at the last frame that had one.
    speed: Option<CarSpeed>,
    speed_scale: Speed,
    noise_scale: f64,
    scatter: LearntScatter,
    blocks: u64,
    /// Angles after the last blocks.
    angles: [Option<f64>; 3],
    bias_sums: BiasSums,
    counts: FrameCounts,
    doubts: Doubts,
    inliers: f64,
    detections: f64,
    changed_s: Option<f64>,
}

/// A reading of a sensor of the car.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Reading {
    pub(crate) time_s: f64,
    pub(crate) value: f64,
}

/// The car's speed at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct CarSpeed {
    pub(crate) mps: f64,
    pub(crate) time_s: f64,
}

/// Scatter of frames, and number of blocks that it was learnt from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct LearntScatter {
    scatter: Scatter,
    blocks: f64,
}

/// Yaw rates at standstill: their number, their sum (rad/s) and the sum of their squares.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct BiasSums {
    count: f64,
    sum: f64,
    squares: f64,
}

impl MotionPlan for Recursive {
    /// The tracked motion has been judged already, and has one verdict more: a frame that went into the vote on the
    /// angle's start is sparse.
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, MountingError> {
        let outcome = self.add(frame)?;
        *weights = outcome.weights;
        Ok(FrameMotion { motion: outcome.motion, verdict: outcome.verdict, earlier: None })
    }

    fn restart(&mut self) {
        self.restart();
    }
}

impl Recursive {
    /// An estimator with nothing seen yet. Without a nominal angle it begins with a vote of frames
    /// whose motion RANSAC finds; the same vote is taken where the frames do not agree with the nominal
    /// angle.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`].
    pub fn new(options: &CalibrationOptions) -> Result<Self, MountingError> {
        let own = CalibrationOptions { motion: None, ..*options };
        Self::with_network(&own, None)
    }

    /// The same, with DeepEgo's weights of detections where the options name its motion.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`]; [`boresight_core::InputError::Incompatible`] for other motions,
    /// [`MountingError::NeedsNetwork`] for DeepEgo's without a network.
    pub fn with_network(
        options: &CalibrationOptions,
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, MountingError> {
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
            scatter: LearntScatter {
                scatter: Scatter {
                    excess: EXCESS_RAD * EXCESS_RAD,
                    correlated: correlated(options),
                },
                blocks: FIRST_SCATTER_BLOCKS,
            },
            blocks: 0,
            angles: [None; 3],
            bias_sums: BiasSums::default(),
            counts: FrameCounts::default(),
            doubts: Doubts::default(),
            inliers: 0.0,
            detections: 0.0,
            changed_s: None,
        };
        Ok(Self::with_state(options, network, state, Intake::default()))
    }

    /// The network that options ask for.
    fn network_of(
        options: &CalibrationOptions,
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Option<Arc<MotionNetwork>>, MountingError> {
        match options.motion {
            None | Some(MotionMethod::Tracked) => Ok(None),
            Some(MotionMethod::Deepego) => needed(MotionMethod::Deepego, network).map(Some),
            Some(motion) => Err(tracked_only(motion.name())),
        }
    }

    fn with_state(
        options: &CalibrationOptions,
        network: Option<Arc<MotionNetwork>>,
        state: State,
        intake: Intake,
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
            intake,
        }
    }

    /// Adds one frame. Consecutive frames on an earlier time base start a new session, as for [`crate::Calibrator::add`].
    ///
    /// # Errors
    /// [`MountingError::TimeBackwards`], and [`boresight_core::InputError::NotFinite`] for a time that
    /// is not finite; the frame then counts as rejected only.
    pub fn add(&mut self, frame: FrameInput) -> Result<FrameOutcome, MountingError> {
        if self.intake.admit(self.state.time_s, frame.time_s)? == Admission::NewSession {
            self.restart();
        }
        self.state.time_s = Some(frame.time_s);
        let screened = self.intake.screen(frame.detections);
        self.state.doubts.look_at_azimuths(frame.detections);
        let frame = FrameInput { detections: &screened.detections, ..frame };
        let mut outcome = FrameOutcome {
            time_s: frame.time_s,
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
        screened.spread(&mut outcome.weights);
        Ok(outcome)
    }

    /// Starts a session, as [`crate::Calibrator::restart`].
    pub fn restart(&mut self) {
        self.intake.restart();
        // The recent blocks and the incomplete one become part of what is known before: a change of the angle is looked for in
        // blocks of the new session alone.
        let mut known = self.complete();
        let o = &self.options;
        known.release(DELAY, o.delay_s, o.delay_sigma_s);
        let state = &mut self.state;
        (state.before, state.now) = (known, known);
        state.recent = Recent::default();
        state.block = Block::default();
        (state.time_s, state.reading, state.speed) = (None, None, None);
        state.speed_scale.restart();
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
        self.intake.absorb(&other.intake);
        let (state, other) = (&mut self.state, &other.state);
        state.time_s = None;
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

    /// The car's speed at the last frame that had one.
    pub(crate) fn speed(&self) -> Option<CarSpeed> {
        self.state.speed
    }

    /// A later speed of the car, from elsewhere.
    pub(crate) fn tell_speed(&mut self, speed: CarSpeed) {
        if self.state.speed.is_none_or(|own| own.time_s < speed.time_s) {
            self.state.speed = Some(speed);
        }
    }

    /// What the frames say of the shared unknowns.
    pub(crate) fn information(&self) -> Information {
        self.complete()
    }
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
