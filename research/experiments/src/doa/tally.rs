//! Errors of angles, counted over the trials of a condition.

use serde::{Deserialize, Serialize};

/// Angles are the whole degrees up to this on either side.
pub const LARGEST_DEG: i32 = 10;
/// Deviations allowed to estimates rounded to whole degrees, deg.
pub const DEVIATIONS_DEG: [f64; 3] = [0.0, 2.0, 4.0];
/// Pairs nearer than this are close, deg.
pub const CLOSE_DEG: i32 = 4;
/// Far more than the conversion of an angle between radians and degrees rounds, and far less than any estimate is
/// worth, deg.
const ROUNDING_DEG: f64 = 1e-9;
/// Methods are told that targets are within this of boresight, rad (15 deg).
pub(super) const FIELD_OF_VIEW_RAD: f64 = 0.261_799_387_799_149_4;

/// Some trials of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DoaRecord {
    /// Index of the condition.
    pub condition: usize,
    /// Trials.
    pub trials: u32,
    /// Of which pairs closer than [`CLOSE_DEG`].
    pub close: u32,
    /// For each rule and counting network, how often it counted 0, 1, 2 and more targets.
    pub counted: Vec<[u32; 4]>,
    /// Methods and networks in order; none where there is no target, and nothing of networks that are for another
    /// number of targets.
    pub methods: Vec<Option<Tally>>,
}

/// What a method did.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Trials in which it gave as many angles as there are targets.
    pub found: u32,
    /// Sum over these of the squared errors, deg^2.
    pub squared_deg2: f64,
    /// The same of angles rounded to whole degrees.
    pub rounded_deg2: f64,
    /// Trials in which every angle was within 1 deg.
    pub success: u32,
    /// Trials in which every angle, rounded to a whole degree, was within [`DEVIATIONS_DEG`].
    pub within: [u32; 3],
    /// `success` and `within` of close pairs.
    pub close_success: u32,
    /// See `close_success`.
    pub close_within: [u32; 3],
}

impl Tally {
    pub(super) fn add(&mut self, other: &Self) {
        self.found += other.found;
        self.squared_deg2 += other.squared_deg2;
        self.rounded_deg2 += other.rounded_deg2;
        self.success += other.success;
        self.close_success += other.close_success;
        for k in 0..DEVIATIONS_DEG.len() {
            self.within[k] += other.within[k];
            self.close_within[k] += other.close_within[k];
        }
    }

    /// Counts a trial; both in ascending order.
    pub(super) fn count(&mut self, truth_deg: &[f64], found_rad: &[f64], close: bool) {
        let found_deg: Vec<f64> = found_rad.iter().map(|&azimuth| in_degrees(azimuth)).collect();
        let end = f64::from(LARGEST_DEG);
        let rounded_deg: Vec<f64> =
            found_deg.iter().map(|angle| angle.round().clamp(-end, end)).collect();
        let errors = |found: &[f64]| -> Vec<f64> {
            truth_deg.iter().zip(found).map(|(t, f)| (f - t).abs()).collect()
        };
        let largest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
        let squares = |errors: &[f64]| errors.iter().map(|error| error.powi(2)).sum::<f64>();
        let (exact, rounded) = (errors(&found_deg), errors(&rounded_deg));
        self.found += 1;
        self.squared_deg2 += squares(&exact);
        self.rounded_deg2 += squares(&rounded);
        let success = u32::from(largest(&exact) <= 1.0);
        self.success += success;
        self.close_success += success * u32::from(close);
        let rounded = largest(&rounded);
        for (k, &deviation) in DEVIATIONS_DEG.iter().enumerate() {
            let within = u32::from(rounded <= deviation);
            self.within[k] += within;
            self.close_within[k] += within * u32::from(close);
        }
    }
}

/// An angle in degrees, whole where it was a whole number of degrees before it was one of radians.
fn in_degrees(angle_rad: f64) -> f64 {
    let (degrees, whole) = (angle_rad.to_degrees(), angle_rad.to_degrees().round());
    if (degrees - whole).abs() < ROUNDING_DEG { whole } else { degrees }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_counted_exactly_and_rounded() {
        let mut tally = Tally::default();
        let mut count = |truth_deg: &[f64], found_deg: &[f64], close| {
            let found_rad: Vec<f64> =
                found_deg.iter().map(|degrees| degrees.to_radians()).collect();
            tally.count(truth_deg, &found_rad, close);
            tally
        };
        // Off by 0.4 and 0.1 deg; rounded they are right.
        let tally = count(&[-2.0, 1.0], &[-2.4, 1.1], true);
        assert_eq!((tally.success, tally.within, tally.close_within), (1, [1; 3], [1; 3]));
        assert!((tally.squared_deg2 - 0.17).abs() < 1e-12);
        assert!(tally.rounded_deg2 < 1e-12);
        // Beyond 10 deg there is no class: 12.4 counts as 10.
        let tally = count(&[-2.0, 9.0], &[-2.0, 12.4], false);
        assert_eq!((tally.success, tally.within), (1, [1, 2, 2]));
        assert!((tally.rounded_deg2 - 1.0).abs() < 1e-12);
        let tally = count(&[5.0], &[5.0 + 3.4], false);
        assert_eq!((tally.found, tally.within, tally.close_success), (3, [1, 2, 3], 1));
        let mut sum = Tally::default();
        sum.add(&tally);
        assert_eq!(sum, tally);
    }

    #[test]
    fn an_error_of_one_degree_is_within_one_degree() {
        let mut errors = 0;
        for truth in -LARGEST_DEG..=LARGEST_DEG {
            for found in [truth - 1, truth + 1] {
                if found.abs() <= LARGEST_DEG {
                    let mut tally = Tally::default();
                    let found = f64::from(found);
                    tally.count(&[f64::from(truth)], &[found.to_radians()], false);
                    assert_eq!((tally.success, tally.squared_deg2), (1, 1.0), "{truth} {found}");
                    errors += 1;
                }
            }
        }
        assert_eq!(errors, 40);
        let mut tally = Tally::default();
        tally.count(&[5.0], &[6.000_001_f64.to_radians()], false);
        assert_eq!(tally.success, 0);
    }
}
