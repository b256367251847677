//! Options of the calibration, in SI units and radians.

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
