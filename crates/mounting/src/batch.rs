//! The methods that weigh all frames at once.

use crate::angle::bias::Bias;
use crate::angle::{
    Sample, Setting, Solution, kabsch, least_squares, orthogonal_distance, weighted_mean, wrap,
};
use crate::error::MountingError;
use crate::estimate::{Alignment, CHANCE};
use crate::estimate::{AngleEstimate, FrameCounts, Remark};
use crate::frame::{CarMotion, FrameInput, FrameOutcome, Motion, Verdict};
use crate::intake::{Admission, Intake};
use crate::motion::{FrameMotion, MotionPlan};
use crate::options::{CalibrationOptions, Method};

/// A radar slower than this stands, m/s, if its detections allow for that.
const STANDSTILL_MPS: f64 = 0.05;
/// Nor does a car whose own sensors have it at this speed, m/s.
const STANDSTILL_MEASURED_MPS: f64 = 0.5;
/// A car that turns faster does not stand, rad/s, whatever its radar sees: no bias is as large.
const STANDSTILL_RADPS: f64 = 0.05;
/// Standard deviation of the angle from which it counts as undetermined, rad (1 deg).
const UNDETERMINED_ANGLE_RAD: f64 = 0.017_453_292_519_943_295;
/// Standard deviation of the scale from which it counts as undetermined.
const UNDETERMINED_SCALE: f64 = 0.05;
/// Time between the last frame of a session and the first of the next, s: more than frames of one manoeuvre are apart.
const SESSION_GAP_S: f64 = 2.0;
/// Convergence compares with the angle of all frames but the last of this time, s.
const SETTLING_S: f64 = 10.0;

/// The methods that weigh all frames at once; they keep 56 bytes of each.
#[derive(Debug)]
pub(crate) struct Batch {
    options: CalibrationOptions,
    motion: Box<dyn MotionPlan>,
    samples: Vec<Sample>,
    bias: Bias,
    counts: FrameCounts,
    inliers: u64,
    detections: u64,
    last_time_s: Option<f64>,
    /// What the clock of this session is behind the times of the samples, s, which ascend over all sessions.
    offset_s: f64,
    intake: Intake,
}

impl Batch {
    pub(crate) fn new(options: CalibrationOptions, motion: Box<dyn MotionPlan>) -> Self {
        Self {
            motion,
            options,
            samples: Vec::new(),
            bias: Bias::default(),
            counts: FrameCounts::default(),
            inliers: 0,
            detections: 0,
            last_time_s: None,
            offset_s: 0.0,
            intake: Intake::default(),
        }
    }

    pub(crate) fn method(&self) -> Method {
        self.options.method
    }

    pub(crate) fn add(&mut self, frame: FrameInput) -> Result<FrameOutcome, MountingError> {
        if self.intake.admit(self.last_time_s, frame.time_s)? == Admission::NewSession {
            self.restart();
        }
        if self.last_time_s.replace(frame.time_s).is_none()
            && let Some(last) = self.samples.last()
        {
            self.offset_s = last.time_s + SESSION_GAP_S - frame.time_s;
        }
        let screened = self.intake.screen(frame.detections);
        let frame = FrameInput { detections: &screened.detections, ..frame };
        let mut weights = Vec::new();
        let FrameMotion { motion, verdict, earlier } = self.motion.estimate(frame, &mut weights)?;
        screened.spread(&mut weights);
        let car = earlier.unwrap_or_else(|| frame.car());
        let (verdict, sample) = match verdict {
            Verdict::Used => self.judge(&car, motion.as_ref()),
            verdict => (verdict, None),
        };
        if let (Verdict::Standing, Some(yaw_rate_radps)) = (verdict, car.yaw_rate_radps) {
            self.bias.add(yaw_rate_radps);
        }
        self.counts.add(verdict);
        let mut outcome = FrameOutcome {
            time_s: car.time_s,
            verdict,
            motion,
            angle_rad: None,
            angle_sigma_rad: None,
            weight: 0.0,
            weights,
        };
        if let (Some(sample), Some(motion)) = (sample, motion) {
            self.inliers += motion.inliers as u64;
            self.detections += motion.detections as u64;
            self.samples.push(sample);
            if let Some(alone) = self.solve(&[sample]) {
                outcome.angle_rad = Some(alone.angle_rad);
                outcome.angle_sigma_rad = Some(alone.covariance.xx.sqrt());
            }
            outcome.weight = 1.0 / sample.beta_variance;
        }
        Ok(outcome)
    }

    /// Starts a session on another clock.
    pub(crate) fn restart(&mut self) {
        self.intake.restart();
        self.motion.restart();
        self.last_time_s = None;
    }

    /// What becomes of a frame, and what is kept of it.
    fn judge(&self, car: &CarMotion, motion: Option<&Motion>) -> (Verdict, Option<Sample>) {
        let o = &self.options;
        let Some(motion) = motion else { return (Verdict::Sparse, None) };
        if (motion.inliers as f64) < o.inlier_ratio_threshold * motion.detections as f64 {
            return (Verdict::Sparse, None);
        }
        let Some(yaw_rate_radps) = car.yaw_rate_radps.filter(|rate| rate.is_finite()) else {
            return (Verdict::WithoutMotion, None);
        };
        let polar = motion.polar();
        let (speed, variance) = (polar.speed_mps, motion.total_variance());
        let measured = car.speed_mps.filter(|speed| speed.is_finite());
        let may_stand = measured.is_none_or(|speed| speed.abs() < STANDSTILL_MEASURED_MPS);
        if may_stand && stands(speed, variance, motion) && yaw_rate_radps.abs() < STANDSTILL_RADPS {
            return (Verdict::Standing, None);
        }
        if speed < o.min_speed_mps || speed <= CHANCE * variance.sqrt() {
            return (Verdict::Slow, None);
        }
        if yaw_rate_radps.abs() > o.max_yaw_rate_radps {
            return (Verdict::Turning, None);
        }
        if o.method == Method::Kabsch && measured.is_none() {
            return (Verdict::WithoutMotion, None);
        }
        let sample = Sample {
            time_s: car.time_s + self.offset_s,
            yaw_rate_radps,
            radar_speed_mps: speed,
            beta_rad: polar.direction_rad,
            beta_variance: polar.direction_variance,
            speed_variance: polar.speed_variance,
            speed_mps: measured.unwrap_or(f64::NAN),
        };
        let sound = sample.beta_variance > 0.0
            && sample.beta_variance.is_finite()
            && sample.speed_variance >= 0.0;
        if sound { (Verdict::Used, Some(sample)) } else { (Verdict::Sparse, None) }
    }

