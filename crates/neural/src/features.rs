//! The covariance as the networks of Sang et al. (2021) take it.

use boresight_aoa::Data;
use boresight_signal::{region, sample_covariance};

/// Elements of the array the networks are for.
pub(crate) const ELEMENTS: usize = 8;

/// Numbers in the upper triangle of an 8 x 8 covariance without its diagonal.
pub const COVARIANCE_FEATURES: usize = ELEMENTS * (ELEMENTS - 1);

/// The features of the covariance of what an estimator is given.
pub fn covariance_features(data: Data<'_>) -> Vec<f32> {
    match data {
        Data::Snapshots(snapshots) => {
            region::covariance_features(sample_covariance(snapshots).view())
        }
        Data::Covariance { matrix, .. } => region::covariance_features(matrix),
    }
}
