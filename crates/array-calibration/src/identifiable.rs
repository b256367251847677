//! What cells determine: the Fisher information of gains, phases and displacements, its rank and its
//! inverse.

use crate::fit::{Fit, Fitted};
use crate::orthonormal::orthonormal;
use boresight_core::{Complex64, InputError};
use boresight_math::linalg::hermitian_eigen;
use ndarray::Array2;
use std::f64::consts::PI;

/// Eigenvalues below this share of the largest are those of what is not determined.
const NOTHING: f64 = 1e-9;

/// Information on real parameters, after each cell's own amplitude and direction are accounted for.
pub(crate) struct Information {
    pub matrix: Array2<f64>,
    /// `J^T W r` for the residuals `r`: what a Gauss-Newton step solves for.
    pub gradient: Vec<f64>,
    /// Sum over cells of outer products of their own gradients.
    pub scatter: Array2<f64>,
    /// Cells that went in.
    pub cells: usize,
}

/// The inverse on what is determined.
pub(crate) struct Inverse {
    pub matrix: Array2<f64>,
    /// How many parameters, or sums of them, are not determined.
    pub undetermined: usize,
}

impl Information {
    fn zeros(size: usize) -> Self {
        Self {
            matrix: Array2::zeros((size, size)),
            gradient: vec![0.0; size],
            scatter: Array2::zeros((size, size)),
            cells: 0,
        }
    }

    /// Of the phases of the channels and, if asked for, of their displacements along the array's axes
    /// in radians (times pi), all channels of one axis after each other.
    pub fn of_phases(fit: &Fit, found: &Fitted, weights: &[f64], with_positions: bool) -> Self {
        let channels = fit.waves.positions.len();
        let axes: &[usize] = if with_positions { &fit.waves.axes } else { &[] };
        let mut information = Self::zeros(channels * (1 + axes.len()));
        for (index, cell) in fit.seen.iter().enumerate() {
            let u = found.directions[index];
            let own = fit.common_phases(u, cell.known.is_none());
            let terms: Vec<f64> = std::iter::once(1.0).chain(axes.iter().map(|&a| u[a])).collect();
            information.add(fit, found, index, weights[index], &own, &terms, |ratio| ratio.im);
        }
        information
    }

    /// Of the logarithms of the gains.
    pub fn of_gains(fit: &Fit, found: &Fitted, weights: &[f64]) -> Self {
        let channels = fit.waves.positions.len();
        let mut information = Self::zeros(channels);
        for (index, weight) in weights.iter().enumerate() {
            let own = vec![vec![1.0; channels]];
            information.add(fit, found, index, *weight, &own, &[1.0], |ratio| ratio.re - 1.0);
        }
        information
    }

    /// Adds a cell: its `own` parameters are projected out, `terms` say how each block of parameters shows in it.
    #[allow(clippy::too_many_arguments)] // a cell's parts
    fn add(
        &mut self,
        fit: &Fit,
        found: &Fitted,
        index: usize,
        weight: f64,
        own: &[Vec<f64>],
        terms: &[f64],
        part: impl Fn(Complex64) -> f64,
    ) {
        let response = fit.response(found, found.directions[index]);
        let channels = response.len();
        let signal = &fit.seen[index].signal;
        let mut share = vec![0.0; channels];
        let mut residual = vec![0.0; channels];
        for k in 0..channels {
            let model = response[k] * found.factors[k] * found.amplitudes[index];
            // Half of the variance lies in each part.
            share[k] = 2.0 * weight * model.norm_sqr();
            let size = model.norm_sqr().max(1e-12);
            residual[k] = part(signal[k] * model.conj() / size);
        }
        let projected = project(&share, own);
        let turned: Vec<f64> = (0..channels)
            .map(|i| (0..channels).map(|k| projected[[i, k]] * residual[k]).sum())
            .collect();
        let size = channels * terms.len();
        let gradient: Vec<f64> =
            (0..size).map(|i| terms[i / channels] * turned[i % channels]).collect();
        for i in 0..size {
            for k in 0..size {
                self.matrix[[i, k]] += terms[i / channels]
                    * terms[k / channels]
                    * projected[[i % channels, k % channels]];
                self.scatter[[i, k]] += gradient[i] * gradient[k];
            }
            self.gradient[i] += gradient[i];
        }
        self.cells += 1;
    }

    /// The inverse on what is determined: the smallest step and, of it, the covariance.
    ///
    /// # Errors
    /// Those of the eigenvalues.
    pub fn inverse(&self) -> Result<Inverse, InputError> {
        let complex = self.matrix.mapv(|x| Complex64::new(x, 0.0));
        let eigen = hermitian_eigen(complex.view())?;
        let largest = eigen.values.first().copied().unwrap_or_default().max(0.0);
        let size = self.gradient.len();
        let mut matrix = Array2::zeros((size, size));
        let mut undetermined = 0;
        for (value, vector) in eigen.values.iter().zip(eigen.vectors.columns()) {
            if *value <= NOTHING * largest {
                undetermined += 1;
                continue;
            }
            for i in 0..size {
                for k in 0..size {
                    matrix[[i, k]] += (vector[i] * vector[k].conj()).re / value;
                }
            }
        }
        Ok(Inverse { matrix, undetermined })
    }

    /// Variances of the parameters by the cells' own scatter, which holds what noise does not explain. None of one cell.
    pub fn scattered(&self, inverse: &Inverse) -> Option<Vec<f64>> {
        if self.cells < 2 {
            return None;
        }
        let few = self.cells as f64 / (self.cells as f64 - 1.0);
        let covariance = inverse.matrix.dot(&self.scatter).dot(&inverse.matrix);
        Some(covariance.diag().iter().map(|variance| variance.max(0.0) * few).collect())
    }
}

impl Inverse {
    /// The Gauss-Newton step.
    pub fn step(&self, gradient: &[f64]) -> Vec<f64> {
        self.matrix
            .outer_iter()
            .map(|row| row.iter().zip(gradient).map(|(a, g)| a * g).sum())
            .collect()
    }

    pub fn variances(&self) -> Vec<f64> {
        self.matrix.diag().iter().map(|variance| variance.max(0.0)).collect()
    }
}

/// `W - W N (N^T W N)^+ N^T W` for the diagonal `W` and the columns of `N`.
fn project(share: &[f64], own: &[Vec<f64>]) -> Array2<f64> {
    let channels = share.len();
    let mut matrix =
        Array2::from_shape_fn((channels, channels), |(i, k)| if i == k { share[i] } else { 0.0 });
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).zip(share).map(|((x, y), w)| x * y * w).sum()
    };
    for known in orthonormal(own, dot) {
        for i in 0..channels {
            for k in 0..channels {
                matrix[[i, k]] -= share[i] * known[i] * known[k] * share[k];
            }
        }
    }
    matrix
}

/// How many phases and displacements no cells of these directions can determine, whatever their number.
pub(crate) fn never_determined(axes: usize, any_known: bool, with_positions: bool) -> usize {
    let phases = if any_known { 1 } else { 1 + axes };
    match (with_positions, any_known) {
        (false, _) => phases,
        // A displacement in common is a phase of each cell.
        (true, true) => phases + axes,
        // Besides, all cosines may be scaled, and turned within the array's plane.
        (true, false) => phases + axes + axes * axes,
    }
}

/// Half wavelengths of a displacement in radians.
pub(crate) fn half_wavelengths(radians: f64) -> f64 {
    radians / PI
}
