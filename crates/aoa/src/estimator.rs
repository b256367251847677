//! One interface for all estimators.

use crate::checks::scale_of;
use crate::cost::Cost;
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::estimators;
use crate::method::Method;
use crate::options::EstimatorOptions;
use crate::order::significance::Significance;
use crate::plan::Plan;
use crate::refinement::Refinement;
use boresight_core::limits::check_operations;
use boresight_core::{Array, Complex64};
use ndarray::{ArrayView3, Axis};

/// An estimator ready to run on many cells.
pub struct Estimator {
    method: Method,
    array: Array,
    plan: Box<dyn Plan>,
    refinement: Option<Refinement>,
    significance: Significance,
    scale: Option<Warning>,
    cost: Cost,
    /// What cells of a batch are estimated into.
    pub(crate) scratch: Vec<Estimate>,
}

impl Estimator {
    /// Checks that method, array and options go together and prepares what does not depend on
    /// data.
    ///
    /// # Errors
    /// [`AoaError`] naming what does not fit.
    pub fn new(
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, AoaError> {
        options.check()?;
        Self::with_plan(method, array, estimators::prepare(method, array, options)?, options)
    }

    /// An estimator on a plan made elsewhere: that of a network.
    ///
    /// # Errors
    /// [`AoaError`] for options out of range, or where a refinement is asked for and the array does not suit it.
    pub fn with_plan(
        method: Method,
        array: &Array,
        plan: Box<dyn Plan>,
        options: &EstimatorOptions,
    ) -> Result<Self, AoaError> {
        options.check()?;
        let refinement = options.refine.then(|| Refinement::new(array, options)).transpose()?;
        let cost = Cost::new(method, array, options);
        let significance = Significance::new(array, options);
        let scale = scale_of(array);
        let (array, scratch) = (array.clone(), Vec::new());
        Ok(Self { method, array, plan, refinement, significance, scale, cost, scratch })
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
        check_operations("the estimate", self.cost.operations(data.snapshots()))?;
        self.plan.estimate_into(data, out)?;
        self.conclude(data, out)
    }

    /// Refines what the plan found, and tests it.
    fn conclude(&mut self, data: Data<'_>, out: &mut Estimate) -> Result<(), AoaError> {
        if let Some(refinement) = &mut self.refinement {
            refinement.apply(out, data)?;
        }
        if out.sources.is_empty() {
            data.check_not_vanishing()?;
        }
        if !self.plan.tests_sources() {
            self.significance.apply(out, data);
        }
        out.warnings.extend(self.scale.iter().cloned());
        Ok(())
    }

    /// Operations of each of so many cells, of so many snapshots.
    pub(crate) fn operations(&self, snapshots: usize, cells: usize) -> Result<f64, AoaError> {
        // A network is analysed for it, which is not worth it where all cells are one portion.
        let network = if cells > self.cells_at_once() { self.plan.operations()? } else { 0.0 };
        Ok(self.cost.operations(snapshots) + network)
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
        for (cell, estimate) in cells.axis_iter(Axis(0)).zip(out) {
            self.conclude(Data::Snapshots(cell), estimate)?;
        }
        Ok(())
    }
}
