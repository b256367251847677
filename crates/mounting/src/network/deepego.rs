//! DeepEgo, single frame: a network weighs detections, and weighted least squares gives the radar's motion.

use super::dense::{Layer, add, asinh, each, rectify, sigmoid, tanh};
use super::fit::{Sights, sum};
use super::hypotheses::{self, Near};
use super::{NetworkError, Weights};
use boresight_core::Detection;
use wide::f32x4;

const FEATURES: usize = 9;
/// Numbers of a residual that a refinement sees.
const OWN: usize = 4;
/// Numbers that are said of a detection: weight, precision, whether it moves.
const SAID: usize = 3;
const REFINEMENTS: usize = 2;
/// Scales of residuals: of range rates, m/s, and of what an azimuth error, rad, makes of the slope.
const RESIDUAL_MPS: f32 = 0.05;
const AZIMUTH_RAD: f32 = 0.005;
/// Of the scale of range rates, where the slope is smaller.
const LEAST_SLOPE: f32 = 0.05;
/// The logarithm of a detection's precision is within plus and minus this.
const PRECISION_RANGE: f32 = 3.0;
/// What that logarithm counts once trained.
const TEMPER: f32 = 0.7;
/// Smallest and largest logarithm of the factor on deviations.
const FACTOR_RANGE: [f32; 2] = [-2.0, 4.0];

/// What the network says of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct WeighedMotion {
    /// Velocity of the radar in its own frame, along boresight and to its left, m/s.
    pub velocity_mps: [f64; 2],
    /// Its covariance as xx, xy, yy, (m/s)^2: equation 3 with weights, times the learnt factor.
    pub covariance: [f64; 3],
    /// Of each detection from 0 to 1, how likely it is that it shows the motion; 0 where azimuth or range rate are not
    /// finite.
    pub weights: Vec<f32>,
    /// The same of whether it is of something that moves.
    pub moves: Vec<f32>,
    /// Mean of the weights of detections that are finite.
    pub share: f64,
    /// Logarithm of the factor on equation 3's deviations.
    pub log_factor: f32,
    /// What smoothing sees of the frame.
    pub(super) context: Vec<f32>,
}

/// The single-frame network.
#[derive(Debug, Clone)]
pub struct DeepEgo {
    encode: [Layer; 2],
    pool: Layer,
    weigh_point: Layer,
    weigh_frame: Layer,
    weigh: [Layer; 2],
    narrow_point: Layer,
    narrow_frame: Layer,
    refine_point: Layer,
    refine_frame: Layer,
    refine: [Layer; 2],
    spread: [Layer; 2],
}

impl DeepEgo {
    /// The network with these weights.
    ///
    /// # Errors
    /// [`NetworkError::Unlike`] where a tensor is missing or has another shape.
    pub fn new(weights: &Weights) -> Result<Self, NetworkError> {
        Self::within(weights, "")
    }

    /// The network whose tensors' names begin with `prefix`.
    pub(super) fn within(weights: &Weights, prefix: &str) -> Result<Self, NetworkError> {
        let layer = |name: &str, inputs: usize| {
            Layer::read(weights, &format!("{prefix}{name}"), inputs, true)
        };
        let bare = |name: &str, inputs: usize| {
            Layer::read(weights, &format!("{prefix}{name}"), inputs, false)
        };
        let two = |names: [&str; 2], inputs: usize| -> Result<[Layer; 2], NetworkError> {
            let first = layer(names[0], inputs)?;
            let second = layer(names[1], first.outputs())?;
            Ok([first, second])
        };
        let encode = two(["encode.0", "encode.2"], FEATURES)?;
        let width = encode[1].outputs();
        let pool = layer("pool.0", 2 * width)?;
        let weigh_point = layer("weigh_point", width)?;
        let narrow_point = layer("narrow_point", width)?;
        let narrow_frame = layer("narrow_frame", pool.outputs())?;
        let refine_point = layer("refine_point", OWN + narrow_point.outputs())?;
        let network = Self {
            weigh_frame: bare("weigh_frame", pool.outputs())?,
            weigh: two(["weigh.1", "weigh.3"], weigh_point.outputs())?,
            refine_frame: bare("refine_frame", narrow_frame.outputs())?,
            refine: two(["refine.1", "refine.3"], refine_point.outputs())?,
            spread: two(["spread.0", "spread.2"], pool.outputs() + 5)?,
            encode,
            pool,
            weigh_point,
            narrow_point,
            narrow_frame,
            refine_point,
        };
        for (name, given, expected) in [
            ("weigh_frame", network.weigh_frame.outputs(), network.weigh_point.outputs()),
            ("weigh.3", network.weigh[1].outputs(), SAID),
            ("refine_frame", network.refine_frame.outputs(), network.refine_point.outputs()),
            ("refine.3", network.refine[1].outputs(), SAID),
            ("spread.2", network.spread[1].outputs(), 1),
        ] {
            if given != expected {
                return Err(NetworkError::Unlike {
                    tensor: format!("{prefix}{name}.weight"),
                    expected: format!("{expected} outputs"),
                    given: format!("{given}"),
                });
            }
        }
        Ok(network)
    }

