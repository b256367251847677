//! One interface for all that gives a radar's motion.

use crate::error::MountingError;
use crate::frame::{CarMotion, FrameInput, Motion, Verdict};
use std::fmt::Debug;

/// What each method of motion implements: everything that depends on the options alone is made once, in the method's
/// own constructor. Whoever has a method of their own brings it to [`crate::Calibrator::with_motion`].
pub trait MotionPlan: Debug + Send {
    /// The radar's motion in a frame that is not older than those before, or in an earlier one of them. In `weights`, whatever it held, comes for each
    /// detection the weight, 0 to 1, with which it was taken as static.
    ///
    /// # Errors
    /// [`MountingError`] where the frame is malformed.
    fn estimate(
        &mut self,
        frame: FrameInput<'_>,
        weights: &mut Vec<f32>,
    ) -> Result<FrameMotion, MountingError>;

    /// Starts a session: the next frame may be on another clock. A plan that compares frames by time drops those before.
    fn restart(&mut self) {}
}

/// What a plan makes of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameMotion {
    /// The radar's motion, if one could be found.
    pub motion: Option<Motion>,
    /// Why the plan finds the frame of no use for the angle; [`Verdict::Used`] leaves that to the method of the angle.
    pub verdict: Verdict,
    /// The car's motion at its time, where it is the motion of an earlier frame.
    pub earlier: Option<CarMotion>,
}

impl FrameMotion {
    /// A motion whose use is still to be judged.
    pub fn to_judge(motion: Option<Motion>) -> Self {
        Self { motion, verdict: Verdict::Used, earlier: None }
    }
}
