//! What each method of angle estimation implements, and the plans of those that need no network.

use crate::atomic_norm::AtomicNorm;
use crate::bartlett::Bartlett;
use crate::capon::Capon;
use crate::coarray_music::CoarrayMusic;
use crate::data::Data;
use crate::error::AoaError;
use crate::esprit::Esprit;
use crate::estimate::Estimate;
use crate::iaa::Iaa;
use crate::maximum_likelihood::MaximumLikelihood;
use crate::method::Method;
use crate::min_norm::MinNorm;
use crate::music::Music;
use crate::nomp::Nomp;
use crate::options::{EstimatorOptions, SourceCount};
use crate::root_music::RootMusic;
use crate::single_snapshot_music::SingleSnapshotMusic;
use crate::sparse_bayesian::SparseBayesian;
use boresight_core::{Array, Complex64};
use ndarray::ArrayView3;

/// What each method implements: everything that depends on array and options alone (grids, FFT
/// plans, steering vectors, scratch space) is made once, in the method's own constructor.
pub trait Plan: Send {
    /// Estimates the angles in data that [`Data::check`] has passed.
    ///
    /// # Errors
    /// [`AoaError`] when the data does not suit the method.
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError>;

    /// The same into an estimate whose memory is used again.
    ///
    /// # Errors
    /// As [`Plan::estimate`].
    fn estimate_into(&mut self, data: Data<'_>, out: &mut Estimate) -> Result<(), AoaError> {
        *out = self.estimate(data)?;
        Ok(())
    }

    /// Operations of an estimate beside those that follow from method, array and options: those of a network.
    ///
    /// # Errors
    /// [`AoaError`] where it cannot be analysed.
    fn operations(&self) -> Result<f64, AoaError> {
        Ok(0.0)
    }

    /// Whether it sets [`Estimate::resolved`] by a test of its own.
    fn tests_sources(&self) -> bool {
        false
    }

    /// Number of cells it is best given at once; those of a batch come in such portions.
    fn cells_at_once(&self) -> usize {
        1
    }

    /// Estimates the angles in the snapshots of several cells, cells x elements x snapshots, all finite, into as
    /// many estimates. Each is what [`Plan::estimate`] gives for it alone.
    ///
    /// # Errors
    /// As [`Plan::estimate`].
    fn estimate_cells(
        &mut self,
        cells: ArrayView3<'_, Complex64>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        for (cell, out) in cells.outer_iter().zip(out) {
            self.estimate_into(Data::Snapshots(cell), out)?;
        }
        Ok(())
    }
}

/// The plan of a method; of a network there is none without its model.
pub(crate) fn plan(
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
