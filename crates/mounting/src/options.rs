//! Options of the calibration, in SI units and radians.

use crate::error::MountingError;
use boresight_core::InputError;
use boresight_options::{Described, Named, Naming, check};
use serde::{Deserialize, Serialize};

/// How the mounting angle is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[option(name = "CalibrationMethod")]
#[non_exhaustive]
pub enum Method {
    /// Weighted mean of the frames' angles, scale taken as 1 (Kellner et al. 2015).
    WeightedMean,
    /// Rotation between the vehicle's and the radar's velocities (Bao et al. 2020; Kabsch 1976).
    Kabsch,
    /// Weighted least squares in angle and inverse scale (Zhu et al., equations 11 to 13).
    LeastSquares,
    /// Weighted orthogonal distance regression in angle and inverse scale.
    OrthogonalDistance,
    /// Recursive robust maximum likelihood: one frame at a time, with bias, scale and side slip as
    /// further unknowns.
    #[default]
    Recursive,
}

/// How the radar's motion is estimated from a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum MotionMethod {
    /// RANSAC, then least squares on the inliers (Kellner et al. 2013).
    #[default]
    Ransac,
    /// RANSAC, then least squares weighted by each detection's noise.
    WeightedLeastSquares,
    /// RANSAC, then orthogonal distance regression: azimuths are noisy too.
    OrthogonalDistance,
    /// Robust maximum likelihood led by the frames before, the yaw rate and the angle so far.
    Tracked,
    /// A network that weighs the detections of a frame, then weighted least squares (DeepEgo); it needs a file of weights.
    Deepego,
    /// The same, smoothed over eight frames by a second network (DeepEgo+), which tells the motion of four frames before; it needs a file of weights.
    DeepegoPlus,
}

/// What frames weigh in the weighted mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FrameWeights {
    /// The inverse variance of the direction of motion.
    #[default]
    Direction,
    /// The inverse of the summed variances of both components of the motion (Zhu et al., equation 13).
    Motion,
    /// All the same (Zhu et al., equation 8).
    Equal,
}

/// Options of all methods. Those a method has no use for are ignored. The car's frame is centred on
/// the rear axle, x forward, y left; angles are positive to the left.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
#[option(name = "CalibrationOptions")]
pub struct CalibrationOptions {
    /// How the angle is estimated.
    #[option(required)]
    pub method: Method,
    /// How the motion is estimated; by default in the way that belongs to the method: RANSAC for
    /// the mean and Kabsch, its weighted forms for the regressions, tracking for the recursive one.
    pub motion: Option<MotionMethod>,
    /// What frames weigh in the weighted mean; the other methods weigh them in their own way.
    pub frame_weights: FrameWeights,
    /// The radar's place ahead of the rear axle.
    #[option(required, range = -100..=100)]
    pub x_m: f64,
    /// The radar's place left of the centre line.
    #[option(range = -100..=100)]
    pub y_m: f64,
    /// The angle the radar should be mounted at, if known: where the search begins, and what the
    /// alarm compares with.
    #[option(range = -180..=180)]
    pub nominal_rad: Option<f64>,
    /// The alarm is raised where the angle differs from nominal by more than this, beyond chance.
    #[option(default = 1.0_f64.to_radians(), range = 1e-9..=180)]
    pub alarm_rad: f64,
    /// Standard deviation below which the estimate may count as converged.
    #[option(default = 0.1_f64.to_radians(), range = 1e-9..=180)]
    pub converged_rad: f64,
    /// Standard deviation of a detection's range rate.
    #[option(default = 0.1, positive)]
    pub range_rate_sigma_mps: f64,
    /// Standard deviation of a detection's azimuth.
    #[option(default = 0.5_f64.to_radians(), range = 0..=180)]
    pub azimuth_sigma_rad: f64,
    /// Standard deviation of what all azimuths of the radar, and the way the car points as it goes straight, are off by, beyond the
    /// mounting: no drive tells it from the angle.
    #[option(default = 0.045_f64.to_radians(), range = 0..=180)]
    pub azimuth_bias_sigma_rad: f64,
    /// Standard deviation of what detections that move and pass for static would turn the angle by if all moved; it counts by the share of
    /// detections that do.
    #[option(default = 0.15_f64.to_radians(), range = 0..=180)]
    pub traffic_sigma_rad: f64,
    /// Standard deviation of the error that the angles of all frames within five seconds and fifty metres share, before the drive
    /// tells it.
    #[option(default = 0.1_f64.to_radians(), positive)]
    pub lasting_sigma_rad: f64,
    /// Standard deviation of the yaw rate's bias before anything is known of it.
    #[option(default = 0.1_f64.to_radians(), positive)]
    pub bias_sigma_radps: f64,
    /// Standard deviation of the yaw rate's scale before anything is known of it.
    #[option(default = 0.02, positive)]
    pub scale_sigma: f64,
    /// Slip angle of the rear axle over lateral acceleration that is expected, rad/(m/s^2), outside Rust in degrees.
    #[option(default = 0.2_f64.to_radians(), range = -5..=5)]
    pub slip_gradient_rad: f64,
    /// Its standard deviation before anything is known of it.
    #[option(default = 0.15_f64.to_radians(), positive)]
    pub slip_gradient_sigma_rad: f64,
    /// How long before its time stamp a scan is expected to have been measured.
    #[option(default = 0.04, range = -1..=1)]
    pub delay_s: f64,
    /// Its standard deviation before anything is known of it.
    #[option(default = 0.03, positive)]
    pub delay_sigma_s: f64,
    /// Time of driving after which what was seen counts for a third (recursive method).
    #[option(default = 3600.0, range = 60..=1e9)]
    pub memory_s: f64,
    /// Frames below this speed of the radar are left out.
    #[option(default = 1.0, range = 0..=1000)]
    pub min_speed_mps: f64,
    /// Frames turning faster than this are left out.
    #[option(default = 140.0_f64.to_radians(), range = 0.1..=180)]
    pub max_yaw_rate_radps: f64,
    /// RANSAC takes a detection as an inlier where its range rate is within this of the fitted
    /// curve.
    #[option(default = 0.3, positive)]
    pub inlier_residual_mps: f64,
    /// Weight from which a detection is an inlier (IT).
    #[option(default = 0.5, range = 0..=1)]
    pub inlier_threshold: f64,
    /// Frames with a smaller share of inliers are left out (IRT).
    #[option(default = 0.3, range = 0..=1)]
    pub inlier_ratio_threshold: f64,
    /// Frames with fewer inliers are left out.
    #[option(default = 5, range = 3..=1e6)]
    pub min_inliers: usize,
    /// Probability that RANSAC draws a pair of inliers at least once.
    #[option(default = 0.999, range = 0..=1)]
    pub confidence: f64,
    /// Largest gap in the yaw rate over which it is interpolated.
    #[option(default = 0.25, positive)]
    pub max_gap_s: f64,
    /// Seed of RANSAC's draws.
    pub seed: u64,
}

