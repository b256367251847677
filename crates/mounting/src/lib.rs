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
//!
//! # Example
//!
//! ```
//! use boresight_mounting::{Calibrator, FrameInput, CalibrationOptions};
//! use boresight_core::Detection;
//!
//! // A car goes straight at 15 m/s past points that stand; its radar is turned by 2 deg to the left.
//! let turned_rad = 2_f64.to_radians();
//! let detections: Vec<Detection> = (-20..=20)
//!     .map(|k| {
//!         let azimuth_rad = 0.05 * f64::from(k);
//!         Detection {
//!             azimuth_rad: azimuth_rad as f32,
//!             range_rate_mps: (-15.0 * (azimuth_rad + turned_rad).cos()) as f32,
//!             range_m: 20.0,
//!             rcs_dbsm: f32::NAN,
//!         }
//!     })
//!     .collect();
//!
//! let mut calibrator = Calibrator::new(CalibrationOptions { x_m: 3.6, ..CalibrationOptions::default() })?;
//! for frame in 0..50 {
//!     calibrator.add(FrameInput {
//!         time_s: 0.05 * f64::from(frame),
//!         detections: &detections,
//!         yaw_rate_radps: Some(0.0),
//!         speed_mps: None,
//!     })?;
//! }
//! let estimate = calibrator.estimate();
//! assert_eq!(estimate.frames.given, 50);
//! assert!((estimate.angle_rad - turned_rad).abs() < 1e-4);
//! # Ok::<(), boresight_mounting::MountingError>(())
//! ```

mod angle;
mod batch;
pub mod calibrator;
pub mod car;
pub mod drive;
pub mod equations;
pub mod error;
pub mod estimate;
pub mod frame;
pub mod fusion;
mod intake;
pub mod joint;
pub mod merge;
pub mod motion;
pub mod network;
pub mod options;
mod plane;
mod radars;
pub mod recursive;
pub mod signs;
pub mod statistics;
mod symmetric;
pub mod trajectory;

pub use angle::wrap;
pub use calibrator::Calibrator;
pub use car::Car;
pub use drive::Frames;
pub use equations::NormalEquations;
pub use error::MountingError;
pub use estimate::{Alignment, AngleEstimate, CHANCE, FrameCounts, Remark};
pub use frame::{CarMotion, FrameInput, FrameOutcome, Motion, Verdict};
pub use fusion::{FusedMotion, Fusion};
pub use joint::Joint;
pub use merge::{
    CarUnknowns, DrivePart, MergeOptions, MergedAngle, MergedDrive, MergedPart, MergedVehicle,
    Sharing, Told, merge, merge_drives,
};
pub use motion::{FrameMotion, MotionEstimator, MotionPlan};
pub use options::{CalibrationOptions, FrameWeights, Method, MotionMethod};
pub use recursive::Recursive;
pub use recursive::outlook::{Forecast, Manoeuvre, Outlook};
pub use signs::{AzimuthSign, RangeRateSign, SignFindings, SignOptions};
