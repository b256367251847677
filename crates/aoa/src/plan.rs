//! What each method of angle estimation implements.

use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::Estimate;
use boresight_core::Complex64;
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