impl CalibrationOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] naming the option.
    pub fn validate(&self) -> Result<(), MountingError> {
        Ok(check(self, Naming::Rust)?)
    }

    /// Standard deviation of what no drive tells from the angle, at a share of static detections.
    pub(crate) fn floor_rad(&self, static_share: f64) -> f64 {
        self.azimuth_bias_sigma_rad.hypot(self.traffic_sigma_rad * (1.0 - static_share))
    }

    /// The motion method in use: the one asked for, or the one that belongs to the method.
    pub fn motion_method(&self) -> MotionMethod {
        self.motion.unwrap_or(match self.method {
            Method::WeightedMean | Method::Kabsch => MotionMethod::Ransac,
            Method::LeastSquares => MotionMethod::WeightedLeastSquares,
            Method::OrthogonalDistance => MotionMethod::OrthogonalDistance,
            Method::Recursive => MotionMethod::Tracked,
        })
    }
}

impl Method {
    /// All methods, in the order they are listed to users.
    pub const ALL: [Self; 5] = [
        Self::WeightedMean,
        Self::Kabsch,
        Self::LeastSquares,
        Self::OrthogonalDistance,
        Self::Recursive,
    ];

    /// The name used in options and on the command line.
    pub fn name(self) -> &'static str {
        Named::name(self)
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::WeightedMean => "Weighted mean",
            Self::Kabsch => "Kabsch, full velocity",
            Self::LeastSquares => "Weighted least squares",
            Self::OrthogonalDistance => "Weighted orthogonal distance",
            Self::Recursive => "Recursive robust likelihood",
        }
    }

    /// Where it was published.
    pub fn reference(self) -> &'static str {
        match self {
            Self::WeightedMean => "Kellner et al. 2015",
            Self::Kabsch => "Bao et al. 2020; Kabsch 1976",
            Self::LeastSquares => "Zhu et al., equations 10 to 13",
            Self::OrthogonalDistance => "Boggs, Byrd and Schnabel 1987; Zhu et al.",
            Self::Recursive => "Boresight",
        }
    }

    /// Finds a method by its [`Method::name`].
    ///
    /// # Errors
    /// [`InputError::Unknown`], listing the known names.
    pub fn from_name(name: &str) -> Result<Self, InputError> {
        Named::from_name("method", name)
    }
}

impl MotionMethod {
    /// All methods, in the order they are listed to users.
    pub const ALL: [Self; 6] = [
        Self::Ransac,
        Self::WeightedLeastSquares,
        Self::OrthogonalDistance,
        Self::Tracked,
        Self::Deepego,
        Self::DeepegoPlus,
    ];

    /// The name used in options and on the command line.
    pub fn name(self) -> &'static str {
        Named::name(self)
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Ransac => "RANSAC, least squares",
            Self::WeightedLeastSquares => "RANSAC, weighted least squares",
            Self::OrthogonalDistance => "RANSAC, orthogonal distance",
            Self::Tracked => "Tracked robust likelihood",
            Self::Deepego => "DeepEgo (network)",
            Self::DeepegoPlus => "DeepEgo+ (network)",
        }
    }

    /// Where it was published.
    pub fn reference(self) -> &'static str {
        match self {
            Self::Ransac => "Kellner et al. 2013; Fischler and Bolles 1981",
            Self::WeightedLeastSquares => "Aitken 1935",
            Self::OrthogonalDistance => "Boggs, Byrd and Schnabel 1987",
            Self::Tracked => "Boresight",
            Self::Deepego => "after Zhu, Yarovoy and Fioranelli 2023",
            Self::DeepegoPlus => "after Zhu et al. 2025",
        }
    }

    /// Finds a method by its [`MotionMethod::name`].
    ///
    /// # Errors
    /// [`InputError::Unknown`], listing the known names.
    pub fn from_name(name: &str) -> Result<Self, InputError> {
        Named::from_name("motion", name)
    }
}
