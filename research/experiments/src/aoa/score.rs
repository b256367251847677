//! Scores of detections against true targets, at every threshold at once: on power, or on the confidence of a
//! network, as the AAETR paper does.
//!
//! A prediction within half a degree of a true target is right, else it is false; a target with such a
//! prediction is found. Precision is right over all predictions, recall found over all targets. The strict
//! score matches one to one: of two predictions on one target one is false. Whether a prediction is
//! right does not depend on the threshold, and neither does the matching where predictions are taken in
//! order of what the threshold is on; so histograms over that are enough.

use serde::{Deserialize, Serialize};

/// Half width of a hit, rad (0.5 deg).
pub const WITHIN_RAD: f64 = 0.008_726_646_259_971_648;
/// Width of a bin, dB, and number of bins downwards from the highest threshold.
const STEP_DB: f64 = 0.25;
const BINS: usize = 280;

/// What the threshold is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Threshold {
    /// Power, dB.
    #[default]
    Power,
    /// The odds of a confidence, dB.
    Confidence,
}

impl Threshold {
    /// The highest, dB.
    fn top_db(self) -> f64 {
        match self {
            Self::Power => 10.0,
            Self::Confidence => 35.0,
        }
    }

    fn is_power(&self) -> bool {
        *self == Self::Power
    }
}

/// Odds of a confidence, dB.
pub fn odds_db(confidence: f64) -> f64 {
    10.0 * (confidence / (1.0 - confidence)).log10()
}

/// A direction with its power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Azimuth, rad.
    pub azimuth_rad: f64,
    /// Power at one element, dB.
    pub power_db: f64,
}

/// A target that is claimed to be there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// The target.
    pub point: Point,
    /// What the threshold is on, dB.
    pub level_db: f64,
}

/// Histograms over levels of what became of predictions and targets; bin 0 holds the highest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// What the levels are.
    #[serde(default, skip_serializing_if = "Threshold::is_power")]
    pub threshold: Threshold,
    /// True targets.
    pub targets: u32,
    right: Vec<u32>,
    wrong: Vec<u32>,
    found: Vec<u32>,
    matched: Vec<u32>,
    /// Sums over right predictions of their distance from the nearest target, deg and dB.
    angle_deg: Vec<f64>,
    power_db: Vec<f64>,
}

/// A point of a precision-recall curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Operating {
    /// Threshold on power, or on the odds of the confidence, dB.
    pub threshold_db: f64,
    /// Right over all predictions.
    pub precision: f64,
    /// Found over all targets.
    pub recall: f64,
    /// Their harmonic mean.
    pub f1: f64,
    /// The same with one prediction a target.
    pub strict_f1: f64,
    /// Mean distance of right predictions from the nearest target, deg and dB.
    pub angle_error_deg: f64,
    /// See `angle_error_deg`.
    pub power_error_db: f64,
}

impl Score {
    /// Of nothing yet.
    pub fn new(threshold: Threshold) -> Self {
        let zeros = vec![0; BINS];
        Self {
            threshold,
            targets: 0,
            right: zeros.clone(),
            wrong: zeros.clone(),
            found: zeros.clone(),
            matched: zeros,
            angle_deg: vec![0.0; BINS],
            power_db: vec![0.0; BINS],
        }
    }

    /// Adds a scene, where half a degree is right. Predictions that are no numbers are false at every threshold.
    pub fn add(&mut self, truth: &[Point], predictions: &[Prediction]) {
        self.add_within(WITHIN_RAD, truth, predictions);
    }

    /// The same, where another error is right, rad.
    pub fn add_within(&mut self, within_rad: f64, truth: &[Point], predictions: &[Prediction]) {
        self.targets += truth.len() as u32;
        let mut order: Vec<&Prediction> = predictions.iter().collect();
        order.sort_by(|a, b| b.level_db.total_cmp(&a.level_db));
        let mut taken = vec![false; truth.len()];
        let mut found = vec![false; truth.len()];
        let top_db = self.threshold.top_db();
        for Prediction { point: prediction, level_db } in order {
            let bin = bin(top_db - level_db);
            let near = |target: &Point| (target.azimuth_rad - prediction.azimuth_rad).abs();
            let mut nearest: Option<(f64, &Point)> = None;
            let mut free: Option<(f64, usize)> = None;
            for (index, target) in truth.iter().enumerate() {
                let distance = near(target);
                if distance <= within_rad {
                    if nearest.is_none_or(|(best, _)| distance < best) {
                        nearest = Some((distance, target));
                    }
                    if !taken[index] && free.is_none_or(|(best, _)| distance < best) {
                        free = Some((distance, index));
                    }
                    if !found[index] {
                        found[index] = true;
                        self.found[bin] += 1;
                    }
                }
            }
            match nearest {
                Some((distance, target)) => {
                    self.right[bin] += 1;
                    self.angle_deg[bin] += distance.to_degrees();
                    self.power_db[bin] += (prediction.power_db - target.power_db).abs();
                }
                None => self.wrong[bin] += 1,
            }
            if let Some((_, index)) = free {
                taken[index] = true;
                self.matched[bin] += 1;
            }
        }
    }

