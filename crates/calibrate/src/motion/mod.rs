//! The radar's own motion from one Doppler point cloud.
//!
//! A static point at azimuth `a` has `-range_rate = vx cos a + vy sin a` (equation 2 of Zhu et al.).
//! `ransac` finds the points that agree on one motion; `least_squares` and
//! `orthogonal_distance` make the most of them.

pub(crate) mod least_squares;
pub(crate) mod orthogonal_distance;
pub(crate) mod ransac;

use crate::{CalibrateError, Motion, MotionMethod, Options};
use boresight_core::{CoreError, Detection, Random};
use ransac::Search;

/// Detections as columns: what the sums and counts run over.
#[derive(Debug, Clone, Default)]
pub(crate) struct Columns {
    /// Cosine of azimuth; 0 where the detection is not finite.
    pub cos: Vec<f32>,
    /// Sine of azimuth; 0 where the detection is not finite.
    pub sin: Vec<f32>,
    /// Minus range rate, m/s; NaN where the detection is not finite, so that it agrees with nothing.
    pub approach: Vec<f32>,
    /// Positions of the finite detections.
    pub finite: Vec<u32>,
}

impl Columns {
    fn load(&mut self, detections: &[Detection]) {
        self.cos.clear();
        self.sin.clear();
        self.approach.clear();
        self.finite.clear();
        for (i, d) in detections.iter().enumerate() {
            let usable = d.azimuth_rad.is_finite() && d.range_rate_mps.abs() <= MAX_RANGE_RATE_MPS;
            let (sin, cos) = if usable { d.azimuth_rad.sin_cos() } else { (0.0, 0.0) };
            self.cos.push(cos);
            self.sin.push(sin);
            self.approach.push(if usable { -d.range_rate_mps } else { f32::NAN });
            if usable {
                self.finite.push(i as u32);
            }
        }
    }

    /// Cosine, sine and minus range rate of a detection.
    pub fn row(&self, i: usize) -> [f64; 3] {
        [f64::from(self.cos[i]), f64::from(self.sin[i]), f64::from(self.approach[i])]
    }
}

/// Faster than any car and slower than what overflows a sum of squares in single precision; markers
/// of missing values such as 1e30 lie above.
const MAX_RANGE_RATE_MPS: f32 = 1e4;

/// Residuals are believed down to this share of the noise expected: few detections agree more closely by
/// chance, copies of two do so for certain.
const LEAST_NOISE: f64 = 0.1;

/// Estimates the motion frame by frame, reusing its buffers.
#[derive(Debug, Clone)]
pub struct MotionEstimator {
    method: MotionMethod,
    options: Options,
    random: Random,
    columns: Columns,
    inliers: Vec<u32>,
    lines: Vec<orthogonal_distance::Line>,
    weights: Vec<f32>,
}

impl MotionEstimator {
    /// An estimator with the thresholds, noises and seed of the options.
    ///
    /// # Errors
    /// Those of [`Options::validate`]; [`CoreError::Unknown`] for [`MotionMethod::Tracked`], which
    /// needs more than one frame: ask a [`crate::Calibrator`] for it.
    pub fn new(options: &Options, method: MotionMethod) -> Result<Self, CalibrateError> {
        options.validate()?;
        if method == MotionMethod::Tracked {
            return Err(CoreError::Unknown {
                what: "motion of one frame".into(),
                expected: "ransac, weighted-least-squares, orthogonal-distance".into(),
                given: method.name().into(),
            }
            .into());
        }
        Ok(Self {
            method,
            options: *options,
            random: Random::new(options.seed, 0),
            columns: Columns::default(),
            inliers: Vec::new(),
            lines: Vec::new(),
            weights: Vec::new(),
        })
    }

    /// The motion, with covariance (equation 3 for least squares; the noise model's, inflated by the
    /// residuals where they exceed it, for the weighted methods). `None` where fewer than
    /// `min_inliers` detections agree, or their azimuths do not span a plane.
    pub fn estimate(&mut self, detections: &[Detection]) -> Option<Motion> {
        self.columns.load(detections);
        self.weights.clear();
        self.weights.resize(detections.len(), 0.0);
        let o = &self.options;
        let search = Search {
            residual_mps: o.inlier_residual_mps,
            confidence: o.confidence,
            min_share: o.inlier_ratio_threshold,
        };
        let mut velocity = search.run(&self.columns, &mut self.random, &mut self.inliers)?;
        let noise = [o.range_rate_sigma_mps, o.azimuth_sigma_rad];
        let fit = match self.method {
            MotionMethod::WeightedLeastSquares | MotionMethod::OrthogonalDistance => {
                let limit = o.inlier_residual_mps / o.range_rate_sigma_mps;
                let mut fit = None;
                for _ in 0..RESELECTIONS {
                    let (columns, inliers) = (&self.columns, &self.inliers);
                    let next = if self.method == MotionMethod::WeightedLeastSquares {
                        least_squares::weighted(columns, inliers, velocity, noise)
                    } else {
                        orthogonal_distance::fit(columns, inliers, velocity, noise, &mut self.lines)
                    }?;
                    velocity = next.0;
                    fit = Some(next);
                    let before = self.inliers.len();
                    least_squares::select(&self.columns, velocity, noise, limit, &mut self.inliers);
                    if self.inliers.len() == before {
                        break;
                    }
                }
                fit
            }
            _ => least_squares::plain(&self.columns, &self.inliers, LEAST_NOISE * noise[0]),
        };
        let (velocity_mps, covariance) = fit?;
        for &i in &self.inliers {
            self.weights[i as usize] = 1.0;
        }
        let threshold = o.inlier_threshold as f32;
        let inliers = self.weights.iter().filter(|&&w| w >= threshold).count();
        let finite = velocity_mps.iter().all(|v| v.is_finite())
            && covariance.xx.is_finite()
            && covariance.yy.is_finite();
        (finite && inliers >= o.min_inliers).then(|| Motion {
            velocity_mps,
            covariance: covariance.rows(),
            inliers,
            detections: detections.len(),
        })
    }

    /// For each detection of the last frame, whether it was taken as static (1) or not (0).
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }
}

/// How often inliers are selected anew by the noise model.
const RESELECTIONS: usize = 3;
