//! One radar's angle from several drives.

use crate::recursive::information::{Matrix, UNKNOWNS, Vector};
use crate::small::{inverse, times};
use crate::{AngleEstimate, CalibrateError, Recursive};
use boresight_core::CoreError;

/// Place of the bias among the unknowns: it is another in each drive.
const BIAS: usize = 2;
/// Unknowns that the drives share: angle, inverse scale, slip gradient, delay.
const SHARED: [usize; UNKNOWNS - 1] = [0, 1, 3, 4];

type SharedVector = [f64; SHARED.len()];
type SharedMatrix = [[f64; SHARED.len()]; SHARED.len()];

/// The angle from several drives with one radar of one car, each as its calibration left it. Angle, scale, slip and delay are taken to be the
/// same in all drives; each has a bias of the yaw rate of its own. Counts are added up.
///
/// # Errors
/// [`CoreError::Empty`] without drives, [`CalibrateError::UnlikeSnapshots`] where radars are mounted at different places.
pub fn merge(drives: &[Recursive]) -> Result<AngleEstimate, CalibrateError> {
    let Some((first, others)) = drives.split_first() else {
        return Err(CoreError::Empty {
            what: "snapshots".into(),
            expected: "one of each drive".into(),
        }
        .into());
    };
    let place = |drive: &Recursive| {
        let o = drive.options();
        [("xM", o.x_m), ("yM", o.y_m)]
    };
    let mut whole = first.clone();
    for other in others {
        for ((what, expected), (_, given)) in place(first).into_iter().zip(place(other)) {
            if expected != given {
                return Err(CalibrateError::UnlikeSnapshots { what, expected, given });
            }
        }
        whole.absorb(other);
    }
    let known = first.information();
    let reference = *known.reference();
    let (mean, inverse_variance) = known.prior();
    let (mut total, mut right): (SharedMatrix, SharedVector) = Default::default();
    for (a, &i) in SHARED.iter().enumerate() {
        total[a][a] = inverse_variance[i];
        right[a] = inverse_variance[i] * (mean[i] - reference[i]);
    }
    let mut bias_information = 0.0_f64;
    for drive in drives {
        let known = drive.information();
        let (n, mut y) = known.tempered();
        // About the first drive's reference.
        let moved: Vector = std::array::from_fn(|i| known.reference()[i] - reference[i]);
        let moved = times(&n, &moved);
        let (mean, inverse_variance) = known.prior();
        let diagonal = n[BIAS][BIAS] + inverse_variance[BIAS];
        bias_information = bias_information.max(diagonal);
        y[BIAS] += inverse_variance[BIAS] * (mean[BIAS] - reference[BIAS]);
        let y: Vector = std::array::from_fn(|i| y[i] + moved[i]);
        for (a, &i) in SHARED.iter().enumerate() {
            let gain = n[i][BIAS] / diagonal;
            right[a] += y[i] - gain * y[BIAS];
            for (b, &j) in SHARED.iter().enumerate() {
                total[a][b] += n[i][j] - gain * n[BIAS][j];
            }
        }
    }
    let Some(covariance) = inverse(&total) else { return Ok(whole.estimate()) };
    let step = times(&covariance, &right);
    let mut x = reference;
    let mut full: Matrix = [[0.0; UNKNOWNS]; UNKNOWNS];
    full[BIAS][BIAS] = 1.0 / bias_information;
    for (a, &i) in SHARED.iter().enumerate() {
        x[i] += step[a];
        for (b, &j) in SHARED.iter().enumerate() {
            full[i][j] = covariance[a][b];
        }
    }
    whole.settle(x[0]);
    Ok(whole.conclude(&known, &x, &full))
}
