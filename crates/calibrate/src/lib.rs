//! Ego-motion of a radar from its Doppler point cloud, and the yaw it is mounted at from that motion
//! and the car's yaw rate, in ordinary driving (Zhu et al., "Radar Mounting Angle Estimation in
//! Operational Driving Conditions"; Kellner et al. 2013, 2014, 2015; Bao et al. 2020).
//!
//! A static point at azimuth `a` has `-range_rate = vx cos a + vy sin a`, where `(vx, vy)` is the
//! radar's own motion in its own frame. Without side slip at the rear axle the car moves with
//! `(v, 0)` there, so a radar at `(x_s, y_s)` moves with `(v - w y_s, w x_s)` in the car's frame, and
//! its direction in its own frame, `beta`, gives the mounting angle:
//! `|V| sin(beta + theta) = w x_s`. The yaw rate is measured with a scale error and a bias,
//! `measured = s w + b`; `s' = 1 / s` is what is estimated.

mod angle;
mod batch;
pub mod calibrator;
pub mod drive;
pub mod error;
pub mod estimate;
pub mod frame;
pub mod joint;
pub mod motion;
pub mod options;
pub mod recursive;
mod small;
mod symmetric;
pub mod trajectory;

pub use calibrator::Calibrator;
pub use drive::Frames;
pub use error::CalibrateError;
pub use estimate::{AngleEstimate, FrameCounts, Remark};
pub use frame::{FrameInput, FrameOutcome, Motion, Verdict};
pub use joint::Joint;
pub use motion::{FrameMotion, MotionEstimator, MotionPlan};
pub use options::{Method, MotionMethod, Options};
pub use recursive::Recursive;
