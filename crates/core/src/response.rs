//! Taking an array's known errors off snapshots.

use crate::array::{Array, Position};
use crate::calibration::ArrayCalibration;
use crate::error::CoreError;
use crate::linalg::solve;
use ndarray::{Array1, Array2, ArrayViewMut2};
use num_complex::Complex64;
use std::sync::Arc;

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
    fn new(calibration: &ArrayCalibration) -> Result<Self, CoreError> {
        let each = calibration.factors().into_iter().map(|factor| factor.inv()).collect();
        let both = |rows: &[Vec<Complex64>]| Ok::<_, CoreError>([inverse(rows)?, matrix(rows)]);
        let uncoupling = calibration.coupling.as_deref().map(both).transpose()?;
        Ok(Self {
            each,
            uncoupling,
            range_bias_m: calibration.range_bias_m,
            residual_db: calibration.residual_db,
        })
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

impl Array {
    /// The array with what is known of its errors: elements where they really are, and a
    /// [`Correction`] that turns measured snapshots into those of such elements.
    ///
    /// # Errors
    /// [`CoreError::OtherArray`] for a calibration of another array; what is wrong with the
    /// calibration; [`CoreError::OutOfRange`] for coupling that cannot be undone.
    pub fn calibrated(&self, calibration: &ArrayCalibration) -> Result<Self, CoreError> {
        calibration.check()?;
        calibration.check_plan(self)?;
        let moved = |(p, channel): (&Position, _)| {
            let d = calibration.displacement(channel);
            [p[0] + d[0], p[1] + d[1], p[2] + d[2]]
        };
        let positions = self.positions().iter().zip(self.channels().iter().copied()).map(moved);
        let correction = Arc::new(Correction::new(calibration)?);
        Ok(self.with(positions.collect(), Some(correction)))
    }

    /// Corrects snapshots of the array's elements: elements x snapshots.
    ///
    /// # Errors
    /// [`CoreError::Shape`] for snapshots of other elements, and for coupling where the array has not
    /// all of the channels that couple.
    pub fn correct(&self, mut snapshots: ArrayViewMut2<'_, Complex64>) -> Result<(), CoreError> {
        let Some(correction) = self.correction() else { return Ok(()) };
        let channels: Vec<usize> =
            self.channels().iter().map(|c| c.tx * self.rx().len() + c.rx).collect();
        let wrong = |expected: String| CoreError::Shape {
            what: "snapshots".into(),
            expected,
            given: vec![snapshots.nrows(), snapshots.ncols()],
        };
        if snapshots.nrows() != channels.len() {
            return Err(wrong(format!("[{}, snapshots]", channels.len())));
        }
        let all = correction.each.len();
        let mut seen = vec![false; all];
        channels.iter().for_each(|&channel| seen[channel] = true);
        if correction.uncoupling.is_some() && seen.contains(&false) {
            return Err(wrong(format!("all {all} channels, between which there is coupling")));
        }
        let mut values = vec![Complex64::ZERO; all];
        for mut column in snapshots.columns_mut() {
            channels.iter().zip(&column).for_each(|(&channel, value)| values[channel] = *value);
            correction.apply(&mut values);
            channels.iter().zip(&mut column).for_each(|(&channel, value)| *value = values[channel]);
        }
        Ok(())
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
fn inverse(rows: &[Vec<Complex64>]) -> Result<Array2<Complex64>, CoreError> {
    let matrix = matrix(rows);
    let unit = Array2::from_diag(&Array1::from_elem(rows.len(), Complex64::ONE));
    let norm = |m: &Array2<Complex64>| m.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    let found = solve(matrix.view(), unit.view())?;
    // Noise grows with the condition number.
    let condition = found.as_ref().map_or(f64::INFINITY, |inverse| norm(inverse) * norm(&matrix));
    match found {
        Some(inverse) if condition < MOST_CONDITION => Ok(inverse),
        _ => Err(CoreError::OutOfRange {
            what: "condition number of the coupling".into(),
            expected: format!("at most {MOST_CONDITION:e}"),
            given: condition,
        }),
    }
}

/// Greatest condition number of coupling that is undone.
const MOST_CONDITION: f64 = 1e6;
