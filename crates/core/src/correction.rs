//! What turns measured channels into those of an array without errors.

use boresight_math::error::InputError;
use boresight_math::linalg::solve;
use ndarray::{Array1, Array2};
use num_complex::Complex64;

/// What turns measured channels into those of the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    each: Vec<Complex64>,
    /// The inverse of the coupling, and the coupling.
    uncoupling: Option<[Array2<Complex64>; 2]>,
    range_bias_m: f64,
    residual_db: Option<f64>,
}

impl Correction {
    /// From the factors of all channels, the coupling between them, what measured ranges are too long by, m, and what is left
    /// of a response, dB.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for coupling that cannot be undone.
    pub(crate) fn new(
        factors: Vec<Complex64>,
        coupling: Option<&[Vec<Complex64>]>,
        range_bias_m: f64,
        residual_db: Option<f64>,
    ) -> Result<Self, InputError> {
        let each = factors.into_iter().map(|factor| factor.inv()).collect();
        let both = |rows: &[Vec<Complex64>]| Ok::<_, InputError>([inverse(rows)?, matrix(rows)]);
        let uncoupling = coupling.map(both).transpose()?;
        Ok(Self { each, uncoupling, range_bias_m, residual_db })
    }

    /// Number of channels.
    pub(crate) fn channels(&self) -> usize {
        self.each.len()
    }

    /// Whether there is coupling between channels.
    pub(crate) fn is_coupled(&self) -> bool {
        self.uncoupling.is_some()
    }

    /// Corrects the measured values of all channels, all receivers of a transmitter after each other.
    /// Values beyond the channels are left alone.
    pub fn apply(&self, channels: &mut [Complex64]) {
        if let Some([uncoupling, _]) = &self.uncoupling {
            multiply(uncoupling, channels);
        }
        channels.iter_mut().zip(&self.each).for_each(|(value, factor)| *value *= factor);
    }

    /// What is measured of channels of the plan: the inverse of [`Correction::apply`].
    pub fn undo(&self, channels: &mut [Complex64]) {
        channels.iter_mut().zip(&self.each).for_each(|(value, factor)| *value /= factor);
        if let Some([_, coupling]) = &self.uncoupling {
            multiply(coupling, channels);
        }
    }

    /// Power of what the calibration leaves of a single target's response over that of the response, dB, where it says so.
    pub fn residual_db(&self) -> Option<f64> {
        self.residual_db
    }

    /// What measured ranges are too long by, m.
    pub fn range_bias_m(&self) -> f64 {
        self.range_bias_m
    }
}

/// Multiplies the channels by a matrix, where it is of as many.
fn multiply(by: &Array2<Complex64>, channels: &mut [Complex64]) {
    if by.ncols() == channels.len() {
        let product = by.dot(&Array1::from(channels.to_vec()));
        channels.iter_mut().zip(product).for_each(|(to, from)| *to = from);
    }
}

fn matrix(rows: &[Vec<Complex64>]) -> Array2<Complex64> {
    Array2::from_shape_fn((rows.len(), rows.len()), |(i, k)| rows[i][k])
}

/// The inverse of a coupling matrix.
fn inverse(rows: &[Vec<Complex64>]) -> Result<Array2<Complex64>, InputError> {
    let matrix = matrix(rows);
    let unit = Array2::from_diag(&Array1::from_elem(rows.len(), Complex64::ONE));
    let norm = |m: &Array2<Complex64>| m.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    let found = solve(matrix.view(), unit.view())?;
    // Noise grows with the condition number.
    let condition = found.as_ref().map_or(f64::INFINITY, |inverse| norm(inverse) * norm(&matrix));
    match found {
        Some(inverse) if condition < MOST_CONDITION => Ok(inverse),
        _ => Err(InputError::OutOfRange {
            what: "condition number of the coupling".into(),
            expected: format!("at most {MOST_CONDITION:e}"),
            given: condition,
        }),
    }
}

/// Greatest condition number of coupling that is undone.
const MOST_CONDITION: f64 = 1e6;
