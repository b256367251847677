//! Snapshots as networks take them: one a cell, as real and imaginary parts, the largest of which is one.

use crate::engine::filled;
use crate::error::NeuralError;
use crate::model::Model;
use boresight_aoa::{AoaError, Data, EstimatorOptions, Method, Warning};
use boresight_core::{Array, Complex64, presets};
use ndarray::{Array2, ArrayView3, Axis};
use tract_onnx::prelude::Tensor;

/// The largest part of each cell's snapshot, with the memory used again.
#[derive(Clone, Default)]
pub(crate) struct Scales(Vec<f64>);

impl Scales {
    /// Those of cells x elements x 1.
    pub fn of(
        &mut self,
        method: Method,
        cells: ArrayView3<'_, Complex64>,
    ) -> Result<&[f64], AoaError> {
        let given = cells.dim().2;
        if given != 1 {
            let (method, expected) = (method.name(), "one snapshot".into());
            return Err(AoaError::Snapshots { method, expected, given });
        }
        self.0.clear();
        self.0.extend(
            cells
                .outer_iter()
                .map(|cell| cell.iter().map(|z| z.re.abs().max(z.im.abs())).fold(0.0, f64::max)),
        );
        Ok(&self.0)
    }
}

/// The snapshots of a stretch of cells over their scales, cells x elements x 2; zeros where there is no signal.
pub(crate) fn scaled(
    cells: ArrayView3<'_, Complex64>,
    scales: &[f64],
    from: usize,
    to: usize,
) -> Result<Tensor, NeuralError> {
    let stretch = cells.slice_axis(Axis(0), (from..to).into());
    filled(&[to - from, cells.dim().1, 2], |numbers| {
        let mut numbers = numbers.chunks_exact_mut(2);
        for (cell, &scale) in stretch.outer_iter().zip(&scales[from..to]) {
            let gain = if scale > 0.0 { scale.recip() } else { 0.0 };
            for (z, pair) in cell.iter().zip(&mut numbers) {
                pair[0] = (z.re * gain) as f32;
                pair[1] = (z.im * gain) as f32;
            }
        }
    })
}

/// The snapshots of data as those of one cell.
pub(crate) fn one_cell<'a>(
    method: Method,
    data: Data<'a>,
) -> Result<ArrayView3<'a, Complex64>, AoaError> {
    match data {
        Data::Snapshots(snapshots) => Ok(snapshots.insert_axis(Axis(0))),
        Data::Covariance { .. } => Err(AoaError::NeedsSnapshots { method: method.name() }),
    }
}

/// Checks that the network takes snapshots of so many elements.
pub(crate) fn check_elements(
    model: &Model,
    method: Method,
    array: &Array,
) -> Result<(), NeuralError> {
    match model.elements() {
        Some(elements) if elements != array.len() => Err(AoaError::Array {
            method: method.name(),
            expected: format!("an array of {elements} elements, as its model was made for"),
            given: format!("has {}", array.len()),
        }
        .into()),
        _ => Ok(()),
    }
}

/// A warning where array or field of view are not what the network was trained on.
pub(crate) fn outside_training(
    model: &Model,
    array: &Array,
    options: &EstimatorOptions,
) -> Option<Warning> {
    let card = model.card()?;
    let mut differences = Vec::new();
    if let Some(name) = &card.data.array
        && let Ok(trained) = presets::preset(name)
        && deviation(array, &trained) > 1e-3 + 4.0 * card.data.position_error
    {
        differences.push(format!("trained on the array {name}, used on another"));
    }
    if let Some([fewest, most]) = card.data.elements
        && !(fewest..=most).contains(&array.len())
    {
        let given = array.len();
        differences
            .push(format!("trained on {fewest} to {most} elements, used on an array of {given}"));
    }
    if let Some(trained) = card.data.field_of_view_deg
        && options.field_of_view_rad.to_degrees() > trained + 1e-6
    {
        let asked = options.field_of_view_rad.to_degrees();
        differences
            .push(format!("trained within {trained} deg of boresight, asked for {asked:.0}"));
    }
    let difference = format!("{} is {}", card.name, differences.join(" and "));
    (!differences.is_empty()).then_some(Warning::OutsideTraining { difference })
}

/// Largest difference of the elements' positions but for a shift of all, half wavelengths.
fn deviation(array: &Array, other: &Array) -> f64 {
    if array.len() != other.len() {
        return f64::INFINITY;
    }
    let centred = |array: &Array| {
        let mut positions =
            Array2::from_shape_fn((array.len(), 3), |(k, i)| array.positions()[k][i]);
        if let Some(mean) = positions.mean_axis(Axis(0)) {
            positions -= &mean;
        }
        positions
    };
    (centred(array) - centred(other)).iter().fold(0.0, |most, d| d.abs().max(most))
}
