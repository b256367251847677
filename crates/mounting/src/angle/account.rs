//! The covariance of an estimate from many frames: errors that last, and unknowns that the method leaves out.
//!
//! An estimate near its solution is linear in the frames' residuals: each frame has an influence on angle and inverse scale. From these follows
//! what errors do that frames share: over a block of seconds (measured by the blocks' scatter, beginning with what real drives have), and over the
//! whole drive (bias and, where the method has none, scale of the yaw rate, side slip, delay, and the radar's own azimuths).

use super::Sample;
use crate::options::CalibrationOptions;
use crate::recursive::block::Extent;
use crate::recursive::information::{MAX_CORRELATION, PRIOR_BLOCKS};
use crate::symmetric::Symmetric;

/// Frames further apart do not tell how fast the yaw rate changes, s.
const CHANGE_GAP_S: f64 = 0.25;

/// A frame's part in an estimate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Influence {
    pub sample: Sample,
    /// Change of angle and inverse scale with the frame's residual.
    pub on: [f64; 2],
    /// Angle that the frame has beyond the estimate, rad.
    pub residual: f64,
    /// Change of the frame's angle with its yaw rate, s.
    pub lever_s: f64,
}

/// What is known of the unknowns that methods leave out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Untold<'a> {
    /// What is expected of them.
    pub options: &'a CalibrationOptions,
    /// Bias that was taken off, and its standard deviation, rad/s.
    pub bias_radps: f64,
    pub bias_sigma_radps: f64,
    /// Whether the method takes the scale as 1.
    pub fixed_scale: bool,
    /// Share of static detections.
    pub static_share: f64,
}

/// Covariance of angle and inverse scale, from that which independent frames would give.
pub(crate) fn covariance(
    independent: Symmetric,
    influences: &[Influence],
    untold: &Untold,
) -> Symmetric {
    let options = untold.options;
    let turn = |i: &Influence| i.sample.yaw_rate_radps - untold.bias_radps;
    let stretched = |i: &Influence| i.lever_s * turn(i);
    // Lateral acceleration over the slope of equation 7, which is near 1.
    let slipped = |i: &Influence| i.sample.radar_speed_mps * turn(i);
    let scale_sigma = if untold.fixed_scale { options.scale_sigma } else { 0.0 };
    let slip_sigma = options.slip_gradient_rad.hypot(options.slip_gradient_sigma_rad);
    // What scale and slip do is told below, and is no error that lasts.
    let [by_scale, by_slip] =
        explained(influences, [(&stretched, scale_sigma), (&slipped, slip_sigma)]);
    let residual = |i: &Influence| i.residual - by_scale * stretched(i) - by_slip * slipped(i);
    let mut result = lasting(independent, influences, residual, options.lasting_sigma_rad);
    let mut add = |[angle, scale]: [f64; 2], sigma: f64| {
        result.add(angle, scale, sigma * sigma);
    };
    let shift = |error: &dyn Fn(&Influence) -> f64| {
        influences.iter().fold([0.0; 2], |sum, influence| {
            let error = error(influence);
            [sum[0] + influence.on[0] * error, sum[1] + influence.on[1] * error]
        })
    };
    add(shift(&|i| i.lever_s), untold.bias_sigma_radps);
    add(shift(&stretched), scale_sigma);
    add(shift(&slipped), slip_sigma);
    add(delayed(influences), options.delay_s.hypot(options.delay_sigma_s));
    add([1.0, 0.0], options.floor_rad(untold.static_share));
    result
}

/// What a delay of one second does to the estimate.
fn delayed(influences: &[Influence]) -> [f64; 2] {
    let mut result = [0.0; 2];
    for pair in influences.windows(2) {
        let [before, now] = [pair[0].sample, pair[1].sample];
        let gap = now.time_s - before.time_s;
        if gap > 0.0 && gap <= CHANGE_GAP_S {
            let change = (now.yaw_rate_radps - before.yaw_rate_radps) / gap;
            for k in 0..2 {
                result[k] += pair[1].on[k] * pair[1].lever_s * change;
            }
        }
    }
    result
}

type Shape<'a> = &'a dyn Fn(&Influence) -> f64;

/// How much of two shapes the residuals have, as far as the deviations of the two allow for.
fn explained(influences: &[Influence], shapes: [(Shape, f64); 2]) -> [f64; 2] {
    let weight = |i: &Influence| i.on[0].abs();
    let (mut total, mut squares) = (0.0, 0.0);
    for influence in influences {
        total += weight(influence);
        squares += weight(influence) * influence.residual.powi(2);
    }
    let scatter = squares / total;
    if scatter.is_nan() || scatter <= 0.0 {
        return [0.0; 2];
    }
    // Weights are scaled to the number of frames.
    let unit = influences.len() as f64 / total / scatter;
    let (mut normal, mut right) = (Symmetric::default(), [0.0; 2]);
    for influence in influences {
        let weight = unit * weight(influence);
        let [x, y] = shapes.map(|(shape, sigma)| sigma * shape(influence));
        normal.add(x, y, weight);
        right[0] += weight * x * influence.residual;
        right[1] += weight * y * influence.residual;
    }
    normal.add(1.0, 0.0, 1.0);
    normal.add(0.0, 1.0, 1.0);
    let solution = normal.inverse().map_or([0.0; 2], |inverse| inverse.times(right));
    [solution[0] * shapes[0].1, solution[1] * shapes[1].1]
}

/// With errors that the frames of a block share: the sandwich over blocks (Liang and Zeger 1986), averaged with what real drives
/// have, which counts as some blocks.
fn lasting(
    independent: Symmetric,
    influences: &[Influence],
    residual: impl Fn(&Influence) -> f64,
    sigma_rad: f64,
) -> Symmetric {
    let (mut expected, mut measured) = (independent, Symmetric::default());
    let (mut blocks, mut lagged, mut before) = (0.0_f64, 0.0, None::<f64>);
    let mut rest = influences;
    while !rest.is_empty() {
        let mut extent = Extent::default();
        let ends =
            |i: &Influence| extent.ends_before(i.sample.time_s, i.sample.radar_speed_mps).is_some();
        let (block, after) = rest.split_at(rest.iter().position(ends).unwrap_or(rest.len()));
        let (mut pull, mut score) = ([0.0; 2], [0.0; 2]);
        for influence in block {
            for k in 0..2 {
                pull[k] += influence.on[k];
                score[k] += influence.on[k] * residual(influence);
            }
        }
        expected.add(pull[0], pull[1], sigma_rad * sigma_rad);
        measured.add(score[0], score[1], 1.0);
        lagged += before.replace(score[0]).map_or(0.0, |last| last * score[0]);
        blocks += 1.0;
        rest = after;
    }
    let unknowns = if independent.yy > 0.0 { 2.0 } else { 1.0 };
    let freedom = (blocks - unknowns).max(0.0);
    if freedom == 0.0 {
        return expected;
    }
    let per_block = (measured.xx + PRIOR_BLOCKS / blocks * expected.xx).max(f64::MIN_POSITIVE);
    let correlation = (lagged / per_block).clamp(0.0, MAX_CORRELATION);
    let factor = blocks / freedom * (1.0 + correlation) / (1.0 - correlation);
    let share = freedom / (freedom + PRIOR_BLOCKS);
    let mix = |measured: f64, expected: f64| share * factor * measured + (1.0 - share) * expected;
    Symmetric {
        xx: mix(measured.xx, expected.xx),
        xy: mix(measured.xy, expected.xy),
        yy: mix(measured.yy, expected.yy),
    }
}
