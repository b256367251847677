//! How far estimates are from the targets they are of.

use boresight_aoa::Source;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64};
use boresight_math::decibels::{db_to_power, power_to_db};
use boresight_simulate::Target;
use serde::{Deserialize, Serialize};

/// Sums over the targets of some snapshots.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Deviation {
    /// Snapshots.
    pub snapshots: u32,
    /// Targets.
    pub targets: u32,
    /// Targets with an estimate of their own.
    pub found: u32,
    /// Estimates that are of no target.
    pub false_targets: u32,
    /// Sum of squared errors of azimuth of what was found, deg^2.
    pub squared_error_deg2: f64,
    /// Largest of these errors, deg.
    pub largest_error_deg: f64,
    /// Gain of a beam steered to the estimate over that of one steered to the target.
    pub beam: Ratios,
    /// Power of the estimate over that of the target.
    pub power: Ratios,
}

/// Ratios of powers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Ratios {
    sum: f64,
    sum_db: f64,
    /// At most one.
    least: f64,
}

/// Least ratio in the sum of decibels.
const LEAST_RATIO: f64 = 1e-12;

impl Default for Ratios {
    fn default() -> Self {
        Self { sum: 0.0, sum_db: 0.0, least: 1.0 }
    }
}

impl Ratios {
    fn add(&mut self, ratio: f64) {
        self.sum += ratio;
        self.sum_db += power_to_db(ratio.max(LEAST_RATIO));
        self.least = self.least.min(ratio);
    }
}

impl Deviation {
    /// Adds a snapshot. An estimate and a target go together if they are each other's nearest, of those that are
    /// left, and within `within_rad` of each other.
    pub fn add(&mut self, array: &Array, truth: &[Target], sources: &[Source], within_rad: f64) {
        self.snapshots += 1;
        self.targets += truth.len() as u32;
        let mut targets: Vec<&Target> = truth.iter().collect();
        let mut left: Vec<&Source> = sources.iter().collect();
        let apart = |t: &Target, s: &Source| t.direction.azimuth_rad - s.direction.azimuth_rad;
        loop {
            let pairs = targets.iter().enumerate().flat_map(|(t, target)| {
                left.iter().enumerate().map(move |(s, source)| (apart(target, source), t, s))
            });
            let nearest = pairs.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
            let Some((error, t, s)) = nearest.filter(|(error, ..)| error.abs() <= within_rad)
            else {
                break;
            };
            self.found(array, targets.swap_remove(t), left.swap_remove(s), error.to_degrees());
        }
        self.false_targets += left.len() as u32;
    }

    fn found(&mut self, array: &Array, target: &Target, source: &Source, error_deg: f64) {
        self.found += 1;
        self.squared_error_deg2 += error_deg * error_deg;
        self.largest_error_deg = self.largest_error_deg.max(error_deg.abs());
        let [a, b] = [target.direction, source.direction].map(|at| steering_vector(array, *at));
        let sum: Complex64 = a.iter().zip(&b).map(|(a, b)| a * b.conj()).sum();
        self.beam.add((sum / array.len() as f64).norm_sqr());
        self.power.add(source.power / db_to_power(target.power_db));
    }

    /// Adds those of other snapshots.
    pub fn merge(&mut self, other: &Self) {
        self.snapshots += other.snapshots;
        self.targets += other.targets;
        self.found += other.found;
        self.false_targets += other.false_targets;
        self.squared_error_deg2 += other.squared_error_deg2;
        self.largest_error_deg = self.largest_error_deg.max(other.largest_error_deg);
        for (to, from) in [(&mut self.beam, other.beam), (&mut self.power, other.power)] {
            *to = Ratios {
                sum: to.sum + from.sum,
                sum_db: to.sum_db + from.sum_db,
                least: to.least.min(from.least),
            };
        }
    }

    /// Share of targets found.
    pub fn share_found(&self) -> f64 {
        f64::from(self.found) / f64::from(self.targets)
    }

    /// False targets a snapshot.
    pub fn false_rate(&self) -> f64 {
        f64::from(self.false_targets) / f64::from(self.snapshots)
    }

    /// Root mean square error of azimuth of what was found, deg.
    pub fn rms_error_deg(&self) -> f64 {
        (self.squared_error_deg2 / f64::from(self.found)).sqrt()
    }

    /// What is lost of the power by steering to the estimates, in the mean over what was found, dB.
    pub fn beam_loss_db(&self) -> f64 {
        -power_to_db(self.beam.sum / f64::from(self.found))
    }

    /// Mean over what was found of what the estimated power lacks of the true one in decibels.
    pub fn power_loss_db(&self) -> f64 {
        -self.power.sum_db / f64::from(self.found)
    }
}

impl Ratios {
    /// Largest loss, dB; 0 where all gained.
    pub fn largest_loss_db(self) -> f64 {
        -power_to_db(self.least) + 0.0
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_core::Direction;

    fn target(azimuth_deg: f64, power_db: f64) -> Target {
        let direction = Direction::azimuth(azimuth_deg.to_radians());
        Target { direction: direction.into(), power_db, ..Target::default() }
    }

    fn source(azimuth_deg: f64, power: f64) -> Source {
        let direction = Direction::azimuth(azimuth_deg.to_radians());
        Source::new(direction, power)
    }

    #[test]
    fn targets_take_the_nearest_estimate_that_is_left() {
        let array = Array::ula(8).unwrap();
        let mut sum = Deviation::default();
        let truth = [target(0.0, 0.0), target(1.0, -10.0)];
        let found = [source(0.4, 0.5), source(0.8, 0.1), source(40.0, 1.0)];
        sum.add(&array, &truth, &found, 1_f64.to_radians());
        assert_eq!((sum.snapshots, sum.targets, sum.found, sum.false_targets), (1, 2, 2, 1));
        assert!((sum.squared_error_deg2 - 0.2).abs() < 1e-9);
        assert!((sum.largest_error_deg - 0.4).abs() < 1e-9);
        assert!((sum.power_loss_db() - 0.5 * 3.0103).abs() < 1e-4);
        assert!((sum.power.largest_loss_db() - 3.0103).abs() < 1e-4);
        // Nothing within reach; and sums of both.
        let mut other = Deviation::default();
        other.add(&array, &truth[..1], &found[2..], 1_f64.to_radians());
        assert_eq!((other.found, other.false_targets), (0, 1));
        sum.merge(&other);
        assert_eq!((sum.targets, sum.found, sum.false_targets), (3, 2, 2));
        assert_eq!(sum.share_found(), 2.0 / 3.0);
    }

    /// A beam half its width off loses 3 dB: 0.886 / 8 of a wavelength over half the spacing is 12.8 deg for eight
    /// elements.
    #[test]
    fn a_beam_half_its_width_off_loses_three_decibels() {
        let array = Array::ula(8).unwrap();
        let mut sum = Deviation::default();
        sum.add(&array, &[target(0.0, 0.0)], &[source(6.4, 1.0)], f64::INFINITY);
        assert!((sum.beam_loss_db() - 3.0).abs() < 0.1, "{sum:?}");
    }
}
