//! The mounting angle from the motions of many frames.
//!
//! Every frame says `theta = asin(s' chi) - beta` with `chi = (yaw rate - bias) x_s / |V|`
//! (equations 7 and 10 of Zhu et al.), or `pi - asin(s' chi) - beta` in reverse.

pub(crate) mod account;
pub(crate) mod bias;
pub(crate) mod kabsch;
pub(crate) mod least_squares;
pub(crate) mod orthogonal_distance;
pub(crate) mod weighted_mean;

use crate::options::CalibrationOptions;
use crate::symmetric::Symmetric;
use account::Untold;
use std::f64::consts::{PI, TAU};

/// What a frame that passed the gates leaves behind.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Measured yaw rate, rad/s.
    pub yaw_rate_radps: f64,
    /// The radar's speed `|V|`, m/s.
    pub radar_speed_mps: f64,
    /// Direction of the radar's motion in its own frame, rad.
    pub beta_rad: f64,
    /// Variance of `beta_rad`.
    pub beta_variance: f64,
    /// Variance of the radar's speed, m^2/s^2.
    pub speed_variance: f64,
    /// The car's speed, m/s; NaN where it is not known.
    pub speed_mps: f64,
}

/// What all frames share when the angle is sought.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setting<'a> {
    /// Bias of the yaw rate, rad/s.
    pub bias_radps: f64,
    /// Its standard deviation (of its prior, where there was no standstill), rad/s.
    pub bias_sigma_radps: f64,
    /// Standard deviation of the yaw rate's noise, rad/s.
    pub yaw_rate_sigma_radps: f64,
    /// Share of static detections.
    pub static_share: f64,
    /// What is expected of the radar and the car.
    pub options: &'a CalibrationOptions,
}

impl<'a> Setting<'a> {
    /// What methods leave out.
    pub fn untold(&self, fixed_scale: bool) -> Untold<'a> {
        Untold {
            options: self.options,
            bias_radps: self.bias_radps,
            bias_sigma_radps: self.bias_sigma_radps,
            fixed_scale,
            static_share: self.static_share,
        }
    }
}

/// An angle with the inverse scale and their covariance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solution {
    /// Mounting angle, rad, in `(-pi, pi]`.
    pub angle_rad: f64,
    /// Inverse scale.
    pub inverse_scale: f64,
    /// Covariance of both; the scale's variance is infinite where it is not determined.
    pub covariance: Symmetric,
    /// Frames left out because no angle has the sine they ask for.
    pub gated: usize,
}

impl Solution {
    /// Whether it consists of numbers: extreme frames and options overflow.
    pub fn is_sound(&self) -> bool {
        let Symmetric { xx, xy, yy } = self.covariance;
        self.angle_rad.is_finite()
            && self.inverse_scale.is_finite()
            && xx >= 0.0
            && yy >= 0.0
            && !xy.is_nan()
    }
}

/// A frame whose `|s' chi|` is larger turns more tightly than the model allows for: its angle would
/// rest on the steep end of the arcsine.
pub(crate) const MAX_SINE: f64 = 0.9;

/// An angle brought to `(-pi, pi]`.
pub fn wrap(angle: f64) -> f64 {
    let wrapped = angle - TAU * (angle / TAU).round();
    if wrapped <= -PI { wrapped + TAU } else { wrapped }
}

/// A frame as the regressions see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// The frame.
    pub sample: Sample,
    /// `chi` of equation 10.
    pub chi: f64,
    /// Direction of motion, turned about where the car reverses: `theta = asin(s' chi) - beta`.
    pub beta: f64,
    /// Variance of `beta`.
    pub variance: f64,
    /// Variance of `chi` from noise of the yaw rate and the speed.
    pub chi_variance: f64,
    /// `1 / (Var_xx + Var_yy)` of equation 13, s^2/m^2.
    pub weight: f64,
    /// Change of `chi` with the bias, s.
    pub lever_s: f64,
}

/// Frames as rows about a reference angle, and how many were gated.
///
/// In reverse the radar moves the other way, which turns `beta` by half a circle and the sign of
/// `chi`. Which frames reverse follows from the nominal angle, else from the majority.
pub(crate) fn rows(samples: &[Sample], setting: &Setting) -> (Vec<Row>, f64, usize) {
    let mut gated = 0;
    let mut result = Vec::with_capacity(samples.len());
    let mut sum = [0.0; 2];
    for sample in samples {
        let lever_s = setting.options.x_m / sample.radar_speed_mps;
        let chi = (sample.yaw_rate_radps - setting.bias_radps) * lever_s;
        if chi.abs() > MAX_SINE {
            gated += 1;
            continue;
        }
        let chi_variance = (lever_s * setting.yaw_rate_sigma_radps).powi(2)
            + chi * chi * sample.speed_variance / sample.radar_speed_mps.powi(2);
        let row = Row {
            sample: *sample,
            chi,
            beta: sample.beta_rad,
            variance: sample.beta_variance,
            chi_variance,
            weight: 1.0
                / (sample.speed_variance + sample.beta_variance * sample.radar_speed_mps.powi(2)),
            lever_s,
        };
        let (sin, cos) = (chi.asin() - row.beta).sin_cos();
        sum[0] += cos / row.variance;
        sum[1] += sin / row.variance;
        result.push(row);
    }
    let reference = setting.options.nominal_rad.unwrap_or_else(|| sum[1].atan2(sum[0]));
    for row in &mut result {
        if wrap(row.chi.asin() - row.beta - reference).abs() > PI / 2.0 {
            row.beta -= PI;
            row.chi = -row.chi;
            row.lever_s = -row.lever_s;
        }
        // About the reference, so that sums of angles need no wrapping.
        row.beta = wrap(row.beta + reference);
    }
    (result, reference, gated)
}
