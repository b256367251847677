//! Recursive robust maximum likelihood: one frame at a time, in constant memory.
//!
//! All frames share five unknowns: the mounting angle, the inverse scale and the bias of the yaw
//! rate, the slip gradient of the rear axle (a turning car slides outwards in proportion to its
//! lateral acceleration), and the radar's delay (range rates are measured over tens of milliseconds
//! before the time a scan is stamped with). Each frame adds two of its own, the speed and the error of its yaw rate,
//! which are eliminated at once. In a frame:
//!
//! 1. the speed that most detections agree on is searched for, given the angle so far, the yaw rate
//!    and the speed before (one unknown, where RANSAC has two: what moves rarely agrees on it);
//! 2. the radar's motion and each detection's probability of being static follow by expectation and
//!    maximisation, with noise in range rate and azimuth;
//! 3. detections so weighted give the frame's information on the shared unknowns (a Schur
//!    complement), tempered by a Student-t weight and by the scatter that frames show beyond their
//!    own noise, both learnt on the way.
//!
//! The covariance is a sandwich over blocks of ten seconds, so that errors that last (tracked
//! objects, a curve, a queue of cars) are not counted as independent.

pub(crate) mod information;
mod tracked;
mod vote;

use crate::angle::wrap;
use crate::calibrator::check_time;
use crate::error::CalibrateError;
use crate::estimate::{AngleEstimate, FrameCounts, Remark};
use crate::frame::{FrameInput, FrameOutcome, Motion, Verdict};
use crate::motion::ransac::Ransac;
use crate::motion::{FrameMotion, MotionPlan};
use crate::options::CalibrationOptions;
use boresight_core::Detection;
use information::{Information, Matrix, UNKNOWNS, Vector};
use tracked::{Cloud, Fit, Limits, Prediction};
use vote::Vote;

/// Standard deviations before any frame: angle about its start, inverse scale, slip gradient, delay (s).
const ANGLE_PRIOR_RAD: f64 = 0.09;
const SCALE_PRIOR: f64 = 0.05;
const SLIP_PRIOR: f64 = 0.003;
const DELAY_PRIOR_S: f64 = 0.03;
/// Readings further apart than this do not say how fast the yaw rate changes, s, nor do changes of a car
/// exceed this, rad/s^2.
const CHANGE_GAP_S: f64 = 0.25;
const MAX_CHANGE: f64 = 1.0;
/// Noise of the yaw rate, rad/s, beside its bias and scale.
const YAW_RATE_NOISE_RADPS: f64 = 0.0035;
/// Frames closer together than this are taken as correlated, s.
const BLOCK_S: f64 = 10.0;
/// Share of a new frame in what is learnt on the way.
const LEARNING_RATE: f64 = 0.01;
/// Degrees of freedom of the frames' Student-t weights.
const FREEDOM: f64 = 4.0;
/// Frames in vain after which the nominal angle is doubted.
const MISSES: usize = 50;
/// Frames used before which the motion is looked for without the prediction, too.
const START_FRAMES: u64 = 40;
/// A speed older than this is forgotten, s.
const SPEED_LIFE_S: f64 = 2.0;