    /// Numbers of a frame that smoothing sees.
    pub(super) fn context_len(&self) -> usize {
        self.narrow_frame.outputs()
    }

    /// The motion that a scan shows. Detections whose azimuth or range rate is not finite have no part in it.
    pub fn motion(&self, detections: &[Detection]) -> WeighedMotion {
        self.motion_near(detections, None)
    }

    /// The same, beginning with what is expected where detections do not speak against it.
    pub fn motion_near(&self, detections: &[Detection], near: Option<Near>) -> WeighedMotion {
        let usable: Vec<usize> = (0..detections.len())
            .filter(|i| {
                let d = &detections[*i];
                d.azimuth_rad.is_finite() && d.range_rate_mps.is_finite()
            })
            .collect();
        let seen: Vec<Detection> = usable.iter().map(|i| detections[*i]).collect();
        let mut motion = self.of_usable(&seen, near);
        for of_all in [&mut motion.weights, &mut motion.moves] {
            let of_usable = std::mem::replace(of_all, vec![0.0; detections.len()]);
            usable.iter().zip(of_usable).for_each(|(&i, value)| of_all[i] = value);
        }
        motion
    }

    /// The motion of detections that are all finite.
    fn of_usable(&self, detections: &[Detection], near: Option<Near>) -> WeighedMotion {
        let mut sights = Sights::default();
        for d in detections {
            let (sin, cos) = d.azimuth_rad.sin_cos();
            sights.cos.push(cos);
            sights.sin.push(sin);
            sights.rate.push(d.range_rate_mps);
        }
        let size = scale(&sights.rate);
        let (mut a, mut h) = (vec![], vec![]);
        self.encode[0].apply_rectified(&features(detections, &sights, size), &mut a);
        self.encode[1].apply_rectified(&a, &mut h);
        let mut g = vec![];
        self.pool.apply_rectified(&pooled(&h, self.encode[1].outputs()), &mut g);

        let mut frame = vec![];
        self.weigh_frame.apply(&g, &mut frame);
        self.weigh_point.apply(&h, &mut a);
        let mut out = two_layers(&self.weigh, &mut a, &frame);
        let (mut context, mut narrow) = (vec![], vec![]);
        self.narrow_frame.apply(&g, &mut context);
        self.narrow_point.apply(&h, &mut narrow);
        self.refine_frame.apply(&context, &mut frame);

        let mut inliers: Vec<f32> = vec![];
        let mut weights: Vec<f32> = vec![];
        let mut fitted = ([0.0; 2], [0.0; 3]);
        for round in 0..=REFINEMENTS {
            if round == 1 {
                let azimuths: Vec<f32> = detections.iter().map(|d| d.azimuth_rad).collect();
                fitted.0 = hypotheses::start(&sights, &azimuths, &inliers, fitted.0, near);
            }
            if round > 0 {
                let told = residuals(&sights, fitted.0, &inliers, size, &narrow);
                self.refine_point.apply(&told, &mut a);
                out = two_layers(&self.refine, &mut a, &frame);
            }
            inliers.clear();
            weights.clear();
            for [logit, precision, _] in out.as_chunks::<SAID>().0 {
                inliers.push(*logit);
                weights.push(*precision);
            }
            let [range, most] = [PRECISION_RANGE, TEMPER * PRECISION_RANGE].map(f32x4::splat);
            each(&mut inliers, sigmoid);
            each(&mut weights, |precision| (most * tanh(precision / range)).exp());
            weights.iter_mut().zip(&inliers).for_each(|(weight, inlier)| *weight *= inlier);
            fitted = sights.fit(&weights);
        }
        let mut moves: Vec<f32> = out.as_chunks::<SAID>().0.iter().map(|said| said[2]).collect();
        each(&mut moves, sigmoid);
        let (velocity, inverse) = fitted;
        let covariance = sights.equation_3(velocity, &inliers, &weights, inverse);
        let count = sum(&inliers);
        let share = count / (inliers.len() as f64).max(1.0);
        let squares: f64 = (0..inliers.len())
            .map(|i| f64::from(inliers[i]) * f64::from(sights.residual(i, velocity)).powi(2))
            .sum();
        let speed = (velocity[0] * velocity[0] + velocity[1] * velocity[1] + 1e-4).sqrt();
        g.extend([
            (squares / (count + 1e-3) + 1e-6).sqrt().ln() as f32,
            count.ln_1p() as f32,
            share as f32,
            (0.5 * (covariance[0] + covariance[2])).ln() as f32,
            speed / size,
        ]);
        self.spread[0].apply_rectified(&g, &mut a);
        self.spread[1].apply(&a, &mut frame);
        let log_factor = frame[0].clamp(FACTOR_RANGE[0], FACTOR_RANGE[1]);
        let factor = f64::from(log_factor);
        WeighedMotion {
            velocity_mps: velocity.map(f64::from),
            covariance: covariance.map(|term| term * (2.0 * factor).exp()),
            moves,
            weights: inliers,
            share,
            log_factor,
            context,
        }
    }
}

