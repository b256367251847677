//! Several radars of one car: an angle each, one yaw-rate sensor.

use crate::equations::NormalEquations;
use crate::error::MountingError;
use crate::estimate::AngleEstimate;
use crate::frame::{FrameInput, FrameOutcome, Verdict};
use crate::network::MotionNetwork;
use crate::options::CalibrationOptions;
use crate::radars;
use crate::recursive::Recursive;
use crate::recursive::information::{Information, Matrix, UNKNOWNS, Vector};
#[cfg(doc)]
use boresight_core::InputError;
use boresight_math::linalg::small::{dot, inverse, times};
use std::sync::Arc;

/// Unknowns that belong to the car: inverse scale, bias, slip gradient, and the delay of its radars, taken to
/// be of one kind.
const SHARED: usize = UNKNOWNS - 1;

type SharedVector = [f64; SHARED];
type SharedMatrix = [[f64; SHARED]; SHARED];

/// Recursive estimates of several radars that share the scale and bias of the yaw rate, the slip of the
/// rear axle and the radars' delay, in constant memory.
///
/// Each radar keeps its own normal equations. Its angle is eliminated from them, the radars' equations
/// in the shared unknowns are added up, and each angle follows. Radars count as independent but for
/// these unknowns; what standstill tells of the bias is taken once, from the radar that knows most.
#[derive(Debug, Clone)]
pub struct Joint {
    radars: Vec<(u8, Recursive)>,
}

/// One radar's part of the joint normal equations, about the reference, with its angle eliminated.
struct Part {
    known: Information,
    /// Information on the angle, prior included, and its right-hand side.
    angle: f64,
    right: f64,
    /// Change of the angle with the shared unknowns, sign turned.
    gain: SharedVector,
    shared: SharedMatrix,
    shared_right: SharedVector,
}

impl Joint {
    /// From the options of each radar by its number in the log; `method` is not looked at.
    ///
    /// # Errors
    /// Those of [`Recursive::new`]; [`InputError::Empty`] without radars, [`InputError::OutOfRange`] for
    /// a number given twice.
    pub fn new(radars: &[(u8, CalibrationOptions)]) -> Result<Self, MountingError> {
        Self::with_network(radars, None)
    }

    /// The same with a network, where options ask for a motion that needs one.
    ///
    /// # Errors
    /// As [`Joint::new`], and those of [`Recursive::with_network`].
    pub fn with_network(
        radars: &[(u8, CalibrationOptions)],
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, MountingError> {
        radars::check_numbers(radars.iter().map(|(sensor, _)| *sensor))?;
        let made = |(sensor, options): &(u8, CalibrationOptions)| {
            Ok((*sensor, Recursive::with_network(options, network)?))
        };
        let result = radars.iter().map(made).collect::<Result<_, MountingError>>()?;
        Ok(Self { radars: result })
    }

    /// Takes one frame of a radar. The speed that it finds leads the other radars: one that sees little traffic guards those
    /// that see much.
    ///
    /// # Errors
    /// Those of [`Recursive::add`]; [`InputError::OutOfRange`] for a radar that was not named. The frame
    /// is then not counted.
    pub fn add(&mut self, sensor: u8, frame: FrameInput) -> Result<FrameOutcome, MountingError> {
        let at = radars::place(self.radars.iter().map(|(id, _)| *id), sensor)?;
        let outcome = self.radars[at].1.add(frame)?;
        if outcome.verdict == Verdict::Used
            && let Some(speed) = self.radars[at].1.speed()
        {
            for (_, other) in &mut self.radars {
                other.tell_speed(speed);
            }
        }
        Ok(outcome)
    }

    /// Starts a session of all radars, as [`crate::Calibrator::restart`].
    pub fn restart(&mut self) {
        for (_, radar) in &mut self.radars {
            radar.restart();
        }
    }

    /// What the drive says of a radar by itself, by its place among those named.
    pub(crate) fn normal_equations(&self, at: usize) -> NormalEquations {
        self.radars[at].1.normal_equations()
    }

    /// The angles as they stand, with one scale, bias, slip and delay for all.
    pub fn estimate(&self) -> Vec<(u8, AngleEstimate)> {
        let parts: Vec<Part> =
            self.radars.iter().map(|(_, radar)| Part::new(radar.information())).collect();
        // The prior of the shared unknowns: the narrowest each, as standstill narrows the bias.
        let (mut total, mut right) = ([[0.0; SHARED]; SHARED], [0.0; SHARED]);
        for i in 0..SHARED {
            for part in &parts {
                let (mean, inverse_variance) = part.known.prior();
                if inverse_variance[i + 1] > total[i][i] {
                    total[i][i] = inverse_variance[i + 1];
                    right[i] =
                        inverse_variance[i + 1] * (mean[i + 1] - part.known.reference()[i + 1]);
                }
            }
        }
        for part in &parts {
            for i in 0..SHARED {
                right[i] += part.shared_right[i];
                for j in 0..SHARED {
                    total[i][j] += part.shared[i][j];
                }
            }
        }
        let Some(shared_covariance) = inverse(&total) else {
            return self.radars.iter().map(|(id, radar)| (*id, radar.estimate())).collect();
        };
        let shared = times(&shared_covariance, &right);
        self.radars
            .iter()
            .zip(&parts)
            .map(|((id, radar), part)| {
                let (x, covariance) = part.solution(&shared, &shared_covariance);
                (*id, radar.conclude(&part.known, &x, &covariance))
            })
            .collect()
    }
}

impl Part {
    fn new(known: Information) -> Self {
        let (n, y) = known.tempered();
        let (mean, inverse_variance) = known.prior();
        let angle = n[0][0] + inverse_variance[0];
        let right = y[0] + inverse_variance[0] * (mean[0] - known.reference()[0]);
        let gain: SharedVector = std::array::from_fn(|i| n[0][i + 1] / angle);
        Self {
            angle,
            right,
            gain,
            shared: std::array::from_fn(|i| {
                std::array::from_fn(|j| n[i + 1][j + 1] - gain[i] * n[0][j + 1])
            }),
            shared_right: std::array::from_fn(|i| y[i + 1] - gain[i] * right),
            known,
        }
    }

    /// The radar's unknowns and their covariance, from the shared ones.
    fn solution(&self, shared: &SharedVector, covariance: &SharedMatrix) -> (Vector, Matrix) {
        let pulled = times(covariance, &self.gain);
        let reference = self.known.reference();
        let x = std::array::from_fn(|i| {
            reference[i]
                + match i {
                    0 => self.right / self.angle - dot(&self.gain, shared),
                    i => shared[i - 1],
                }
        });
        let full = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i, j) {
                (0, 0) => 1.0 / self.angle + dot(&self.gain, &pulled),
                (0, k) | (k, 0) => -pulled[k - 1],
                (i, j) => covariance[i - 1][j - 1],
            })
        });
        (x, full)
    }
}
