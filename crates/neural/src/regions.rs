//! The networks that Sang et al. (2021) run on a region in turn: one counts, another of two tells the angles.

use crate::card::Kind;
use crate::classifier::rises;
use crate::error::NeuralError;
use crate::features::ELEMENTS;
use crate::model::Model;
use boresight_aoa::{
    AoaError, CountSources, Counted, Data, Estimator, EstimatorOptions, Estimators, SourceCount,
    SourceProbabilities,
};
use boresight_core::Array;
use boresight_math::error::check_range;
use boresight_options::Named;
use std::sync::Arc;

/// Half width of the sector of networks of regions, rad: 10 deg.
pub const REGION_FIELD_OF_VIEW_RAD: f64 = 0.174_532_925_199_432_95;

/// A counting network, and networks that tell the angles of one and of two targets.
#[derive(Clone, Copy)]
pub struct RegionNetworks<'a> {
    /// Of kind `counting`.
    pub counting: &'a Model,
    /// A DNN or 3D-CNN for one target.
    pub one: &'a Model,
    /// One of the same kind for two targets.
    pub two: &'a Model,
}

impl RegionNetworks<'_> {
    /// The three together, for an array. Answers are whole degrees within 10 of boresight, or, refined, what fits the
    /// region best near them ([`EstimatorOptions::refine`]).
    ///
    /// # Errors
    /// [`NeuralError::WrongKind`] where a network is of another kind or the two that tell angles are of different
    /// ones, [`NeuralError::Targets`] where a card says that a network is for another number of targets; otherwise as
    /// [`Model::estimator`].
    pub fn counted(&self, array: &Array, refine: bool) -> Result<Counted, NeuralError> {
        let counter = self.counting.counter()?;
        if !matches!(self.one.kind(), Kind::Dnn | Kind::Cnn3d) {
            return Err(self.one.wrong_kind("dnn or cnn3d"));
        }
        if self.two.kind() != self.one.kind() {
            return Err(self.two.wrong_kind(self.one.kind().name()));
        }
        let of = |model: &Model, expected| {
            if let Some(card) = model.card()
                && let Some(given) = card.targets
                && given != expected
            {
                let name = card.name.clone();
                return Err(NeuralError::Targets { name, expected, given });
            }
            let sources = SourceCount::Known(expected);
            let options = EstimatorOptions {
                sources,
                field_of_view_rad: REGION_FIELD_OF_VIEW_RAD,
                refine,
                ..EstimatorOptions::default()
            };
            model.estimator(array, &options)
        };
        Ok(Counted::new(counter, [of(self.one, 1)?, of(self.two, 2)?])?)
    }
}

impl CountSources for Model {
    fn check_array(&self, array: &Array) -> Result<(), AoaError> {
        rises(array, ELEMENTS, Kind::Counting.name()).map(|_| ())
    }

    fn count(&self, data: Data<'_>) -> Result<SourceProbabilities, AoaError> {
        let failed = |error| crate::error::network_failed(Kind::Counting.name(), error);
        Self::count(self, data).map_err(failed)
    }
}

impl Model {
    /// The network as what counts the sources of estimators ([`SourceCount::Network`]).
    ///
    /// # Errors
    /// [`NeuralError::WrongKind`] for any but the counting network.
    pub fn counter(&self) -> Result<Arc<dyn CountSources>, NeuralError> {
        if self.kind() != Kind::Counting {
            return Err(self.wrong_kind("counting"));
        }
        Ok(Arc::new(self.clone()))
    }

    /// As [`Model::estimator`], with the sources of each cell counted by `counter` where the options ask for it
    /// ([`SourceCount::Network`]) and the network takes their number: DNN and 3D-CNN.
    ///
    /// # Errors
    /// As [`Model::estimator`]; [`NeuralError::Angle`] where the array does not suit the counter.
    pub fn counted_estimator(
        &self,
        array: &Array,
        options: &EstimatorOptions,
        counter: &Arc<dyn CountSources>,
    ) -> Result<Estimator, NeuralError> {
        let is_counted = options.sources == SourceCount::Network
            && matches!(self.kind(), Kind::Dnn | Kind::Cnn3d);
        if !is_counted {
            return self.estimator(array, options);
        }
        Estimator::counted_by(counter, options, |known| self.estimator(array, known))
    }

    /// As [`Model::counted_estimator`], for up to `threads` threads.
    ///
    /// # Errors
    /// As [`Model::counted_estimator`]; [`boresight_core::InputError::OutOfRange`] for no threads, or more than 1024.
    pub fn counted_estimators(
        &self,
        array: &Array,
        options: &EstimatorOptions,
        threads: usize,
        counter: &Arc<dyn CountSources>,
    ) -> Result<Estimators, NeuralError> {
        check_range("threads", threads as f64, 1.0, 1024.0)?;
        let one = |_| self.counted_estimator(array, options, counter);
        Ok(Estimators::of((0..threads).map(one).collect::<Result<_, _>>()?)?)
    }
}
