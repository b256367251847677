//! How often errors lie within their stated deviations.

use boresight_mounting::Told;
use std::fmt::{Display, Formatter};

/// Counts of errors within one and two deviations.
#[derive(Default)]
pub struct Tally {
    pub trials: f64,
    within: [f64; 2],
}

impl Tally {
    pub fn add(&mut self, deviations: f64) {
        self.trials += 1.0;
        for (within, most) in self.within.iter_mut().zip([1.0, 2.0]) {
            *within += if deviations.abs() < most { 1.0 } else { 0.0 };
        }
    }

    pub fn told(&mut self, told: Option<Told>, truth: f64) {
        let told = told.unwrap();
        self.add((told.value - truth) / told.sigma);
    }

    /// Shares, percent.
    pub fn shares(&self) -> [f64; 2] {
        self.within.map(|within| 100.0 * within / self.trials)
    }
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [one, two] = self.shares();
        write!(f, "{one:.1} and {two:.1} % within one and two")
    }
}
