//! One radar's equations of one drive, parted into what they say of the angle and the rest.

use super::{CAR, CarMatrix, CarVector};
use crate::equations::NormalEquations;
use crate::recursive::information::Vector;
use boresight_math::linalg::small::{inverse, times};

/// Equations about the vehicle's reference. The angle as the drive alone has it, `value = angle + slopes . car`, is known with
/// variance `own`; what is left of the equations once the angle is eliminated is independent of that, and of any error of the drive's angle.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Which angle.
    pub(super) angle: usize,
    pub(super) value: f64,
    pub(super) slopes: CarVector,
    /// Infinite where the equations say nothing of the angle.
    own: f64,
    /// Variance that doubts about the drive add.
    doubt: f64,
    pub(super) rest: CarMatrix,
    pub(super) rest_right: CarVector,
    /// What the part counts for.
    pub(super) weight: f64,
}

impl Part {
    /// From equations about `reference`; `moved` is theirs less that. None where they lead beyond what numbers hold, or
    /// are not those of any observations.
    pub(super) fn new(angle: usize, equations: &NormalEquations, moved: &Vector) -> Option<Self> {
        let n = equations.matrix();
        let shift = times(&n, moved);
        let y: Vector = std::array::from_fn(|i| equations.right[i] + shift[i]);
        let mut whole = n;
        for (i, known) in equations.prior_information.iter().enumerate() {
            whole[i][i] += known;
        }
        inverse(&whole)?;
        let own = 1.0 / n[0][0];
        let (value, slopes) = if own.is_finite() {
            (own * y[0], std::array::from_fn(|i| own * n[0][i + 1]))
        } else {
            (0.0, [0.0; CAR])
        };
        let rest: CarMatrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| n[i + 1][j + 1] - n[0][i + 1] * slopes[j])
        });
        let rest_right: CarVector = std::array::from_fn(|i| y[i + 1] - n[0][i + 1] * value);
        let doubt = equations.doubt_rad * equations.doubt_rad;
        let parts = [&[value, doubt][..], &slopes, &rest_right, rest.as_flattened()];
        let sound = parts.into_iter().flatten().all(|number| number.is_finite());
        sound.then_some(Self { angle, value, slopes, own, doubt, rest, rest_right, weight: 1.0 })
    }

    /// Whether it says anything of the angle.
    pub(super) fn tells(&self) -> bool {
        self.own.is_finite()
    }

    /// Variance of `value` about the vehicle's angle, where drives' angles have this one of their own.
    pub(super) fn variance(&self, of_drive: f64) -> f64 {
        self.own + self.doubt + of_drive
    }
}