    /// Adds the scenes of another score with its threshold on the same.
    pub fn merge(&mut self, other: &Self) {
        fn add<T: Copy + std::ops::AddAssign>(to: &mut [T], from: &[T]) {
            for (to, from) in to.iter_mut().zip(from) {
                *to += *from;
            }
        }
        self.targets += other.targets;
        add(&mut self.right, &other.right);
        add(&mut self.wrong, &other.wrong);
        add(&mut self.found, &other.found);
        add(&mut self.matched, &other.matched);
        add(&mut self.angle_deg, &other.angle_deg);
        add(&mut self.power_db, &other.power_db);
    }

    /// Precision and recall at every threshold with predictions, from high to low.
    pub fn curve(&self) -> Vec<Operating> {
        let (mut right, mut wrong, mut found, mut matched) = (0.0, 0.0, 0.0, 0.0);
        let (mut angle, mut power) = (0.0, 0.0);
        let targets = f64::from(self.targets).max(1.0);
        let mut curve = vec![];
        for bin in 0..BINS {
            let new = self.right[bin] + self.wrong[bin];
            right += f64::from(self.right[bin]);
            wrong += f64::from(self.wrong[bin]);
            found += f64::from(self.found[bin]);
            matched += f64::from(self.matched[bin]);
            angle += self.angle_deg[bin];
            power += self.power_db[bin];
            if new > 0 {
                let all: f64 = right + wrong;
                let mean = |hits: f64, recalled: f64| 2.0 * hits * recalled / (hits + recalled);
                let (precision, recall) = (right / all, found / targets);
                let (strict_precision, strict_recall) = (matched / all, matched / targets);
                let f1 = if found > 0.0 { mean(precision, recall) } else { 0.0 };
                let strict =
                    if matched > 0.0 { mean(strict_precision, strict_recall) } else { 0.0 };
                curve.push(Operating {
                    threshold_db: self.threshold.top_db() - STEP_DB * (bin as f64 + 1.0),
                    precision,
                    recall,
                    f1,
                    strict_f1: strict,
                    angle_error_deg: angle / right.max(1.0),
                    power_error_db: power / right.max(1.0),
                });
            }
        }
        curve
    }

    /// The point of the largest F1; `None` without predictions.
    pub fn best(&self) -> Option<Operating> {
        self.curve().into_iter().max_by(|a, b| a.f1.total_cmp(&b.f1))
    }
}

/// The point of a curve at a threshold; `None` where there are no predictions above it.
pub fn point_at(curve: &[Operating], threshold_db: f64) -> Option<Operating> {
    let above = curve.partition_point(|point| point.threshold_db >= threshold_db);
    above.checked_sub(1).and_then(|last| curve.get(last)).copied()
}

/// The threshold, the same for all of some scores, at which the mean of their F1 is largest, the highest of equal
/// ones; `None` without predictions.
pub fn one_threshold_db(scores: &[Score]) -> Option<f64> {
    let curves: Vec<Vec<Operating>> = scores.iter().map(Score::curve).collect();
    let mut all: Vec<f64> = curves.iter().flatten().map(|point| point.threshold_db).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    let mut best: Option<(f64, f64)> = None;
    for threshold_db in all {
        let f1 = |curve: &Vec<_>| point_at(curve, threshold_db).map_or(0.0, |point| point.f1);
        let sum: f64 = curves.iter().map(f1).sum();
        if best.is_none_or(|(_, largest)| sum > largest) {
            best = Some((threshold_db, sum));
        }
    }
    best.map(|(threshold_db, _)| threshold_db)
}

