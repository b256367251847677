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

impl Recursive {
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
        let inlier_share = if none { 0.0 } else { state.inliers / state.detections.max(1.0) };
        let (doubts, doubt_rad) = state.doubts.remarks(known, options.nominal_rad, inlier_share);
        let floor_rad = options.floor_rad(inlier_share);
        let variance = covariance[0][0] + floor_rad * floor_rad + doubt_rad * doubt_rad;
        let sigma_rad = if none { f64::INFINITY } else { variance.sqrt() };
        let inverse_scale = x[1].max(0.1);
        let scale_variance = covariance[1][1].max(0.0) + SCALE_FLOOR * SCALE_FLOOR;
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
            (Remark::Changed, state.changed_s.is_some()),
            (Remark::Misaligned, misaligned == Some(true)),
            (Remark::NotConverged, !converged),
        ];
        let holding = |(remark, holds): (Remark, bool)| holds.then_some(remark);
        AngleEstimate {
            angle_rad,
            sigma_rad,
            scale: 1.0 / inverse_scale,
            scale_sigma: scale_variance.sqrt() / (inverse_scale * inverse_scale),
            covariance: [[variance, covariance[0][1]], [covariance[1][0], scale_variance]],
            bias_radps: x[2] / inverse_scale,
            bias_sigma_radps: sigma(2) / inverse_scale,
            slip_gradient_rad: x[3],
            slip_gradient_sigma_rad: sigma(3),
            delay_s: x[4],
            delay_sigma_s: sigma(4),
            speed_scale: state.speed_scale.scale(),
            speed_scale_sigma: state.speed_scale.scale_sigma(),
            changed_s: state.changed_s,
            inlier_share,
            frames: state.counts,
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
