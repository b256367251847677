//! Where to begin: a vote of frames on the angle, one degree a bin.

use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

const BINS: usize = 360;
/// Votes within two degrees of the peak that settle it.
const ENOUGH: f64 = 12.0;

/// A circular histogram of the angles that frames give by themselves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Vote {
    bins: Vec<f64>,
    total: f64,
}

impl Vote {
    pub(crate) fn new() -> Self {
        Self { bins: vec![0.0; BINS], total: 0.0 }
    }

    /// Adds a frame's angle with a weight of 0 to 1.
    pub(crate) fn add(&mut self, angle_rad: f64, weight: f64) {
        let turn = ((angle_rad + PI) / TAU).rem_euclid(1.0);
        let bin = ((turn * BINS as f64) as usize).min(BINS - 1);
        self.bins[bin] += weight;
        self.total += weight;
    }

    /// Whether it has the bins that votes fall into.
    pub(crate) fn is_sound(&self) -> bool {
        self.bins.len() == BINS && self.bins.iter().all(|bin| bin.is_finite())
    }

    /// The angle most frames agree on, once enough do: the mean of the five bins around the peak,
    /// where they hold half of all votes.
    pub(crate) fn settled(&self) -> Option<f64> {
        let window = |centre: usize| (0..5).map(move |k| (centre + BINS + k - 2, k as f64 - 2.0));
        let votes =
            |centre: usize| -> f64 { window(centre).map(|(bin, _)| self.bins[bin % BINS]).sum() };
        let peak = (0..BINS).max_by(|&a, &b| votes(a).total_cmp(&votes(b)))?;
        let count = votes(peak);
        if count < ENOUGH || 2.0 * count < self.total {
            return None;
        }
        let mean: f64 =
            window(peak).map(|(bin, step)| step * self.bins[bin % BINS]).sum::<f64>() / count;
        let turn = (peak as f64 + 0.5 + mean) / BINS as f64;
        Some(turn * TAU - PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clear_majority_settles_it_also_across_the_wrap() {
        let mut vote = Vote::new();
        for k in 0..20 {
            vote.add(PI - 0.01 + 0.001 * f64::from(k), 1.0);
            assert_eq!(vote.settled().is_some(), k >= 11);
            vote.add(0.3 * f64::from(k), 0.3);
        }
        let angle = vote.settled().unwrap();
        assert!((angle - PI).abs() < 0.02 || (angle + PI).abs() < 0.02, "{angle}");
    }
}
