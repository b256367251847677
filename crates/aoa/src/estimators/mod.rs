//! The methods that need no network, one in each file.

pub(crate) mod atomic_norm;
pub(crate) mod bartlett;
pub(crate) mod capon;
pub(crate) mod coarray_music;
pub(crate) mod esprit;
pub(crate) mod iaa;
pub(crate) mod maximum_likelihood;
pub(crate) mod min_norm;
pub(crate) mod music;
pub(crate) mod nomp;
pub(crate) mod root_music;
pub(crate) mod single_snapshot_music;
pub(crate) mod sparse_bayesian;

use crate::error::AoaError;
use crate::method::Method;
use crate::options::{EstimatorOptions, SourceCount};
use crate::plan::Plan;
use atomic_norm::AtomicNorm;
use bartlett::Bartlett;
use boresight_core::Array;
use capon::Capon;
use coarray_music::CoarrayMusic;
use esprit::Esprit;
use iaa::Iaa;
use maximum_likelihood::MaximumLikelihood;
use min_norm::MinNorm;
use music::Music;
use nomp::Nomp;
use root_music::RootMusic;
use single_snapshot_music::SingleSnapshotMusic;
use sparse_bayesian::SparseBayesian;

/// Prepares a method. Networks need their model and are prepared elsewhere.
pub(crate) fn prepare(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
) -> Result<Box<dyn Plan>, AoaError> {
    if options.sources == SourceCount::Network && method.requirements().source_count {
        return Err(AoaError::NeedsCounter { method: method.name() });
    }
    Ok(match method {
        Method::Bartlett => Box::new(Bartlett::new(array, options)?),
        Method::Capon => Box::new(Capon::new(array, options)?),
        Method::Music => Box::new(Music::new(array, options)?),
        Method::SingleSnapshotMusic => Box::new(SingleSnapshotMusic::new(array, options)?),
        Method::RootMusic => Box::new(RootMusic::new(array, options)?),
        Method::Esprit => Box::new(Esprit::new(array, options)?),
        Method::MinNorm => Box::new(MinNorm::new(array, options)?),
        Method::CoarrayMusic => Box::new(CoarrayMusic::new(array, options)?),
        Method::Iaa => Box::new(Iaa::new(array, options)?),
        Method::Nomp => Box::new(Nomp::new(array, options)?),
        Method::AtomicNorm => Box::new(AtomicNorm::new(array, options)?),
        Method::MaximumLikelihood => Box::new(MaximumLikelihood::new(array, options)?),
        Method::SparseBayesian => Box::new(SparseBayesian::new(array, options)?),
        _ => return Err(AoaError::NeedsModel { method: method.name() }),
    })
}
