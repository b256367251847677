//! What the methods that look at one frame by itself share: RANSAC finds the detections that agree on a motion, and a fit
//! makes the most of them.

use super::Columns;
use super::least_squares::{Fit, select};
use super::search::Search;
use crate::frame::Motion;
use crate::options::CalibrationOptions;
use boresight_core::{Detection, Random};

/// How often inliers are selected anew by the noise model.
const RESELECTIONS: usize = 3;

/// The search with its buffers.
#[derive(Debug, Clone)]
pub(crate) struct Consensus {
    options: CalibrationOptions,
    random: Random,
    columns: Columns,
    inliers: Vec<u32>,
}

impl Consensus {
    pub fn new(options: &CalibrationOptions) -> Self {
        Self {
            options: *options,
            random: Random::new(options.seed, 0),
            columns: Columns::default(),
            inliers: Vec::new(),
        }
    }

    /// Draws from here on as for the frame of this number, whatever has been drawn before.
    pub fn draw_for(&mut self, frame: u64) {
        self.random = Random::new(self.options.seed, frame);
    }

    /// The motion, by a `fit` of the inliers that begins with the velocity of the search and may select others. `None`
    /// where fewer than `min_inliers` detections agree, or their azimuths do not span a plane.
    pub fn estimate(
        &mut self,
        detections: &[Detection],
        weights: &mut Vec<f32>,
        fit: impl FnOnce(&Columns, &mut Vec<u32>, [f64; 2]) -> Option<Fit>,
    ) -> Option<Motion> {
        self.columns.load(detections);
        weights.clear();
        weights.resize(detections.len(), 0.0);
        let o = &self.options;
        let search = Search {
            residual_mps: o.inlier_residual_mps,
            confidence: o.confidence,
            min_share: o.inlier_ratio_threshold,
        };
        let velocity = search.run(&self.columns, &mut self.random, &mut self.inliers)?;
        let (velocity_mps, covariance) = fit(&self.columns, &mut self.inliers, velocity)?;
        for &i in &self.inliers {
            weights[i as usize] = 1.0;
        }
        let threshold = o.inlier_threshold as f32;
        let inliers = weights.iter().filter(|&&w| w >= threshold).count();
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

    /// The same by a `fit` under the noise model (standard deviations of range rate and azimuth), by which inliers are
    /// selected anew until their number stays.
    pub fn estimate_reselecting(
        &mut self,
        detections: &[Detection],
        weights: &mut Vec<f32>,
        mut fit: impl FnMut(&Columns, &[u32], [f64; 2], [f64; 2]) -> Option<Fit>,
    ) -> Option<Motion> {
        let noise = [self.options.range_rate_sigma_mps, self.options.azimuth_sigma_rad];
        let limit = self.options.inlier_residual_mps / noise[0];
        self.estimate(detections, weights, |columns, inliers, mut velocity| {
            let mut last = None;
            for _ in 0..RESELECTIONS {
                let next = fit(columns, inliers, velocity, noise)?;
                velocity = next.0;
                last = Some(next);
                let before = inliers.len();
                select(columns, velocity, noise, limit, inliers);
                if inliers.len() == before {
                    break;
                }
            }
            last
        })
    }
}
