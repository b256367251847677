//! From what is known to the answer.

use super::Recursive;
use super::information::{Information, Matrix, Vector};
use crate::angle::wrap;
use crate::estimate::{Alignment, AngleEstimate, Remark};

/// Standard deviations of a prior above which an unknown rests on it.
const PRIOR_SHARE: f64 = 0.7;

/// Standard deviation of what turns do to a radar's azimuths and looks like a scale of the yaw rate: slip that is not in proportion, reflectors
/// whose part in view changes with the turn. No drive tells a scale better.
const SCALE_FLOOR: f64 = 0.005;

/// The least inverse scale that a scale is told of.
const LEAST_INVERSE_SCALE: f64 = 0.1;

/// Value and standard deviation to tell of an unknown, by its place, its variance and the inverse scale: the scale in place of its inverse, and the
/// bias without it.
pub(crate) fn told(i: usize, value: f64, variance: f64, inverse_scale: f64) -> (f64, f64) {
    let inverse_scale = inverse_scale.max(LEAST_INVERSE_SCALE);
    let variance = variance.max(0.0);
    match i {
        1 => {
            let sigma = scale_variance(variance).sqrt();
            (1.0 / inverse_scale, sigma / (inverse_scale * inverse_scale))
        }
        2 => (value / inverse_scale, variance.sqrt() / inverse_scale),
        _ => (value, variance.sqrt()),
    }
}

fn scale_variance(variance: f64) -> f64 {
    variance.max(0.0) + SCALE_FLOOR * SCALE_FLOOR
}

impl Recursive {
    /// Static detections over all, of the frames used; 0 without any.
    fn inlier_share(&self) -> f64 {
        let none = self.state.counts.used == 0;
        if none { 0.0 } else { self.state.inliers / self.state.detections.max(1.0) }
    }

    /// Standard deviations of the angle beyond what the equations say, rad: of what no drive tells, and of doubts about this one.
    pub(crate) fn beyond_rad(&self, known: &Information) -> (f64, f64) {
        let share = self.inlier_share();
        let (_, doubt_rad) = self.state.doubts.remarks(known, self.options.nominal_rad, share);
        (self.options.floor_rad(share), doubt_rad)
    }

    /// Unknowns and their covariance, with all that is needed to judge them.
    pub(crate) fn conclude(
        &self,
        known: &Information,
        x: &Vector,
        covariance: &Matrix,
    ) -> AngleEstimate {
        let (options, state) = (&self.options, &self.state);
        let none = state.counts.used == 0;
        let sigma = |i: usize| covariance[i][i].max(0.0).sqrt();
        let inlier_share = self.inlier_share();
        let (doubts, doubt_rad) = state.doubts.remarks(known, options.nominal_rad, inlier_share);
        let floor_rad = options.floor_rad(inlier_share);
        let variance = covariance[0][0] + floor_rad * floor_rad + doubt_rad * doubt_rad;
        let sigma_rad = if none { f64::INFINITY } else { variance.sqrt() };
        let [(scale, scale_sigma), (bias_radps, bias_sigma_radps), slip, delay] =
            std::array::from_fn(|i| told(i + 1, x[i + 1], covariance[i + 1][i + 1], x[1]));
        let angle_rad = wrap(x[0]);
        let settled = state.angles[2]
            .is_some_and(|before| wrap(angle_rad - before).abs() <= options.converged_rad);
        let converged = settled && sigma_rad <= options.converged_rad;
        let alignment = Alignment::of(angle_rad, sigma_rad, options);
        let misaligned = alignment.map(|alignment| alignment == Alignment::Misaligned);
        let unknown = |i: usize, prior: f64| sigma(i) > PRIOR_SHARE * prior;
        let before = [
            (Remark::NoFrames, none),
            (Remark::AngleUndetermined, sigma_rad > 1.0_f64.to_radians()),
            (Remark::ScaleUndetermined, unknown(1, options.scale_sigma)),
            (Remark::BiasUndetermined, unknown(2, options.bias_sigma_radps)),
        ];
        let after = [
            (Remark::InvalidDetections, self.intake.rejected_detections > 0),
            (Remark::ClockReset, self.intake.clock_resets > 0),
            (Remark::Stale, self.intake.is_stale()),
            (Remark::Changed, state.changed_s.is_some()),
            (Remark::Misaligned, misaligned == Some(true)),
            (Remark::NotConverged, !converged),
        ];
        let holding = |(remark, holds): (Remark, bool)| holds.then_some(remark);
        AngleEstimate {
            angle_rad,
            sigma_rad,
            scale,
            scale_sigma,
            covariance: [
                [variance, covariance[0][1]],
                [covariance[1][0], scale_variance(covariance[1][1])],
            ],
            bias_radps,
            bias_sigma_radps,
            slip_gradient_rad: slip.0,
            slip_gradient_sigma_rad: slip.1,
            delay_s: delay.0,
            delay_sigma_s: delay.1,
            speed_scale: state.speed_scale.scale(),
            speed_scale_sigma: state.speed_scale.scale_sigma(),
            changed_s: state.changed_s,
            inlier_share,
            frames: state.counts,
            last_frame_s: state.time_s,
            stale: self.intake.is_stale(),
            rejected_frames: self.intake.rejected_frames,
            rejected_detections: self.intake.rejected_detections,
            clock_resets: self.intake.clock_resets,
            converged,
            misaligned,
            alignment,
            remarks: before
                .into_iter()
                .filter_map(holding)
                .chain(doubts)
                .chain(after.into_iter().filter_map(holding))
                .collect(),
        }
    }
}
