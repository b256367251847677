//! Estimators whose number of sources comes from outside the method, cell by cell: from a trained counting network.

use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::estimator::Estimator;
use crate::method::Method;
use crate::options::{EstimatorOptions, SourceCount};
use crate::plan::Plan;
use boresight_core::Array;
use boresight_options::{Described, columns};
use serde::Serialize;
use std::sync::Arc;

/// How probable each number of sources is.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct SourceProbabilities {
    /// The most probable number.
    pub sources: usize,
    /// Probability of 0, 1 and 2 sources, each by itself.
    #[option(described_as = Vec<f64>)]
    #[serde(serialize_with = "columns::serialize")]
    pub probability: [f64; 3],
}

/// What counts 0, 1 or 2 sources in data.
pub trait CountSources: Send + Sync {
    /// Whether it counts what such an array sees.
    ///
    /// # Errors
    /// [`AoaError::Array`] where it does not.
    fn check_array(&self, array: &Array) -> Result<(), AoaError>;

    /// Counts the sources in data that [`Data::check`] has passed.
    ///
    /// # Errors
    /// [`AoaError`] where the data does not suit, or the network fails.
    fn count(&self, data: Data<'_>) -> Result<SourceProbabilities, AoaError>;
}

/// A counter with an estimator for one source and one for two.
pub struct Counted {
    counter: Arc<dyn CountSources>,
    estimators: [Estimator; 2],
}

impl Counted {
    /// Puts them together; the estimators are made for one and two known sources, of one method and on one array.
    ///
    /// # Errors
    /// As [`CountSources::check_array`].
    pub fn new(
        counter: Arc<dyn CountSources>,
        estimators: [Estimator; 2],
    ) -> Result<Self, AoaError> {
        counter.check_array(estimators[0].array())?;
        Ok(Self { counter, estimators })
    }

    /// The method of the estimators.
    pub fn method(&self) -> Method {
        self.estimators[0].method()
    }

    /// The array of the estimators.
    pub fn array(&self) -> &Array {
        self.estimators[0].array()
    }

    /// Counts the sources in data.
    ///
    /// # Errors
    /// As [`Data::check`] and [`CountSources::count`].
    pub fn count(&self, data: Data<'_>) -> Result<SourceProbabilities, AoaError> {
        data.check(self.array().len())?;
        self.counter.count(data)
    }

    /// Estimates the angles of so many sources, of two where there are more; of none there are no sources and the
    /// warning [`Warning::NoSources`].
    ///
    /// # Errors
    /// As [`Estimator::estimate`].
    pub fn estimate_of(&mut self, sources: usize, data: Data<'_>) -> Result<Estimate, AoaError> {
        let [one, two] = &mut self.estimators;
        match sources {
            0 => {
                let nothing = Estimate::new(one.method());
                Ok(Estimate { warnings: vec![Warning::NoSources], ..nothing })
            }
            1 => one.estimate(data),
            _ => two.estimate(data),
        }
    }
}

impl Plan for Counted {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let sources = self.count(data)?.sources;
        self.estimate_of(sources, data)
    }
}

impl Estimator {
    /// As [`Estimator::new`], with the sources of each cell counted by `counter` where the options ask for it
    /// ([`SourceCount::Network`]) and the method needs their number.
    ///
    /// # Errors
    /// As [`Estimator::new`] and [`CountSources::check_array`].
    pub fn counted(
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
        counter: &Arc<dyn CountSources>,
    ) -> Result<Self, AoaError> {
        if options.sources != SourceCount::Network || !method.requirements().source_count {
            return Self::new(method, array, options);
        }
        Self::counted_by(counter, options, |options| Self::new(method, array, options))
    }

    /// An estimator of counted sources from what makes one of known ones.
    ///
    /// # Errors
    /// As `known` and [`CountSources::check_array`].
    pub fn counted_by<E: From<AoaError>>(
        counter: &Arc<dyn CountSources>,
        options: &EstimatorOptions,
        known: impl Fn(&EstimatorOptions) -> Result<Self, E>,
    ) -> Result<Self, E> {
        let of =
            |sources| known(&EstimatorOptions { sources: SourceCount::Known(sources), ..*options });
        let counted = Counted::new(counter.clone(), [of(1)?, of(2)?])?;
        let (method, array) = (counted.method(), counted.array().clone());
        // The estimators within refine what they find.
        let options = EstimatorOptions { refine: false, ..*options };
        Ok(Self::with_plan(method, &array, Box::new(counted), &options)?)
    }
}
