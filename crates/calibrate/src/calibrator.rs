//! The calibration: frames in, mounting angle out, whichever method.

use crate::batch::Batch;
use crate::motion::plan::plan;
use crate::{
    AngleEstimate, CalibrateError, CalibrationOptions, FrameInput, FrameOutcome, Method,
    MotionMethod, MotionPlan, Outlook, Recursive,
};
use boresight_core::CoreError;

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
    /// Those of [`CalibrationOptions::validate`], and [`CoreError::Unknown`] for the recursive method with another
    /// motion than its own.
    pub fn new(options: CalibrationOptions) -> Result<Self, CalibrateError> {
        options.validate()?;
        let motion = options.motion_method();
        if options.method == Method::Recursive {
            return match motion {
                MotionMethod::Tracked => {
                    let recursive = Box::new(Recursive::new(&options)?);
                    Ok(Self { inner: Inner::Recursive(recursive) })
                }
                _ => Err(tracked_only(motion.name())),
            };
        }
        Self::with_motion(options, plan(motion, &options)?)
    }

    /// A calibration on motions that come from elsewhere, such as a network. What the options say of the motion is then
    /// not looked at.
    ///
    /// # Errors
    /// Those of [`CalibrationOptions::validate`], and [`CoreError::Unknown`] for the recursive method, which finds the motion itself.
    pub fn with_motion(
        options: CalibrationOptions,
        motion: Box<dyn MotionPlan>,
    ) -> Result<Self, CalibrateError> {
        options.validate()?;
        if options.method == Method::Recursive {
            return Err(tracked_only("a plan"));
        }
        Ok(Self { inner: Inner::Batch(Box::new(Batch::new(options, motion))) })
    }

    /// The calibration as bytes, from which [`Calibrator::restore`] makes one that goes on to the last digit as this one does.
    ///
    /// # Errors
    /// [`CoreError::Unknown`] for the methods that weigh all frames at once: they keep all of them.
    pub fn snapshot(&self) -> Result<Vec<u8>, CalibrateError> {
        match &self.inner {
            Inner::Recursive(recursive) => Ok(recursive.snapshot()),
            Inner::Batch(batch) => Err(CoreError::Unknown {
                what: "method of a snapshot".into(),
                expected: "recursive".into(),
                given: batch.method().name().into(),
            }
            .into()),
        }
    }

    /// The calibration that a snapshot is of, with its options.
    ///
    /// # Errors
    /// Those of [`Recursive::restore`].
    pub fn restore(snapshot: &[u8]) -> Result<Self, CalibrateError> {
        Ok(Self { inner: Inner::Recursive(Box::new(Recursive::restore(snapshot)?)) })
    }

    /// Takes one frame.
    ///
    /// # Errors
    /// [`CalibrateError::TimeBackwards`] for a frame older than the one before, and
    /// [`CoreError::NotFinite`] for a time that is no number; the frame is then not counted.
    pub fn add(&mut self, frame: FrameInput) -> Result<FrameOutcome, CalibrateError> {
        match &mut self.inner {
            Inner::Batch(batch) => batch.add(frame),
            Inner::Recursive(recursive) => recursive.add(frame),
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

fn tracked_only(given: &str) -> CalibrateError {
    CoreError::Unknown {
        what: "motion".into(),
        expected: "tracked, with the recursive method".into(),
        given: given.into(),
    }
    .into()
}

/// Checks that time is a number and does not run backwards.
pub(crate) fn check_time(previous: Option<f64>, given: f64) -> Result<(), CalibrateError> {
    if !given.is_finite() {
        return Err(CoreError::NotFinite { what: "timeS".into(), index: 0, given }.into());
    }
    match previous {
        Some(previous) if given < previous => {
            Err(CalibrateError::TimeBackwards { previous, given })
        }
        _ => Ok(()),
    }
}
