//! Maximum likelihood with more information than other methods: the region itself, or the knowledge (which the networks
//! have) that targets lie at whole degrees.

use super::REGION;
use super::tally::{FIELD_OF_VIEW_RAD, LARGEST_DEG};
use crate::error::EvaluateError;
use boresight_aoa::{EstimatorOptions, RangeAngle, SourceCount};
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex32, Complex64, Direction};
use boresight_math::linalg::Cholesky;
use boresight_math::order::sort_numbers;
use ndarray::{Array2, ArrayView3};

/// Kind of method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RegionMethod {
    /// Maximum likelihood of range and azimuth together.
    Joint,
    /// Maximum likelihood on the covariance, over whole degrees within those of the targets.
    WholeDegrees,
}

impl RegionMethod {
    pub const ALL: [Self; 2] = [Self::Joint, Self::WholeDegrees];

    pub fn name(self) -> &'static str {
        match self {
            Self::Joint => "joint range-angle",
            Self::WholeDegrees => "maximum-likelihood, whole degrees",
        }
    }

    /// Prepares the method for a known number of targets.
    pub fn plan(
        self,
        array: &Array,
        samples: usize,
        targets: usize,
    ) -> Result<RegionPlan, EvaluateError> {
        Ok(match self {
            Self::Joint => {
                let options = EstimatorOptions {
                    sources: SourceCount::Known(targets),
                    field_of_view_rad: FIELD_OF_VIEW_RAD,
                    ..EstimatorOptions::default()
                };
                RegionPlan::Joint(Box::new(RangeAngle::new(array, samples, REGION[0], &options)?))
            }
            Self::WholeDegrees => RegionPlan::WholeDegrees(projections(array, targets)?),
        })
    }
}

/// Prepared method.
pub(super) enum RegionPlan {
    Joint(Box<RangeAngle>),
    /// All sets of whole degrees.
    WholeDegrees(Vec<Hypothesis>),
}

/// Azimuths, rad, and the projection on the span of their steering vectors.
type Hypothesis = (Vec<f64>, Array2<Complex64>);

impl RegionPlan {
    /// Returns the azimuths of the targets in ascending order, rad, or `None` if fewer were found.
    pub fn azimuths(
        &mut self,
        region: ArrayView3<'_, Complex32>,
        covariance: &Array2<Complex64>,
        targets: usize,
    ) -> Result<Option<Vec<f64>>, EvaluateError> {
        Ok(match self {
            Self::Joint(joint) => {
                let found = joint.estimate(region)?;
                let mut azimuths: Vec<f64> = found.targets.iter().map(|t| t.azimuth_rad).collect();
                sort_numbers(&mut azimuths);
                (azimuths.len() == targets).then_some(azimuths)
            }
            Self::WholeDegrees(sets) => {
                let explained = |projection: &Array2<Complex64>| -> f64 {
                    projection.iter().zip(covariance).map(|(p, r)| (p.conj() * r).re).sum()
                };
                let all = sets.iter().map(|(azimuths, p)| (azimuths, explained(p)));
                all.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(azimuths, _)| azimuths.clone())
            }
        })
    }
}

/// Returns the hypotheses of one or two targets at whole degrees.
fn projections(array: &Array, targets: usize) -> Result<Vec<Hypothesis>, EvaluateError> {
    let degrees = || -LARGEST_DEG..=LARGEST_DEG;
    let sets: Vec<Vec<i32>> = match targets {
        1 => degrees().map(|one| vec![one]).collect(),
        _ => degrees()
            .flat_map(|one| {
                degrees().filter(move |other| *other > one).map(move |other| vec![one, other])
            })
            .collect(),
    };
    let of = |set: Vec<i32>| {
        let azimuths: Vec<f64> =
            set.iter().map(|degrees| f64::from(*degrees).to_radians()).collect();
        let directions: Vec<Direction> = azimuths.iter().map(|a| Direction::azimuth(*a)).collect();
        let steering = steering_matrix(array, &directions);
        let adjoint = boresight_math::linalg::adjoint(steering.view());
        let inverse = Cholesky::new(adjoint.dot(&steering).view())?.inverse();
        Ok((azimuths, steering.dot(&inverse).dot(&adjoint)))
    };
    sets.into_iter().map(of).collect()
}