/// The 90 % quantile of range rates without sign, by nearest rank, or 1 m/s where that is less.
fn scale(rates: &[f32]) -> f32 {
    let mut speeds: Vec<f32> = rates.iter().map(|rate| rate.abs()).collect();
    if speeds.is_empty() {
        return 1.0;
    }
    let rank = (9 * speeds.len()).div_ceil(10) - 1;
    speeds.select_nth_unstable_by(rank, f32::total_cmp).1.max(1.0)
}

/// Nine numbers a detection.
fn features(detections: &[Detection], sights: &Sights, size: f32) -> Vec<f32> {
    let mut all = Vec::with_capacity(FEATURES * detections.len());
    for (i, d) in detections.iter().enumerate() {
        let rate = d.range_rate_mps / size;
        let known = |value: f32| if value.is_finite() { (value, 1.0) } else { (0.0, 0.0) };
        let ((range, has_range), (rcs, has_rcs)) = (known(d.range_m), known(d.rcs_dbsm));
        let range = range.max(0.0).ln_1p() / 5.0;
        let (sin, cos) = (sights.sin[i], sights.cos[i]);
        let rest = [range, rcs / 20.0, has_range, has_rcs, size / 30.0];
        all.extend([sin, cos, rate, rate.abs()]);
        all.extend(rest);
    }
    all
}

/// Mean and maximum over detections of encodings, which are not negative.
fn pooled(h: &[f32], width: usize) -> Vec<f32> {
    let (mut sums, mut most) = (vec![0.0_f64; width], vec![0.0_f32; width]);
    for row in h.chunks_exact(width.max(1)) {
        for (i, value) in row.iter().enumerate() {
            sums[i] += f64::from(*value);
            // Unlike `max`, which minds NaN, this is one instruction in WebAssembly.
            most[i] = if *value > most[i] { *value } else { most[i] };
        }
    }
    let count = ((h.len() / width.max(1)) as f64).max(1.0);
    let mut both: Vec<f32> = sums.into_iter().map(|sum| (sum / count) as f32).collect();
    both.extend(most);
    both
}

/// What belongs to detections and to the frame, added, rectified and through two layers.
fn two_layers(layers: &[Layer; 2], points: &mut [f32], frame: &[f32]) -> Vec<f32> {
    for row in points.chunks_exact_mut(frame.len().max(1)) {
        add(row, frame);
    }
    rectify(points);
    let (mut hidden, mut out) = (vec![], vec![]);
    layers[0].apply_rectified(points, &mut hidden);
    layers[1].apply(&hidden, &mut out);
    out
}

/// What a refinement sees of each detection.
fn residuals(
    sights: &Sights,
    velocity: [f32; 2],
    inliers: &[f32],
    size: f32,
    near: &[f32],
) -> Vec<f32> {
    let narrow = near.len() / sights.len().max(1);
    let mut told = Vec::with_capacity((OWN + narrow) * sights.len());
    let slopes: Vec<f32> = (0..sights.len()).map(|i| sights.slope(i, velocity)).collect();
    let mut off: Vec<f32> = (0..sights.len()).map(|i| sights.residual(i, velocity)).collect();
    let by_slope = |(residual, slope): (&f32, &f32)| {
        residual.abs() / (AZIMUTH_RAD * (slope + LEAST_SLOPE * size))
    };
    let mut across: Vec<f32> = off.iter().zip(&slopes).map(by_slope).collect();
    each(&mut off, |residual| asinh(residual / f32x4::splat(RESIDUAL_MPS)));
    each(&mut across, asinh);
    for (i, row) in near.chunks_exact(narrow.max(1)).enumerate() {
        told.extend([off[i], across[i], inliers[i], slopes[i] / size]);
        told.extend_from_slice(row);
    }
    told
}
