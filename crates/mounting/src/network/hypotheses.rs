//! Where refinements start: the motion that most weight agrees on, of those that pairs of detections tell.
//!
//! A fit that trusts every weight a little is pulled far off by what moves, and refinements then start from a motion that
//! nothing agrees with. Pairs are drawn by weight, as in guided sampling (Brachmann and Rother 2019, Neural-guided
//! RANSAC), from a sequence that fills the square evenly (Roberts 2018, R2), so that the same frame has the same pairs.

use super::fit::Sights;
use boresight_math::order::ascending;
use wide::f32x4;

const DRAWS: usize = 48;
/// Residual from which a detection does not agree with a motion, m/s.
const CONSENSUS_MPS: f32 = 0.3;
/// Least sine of the angle between two lines of sight that tell a motion.
const LEAST_SINE: f32 = 0.01;
/// Of range rates, m/s, which order detections of the same azimuth, rad.
const TIE_BREAK: f64 = 1e-12;
/// Added to the deviation of where the motion is expected, m/s, and what a vote elsewhere still counts.
const NEAR_MPS: f32 = 0.1;
const ELSEWHERE: f32 = 0.2;
/// Of the sequence along each axis: `1/p` and `1/p^2`, with `p` the real root of `p^3 = p + 1`.
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// Where a radar's motion is expected, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// Velocity, m/s.
    pub velocity_mps: [f64; 2],
    /// Its deviation, m/s.
    pub sigma_mps: f64,
}

impl Near {
    /// What a vote for a velocity counts: all where it is expected.
    fn belief(self, [x, y]: [f32; 2]) -> f32 {
        let [ex, ey] = self.velocity_mps.map(|v| v as f32);
        let variance = (self.sigma_mps as f32).powi(2) + NEAR_MPS * NEAR_MPS;
        let squared = ((x - ex).powi(2) + (y - ey).powi(2)) / variance;
        ELSEWHERE + (1.0 - ELSEWHERE) * (-0.5 * squared).exp()
    }
}

/// Velocity that the most weight agrees on, fitted to what agrees. `azimuths` are those of the sights, `first` is taken
/// where no pair has more; votes `near` what is expected count more. The order of the detections does not matter.
pub(super) fn start(
    sights: &Sights,
    azimuths: &[f32],
    weights: &[f32],
    first: [f32; 2],
    near: Option<Near>,
) -> [f32; 2] {
    let place = |(azimuth, rate): (&f32, &f32)| f64::from(*azimuth) + TIE_BREAK * f64::from(*rate);
    let order = ascending(azimuths.iter().zip(&sights.rate).map(place));
    let mut total = 0.0;
    let filled: Vec<f64> = order
        .iter()
        .map(|&i| {
            total += f64::from(weights[i]);
            total
        })
        .collect();
    let at = |level: f64| {
        let rank = filled.partition_point(|sum| *sum <= level * total);
        order.get(rank.min(order.len().saturating_sub(1))).copied()
    };
    let counted = |velocity: [f32; 2]| {
        votes(sights, weights, velocity) * near.map_or(1.0, |near| near.belief(velocity))
    };
    let expected = near.map(|near| near.velocity_mps.map(|v| v as f32));
    let drawn = (1..=DRAWS).filter_map(|draw| {
        let [one, other] = STEPS.map(|step| at((0.5 + draw as f64 * step).fract()));
        one.zip(other).and_then(|(i, k)| of_pair(sights, i, k))
    });
    let mut best = (counted(first), first);
    for velocity in expected.into_iter().chain(drawn) {
        let sum = counted(velocity);
        if sum > best.0 {
            best = (sum, velocity);
        }
    }
    let agreeing: Vec<f32> = weights
        .iter()
        .enumerate()
        .map(|(i, weight)| {
            let off = sights.residual(i, best.1) / CONSENSUS_MPS;
            weight * (1.0 - off * off).max(0.0)
        })
        .collect();
    sights.fit(&agreeing).0
}

/// The velocity that two detections tell.
fn of_pair(sights: &Sights, i: usize, k: usize) -> Option<[f32; 2]> {
    let (ci, si, ri) = (sights.cos[i], sights.sin[i], sights.rate[i]);
    let (ck, sk, rk) = (sights.cos[k], sights.sin[k], sights.rate[k]);
    let cross = ci * sk - ck * si;
    (cross.abs() > LEAST_SINE).then(|| [(si * rk - sk * ri) / cross, (ck * ri - ci * rk) / cross])
}

/// Weight that agrees with a velocity: all of a detection's without a residual, none from [`CONSENSUS_MPS`] on.
fn votes(sights: &Sights, weights: &[f32], [x, y]: [f32; 2]) -> f32 {
    let (vx, vy) = (f32x4::splat(x), f32x4::splat(y));
    let scale = f32x4::splat(1.0 / (CONSENSUS_MPS * CONSENSUS_MPS));
    let (cos, cos_rest) = sights.cos.as_chunks::<4>();
    let (sin, _) = sights.sin.as_chunks::<4>();
    let (rate, _) = sights.rate.as_chunks::<4>();
    let (weight, _) = weights.as_chunks::<4>();
    let mut sum = f32x4::ZERO;
    for (((cos, sin), rate), weight) in cos.iter().zip(sin).zip(rate).zip(weight) {
        let residual = f32x4::from(*rate) + vx * f32x4::from(*cos) + vy * f32x4::from(*sin);
        let share = (f32x4::ONE - residual * residual * scale).max(f32x4::ZERO);
        sum += f32x4::from(*weight) * share;
    }
    let mut sum = sum.reduce_add();
    for i in sights.len() - cos_rest.len()..sights.len() {
        let residual = sights.residual(i, [x, y]);
        let share = (1.0 - residual * residual / (CONSENSUS_MPS * CONSENSUS_MPS)).max(0.0);
        sum += weights[i] * share;
    }
    sum
}
