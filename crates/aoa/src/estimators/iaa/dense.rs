//! IAA by matrix products over the whole grid: any array, any directions.

use super::inverse::Singular;
use super::kernel::{Kernel, weighted_power};
use crate::spectra::dense_grid::DenseGrid;
use boresight_core::{Array, Complex64, Direction};
use boresight_math::linalg::Cholesky;
use ndarray::{ArrayView1, ArrayView2};

/// The dense form.
pub struct DenseKernel {
    grid: DenseGrid,
    snapshots: Vec<Vec<Complex64>>,
    power: Vec<f64>,
}

impl DenseKernel {
    /// Plans for an array and the directions of the grid.
    pub fn new(array: &Array, directions: Vec<Direction>) -> Self {
        let power = vec![0.0; directions.len()];
        Self { grid: DenseGrid::new(array, directions), snapshots: Vec::new(), power }
    }
}

impl Kernel for DenseKernel {
    fn start(&mut self, y: ArrayView2<Complex64>, scale: f64) {
        self.snapshots =
            y.columns().into_iter().map(|c| c.iter().map(|z| z * scale).collect()).collect();
        let gain = 1.0 / (y.nrows() * y.nrows() * y.ncols()) as f64;
        self.power = self.grid.responses(&self.snapshots);
        self.power.iter_mut().for_each(|p| *p *= gain);
    }

    fn iterate(&mut self, loading: f64) -> Result<(), Singular> {
        let mut r = self.grid.covariance(&self.power);
        let diagonal = r[[0, 0]].re + loading;
        for d in r.diag_mut() {
            *d += loading;
        }
        let factor = Cholesky::new(r.view()).map_err(|_| Singular)?;
        let smallest = 4.0 * r.nrows() as f64 * f64::EPSILON * diagonal;
        if !factor.lower().diag().iter().all(|d| d.re * d.re > smallest) {
            return Err(Singular);
        }
        let solved: Vec<Vec<Complex64>> =
            self.snapshots.iter().map(|y| factor.solve(ArrayView1::from(y)).to_vec()).collect();
        let count = solved.len() as f64;
        let numerator = self.grid.responses(&solved);
        let denominator = self.grid.quadratic(&factor.inverse());
        for ((power, n), d) in self.power.iter_mut().zip(numerator).zip(denominator) {
            *power = weighted_power(n, d, count);
        }
        Ok(())
    }

    fn element_power(&self) -> f64 {
        self.power.iter().sum()
    }

    fn power_from(&self, first: usize, out: &mut [f64]) {
        out.copy_from_slice(&self.power[first..first + out.len()]);
    }

    fn map_power(&mut self, change: &mut dyn FnMut(f64) -> f64) {
        for power in &mut self.power {
            *power = change(*power);
        }
    }
}
