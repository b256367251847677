//! One interface for all estimators.

use crate::bartlett::Bartlett;
use crate::capon::Capon;
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
use crate::options::Options;
use crate::refinement::Refinement;
use crate::root_music::RootMusic;
use crate::single_snapshot_music::SingleSnapshotMusic;
use crate::sparse_bayesian::SparseBayesian;
use boresight_core::{Array, Complex64};
use ndarray::{ArrayView3, Axis};

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

/// An estimator ready to run on many cells.
pub struct Estimator {
    method: Method,
    array: Array,
    plan: Box<dyn Plan>,
    refinement: Option<Refinement>,
    /// What cells of a batch are estimated into.
    pub(crate) scratch: Vec<Estimate>,
}

impl Estimator {
    /// Checks that method, array and options go together and prepares what does not depend on
    /// data.
    ///
    /// # Errors
    /// [`AoaError`] naming what does not fit.
    pub fn new(method: Method, array: &Array, options: &Options) -> Result<Self, AoaError> {
        options.check()?;
        Self::with_plan(method, array, plan(method, array, options)?, options)
    }

    /// An estimator on a plan made elsewhere: that of a network.
    ///
    /// # Errors
    /// [`AoaError`] for options out of range, or where a refinement is asked for and the array does not suit it.
    pub fn with_plan(
        method: Method,
        array: &Array,
        plan: Box<dyn Plan>,
        options: &Options,
    ) -> Result<Self, AoaError> {
        options.check()?;
        let refinement = options.refine.then(|| Refinement::new(array, options)).transpose()?;
        Ok(Self { method, array: array.clone(), plan, refinement, scratch: Vec::new() })
    }

    /// The method.
    pub fn method(&self) -> Method {
        self.method
    }

    /// The array.
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// Estimates angles.
    ///
    /// # Errors
    /// [`AoaError`] when the data is malformed or does not suit the method.
    pub fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut estimate = Estimate::new(self.method);
        self.estimate_into(data, &mut estimate)?;
        Ok(estimate)
    }

    /// Like [`Estimator::estimate`], into an estimate whose memory is used again.
    ///
    /// # Errors
    /// As [`Estimator::estimate`]; then `out` holds nothing of use.
    pub fn estimate_into(&mut self, data: Data<'_>, out: &mut Estimate) -> Result<(), AoaError> {
        data.check(self.array.len())?;
        self.plan.estimate_into(data, out)?;
        match &mut self.refinement {
            Some(refinement) => refinement.apply(out, data),
            None => Ok(()),
        }
    }

    pub(crate) fn cells_at_once(&self) -> usize {
        self.plan.cells_at_once().max(1)
    }

    /// As [`Plan::estimate_cells`].
    pub(crate) fn estimate_cells(
        &mut self,
        cells: ArrayView3<'_, Complex64>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        self.plan.estimate_cells(cells, out)?;
        if let Some(refinement) = &mut self.refinement {
            for (cell, estimate) in cells.axis_iter(Axis(0)).zip(out) {
                refinement.apply(estimate, Data::Snapshots(cell))?;
            }
        }
        Ok(())
    }
}

fn plan(method: Method, array: &Array, options: &Options) -> Result<Box<dyn Plan>, AoaError> {
    Ok(match method {
        Method::Bartlett => Box::new(Bartlett::new(array, options)?),
        Method::Capon => Box::new(Capon::new(array, options)?),
        Method::Music => Box::new(Music::new(array, options)?),
        Method::SingleSnapshotMusic => Box::new(SingleSnapshotMusic::new(array, options)?),
        Method::RootMusic => Box::new(RootMusic::new(array, options)?),
        Method::Esprit => Box::new(Esprit::new(array, options)?),
        Method::MinNorm => Box::new(MinNorm::new(array, options)?),
        Method::Iaa => Box::new(Iaa::new(array, options)?),
        Method::Nomp => Box::new(Nomp::new(array, options)?),
        Method::MaximumLikelihood => Box::new(MaximumLikelihood::new(array, options)?),
        Method::SparseBayesian => Box::new(SparseBayesian::new(array, options)?),
        Method::Aaetr | Method::Dnn | Method::Cnn3d => {
            return Err(AoaError::NeedsModel { method: method.name() });
        }
    })
}
