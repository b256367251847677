//! DeepEgo+, multi frame: a recurrent network weighs the motions of successive frames of one radar, and a quadratic in time
//! with learnt priors is fitted to them.

use super::dense::{Layer, asinh, one};
use super::recurrent::Recurrent;
use super::{DeepEgo, NetworkError, WeighedMotion, Weights};
use crate::plane::{turned, turned_covariance};
use boresight_math::linalg::small;

/// Numbers of a frame beside its context.
const MOTION: usize = 9;
const CYCLE_S: f64 = 0.074;
/// Scale of deviations from the window's mean motion, m/s.
const SCALE_MPS: f32 = 0.05;
/// Logarithms of frames' weights are within plus and minus this.
const WEIGHT_RANGE: f32 = 4.0;
/// Deviations of linear and quadratic terms along and across the motion before learning, m/s over half a window; their
/// logarithms change by at most [`PRIOR_RANGE`].
const PRIORS_MPS: [f64; 4] = [1.0, 0.3, 0.3, 0.1];
const PRIOR_RANGE: f32 = 3.0;
/// Deviation of constant terms, m/s: none to speak of.
const OPEN_MPS: f64 = 1e3;
/// Added to the frames' variances, (m/s)^2.
const LEAST_VARIANCE: f64 = 1e-6;
/// Terms of a quadratic, and of two.
const TERMS: usize = 3;
const BOTH: usize = 2 * TERMS;

/// A frame of a window: what the single-frame network says of it.
#[derive(Debug, Clone, Copy)]
pub struct WindowFrame<'a> {
    /// Time, s.
    pub time_s: f64,
    /// The motion.
    pub motion: &'a WeighedMotion,
}

/// A smoothed motion of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothedMotion {
    /// Velocity of the radar in its own frame, along boresight and to its left, m/s.
    pub velocity_mps: [f64; 2],
    /// Its covariance as xx, xy, yy, (m/s)^2. Those of a window's frames are correlated.
    pub covariance: [f64; 3],
}

/// Both networks.
#[derive(Debug, Clone)]
pub struct DeepEgoPlus {
    single: DeepEgo,
    encode: Layer,
    recur: Recurrent,
    weigh: Layer,
    window: Layer,
}

impl DeepEgoPlus {
    /// The networks with these weights.
    ///
    /// # Errors
    /// [`NetworkError::Unlike`] where a tensor is missing or has another shape.
    pub fn new(weights: &Weights) -> Result<Self, NetworkError> {
        let single = DeepEgo::within(weights, "single.")?;
        let layer = |name: &str, inputs: usize| {
            Layer::read(weights, &format!("smoother.{name}"), inputs, true)
        };
        let encode = layer("encode.0", MOTION + single.context_len())?;
        let recur = Recurrent::read(weights, "smoother.recur", encode.outputs())?;
        let (weigh, window) = (layer("weigh", recur.outputs())?, layer("window", recur.outputs())?);
        for (name, given, expected) in
            [("weigh", weigh.outputs(), 1), ("window", window.outputs(), PRIORS_MPS.len() + 1)]
        {
            if given != expected {
                return Err(NetworkError::Unlike {
                    tensor: format!("smoother.{name}.weight"),
                    expected: format!("{expected} outputs"),
                    given: format!("{given}"),
                });
            }
        }
        Ok(Self { single, encode, recur, weigh, window })
    }

    /// The single-frame network that the smoother was trained on.
    pub fn single(&self) -> &DeepEgo {
        &self.single
    }

