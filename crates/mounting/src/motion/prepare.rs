//! The methods of motion by name.

use super::orthogonal_distance::OrthogonalDistance;
use super::plan::MotionPlan;
use super::ransac::Ransac;
use super::weighed::Weighed;
use super::weighted_least_squares::WeightedLeastSquares;
use crate::error::MountingError;
use crate::network::MotionNetwork;
use crate::options::{CalibrationOptions, MotionMethod};
use crate::recursive::Recursive;
use std::sync::Arc;

/// Prepares a method; networks need one that is given.
pub(crate) fn prepare(
    method: MotionMethod,
    options: &CalibrationOptions,
    network: Option<&Arc<MotionNetwork>>,
) -> Result<Box<dyn MotionPlan>, MountingError> {
    options.validate()?;
    Ok(match method {
        MotionMethod::Ransac => Box::new(Ransac::new(options)),
        MotionMethod::WeightedLeastSquares => Box::new(WeightedLeastSquares::new(options)),
        MotionMethod::OrthogonalDistance => Box::new(OrthogonalDistance::new(options)),
        MotionMethod::Tracked => Box::new(Recursive::new(options)?),
        MotionMethod::Deepego | MotionMethod::DeepegoPlus => {
            Box::new(Weighed::new(method, network, options)?)
        }
    })
}