    fn solve(&self, samples: &[Sample]) -> Option<Solution> {
        let known = self.bias.sigma().is_finite();
        let setting = Setting {
            bias_radps: self.bias.mean(),
            bias_sigma_radps: if known { self.bias.sigma() } else { self.options.bias_sigma_radps },
            yaw_rate_sigma_radps: self.bias.noise(),
            static_share: self.inlier_share(),
            options: &self.options,
        };
        match self.options.method {
            Method::WeightedMean => weighted_mean::solve(samples, &setting),
            Method::Kabsch => kabsch::solve(samples, &setting),
            Method::OrthogonalDistance => orthogonal_distance::solve(samples, &setting),
            Method::LeastSquares | Method::Recursive => least_squares::solve(samples, &setting),
        }
        .filter(Solution::is_sound)
    }

    pub(crate) fn estimate(&self) -> AngleEstimate {
        let o = &self.options;
        let solution = self.solve(&self.samples);
        let scaled = matches!(o.method, Method::LeastSquares | Method::OrthogonalDistance);
        let (angle, inverse_scale, covariance) = match &solution {
            Some(s) => (s.angle_rad, s.inverse_scale, s.covariance.rows()),
            None => {
                let yy = if scaled { f64::INFINITY } else { 0.0 };
                (o.nominal_rad.unwrap_or(0.0), 1.0, [[f64::INFINITY, 0.0], [0.0, yy]])
            }
        };
        let sigma = covariance[0][0].sqrt();
        let scale_sigma = covariance[1][1].sqrt() / (inverse_scale * inverse_scale);
        let mut frames = self.counts;
        if let Some(s) = &solution {
            // What no angle explains is turning too tightly for the model.
            frames.used -= s.gated as u64;
            frames.turning += s.gated as u64;
        }
        let converged = sigma < o.converged_rad && self.moved(angle) <= o.converged_rad;
        let alignment = Alignment::of(angle, sigma, o);
        let misaligned = alignment.map(|alignment| alignment == Alignment::Misaligned);
        let inlier_share = self.inlier_share();
        let remarks = [
            (Remark::NoFrames, solution.is_none()),
            (Remark::AngleUndetermined, sigma.is_nan() || sigma > UNDETERMINED_ANGLE_RAD),
            (
                Remark::ScaleUndetermined,
                scaled && (scale_sigma.is_nan() || scale_sigma > UNDETERMINED_SCALE),
            ),
            (Remark::BiasUndetermined, !self.bias.sigma().is_finite()),
            (Remark::InvalidDetections, self.intake.rejected_detections > 0),
            (Remark::ClockReset, self.intake.clock_resets > 0),
            (Remark::Stale, self.intake.is_stale()),
            (Remark::FewInliers, self.detections > 0 && inlier_share < 0.5),
            (Remark::Misaligned, misaligned == Some(true)),
            (Remark::NotConverged, !converged),
        ];
        AngleEstimate {
            angle_rad: angle,
            sigma_rad: sigma,
            scale: 1.0 / inverse_scale,
            scale_sigma,
            covariance,
            bias_radps: self.bias.mean(),
            bias_sigma_radps: self.bias.sigma(),
            slip_gradient_rad: 0.0,
            slip_gradient_sigma_rad: 0.0,
            delay_s: 0.0,
            delay_sigma_s: 0.0,
            speed_scale: 1.0,
            speed_scale_sigma: 0.0,
            changed_s: None,
            inlier_share,
            frames,
            last_frame_s: self.last_time_s,
            stale: self.intake.is_stale(),
            rejected_frames: self.intake.rejected_frames,
            rejected_detections: self.intake.rejected_detections,
            clock_resets: self.intake.clock_resets,
            converged,
            misaligned,
            alignment,
            remarks: remarks.into_iter().filter_map(|(r, holds)| holds.then_some(r)).collect(),
        }
    }

    /// Static detections over all; 0 without any.
    fn inlier_share(&self) -> f64 {
        if self.detections == 0 { 0.0 } else { self.inliers as f64 / self.detections as f64 }
    }

    /// How far the angle is from that of all frames but the latest, rad.
    fn moved(&self, angle: f64) -> f64 {
        let Some(last) = self.samples.last() else { return f64::INFINITY };
        let until = self.samples.partition_point(|s| s.time_s < last.time_s - SETTLING_S);
        self.solve(&self.samples[..until])
            .map_or(f64::INFINITY, |earlier| wrap(angle - earlier.angle_rad).abs())
    }
}

/// Whether a radar stands: so slow that it is nothing or within the motion's own uncertainty, and most of
/// what it sees agrees.
fn stands(speed: f64, variance: f64, motion: &Motion) -> bool {
    let chance = (CHANCE * variance.sqrt()).min(2.0 * STANDSTILL_MPS);
    speed <= STANDSTILL_MPS.max(chance) && 2 * motion.inliers >= motion.detections
}