/// The recursive estimator.
#[derive(Debug, Clone)]
pub struct Recursive {
    options: CalibrationOptions,
    limits: Limits,
    information: Information,
    cloud: Cloud,
    alone: Ransac,
    alone_weights: Vec<f32>,
    vote: Option<Vote>,
    misses: usize,
    time_s: Option<f64>,
    reading: Option<(f64, f64)>,
    speed: Option<(f64, f64)>,
    noise_scale: f64,
    excess: f64,
    slope: f64,
    block_start_s: f64,
    angle_before: Option<f64>,
    settled: bool,
    bias_sum: [f64; 3],
    counts: FrameCounts,
    inliers: f64,
    detections: f64,
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
        options.validate()?;
        let bias_sigma = options.bias_sigma_radps;
        let start = options.nominal_rad.unwrap_or(0.0);
        Ok(Self {
            options: *options,
            limits: Limits {
                range_rate_sigma_mps: options.range_rate_sigma_mps,
                azimuth_sigma_rad: options.azimuth_sigma_rad,
                inlier_threshold: options.inlier_threshold,
                min_inliers: options.min_inliers,
            },
            information: prior(start, 0.0, bias_sigma),
            cloud: Cloud::default(),
            alone: Ransac::new(options),
            alone_weights: Vec::new(),
            vote: options.nominal_rad.is_none().then(Vote::new),
            misses: 0,
            time_s: None,
            reading: None,
            speed: None,
            noise_scale: 1.0,
            excess: 0.2_f64.to_radians().powi(2),
            slope: 0.8,
            block_start_s: f64::NEG_INFINITY,
            angle_before: None,
            settled: false,
            bias_sum: [0.0; 3],
            counts: FrameCounts::default(),
            inliers: 0.0,
            detections: 0.0,
        })
    }

    /// Takes one frame.
    ///
    /// # Errors
    /// [`CalibrateError::TimeBackwards`], and [`boresight_core::CoreError::NotFinite`] for a time that
    /// is no number; the frame is then not counted.
    pub fn add(&mut self, frame: FrameInput) -> Result<FrameOutcome, CalibrateError> {
        check_time(self.time_s, frame.time_s)?;
        self.time_s = Some(frame.time_s);
        let mut outcome = FrameOutcome {
            verdict: Verdict::Sparse,
            motion: None,
            angle_rad: None,
            angle_sigma_rad: None,
            weight: 0.0,
            weights: vec![0.0; frame.detections.len()],
        };
        outcome.verdict = self.take(&frame, &mut outcome);
        self.counts.add(outcome.verdict);
        Ok(outcome)
    }

    fn take(&mut self, frame: &FrameInput, outcome: &mut FrameOutcome) -> Verdict {
        let Some(measured) = frame.yaw_rate_radps.filter(|rate| rate.is_finite()) else {
            return Verdict::WithoutMotion;
        };
        if measured.abs() > self.options.max_yaw_rate_radps {
            return Verdict::Turning;
        }
        let change = self.change(frame.time_s, measured);
        self.cloud.set(frame.detections);
        let age = self.speed.map(|(_, time)| frame.time_s - time);
        if age.is_some_and(|age| age > SPEED_LIFE_S) {
            self.speed = None;
        }
        if self.stands(measured) {
            self.speed = Some((0.0, frame.time_s));
            self.learn_bias(measured);
            outcome.motion = Some(self.at_rest(frame.detections.len()));
            return Verdict::Standing;
        }
        if self.vote.is_some() {
            return self.begin(frame, measured, outcome);
        }
        let x = self.information.mean();
        let prediction = Prediction {
            angle_rad: x[0],
            angle_variance: self.information.formal()[0][0],
            reading_radps: measured - x[4] * change,
            change,
            yaw_rate_radps: x[1] * (measured - x[4] * change) - x[2],
            slip: x[3],
            x_m: self.options.x_m,
            y_m: self.options.y_m,
            speed: self.speed.map(|(speed, time)| (speed, frame.time_s - time)),
            measured_speed: frame.speed_mps.filter(|speed| speed.is_finite()),
        };
        let Some(fit) = self.fit(&prediction, frame.detections) else {
            self.miss();
            return Verdict::Sparse;
        };
        for (&index, &weight) in self.cloud.index.iter().zip(&self.cloud.weight) {
            outcome.weights[index] = weight as f32;
        }
        outcome.motion = Some(Motion {
            velocity_mps: fit.velocity,
            covariance: fit.covariance,
            inliers: fit.inliers,
            detections: frame.detections.len(),
        });
        self.speed = Some((fit.speed, frame.time_s));
        if fit.velocity[0].hypot(fit.velocity[1]) < self.options.min_speed_mps {
            return Verdict::Slow;
        }
        let step = LEARNING_RATE * (fit.reduced_squares.clamp(0.2, 5.0) - 1.0);
        self.noise_scale = (self.noise_scale * step.exp()).clamp(1e-4, 1e4);
        self.inform(frame.time_s, &prediction, &fit, outcome)
    }

    /// The frame's motion. While the angle is new and nothing tells the car's speed, a queue of cars may fit
    /// the prediction better than the standing world does, so that RANSAC's motion is tried as well and
    /// the more likely one taken.
    fn fit(&mut self, prediction: &Prediction, detections: &[Detection]) -> Option<Fit> {
        let predicted = self.cloud.fit(prediction, &self.limits, self.noise_scale, None);
        if self.counts.used >= START_FRAMES || prediction.measured_speed.is_some() {
            return predicted;
        }
        let start = self
            .alone
            .motion(detections, &mut self.alone_weights)
            .map(|motion| motion.velocity_mps);
        let found = start.and_then(|velocity| {
            self.cloud.fit(prediction, &self.limits, self.noise_scale, Some(velocity))
        });
        match (&predicted, &found) {
            (Some(a), Some(b)) if b.likelihood > a.likelihood => found,
            (None, _) => found,
            _ => self.cloud.fit(prediction, &self.limits, self.noise_scale, None),
        }
    }

    /// How fast the yaw rate changes, rad/s^2, from this reading and the one before.
    fn change(&mut self, time_s: f64, measured: f64) -> f64 {
        let before = self.reading.replace((time_s, measured));
        let apart = before.map(|(time, reading)| (time_s - time, measured - reading));
        match apart {
            Some((gap, change)) if gap > 0.0 && gap <= CHANGE_GAP_S => {
                (change / gap).clamp(-MAX_CHANGE, MAX_CHANGE)
            }
            _ => 0.0,
        }
    }

    /// Before there is an angle: a frame's own motion, and its vote.
    fn begin(&mut self, frame: &FrameInput, measured: f64, outcome: &mut FrameOutcome) -> Verdict {
        let Some(motion) = self.alone.motion(frame.detections, &mut self.alone_weights) else {
            return Verdict::Sparse;
        };
        outcome.weights.copy_from_slice(&self.alone_weights);
        outcome.motion = Some(motion);
        let [vx, vy] = motion.velocity_mps;
        let speed = vx.hypot(vy);
        if speed < self.options.min_speed_mps {
            return Verdict::Slow;
        }
        let sine = (measured - self.information.mean()[2]) * self.options.x_m / speed;
        let share = motion.inliers as f64 / motion.detections.max(1) as f64;
        if sine.abs() >= 1.0 || share < self.options.inlier_ratio_threshold {
            return Verdict::Sparse;
        }
        let mut angle = wrap(sine.asin() - vy.atan2(vx));
        // In reverse the radar moves the other way, and its place turns it the other way.
        let backwards = wrap(-sine.asin() - (-vy).atan2(-vx));
        let reversing = match (frame.speed_mps, self.options.nominal_rad) {
            (Some(speed), _) if speed.is_finite() => speed < 0.0,
            (_, Some(nominal)) => wrap(backwards - nominal).abs() < wrap(angle - nominal).abs(),
            _ => false,
        };
        if reversing {
            angle = backwards;
        }
        if let Some(vote) = &mut self.vote {
            vote.add(angle, share.min(1.0));
            if let Some(angle) = vote.settled() {
                self.vote = None;
                self.information.restart(angle, ANGLE_PRIOR_RAD);
            }
        }
        Verdict::Sparse
    }

    /// Frames that fit no speed, one after the other before any has been used, say that the nominal
    /// angle is not where to begin.
    fn miss(&mut self) {
        self.misses += 1;
        if self.counts.used == 0 && self.misses >= MISSES && self.vote.is_none() {
            self.vote = Some(Vote::new());
            self.misses = 0;
        }
    }

    /// Most of what the radar sees is at rest relative to it, the car does not turn, and it was not
    /// driving a moment ago.
    fn stands(&self, measured: f64) -> bool {
        let turning = (measured - self.bias_mean().unwrap_or(0.0)).abs();
        self.cloud.len() >= self.limits.min_inliers
            && self.cloud.share_at_rest(&self.limits) >= 0.6
            && self.speed.is_none_or(|(speed, _)| speed.abs() < 1.0)
            && turning < 0.02
    }

    /// The motion of a radar that stands, which is none: a trajectory without these frames would run
    /// on through the stop at the speed before it.
    fn at_rest(&self, detections: usize) -> Motion {
        let inliers = (self.cloud.share_at_rest(&self.limits) * self.cloud.len() as f64).round();
        // That of a mean over azimuths all around, of which each component has half.
        let variance = 2.0 * self.limits.range_rate_sigma_mps.powi(2) / inliers.max(1.0);
        Motion {
            velocity_mps: [0.0; 2],
            covariance: [[variance, 0.0], [0.0, variance]],
            inliers: inliers as usize,
            detections,
        }
    }

    fn bias_mean(&self) -> Option<f64> {
        (self.bias_sum[0] >= 1.0).then(|| self.bias_sum[1] / self.bias_sum[0])
    }

    /// Equation 5 of Zhu et al., with the prior as one more observation of its own standard deviation.
    fn learn_bias(&mut self, measured: f64) {
        self.bias_sum[0] += 1.0;
        self.bias_sum[1] += measured;
        self.bias_sum[2] += measured * measured;
        let [count, sum, squares] = self.bias_sum;
        // Samples of one second are not independent: ten count as one.
        if count < 10.0 {
            return;
        }
        let mean = sum / count;
        let variance = (squares / count - mean * mean).max(1e-10);
        let prior = 1.0 / self.options.bias_sigma_radps.powi(2);
        let information = count / 10.0 / variance;
        self.information.set_bias(
            mean * information / (information + prior),
            1.0 / (information + prior).sqrt(),
        );
    }

    /// The frame's information on the shared unknowns, with its speed and yaw rate eliminated.
    fn inform(
        &mut self,
        time_s: f64,
        prediction: &Prediction,
        fit: &Fit,
        outcome: &mut FrameOutcome,
    ) -> Verdict {
        let (n, score) = self.normal_equations(prediction, fit);
        if !(n[0][0] > 0.0 && n[0][0].is_finite()) {
            return Verdict::Sparse;
        }
        let innovation = score[0] / n[0][0];
        let own = fit.missing / n[0][0];
        let known = self.information.formal()[0][0];
        let freedom = self.counts.used as f64;
        let rate = LEARNING_RATE.max(1.0 / (freedom + 10.0));
        let normalised = innovation * innovation / (own + self.excess + known);
        let student = (FREEDOM + 1.0) / (FREEDOM + normalised);
        let slope = student * (FREEDOM - normalised) / (FREEDOM + normalised);
        self.slope += rate * (slope - self.slope);
        let squared = (innovation * innovation).min(9.0 * (own + self.excess + known));
        let share = 1.0 / (n[0][0] * (own + self.excess));
        self.excess += rate * (squared * student - own - known - self.excess);
        self.excess = self.excess.max(1e-7);
        let informed = share * self.slope.clamp(0.3, 1.0);
        let scaled = n.map(|row| row.map(|entry| entry * informed));
        let angle = prediction.angle_rad + innovation;
        if time_s - self.block_start_s >= BLOCK_S {
            self.information.end_block();
            self.block_start_s = time_s;
            let now = self.information.mean()[0];
            self.settled = self
                .angle_before
                .is_some_and(|before| wrap(now - before).abs() <= self.options.converged_rad);
            self.angle_before = Some(now);
        }
        self.information.add_frame(&scaled, &score.map(|entry| entry * share * student));
        outcome.angle_rad = Some(wrap(angle));
        outcome.angle_sigma_rad = Some((own + self.excess).sqrt());
        outcome.weight = informed * n[0][0];
        self.inliers += fit.inliers as f64;
        self.detections += outcome.weights.len() as f64;
        Verdict::Used
    }

    fn normal_equations(&self, prediction: &Prediction, fit: &Fit) -> (Matrix, Vector) {
        let (sin0, cos0) = prediction.angle_rad.sin_cos();
        let speed = fit.speed;
        let rate = prediction.yaw_rate_radps;
        let along = speed - rate * prediction.y_m;
        let across = prediction.lateral(speed);
        let lever = prediction.x_m - prediction.slip * speed * speed;
        let delayed = self.information.mean()[1] * prediction.change;
        // Shared unknowns first, then speed and yaw rate.
        let mut full = [[0.0; UNKNOWNS + 2]; UNKNOWNS + 2];
        let mut right = [0.0; UNKNOWNS + 2];
        for i in 0..self.cloud.len() {
            let cos = self.cloud.cos[i] * cos0 - self.cloud.sin[i] * sin0;
            let sin = self.cloud.sin[i] * cos0 + self.cloud.cos[i] * sin0;
            let residual = self.cloud.closing[i] - along * cos - across * sin;
            let by_rate = lever * sin - prediction.y_m * cos;
            let row = [
                across * cos - along * sin,
                by_rate * prediction.reading_radps,
                -by_rate,
                -speed * speed * rate * sin,
                -by_rate * delayed,
                cos - 2.0 * prediction.slip * speed * rate * sin,
                by_rate,
            ];
            let weight = self.cloud.weight[i] / self.cloud.variance[i];
            for a in 0..row.len() {
                right[a] += weight * row[a] * residual;
                for b in 0..=a {
                    full[a][b] += weight * row[a] * row[b];
                }
            }
        }
        full[UNKNOWNS + 1][UNKNOWNS + 1] += 1.0 / YAW_RATE_NOISE_RADPS.powi(2);
        // Eliminate the yaw rate's error, then the speed.
        for pivot in (UNKNOWNS..UNKNOWNS + 2).rev() {
            let diagonal = full[pivot][pivot];
            if diagonal.is_nan() || diagonal <= 0.0 {
                return ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
            }
            for a in 0..pivot {
                let factor = full[pivot][a] / diagonal;
                right[a] -= factor * right[pivot];
                for b in 0..=a {
                    full[a][b] -= factor * full[pivot][b];
                }
            }
        }
        let n = std::array::from_fn(|i| {
            std::array::from_fn(|j| if j <= i { full[i][j] } else { full[j][i] })
        });
        (n, std::array::from_fn(|i| right[i]))
    }

    /// The angle as it stands.
    pub fn estimate(&self) -> AngleEstimate {
        self.conclude(&self.information.mean(), &self.information.covariance())
    }

    /// What the frames say of the shared unknowns.
    pub(crate) fn information(&self) -> &Information {
        &self.information
    }

    /// Unknowns and their covariance, with all that is needed to judge them.
    pub(crate) fn conclude(&self, x: &Vector, covariance: &Matrix) -> AngleEstimate {
        let none = self.counts.used == 0;
        let sigma = |i: usize| covariance[i][i].max(0.0).sqrt();
        let sigma_rad = if none { f64::INFINITY } else { sigma(0) };
        let inverse_scale = x[1].max(0.1);
        let inlier_share = if none { 0.0 } else { self.inliers / self.detections.max(1.0) };
        let angle_rad = wrap(x[0]);
        let converged = self.settled && sigma_rad <= self.options.converged_rad;
        let misaligned = self.options.nominal_rad.map(|nominal| {
            wrap(angle_rad - nominal).abs() > self.options.alarm_rad + 2.0 * sigma_rad
        });
        let mut remarks = Vec::new();
        let mut remark = |present: bool, remark| {
            if present {
                remarks.push(remark);
            }
        };
        let unknown = |i: usize, prior: f64| sigma(i) > 0.7 * prior;
        remark(none, Remark::NoFrames);
        remark(sigma_rad > 1.0_f64.to_radians(), Remark::AngleUndetermined);
        remark(unknown(1, SCALE_PRIOR), Remark::ScaleUndetermined);
        remark(unknown(2, self.options.bias_sigma_radps), Remark::BiasUndetermined);
        remark(!none && inlier_share < 0.5, Remark::FewInliers);
        remark(misaligned == Some(true), Remark::Misaligned);
        remark(!converged, Remark::NotConverged);
        AngleEstimate {
            angle_rad,
            sigma_rad,
            scale: 1.0 / inverse_scale,
            scale_sigma: sigma(1) / (inverse_scale * inverse_scale),
            covariance: [
                [covariance[0][0], covariance[0][1]],
                [covariance[1][0], covariance[1][1]],
            ],
            bias_radps: x[2] / inverse_scale,
            bias_sigma_radps: sigma(2) / inverse_scale,
            inlier_share,
            frames: self.counts,
            converged,
            misaligned,
            remarks,
        }
    }
}

fn prior(angle_rad: f64, bias: f64, bias_sigma: f64) -> Information {
    Information::new(
        [angle_rad, 1.0, bias, 0.0, 0.0],
        [ANGLE_PRIOR_RAD, SCALE_PRIOR, bias_sigma, SLIP_PRIOR, DELAY_PRIOR_S],
    )
}
