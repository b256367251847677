//! Coupling between all channels, from targets at known directions.

use crate::fit::{Fit, Fitted, amplitude};
use boresight_core::{Complex64, InputError};
use boresight_math::linalg::hermitian_eigen;
use ndarray::{Array1, Array2};

/// Most rounds of alternation.
const ROUNDS: usize = 2000;

/// Change of the misfit, as a share of it, below which alternation ends.
const SETTLED: f64 = 1e-9;

/// Least eigenvalue of the directions' responses over the largest: what is weaker is noise once it is undone.
const LEAST_SHARE: f64 = 1e-4;

/// A coupling matrix, and the misfit of each cell.
pub(crate) type Coupled = (Array2<Complex64>, Vec<f64>);

/// The matrix that turns responses of the plan into measured ones, and the misfit of each cell (Ng and See 1996); `None`
/// where the directions known do not span all channels.
pub(crate) fn matrix(
    fit: &Fit,
    start: &Fitted,
    weights: &[f64],
) -> Result<Option<Coupled>, InputError> {
    let channels = start.factors.len();
    let known: Vec<usize> =
        (0..fit.seen.len()).filter(|&index| fit.seen[index].known.is_some()).collect();
    if known.len() < channels {
        return Ok(None);
    }
    let plane: Vec<Vec<Complex64>> =
        known.iter().map(|&index| fit.waves.response(start.directions[index])).collect();
    let outer = |a: &[Complex64], b: &[Complex64]| {
        Array2::from_shape_fn((channels, channels), |(i, k)| a[i] * b[k].conj())
    };
    let spread = plane.iter().fold(Array2::zeros((channels, channels)), |sum, a| sum + outer(a, a));
    let values = hermitian_eigen(spread.view())?.values;
    let (first, last) = (values[0], values[channels - 1]);
    if last <= LEAST_SHARE * first {
        return Ok(None);
    }
    let mut found = Array2::from_diag(&Array1::from(start.factors.clone()));
    let mut before = f64::INFINITY;
    let mut residuals = start.residuals.clone();
    for _ in 0..ROUNDS {
        let mut cross = Array2::<Complex64>::zeros((channels, channels));
        let mut power = Array2::<Complex64>::zeros((channels, channels));
        let mut cost = 0.0;
        for (a, &index) in plane.iter().zip(&known) {
            let model = found.dot(&Array1::from(a.clone())).to_vec();
            let (b, left) = amplitude(&model, &fit.seen[index].signal);
            residuals[index] = left;
            cost += weights[index] * left;
            let scaled: Vec<Complex64> = a.iter().map(|z| z * b).collect();
            let weight = Complex64::from(weights[index]);
            cross = cross + outer(&fit.seen[index].signal, &scaled) * weight;
            power = power + outer(&scaled, &scaled) * weight;
        }
        if before - cost <= SETTLED * cost {
            break;
        }
        before = cost;
        // found = cross power^-1, both from the left of their adjoints.
        let adjoint = |m: &Array2<Complex64>| m.t().mapv(|z| z.conj());
        let right = adjoint(&cross);
        let Some(solved) = boresight_math::linalg::solve(adjoint(&power).view(), right.view())?
        else {
            return Ok(None);
        };
        found = adjoint(&solved);
        let mean = found.diag().iter().map(Complex64::norm_sqr).sum::<f64>() / channels as f64;
        let phase: Complex64 = found.diag().sum();
        let scale = phase / phase.norm().max(f64::MIN_POSITIVE) * mean.sqrt();
        if scale.norm() > 0.0 {
            found.mapv_inplace(|z| z / scale);
        }
    }
    Ok(Some((found, residuals)))
}
