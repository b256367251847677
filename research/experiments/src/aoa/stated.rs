//! Whether the deviations that a network states are those of its errors.

use super::score::Point;
use boresight_aoa::Source;
use boresight_math::decibels::power_to_db;
use serde::{Deserialize, Serialize};

/// How many right predictions there are that state deviations, and how many err by less than one and two of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Stated {
    /// Predictions near enough to a target to be right.
    pub predictions: u32,
    /// Of these, those whose azimuth errs by less than one and two deviations.
    pub azimuth: [u32; 2],
    /// The same of the power.
    pub power: [u32; 2],
}

impl Stated {
    /// Adds a prediction, if it states deviations and is right: off by an error at most, rad.
    pub fn add(&mut self, within_rad: f64, truth: &[Point], source: &Source) {
        let azimuth_rad = source.direction.azimuth_rad;
        let distance = |target: &&Point| (target.azimuth_rad - azimuth_rad).abs();
        let nearest = truth.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let (Some(stated), Some(target)) = (source.deviation, nearest) else { return };
        let angle = distance(&target);
        if angle > within_rad {
            return;
        }
        let level = (power_to_db(source.power) - target.power_db).abs();
        self.predictions += 1;
        for (k, times) in [1.0, 2.0].into_iter().enumerate() {
            self.azimuth[k] += u32::from(angle <= times * stated.azimuth_rad);
            self.power[k] += u32::from(level <= times * stated.power_db);
        }
    }

    /// Adds others.
    pub fn merge(&mut self, other: &Self) {
        self.predictions += other.predictions;
        for k in 0..2 {
            self.azimuth[k] += other.azimuth[k];
            self.power[k] += other.power[k];
        }
    }

    /// Shares of azimuths and powers within one and two deviations, %.
    pub fn shown(&self) -> [String; 2] {
        [self.azimuth, self.power].map(|within| {
            let share = |n: u32| 100.0 * f64::from(n) / f64::from(self.predictions.max(1));
            let [one, two] = within.map(share);
            format!("{one:.1} / {two:.1}")
        })
    }

    /// Whether nothing stated deviations.
    pub fn is_empty(&self) -> bool {
        self.predictions == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_aoa::Deviation;
    use boresight_core::Direction;

    const HALF_A_DEGREE: f64 = 0.0087;

    #[test]
    fn right_predictions_with_deviations_count() {
        let truth = [(0.1, -3.0), (0.2, 0.0)]
            .map(|(azimuth_rad, power_db)| Point { azimuth_rad, power_db });
        let deviation = Some(Deviation { azimuth_rad: 1e-3, power_db: 1.0 });
        let source = |azimuth_rad: f64, power_db: f64| Source {
            deviation,
            ..Source::new(Direction::azimuth(azimuth_rad), 10f64.powf(power_db / 10.0))
        };
        let mut stated = Stated::default();
        stated.add(HALF_A_DEGREE, &truth, &Source { deviation: None, ..source(0.1, -3.0) });
        stated.add(HALF_A_DEGREE, &truth, &source(0.3, 0.0));
        stated.add(HALF_A_DEGREE, &[], &source(0.1, -3.0));
        assert!(stated.is_empty());
        // By 0.5 and 0.2 deviations, 1.5 and 0.9, 2.5 and 3.
        stated.add(HALF_A_DEGREE, &truth, &source(0.1005, -3.2));
        stated.add(HALF_A_DEGREE, &truth, &source(0.1985, 0.9));
        stated.add(HALF_A_DEGREE, &truth, &source(0.0975, -6.0));
        assert_eq!(stated, Stated { predictions: 3, azimuth: [1, 2], power: [2, 2] });
        assert_eq!(stated.shown(), ["33.3 / 66.7", "66.7 / 66.7"]);
        let mut twice = stated;
        twice.merge(&stated);
        assert_eq!(twice, Stated { predictions: 6, azimuth: [2, 4], power: [4, 4] });
    }
}
