//! Options of the calibration, in SI units and radians.

use crate::CalibrateError;
use boresight_core::CoreError;
use boresight_core::error::{check_positive, check_range, named};
use std::f64::consts::PI;

/// How the mounting angle is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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
}

/// Options of all methods. Those a method has no use for are ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// How the angle is estimated.
    pub method: Method,
    /// How the motion is estimated; `None` for the one that belongs to the method.
    pub motion: Option<MotionMethod>,
    /// The radar's place ahead of the rear axle, m.
    pub x_m: f64,
    /// The radar's place left of the centre line, m.
    pub y_m: f64,
    /// The angle the radar should be mounted at, rad, if known: where the search begins, and what
    /// the alarm compares with.
    pub nominal_rad: Option<f64>,
    /// How far from nominal is a misalignment, rad.
    pub alarm_rad: f64,
    /// Standard deviation below which the estimate may count as converged, rad.
    pub converged_rad: f64,
    /// Standard deviation of a detection's range rate, m/s.
    pub range_rate_sigma_mps: f64,
    /// Standard deviation of a detection's azimuth, rad.
    pub azimuth_sigma_rad: f64,
    /// Standard deviation of the yaw rate's bias before anything is known of it, rad/s.
    pub bias_sigma_radps: f64,
    /// Frames below this speed of the radar are left out, m/s.
    pub min_speed_mps: f64,
    /// Frames turning faster than this are left out, rad/s.
    pub max_yaw_rate_radps: f64,
    /// Below this residual, m/s, a detection is an inlier of RANSAC.
    pub inlier_residual_mps: f64,
    /// A detection is an inlier where its weight is at least this (IT).
    pub inlier_threshold: f64,
    /// Frames with a smaller share of inliers are left out (IRT).
    pub inlier_ratio_threshold: f64,
    /// Fewest inliers of a frame.
    pub min_inliers: usize,
    /// Probability that RANSAC draws a pair of inliers at least once.
    pub confidence: f64,
    /// Largest gap in the yaw rate over which it is interpolated, s.
    pub max_gap_s: f64,
    /// Seed of RANSAC's draws.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::default(),
            motion: None,
            x_m: 0.0,
            y_m: 0.0,
            nominal_rad: None,
            alarm_rad: 1.0_f64.to_radians(),
            converged_rad: 0.1_f64.to_radians(),
            range_rate_sigma_mps: 0.1,
            azimuth_sigma_rad: 0.5_f64.to_radians(),
            bias_sigma_radps: 0.1_f64.to_radians(),
            min_speed_mps: 1.0,
            max_yaw_rate_radps: 140.0_f64.to_radians(),
            inlier_residual_mps: 0.3,
            inlier_threshold: 0.5,
            inlier_ratio_threshold: 0.3,
            min_inliers: 5,
            confidence: 0.999,
            max_gap_s: 0.25,
            seed: 0,
        }
    }
}

impl Options {
    /// Checks every option.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`] naming the option.
    pub fn validate(&self) -> Result<(), CalibrateError> {
        check_range("xM", self.x_m, -100.0, 100.0)?;
        check_range("yM", self.y_m, -100.0, 100.0)?;
        if let Some(nominal) = self.nominal_rad {
            check_range("nominalRad", nominal, -PI, PI)?;
        }
        for (what, given) in [
            ("alarmRad", self.alarm_rad),
            ("convergedRad", self.converged_rad),
            ("rangeRateSigmaMps", self.range_rate_sigma_mps),
            ("maxYawRateRadps", self.max_yaw_rate_radps),
            ("inlierResidualMps", self.inlier_residual_mps),
            ("maxGapS", self.max_gap_s),
            ("biasSigmaRadps", self.bias_sigma_radps),
        ] {
            check_positive(what, given)?;
        }
        check_range("azimuthSigmaRad", self.azimuth_sigma_rad, 0.0, PI)?;
        check_range("minSpeedMps", self.min_speed_mps, 0.0, 1e3)?;
        check_range("inlierThreshold", self.inlier_threshold, 0.0, 1.0)?;
        check_range("inlierRatioThreshold", self.inlier_ratio_threshold, 0.0, 1.0)?;
        check_range("minInliers", self.min_inliers as f64, 3.0, 1e6)?;
        check_range("confidence", self.confidence, 0.0, 1.0)?;
        Ok(())
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
        match self {
            Self::WeightedMean => "weighted-mean",
            Self::Kabsch => "kabsch",
            Self::LeastSquares => "least-squares",
            Self::OrthogonalDistance => "orthogonal-distance",
            Self::Recursive => "recursive",
        }
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
    /// [`CoreError::Unknown`], listing the known names.
    pub fn from_name(name: &str) -> Result<Self, CoreError> {
        named("method", &Self::ALL, Self::name, name)
    }
}

impl MotionMethod {
    /// All methods, in the order they are listed to users.
    pub const ALL: [Self; 4] =
        [Self::Ransac, Self::WeightedLeastSquares, Self::OrthogonalDistance, Self::Tracked];

    /// The name used in options and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ransac => "ransac",
            Self::WeightedLeastSquares => "weighted-least-squares",
            Self::OrthogonalDistance => "orthogonal-distance",
            Self::Tracked => "tracked",
        }
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Ransac => "RANSAC, least squares",
            Self::WeightedLeastSquares => "RANSAC, weighted least squares",
            Self::OrthogonalDistance => "RANSAC, orthogonal distance",
            Self::Tracked => "Tracked robust likelihood",
        }
    }

    /// Where it was published.
    pub fn reference(self) -> &'static str {
        match self {
            Self::Ransac => "Kellner et al. 2013; Fischler and Bolles 1981",
            Self::WeightedLeastSquares => "Aitken 1935",
            Self::OrthogonalDistance => "Boggs, Byrd and Schnabel 1987",
            Self::Tracked => "Boresight",
        }
    }

    /// Finds a method by its [`MotionMethod::name`].
    ///
    /// # Errors
    /// [`CoreError::Unknown`], listing the known names.
    pub fn from_name(name: &str) -> Result<Self, CoreError> {
        named("motion", &Self::ALL, Self::name, name)
    }
}
