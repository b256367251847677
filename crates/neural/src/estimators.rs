//! Estimators made of models, by the kind of network.

use crate::card::Kind;
use crate::classifier::Classifier;
use crate::error::NeuralError;
use crate::model::Model;
use crate::spectrum::Spectral;
use crate::target_set::TargetSet;
use boresight_aoa::{
    AoaError, Data, Estimate, Estimator, EstimatorOptions, Estimators, Method, Plan, SourceCount,
};
use boresight_core::{Array, Complex32};
use boresight_math::error::check_range;
use boresight_options::Named;
use boresight_signal::region::{region_covariance, region_snapshots};
use ndarray::ArrayView3;

impl Model {
    /// An estimator for an array.
    ///
    /// # Errors
    /// [`NeuralError::WrongKind`] for the counting network; [`NeuralError::Angle`] where the array does not suit the
    /// network or options are out of range.
    pub fn estimator(
        &self,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Estimator, NeuralError> {
        let (method, plan) = self.plan(array, options)?;
        Ok(Estimator::with_plan(method, array, plan.boxed(), options)?)
    }

    /// Estimators for batches over up to `threads` threads.
    ///
    /// # Errors
    /// As [`Model::estimator`]; [`boresight_core::InputError::OutOfRange`] for no threads, or more than 1024.
    pub fn estimators(
        &self,
        array: &Array,
        options: &EstimatorOptions,
        threads: usize,
    ) -> Result<Estimators, NeuralError> {
        check_range("threads", threads as f64, 1.0, 1024.0)?;
        let (method, plan) = self.plan(array, options)?;
        let one = |_| Estimator::with_plan(method, array, plan.clone().boxed(), options);
        Ok(Estimators::of((0..threads).map(one).collect::<Result<_, _>>()?)?)
    }

    fn plan(
        &self,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<(Method, Network), NeuralError> {
        options.check()?;
        if options.sources == SourceCount::Network && self.kind() != Kind::Aaetr {
            return Err(AoaError::NeedsCounter { method: self.kind().name() }.into());
        }
        let Some(method) = self.kind().method() else {
            return Err(self.wrong_kind("any but a counting network"));
        };
        let network = match self.kind() {
            Kind::Aaetr | Kind::LearnedPursuit => {
                Network::TargetSet(TargetSet::new(self, method, array, options)?)
            }
            Kind::UnrolledIaa | Kind::CovarianceCnn | Kind::DeepMusic => {
                Network::Spectral(Box::new(Spectral::new(self, method, array, options)?))
            }
            _ => Network::Classifier(Classifier::new(self, method, array, options)?),
        };
        Ok((method, network))
    }

    /// Estimates angles in a region of the range spectrum, 65 bins x 8 elements x 4 chirps
    /// ([`boresight_signal::region::crop_region`]): the 3D-CNN from the region itself, the DNN from its covariance.
    ///
    /// # Errors
    /// As [`Model::estimator`] and [`Estimator::estimate`].
    pub fn estimate_region(
        &self,
        region: ArrayView3<'_, Complex32>,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Estimate, NeuralError> {
        let mut estimator = self.estimator(array, options)?;
        Ok(match self.kind() {
            Kind::Dnn => {
                let (length, _, chirps) = region.dim();
                let matrix = region_covariance(region);
                let snapshots = length * chirps;
                estimator.estimate(Data::Covariance { matrix: matrix.view(), snapshots })?
            }
            _ => estimator.estimate(Data::Snapshots(region_snapshots(region).view()))?,
        })
    }
}

#[derive(Clone)]
enum Network {
    TargetSet(TargetSet),
    Classifier(Classifier),
    Spectral(Box<Spectral>),
}

impl Network {
    fn boxed(self) -> Box<dyn Plan> {
        match self {
            Self::TargetSet(plan) => Box::new(plan),
            Self::Classifier(plan) => Box::new(plan),
            Self::Spectral(plan) => plan,
        }
    }
}
