//! The radars of a car, each by itself or all together.

use crate::calibrator::Calibrator;
use crate::equations::NormalEquations;
use crate::error::MountingError;
use crate::estimate::AngleEstimate;
use crate::frame::{FrameInput, FrameOutcome};
use crate::joint::Joint;
use crate::network::MotionNetwork;
use crate::options::{CalibrationOptions, Method};
use crate::radars;
use crate::recursive::outlook::Outlook;
#[cfg(doc)]
use boresight_core::InputError;
use std::sync::Arc;

/// Calibrates the radars of a car in one pass over a drive.
#[derive(Debug)]
pub struct Car {
    radars: Vec<(u8, CalibrationOptions)>,
    inner: Inner,
}

#[derive(Debug)]
enum Inner {
    Apart(Vec<Calibrator>),
    Together(Joint),
}

impl Car {
    /// Each radar by itself, by the method its options ask for.
    ///
    /// # Errors
    /// Those of [`Calibrator::with_network`]; [`InputError::Empty`] without radars, [`InputError::OutOfRange`] for a number given
    /// twice.
    pub fn apart(
        radars: Vec<(u8, CalibrationOptions)>,
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, MountingError> {
        radars::check_numbers(radars.iter().map(|(sensor, _)| *sensor))?;
        let made =
            |(_, options): &(u8, CalibrationOptions)| Calibrator::with_network(*options, network);
        let calibrators = radars.iter().map(made).collect::<Result<_, _>>()?;
        Ok(Self { radars, inner: Inner::Apart(calibrators) })
    }

    /// All radars together, as [`Joint`] does.
    ///
    /// # Errors
    /// Those of [`Joint::new`].
    pub fn together(radars: Vec<(u8, CalibrationOptions)>) -> Result<Self, MountingError> {
        let joint = Joint::new(&radars)?;
        Ok(Self { radars, inner: Inner::Together(joint) })
    }

    /// The radars and their options.
    #[must_use]
    pub fn radars(&self) -> &[(u8, CalibrationOptions)] {
        &self.radars
    }

    /// Whether the radars are calibrated together.
    #[must_use]
    pub fn is_joint(&self) -> bool {
        matches!(self.inner, Inner::Together(_))
    }

    /// Whether an estimate is at hand after each frame, or takes time in proportion to all frames before.
    #[must_use]
    pub fn is_at_hand(&self) -> bool {
        self.is_joint() || self.radars.iter().all(|(_, o)| o.method == Method::Recursive)
    }

    /// Takes one frame of a radar.
    ///
    /// # Errors
    /// Those of [`Calibrator::add`]; [`InputError::OutOfRange`] for a radar that was not named. The frame is then not counted.
    pub fn add(&mut self, sensor: u8, frame: FrameInput) -> Result<FrameOutcome, MountingError> {
        match &mut self.inner {
            Inner::Apart(calibrators) => {
                let at = radars::place(self.radars.iter().map(|(id, _)| *id), sensor)?;
                calibrators[at].add(frame)
            }
            Inner::Together(joint) => joint.add(sensor, frame),
        }
    }

    /// Starts a session of all radars, as [`Calibrator::restart`].
    pub fn restart(&mut self) {
        match &mut self.inner {
            Inner::Apart(calibrators) => calibrators.iter_mut().for_each(Calibrator::restart),
            Inner::Together(joint) => joint.restart(),
        }
    }

    /// The angle of a radar from all frames so far.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a radar that was not named.
    pub fn estimate(&self, sensor: u8) -> Result<AngleEstimate, MountingError> {
        let at = radars::place(self.radars.iter().map(|(id, _)| *id), sensor)?;
        Ok(match &self.inner {
            Inner::Apart(calibrators) => calibrators[at].estimate(),
            Inner::Together(joint) => joint.estimate().swap_remove(at).1,
        })
    }

    /// What driving on would bring a radar, where [`Calibrator::outlook`] tells; none for radars calibrated together.
    #[must_use]
    pub fn outlook(&self, sensor: u8) -> Option<Outlook> {
        let Inner::Apart(calibrators) = &self.inner else { return None };
        let at = self.radars.iter().position(|(id, _)| *id == sensor)?;
        calibrators[at].outlook()
    }

    /// What the drive says of a radar, as [`Calibrator::normal_equations`]; none for a radar that was not named.
    pub fn normal_equations(&self, sensor: u8) -> Option<NormalEquations> {
        let at = self.radars.iter().position(|(id, _)| *id == sensor)?;
        match &self.inner {
            Inner::Apart(calibrators) => calibrators[at].normal_equations(),
            Inner::Together(joint) => Some(joint.normal_equations(at)),
        }
    }
}
