//! The angles of all radars of a vehicle over all its drives.
//!
//! Each drive says of each radar what [`NormalEquations`] hold. The vehicle has an angle a radar, or several where knocks changed it, and
//! scale, bias, slip and delay, which the radars of a drive share and, as [`MergeOptions`] say, the drives as well. Beside these every drive
//! has errors of its own: of each radar's angle, and of each unknown that drives share. All that is a drive's own is eliminated drive by
//! drive (Schur complement; `elimination`), so that the time taken is in proportion to the drives. How large such errors are is learnt from
//! the drives' scatter about the solution by restricted likelihood (Patterson and Thompson 1971), beginning with what is expected; drives
//! whose angle is far off weigh less (Student-t weights; Lange, Little and Taylor 1989; `vehicle`).

mod elimination;
mod gather;
mod one;
mod options;
mod part;
mod vehicle;

#[cfg(test)]
mod tests;

pub use one::merge;
pub use options::{MergeOptions, Sharing};

use crate::angle::wrap;
use crate::equations::NormalEquations;
use crate::error::MountingError;
use crate::recursive::conclude::told;
use crate::recursive::information::UNKNOWNS;
#[cfg(doc)]
use boresight_core::InputError;
use boresight_core::limits;
use boresight_options::{Naming, check};
use elimination::{About, Layout, Residual};
use gather::{Reference, gather};
use serde::Serialize;
use vehicle::Outcome;

/// Unknowns of the car: inverse scale, bias times inverse scale, slip gradient, delay.
const CAR: usize = UNKNOWNS - 1;
type CarVector = [f64; CAR];
type CarMatrix = [[f64; CAR]; CAR];

/// What one radar says in a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivePart {
    /// Which of the vehicle's angles: one a radar and time between knocks. A radar that was moved to another place has another angle.
    pub angle: usize,
    /// What it says.
    pub equations: NormalEquations,
}

/// The joint estimate of a vehicle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedVehicle {
    /// The angles.
    pub angles: Vec<MergedAngle>,
    /// Covariance of the angles, rad^2. Angles of one radar have what no drive tells in common.
    pub covariance: Vec<Vec<f64>>,
    /// The car's unknowns that drives share.
    pub shared: CarUnknowns,
    /// Standard deviations of what drives that share an unknown differ by; none of those that are each drive's own.
    pub spreads: [Option<f64>; CAR],
    /// The drives.
    pub drives: Vec<MergedDrive>,
    /// Whether what drives differ by had stopped changing when the iteration ended. Otherwise its bound was reached, and the standard
    /// deviations may be wrong.
    pub converged: bool,
}

/// An angle of the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MergedAngle {
    /// The angle, rad, within half a turn; that of the prior, or 0, where no drive tells.
    pub angle_rad: f64,
    /// Its standard deviation, rad; infinite where no drive tells.
    pub sigma_rad: f64,
    /// Standard deviation of what the radar's angle is off by in one drive and not in another, rad.
    pub drive_sigma_rad: f64,
    /// Drives that tell of it.
    pub drives: usize,
}

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Told {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// Unknowns of a car; none where they belong elsewhere: with the drives, or with what they share.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct CarUnknowns {
    /// Scale factor of the yaw rate (measured over true).
    pub scale: Option<Told>,
    /// Bias of the yaw rate, rad/s.
    pub bias_radps: Option<Told>,
    /// Slip angle of the rear axle over lateral acceleration, rad/(m/s^2).
    pub slip_gradient_rad: Option<Told>,
    /// How long before its time stamp a scan was measured, s.
    pub delay_s: Option<Told>,
}

/// A drive in the joint estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedDrive {
    /// The car's unknowns that are the drive's own; none of a drive without parts.
    pub own: CarUnknowns,
    /// The radars, as they were given.
    pub parts: Vec<MergedPart>,
}

/// A radar of a drive in the joint estimate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MergedPart {
    /// By how much the angle of this drive alone exceeds what all others say of it, in standard deviations of the difference; 0 where it says
    /// nothing.
    pub deviations: f64,
    /// What it counts for: about 1, and less the further it is off.
    pub weight: f64,
}

/// A solution with what it refers to.
struct Settled {
    layout: Layout,
    reference: Reference,
    outcome: Outcome,
    told: Vec<Account>,
}

/// What tells of an angle.
#[derive(Clone, Copy, Default)]
struct Account {
    drives: usize,
    /// Sums of the information and of the information times the square of what no drive tells.
    information: f64,
    floor: f64,
}

/// The angles of a vehicle from all its drives. `radars` has for each angle the number of its radar, and each drive the parts that tell of an
/// angle. Priors of what drives share count once, the narrowest of each; so do, in each drive, those of what is its own.
///
/// # Errors
/// [`InputError::OutOfRange`] for an angle that is not there, [`MountingError::UnsoundEquations`] for equations that no drive leads to,
/// [`InputError::TooLarge`] beyond the limits of the thread; those of the options' check.
pub fn merge_drives(
    radars: &[u8],
    drives: &[Vec<DrivePart>],
    options: &MergeOptions,
) -> Result<MergedVehicle, MountingError> {
    settle(radars, drives, options).map(|settled| settled.tell(radars))
}