/// Bin of a level that far below the highest; what is no number counts as the highest.
fn bin(below_db: f64) -> usize {
    ((below_db / STEP_DB).floor().max(0.0) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn at(azimuth_deg: f64, power_db: f64) -> Point {
        Point { azimuth_rad: azimuth_deg.to_radians(), power_db }
    }

    /// With the threshold on power.
    fn claimed(points: &[Point]) -> Vec<Prediction> {
        points.iter().map(|&point| Prediction { point, level_db: point.power_db }).collect()
    }

    #[test]
    fn two_predictions_on_one_target_are_right_twice_and_strictly_once() {
        let mut score = Score::new(Threshold::Power);
        let truth = [at(10.0, 0.0), at(20.0, -5.0)];
        score.add(&truth, &claimed(&[at(10.3, -0.1), at(9.8, -3.1), at(-40.0, -8.1)]));
        let curve = score.curve();
        assert_eq!(curve.len(), 3);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
        close(curve[0].precision, 1.0);
        close(curve[0].recall, 0.5);
        close(curve[0].angle_error_deg, 0.3);
        close(curve[0].power_error_db, 0.1);
        close(curve[1].precision, 1.0);
        close(curve[1].f1, 2.0 / 3.0);
        // One of two predictions, one of two targets.
        close(curve[1].strict_f1, 0.5);
        close(curve[2].precision, 2.0 / 3.0);
        let best = score.best().unwrap();
        close(best.f1, 2.0 / 3.0);
    }

    #[test]
    fn merging_is_adding_and_nothing_makes_no_curve() {
        let empty = || Score::new(Threshold::Power);
        let (mut a, mut b, mut both) = (empty(), empty(), empty());
        for (k, score) in [&mut a, &mut b].into_iter().enumerate() {
            let truth = [at(5.0 * k as f64, -1.0)];
            let found = [at(5.1 * k as f64, -1.2), at(30.0, f64::NAN), at(1.0, -300.0)];
            score.add(&truth, &claimed(&found));
            both.add(&truth, &claimed(&found));
        }
        a.merge(&b);
        assert_eq!(a, both);
        assert!(empty().best().is_none());
    }
    #[test]
    fn one_threshold_is_the_best_on_average_and_not_of_one_score() {
        // The first score is best at -5.25 dB, where the second has a false prediction for each right one; both are at
        // -3.25 dB, if the first one misses a target of four.
        let (mut a, mut b) = (Score::new(Threshold::Power), Score::new(Threshold::Power));
        let right = [at(0.0, -1.1), at(10.0, -2.1), at(20.0, -3.1), at(30.0, -5.1)];
        a.add(&right, &claimed(&right));
        let wrong = [at(-30.0, -4.1), at(-40.0, -4.1)];
        b.add(&right[..2], &claimed(&[&right[..2], &wrong].concat()));
        assert_eq!(a.best().unwrap().threshold_db, -5.25);
        assert_eq!(one_threshold_db(&[a.clone(), b.clone()]), Some(-3.25));
        let at = |score: &Score, threshold_db| point_at(&score.curve(), threshold_db);
        assert_eq!(at(&a, -3.25).unwrap().recall, 0.75);
        // Between the points of a curve it is the one before.
        let precision = |threshold_db| at(&b, threshold_db).unwrap().precision;
        assert_eq!((precision(-3.25), precision(-4.25)), (1.0, 0.5));
        assert!(at(&a, -1.0).is_none());
        assert_eq!(one_threshold_db(&[]), None);
    }

    #[test]
    fn confidence_decides_where_the_threshold_is_on_it() {
        let mut score = Score::new(Threshold::Confidence);
        // The stronger prediction is the less confident one, and wrong.
        let of = |point, confidence| Prediction { point, level_db: odds_db(confidence) };
        score.add(&[at(10.0, -5.0)], &[of(at(-30.0, 0.0), 0.2), of(at(10.1, -5.0), 0.9)]);
        let curve = score.curve();
        assert_eq!((curve[0].precision, curve[1].precision), (1.0, 0.5));
        assert!((curve[0].threshold_db - odds_db(0.9)).abs() <= STEP_DB);
        // Certainty is within the range.
        score.add(&[], &[of(at(0.0, 0.0), 1.0), of(at(0.0, 0.0), 0.0)]);
        assert_eq!(score.curve().last().unwrap().precision, 0.25);
    }
}
