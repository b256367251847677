//! How far answers that call themselves converged are to be trusted, and how many there are: precision and recall as NVIDIA's
//! DriveWorks states them for its calibration of radars (short drives against a long reference; documentation of release 6.0).

use crate::whole::Answer;
use serde::Serialize;

/// An accepted angle counts as right within this, deg: the accuracy that DriveWorks asks for.
pub const PRECISION_DEG: f64 = 0.1;

/// Answers that call themselves converged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accepted {
    /// Share of them within [`PRECISION_DEG`], where there are any.
    pub precision: Option<f64>,
    /// Their share of all that could have answered, where there are any.
    pub recall: Option<f64>,
}

impl Accepted {
    /// Of answers whose errors are against the reference, and the number of drives that gave none.
    pub(super) fn of(answers: impl Iterator<Item = Answer>, without: usize) -> Self {
        let (mut all, mut accepted, mut right) = (without, 0_usize, 0_usize);
        for answer in answers {
            all += 1;
            accepted += usize::from(answer.converged);
            right += usize::from(answer.converged && answer.error_deg.abs() <= PRECISION_DEG);
        }
        let share = |part: usize, of: usize| (of > 0).then(|| part as f64 / of as f64);
        Self { precision: share(right, accepted), recall: share(accepted, all) }
    }

    /// As a cell of a table.
    pub(super) fn cell(&self) -> String {
        let share = |share: Option<f64>| {
            share.map_or("-".into(), |share| format!("{:.0} %", 100.0 * share))
        };
        format!("{}, {}", share(self.precision), share(self.recall))
    }
}

/// Share of errors within one and two standard deviations.
pub(super) fn within(errors: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
    let (mut one, mut two, mut all) = (0_usize, 0_usize, 0_usize);
    for (error, sigma) in errors {
        one += usize::from(error.abs() <= sigma);
        two += usize::from(error.abs() <= 2.0 * sigma);
        all += 1;
    }
    [one, two].map(|count| count as f64 / (all as f64).max(1.0))
}

pub(super) fn percent([one, two]: [f64; 2]) -> String {
    format!("{:.0} %, {:.0} %", 100.0 * one, 100.0 * two)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn precision_is_of_the_accepted_and_recall_of_all() {
        let answer = |error_deg, converged| Answer { error_deg, sigma_deg: 0.05, converged };
        let answers = [answer(0.09, true), answer(-0.2, true), answer(0.0, false)];
        let accepted = Accepted::of(answers.into_iter(), 1);
        assert_eq!((accepted.precision, accepted.recall), (Some(0.5), Some(0.5)));
        assert_eq!(accepted.cell(), "50 %, 50 %");
        assert_eq!(Accepted::of([].into_iter(), 0).cell(), "-, -");
        assert_eq!(Accepted::of([answer(0.0, false)].into_iter(), 0).cell(), "-, 0 %");
    }
}