fn settle(
    radars: &[u8],
    drives: &[Vec<DrivePart>],
    options: &MergeOptions,
) -> Result<Settled, MountingError> {
    check(options, Naming::Rust)?;
    let size = radars.len() as f64 + CAR as f64;
    limits::check_bytes("the covariance of the angles", &[radars.len() + CAR; 2], 3 * 8)?;
    let each = |parts: &Vec<DrivePart>| (parts.len() as f64 + 2.0 * CAR as f64).powi(3);
    let operations = size.powi(3) + drives.iter().map(each).sum::<f64>();
    limits::check_operations("the joint estimate", vehicle::ROUNDS as f64 * operations)?;
    let (mut vehicle, reference) = gather(radars, drives, options)?;
    let outcome = vehicle.settle()?;
    let mut told = vec![Account::default(); radars.len()];
    for ((drive, given), about) in vehicle.drives.iter().zip(drives).zip(&outcome.about) {
        for ((part, DrivePart { angle, equations }), about) in
            drive.parts.iter().zip(given).zip(&about.parts).filter(|((p, _), _)| p.tells())
        {
            let account = &mut told[*angle];
            let information = part.weight / about.variance;
            account.drives += 1;
            account.information += information;
            account.floor += information * equations.floor_rad * equations.floor_rad;
        }
    }
    Ok(Settled { layout: vehicle.layout, reference, outcome, told })
}

impl Settled {
    /// The car's unknowns at a step from the reference, of those shared or of the others.
    fn car(&self, step: &CarVector, variance: &CarVector, shared: bool) -> CarUnknowns {
        let x: CarVector = std::array::from_fn(|i| self.reference.car[i] + step[i]);
        let of = |i: usize| {
            let (value, sigma) = told(i + 1, x[i], variance[i], x[0]);
            (self.layout.shared[i] == shared).then_some(Told { value, sigma })
        };
        CarUnknowns { scale: of(0), bias_radps: of(1), slip_gradient_rad: of(2), delay_s: of(3) }
    }

    /// Steps and covariance of the car's unknowns that drives share.
    fn shared(&self) -> (CarVector, CarMatrix) {
        let (angles, size) = (self.layout.radar.len(), self.layout.size());
        let at =
            |i: usize, j: usize| self.outcome.solution.covariance[(angles + i) * size + angles + j];
        let step = std::array::from_fn(|i| self.outcome.solution.x[angles + i]);
        (step, std::array::from_fn(|i| std::array::from_fn(|j| at(i, j))))
    }

    fn tell(&self, radars: &[u8]) -> MergedVehicle {
        let Outcome { solution, effects, about, converged } = &self.outcome;
        let size = self.layout.size();
        let floor = |angle: usize| {
            let account = &self.told[angle];
            (account.floor / account.information).sqrt()
        };
        let covariance: Vec<Vec<f64>> = (0..radars.len())
            .map(|i| {
                let entry = |j: usize| match (self.told[i].drives, self.told[j].drives) {
                    (0, _) | (_, 0) if i == j => f64::INFINITY,
                    (0, _) | (_, 0) => 0.0,
                    _ => {
                        let common = radars[i] == radars[j];
                        let beyond = if common { floor(i) * floor(j) } else { 0.0 };
                        solution.covariance[i * size + j] + beyond
                    }
                };
                (0..radars.len()).map(entry).collect()
            })
            .collect();
        let (step, known) = self.shared();
        let anything = about.iter().any(|about| !about.parts.is_empty());
        let spread = |i: usize| self.layout.shared[i].then(|| effects.car[i].sqrt());
        MergedVehicle {
            angles: (0..radars.len())
                .map(|i| MergedAngle {
                    angle_rad: wrap(self.reference.angles[i] + solution.x[i]),
                    sigma_rad: covariance[i][i].max(0.0).sqrt(),
                    drive_sigma_rad: effects.angle[self.layout.radar[i]].sqrt(),
                    drives: self.told[i].drives,
                })
                .collect(),
            covariance,
            shared: if anything {
                self.car(&step, &std::array::from_fn(|i| known[i][i]), true)
            } else {
                CarUnknowns::default()
            },
            spreads: std::array::from_fn(spread),
            drives: about.iter().map(|about| self.drive(about)).collect(),
            converged: *converged,
        }
    }

    fn drive(&self, about: &About) -> MergedDrive {
        let part =
            |told: &Residual| MergedPart { deviations: told.deviations(), weight: told.weight };
        MergedDrive {
            own: if about.parts.is_empty() {
                CarUnknowns::default()
            } else {
                self.car(&about.car, &about.car_variance, false)
            },
            parts: about.parts.iter().map(part).collect(),
        }
    }
}
