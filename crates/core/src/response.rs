//! Taking an array's known errors off snapshots.

use crate::array::{Array, Position};
use crate::calibration::ArrayCalibration;
use crate::correction::Correction;
use boresight_math::error::InputError;
use ndarray::ArrayViewMut2;
use num_complex::Complex64;
use std::sync::Arc;

impl Array {
    /// The array with what is known of its errors: elements where they really are, and a
    /// [`Correction`] that turns measured snapshots into those of such elements.
    ///
    /// # Errors
    /// [`InputError::OtherArray`] for a calibration of another array; what is wrong with the
    /// calibration; [`InputError::OutOfRange`] for coupling that cannot be undone.
    pub fn calibrated(&self, calibration: &ArrayCalibration) -> Result<Self, InputError> {
        calibration.check()?;
        calibration.check_plan(self)?;
        let moved = |(p, channel): (&Position, _)| {
            let d = calibration.displacement(channel);
            [p[0] + d[0], p[1] + d[1], p[2] + d[2]]
        };
        let positions = self.positions().iter().zip(self.channels().iter().copied()).map(moved);
        let correction = Correction::new(
            calibration.factors(),
            calibration.coupling.as_deref(),
            calibration.range_bias_m,
            calibration.residual_db,
        )?;
        Ok(self.with(positions.collect(), Some(Arc::new(correction))))
    }

    /// Corrects snapshots of the array's elements: elements x snapshots.
    ///
    /// # Errors
    /// [`InputError::Shape`] for snapshots of other elements, and for coupling where the array has not
    /// all of the channels that couple.
    pub fn correct(&self, mut snapshots: ArrayViewMut2<'_, Complex64>) -> Result<(), InputError> {
        let Some(correction) = self.correction() else { return Ok(()) };
        let channels: Vec<usize> =
            self.channels().iter().map(|c| c.tx * self.rx().len() + c.rx).collect();
        let wrong = |expected: String| InputError::Shape {
            what: "snapshots".into(),
            expected,
            given: vec![snapshots.nrows(), snapshots.ncols()],
        };
        if snapshots.nrows() != channels.len() {
            return Err(wrong(format!("[{}, snapshots]", channels.len())));
        }
        let all = correction.channels();
        let mut seen = vec![false; all];
        channels.iter().for_each(|&channel| seen[channel] = true);
        if correction.is_coupled() && seen.contains(&false) {
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
