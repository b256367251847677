//! One radar's angle from several drives.

use super::{DrivePart, MergeOptions, settle};
use crate::error::MountingError;
use crate::estimate::AngleEstimate;
use crate::recursive::Recursive;
use crate::recursive::information::{Matrix, UNKNOWNS, Vector};
use boresight_core::InputError;

/// The angle from several drives with one radar of one car, each as its calibration left it: [`super::merge_drives`] with the options' defaults,
/// so that angle, scale, slip and delay are shared and each drive has a bias of the yaw rate of its own, of which that of the last is told.
/// Counts are added up.
///
/// # Errors
/// [`InputError::Empty`] without drives, [`MountingError::UnlikeSnapshots`] where radars are mounted at different places.
pub fn merge(drives: &[Recursive]) -> Result<AngleEstimate, MountingError> {
    let Some((first, others)) = drives.split_first() else {
        return Err(InputError::Empty {
            what: "snapshots".into(),
            expected: "one of each drive".into(),
        }
        .into());
    };
    let place = |drive: &Recursive| {
        let o = drive.options();
        [("x_m", o.x_m), ("y_m", o.y_m)]
    };
    let mut whole = first.clone();
    for other in others {
        for ((what, expected), (_, given)) in place(first).into_iter().zip(place(other)) {
            if expected != given {
                return Err(MountingError::UnlikeSnapshots { what: what.into(), expected, given });
            }
        }
        whole.absorb(other);
    }
    let part = |drive: &Recursive| DrivePart { angle: 0, equations: drive.normal_equations() };
    let parts: Vec<Vec<DrivePart>> = drives.iter().map(|drive| vec![part(drive)]).collect();
    let settled = settle(&[0], &parts, &MergeOptions::default())?;
    let (mut step, known) = settled.shared();
    let mut variance: [f64; UNKNOWNS - 1] = std::array::from_fn(|i| known[i][i]);
    if let Some(last) = settled.outcome.about.last() {
        for i in (0..step.len()).filter(|i| !settled.layout.shared[*i]) {
            step[i] = last.car[i];
            variance[i] = last.car_variance[i];
        }
    }
    // Angles come first among the unknowns, and this is the only one.
    let at = |i: usize, j: usize| settled.outcome.solution.covariance[i * UNKNOWNS + j];
    let x: Vector = std::array::from_fn(|i| match i {
        0 => settled.reference.angles[0] + settled.outcome.solution.x[0],
        i => settled.reference.car[i - 1] + step[i - 1],
    });
    let covariance: Matrix = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j && i > 0 { variance[i - 1] } else { at(i, j) })
    });
    whole.settle(x[0]);
    Ok(whole.conclude(&first.information(), &x, &covariance))
}
