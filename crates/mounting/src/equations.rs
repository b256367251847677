//! What a drive says of the unknowns that drives share, to put together with other drives.

use crate::recursive::Recursive;
use crate::recursive::information::UNKNOWNS;
use serde::{Deserialize, Serialize};

/// Normal equations `information (x - reference) = right` of one radar in one drive, without the prior. The unknowns `x` are, in this order,
/// mounting angle (rad), inverse scale of the yaw rate, bias times inverse scale (rad/s), slip gradient (rad per m/s^2) and delay (s).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct NormalEquations {
    /// What the equations are written about.
    pub reference: [f64; UNKNOWNS],
    /// Upper triangle of the matrix, row by row. What lasts from frame to frame, and how much of it, is accounted for.
    pub information: [f64; UNKNOWNS * (UNKNOWNS + 1) / 2],
    /// Right-hand side.
    pub right: [f64; UNKNOWNS],
    /// Means of the prior.
    pub prior: [f64; UNKNOWNS],
    /// Inverse variances of the prior; of the bias what standstill told is in it.
    pub prior_information: [f64; UNKNOWNS],
    /// Standard deviation of what no drive tells from the angle and all drives share, rad.
    pub floor_rad: f64,
    /// Standard deviation that doubts about this drive add to its angle, rad.
    pub doubt_rad: f64,
}

impl Recursive {
    /// What the frames so far say, for [`crate::merge_drives`]; 37 numbers, where [`Recursive::snapshot`] also has what it takes to go on.
    pub fn normal_equations(&self) -> NormalEquations {
        let known = self.information();
        let (n, right) = known.tempered();
        let (prior, prior_information) = known.prior();
        let (floor_rad, doubt_rad) = self.beyond_rad(&known);
        let mut information = [0.0; UNKNOWNS * (UNKNOWNS + 1) / 2];
        let upper = (0..UNKNOWNS).flat_map(|i| (i..UNKNOWNS).map(move |j| (i, j)));
        for (entry, (i, j)) in information.iter_mut().zip(upper) {
            *entry = n[i][j];
        }
        NormalEquations {
            reference: *known.reference(),
            information,
            right,
            prior: *prior,
            prior_information: *prior_information,
            floor_rad,
            doubt_rad,
        }
    }
}

impl NormalEquations {
    /// The matrix as a whole.
    pub fn matrix(&self) -> [[f64; UNKNOWNS]; UNKNOWNS] {
        let mut n = [[0.0; UNKNOWNS]; UNKNOWNS];
        let upper = (0..UNKNOWNS).flat_map(|i| (i..UNKNOWNS).map(move |j| (i, j)));
        for (entry, (i, j)) in self.information.iter().zip(upper) {
            n[i][j] = *entry;
            n[j][i] = *entry;
        }
        n
    }

    /// Whether its numbers are such as drives lead to.
    pub fn is_sound(&self) -> bool {
        let numbers = [&self.reference[..], &self.information, &self.right, &self.prior];
        numbers.into_iter().flatten().all(|number| number.is_finite())
            && self.prior_information.iter().all(|weight| *weight > 0.0 && weight.is_finite())
            && (0..UNKNOWNS).all(|i| self.matrix()[i][i] >= 0.0)
            && [self.floor_rad, self.doubt_rad]
                .iter()
                .all(|sigma| *sigma >= 0.0 && sigma.is_finite())
    }
}