    /// Smooths successive frames of one radar, eight as in training or another number, by ascending time.
    pub fn smooth(&self, frames: &[WindowFrame]) -> Vec<SmoothedMotion> {
        if frames.is_empty() {
            return vec![];
        }
        let covariances: Vec<[f64; 3]> = frames
            .iter()
            .map(|f| {
                let [xx, xy, yy] = f.motion.covariance;
                [xx + LEAST_VARIANCE, xy, yy + LEAST_VARIANCE]
            })
            .collect();
        let mut mean = [0.0; 2];
        let mut trusted = 0.0;
        for (frame, [xx, _, yy]) in frames.iter().zip(&covariances) {
            let trust = 1.0 / (xx + yy);
            trusted += trust;
            mean = [0, 1].map(|i| mean[i] + trust * frame.motion.velocity_mps[i]);
        }
        let mean = mean.map(|sum| sum / trusted);
        let speed = (mean[0] * mean[0] + mean[1] * mean[1] + 1e-6).sqrt();
        // At standstill any direction does.
        let axis = if speed > 0.01 { [mean[0] / speed, mean[1] / speed] } else { [1.0, 0.0] };
        let ahead = turned(mean, axis);
        let covariances: Vec<[f64; 3]> =
            covariances.into_iter().map(|c| turned_covariance(c, axis)).collect();
        let deviations: Vec<[f64; 2]> = frames
            .iter()
            .map(|f| {
                let [x, y] = turned(f.motion.velocity_mps, axis);
                [x - ahead[0], y - ahead[1]]
            })
            .collect();

        let mut features = vec![];
        for (k, frame) in frames.iter().enumerate() {
            let since = if k == 0 { 0.0 } else { frame.time_s - frames[k - 1].time_s };
            let [xx, xy, yy] = covariances[k];
            let (sx, sy) = (xx.sqrt(), yy.sqrt());
            features.extend(deviations[k].map(|d| one(d as f32 / SCALE_MPS, asinh)));
            let rest = [sx.ln(), sy.ln(), xy / (sx * sy), since / CYCLE_S, speed / 30.0];
            features.extend(rest.map(|number| number as f32));
            features.extend([frame.motion.share as f32, frame.motion.log_factor]);
            features.extend_from_slice(&frame.motion.context);
        }
        let mut encoded = vec![];
        self.encode.apply_rectified(&features, &mut encoded);
        let states = self.recur.apply(&encoded, self.encode.outputs());
        let mut heads = vec![];
        self.weigh.apply(&states, &mut heads);
        let weights: Vec<f64> = heads
            .iter()
            .map(|weight| f64::from(WEIGHT_RANGE * (weight / WEIGHT_RANGE).tanh()).exp())
            .collect();
        let row = self.recur.outputs();
        let mean_state: Vec<f32> = (0..row)
            .map(|i| states.iter().skip(i).step_by(row).sum::<f32>() / frames.len() as f32)
            .collect();
        let mut window = vec![];
        self.window.apply(&mean_state, &mut window);
        let sigmas: [f64; 4] = std::array::from_fn(|i| {
            PRIORS_MPS[i] * f64::from(PRIOR_RANGE * (window[i] / PRIOR_RANGE).tanh()).exp()
        });
        let factor = f64::from(window[PRIORS_MPS.len()].clamp(-2.0, 4.0));
        let times: Vec<f64> = frames.iter().map(|f| f.time_s - frames[0].time_s).collect();
        let smoothed = quadratic(&times, &deviations, &covariances, &weights, sigmas);
        let back = [axis[0], -axis[1]];
        smoothed
            .into_iter()
            .map(|([x, y], covariance)| SmoothedMotion {
                velocity_mps: turned([x + ahead[0], y + ahead[1]], back),
                covariance: turned_covariance(
                    covariance.map(|term| term * (2.0 * factor).exp()),
                    back,
                ),
            })
            .collect()
    }
}

/// Motions on the weighted quadratic in time, and their covariances.
fn quadratic(
    times_s: &[f64],
    deviations: &[[f64; 2]],
    covariances: &[[f64; 3]],
    weights: &[f64],
    [along, bent_along, across, bent_across]: [f64; 4],
) -> Vec<([f64; 2], [f64; 3])> {
    let half = 0.5 * times_s.last().copied().unwrap_or(0.0).max(1e-3);
    let basis = |time: f64| {
        let t = time / half - 1.0;
        [1.0, t, t * t]
    };
    let mut normal = [[0.0; BOTH]; BOTH];
    let mut right = [0.0; BOTH];
    let priors = [OPEN_MPS, along, bent_along, OPEN_MPS, across, bent_across];
    for (i, prior) in priors.into_iter().enumerate() {
        normal[i][i] = 1.0 / (prior * prior);
    }
    for (k, [xx, xy, yy]) in covariances.iter().enumerate() {
        let scale = weights[k] / (xx * yy - xy * xy).max(1e-14);
        let blocks = [[yy * scale, -xy * scale], [-xy * scale, xx * scale]];
        let terms = basis(times_s[k]);
        for i in 0..BOTH {
            let (row, term) = (blocks[i / TERMS], terms[i % TERMS]);
            right[i] += (row[0] * deviations[k][0] + row[1] * deviations[k][1]) * term;
            for j in 0..BOTH {
                normal[i][j] += row[j / TERMS] * term * terms[j % TERMS];
            }
        }
    }
    // Priors make the matrix positive definite; where numbers fail, nothing is known.
    let inverse = small::inverse(&normal).unwrap_or([[f64::NAN; BOTH]; BOTH]);
    let coefficients = small::times(&inverse, &right);
    times_s
        .iter()
        .map(|time| {
            let terms = basis(*time);
            let value = |c: usize| (0..TERMS).map(|i| terms[i] * coefficients[TERMS * c + i]).sum();
            let spread = |c: usize, d: usize| {
                let mut sum = 0.0;
                for i in 0..TERMS {
                    for j in 0..TERMS {
                        sum += terms[i] * inverse[TERMS * c + i][TERMS * d + j] * terms[j];
                    }
                }
                sum
            };
            ([value(0), value(1)], [spread(0, 0), spread(0, 1), spread(1, 1)])
        })
        .collect()
}
