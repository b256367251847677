//! The calibration: frames in, mounting angle out, whichever method.

use crate::batch::Batch;
use crate::equations::NormalEquations;
use crate::error::{MountingError, tracked_only};
use crate::estimate::AngleEstimate;
use crate::frame::{FrameInput, FrameOutcome};
use crate::motion::MotionPlan;
use crate::motion::prepare::prepare;
use crate::network::MotionNetwork;
use crate::options::{CalibrationOptions, Method};
use crate::recursive::Recursive;
use crate::recursive::outlook::Outlook;
use boresight_core::InputError;
use std::sync::Arc;

/// Estimates a mounting angle from frames in order of time.
#[derive(Debug)]
pub struct Calibrator {
    inner: Inner,
}

#[derive(Debug)]
enum Inner {
    Batch(Box<Batch>),
    Recursive(Box<Recursive>),
}

impl Calibrator {
    /// A calibration without frames.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`], [`InputError::Incompatible`] for the recursive method with another
    /// motion than its own or DeepEgo's, and [`MountingError::NeedsNetwork`] for motions by networks.
    pub fn new(options: CalibrationOptions) -> Result<Self, MountingError> {
        Self::with_network(options, None)
    }

    /// The same with a network, where the options ask for a motion that needs one. The recursive method takes from it how
    /// likely each detection is to stand, and finds the motion itself.
    ///
    /// # Errors
    /// As [`Calibrator::new`].
    pub fn with_network(
        options: CalibrationOptions,
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, MountingError> {
        options.validate()?;
        if options.method == Method::Recursive {
            let recursive = Box::new(Recursive::with_network(&options, network)?);
            return Ok(Self { inner: Inner::Recursive(recursive) });
        }
        Self::with_motion(options, prepare(options.motion_method(), &options, network)?)
    }

    /// A calibration on motions that come from elsewhere, such as a network. What the options say of the motion is then
    /// not looked at.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`], and [`InputError::Incompatible`] for the recursive method, which finds the motion itself.
    pub fn with_motion(
        options: CalibrationOptions,
        motion: Box<dyn MotionPlan>,
    ) -> Result<Self, MountingError> {
        options.validate()?;
        if options.method == Method::Recursive {
            return Err(tracked_only("a custom motion plan"));
        }
        Ok(Self { inner: Inner::Batch(Box::new(Batch::new(options, motion))) })
    }

    /// The calibration as bytes, from which [`Calibrator::restore`] makes one that goes on to the last digit as this one does.
    ///
    /// # Errors
    /// [`InputError::Incompatible`] for the methods that weigh all frames at once: they keep all of them.
    pub fn snapshot(&self) -> Result<Vec<u8>, MountingError> {
        match &self.inner {
            Inner::Recursive(recursive) => Ok(recursive.snapshot()),
            Inner::Batch(batch) => Err(InputError::Incompatible {
                what: "method".into(),
                expected: "recursive, the only one with snapshots".into(),
                given: batch.method().name().into(),
            }
            .into()),
        }
    }

    /// The calibration that a snapshot is of, with its options; one with a network needs that again.
    ///
    /// # Errors
    /// Those of [`Recursive::restore`].
    pub fn restore(
        snapshot: &[u8],
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, MountingError> {
        let recursive = Recursive::restore_with_network(snapshot, network)?;
        Ok(Self { inner: Inner::Recursive(Box::new(recursive)) })
    }

    /// What the frames so far say, to put together with other drives; `None` for the methods that weigh all frames at once.
    pub fn normal_equations(&self) -> Option<NormalEquations> {
        match &self.inner {
            Inner::Recursive(recursive) => Some(recursive.normal_equations()),
            Inner::Batch(_) => None,
        }
    }

    /// Adds one frame. Ten consecutive frames that ascend on an earlier time base start a new session, as [`Calibrator::restart`]
    /// does: the tenth is the first one used.
    ///
    /// # Errors
    /// [`MountingError::TimeBackwards`] for a frame older than the one before, and
    /// [`InputError::NotFinite`] for a time that is not finite; the frame then counts as rejected only.
    pub fn add(&mut self, frame: FrameInput) -> Result<FrameOutcome, MountingError> {
        match &mut self.inner {
            Inner::Batch(batch) => batch.add(frame),
            Inner::Recursive(recursive) => recursive.add(frame),
        }
    }

    /// Starts a session on a clock that need not continue the one before: after a restart of the radar or of its clock. Keeps what
    /// was learnt of the mounting angle and of the car; drops the delay of time stamps, the speed and yaw rate of the last frame
    /// and all that compares frames by time.
    pub fn restart(&mut self) {
        match &mut self.inner {
            Inner::Batch(batch) => batch.restart(),
            Inner::Recursive(recursive) => recursive.restart(),
        }
    }

    /// What driving on would bring, for the recursive method; `None` for the methods that weigh all frames at once.
    pub fn outlook(&self) -> Option<Outlook> {
        match &self.inner {
            Inner::Recursive(recursive) => Some(recursive.outlook()),
            Inner::Batch(_) => None,
        }
    }

    /// The angle from all frames so far. With the methods that weigh all frames at once it takes time in
    /// proportion to their number; the recursive one has it at hand.
    ///
    /// It has converged when its standard deviation is below `converged_rad` and the angle from all
    /// frames but those of the last 10 s differs by no more than that. It is misaligned when it differs
    /// from the nominal angle by more than `alarm_rad` plus three standard deviations.
    pub fn estimate(&self) -> AngleEstimate {
        match &self.inner {
            Inner::Batch(batch) => batch.estimate(),
            Inner::Recursive(recursive) => recursive.estimate(),
        }
    }
}
