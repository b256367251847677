//! A set of targets from one snapshot: AAETR and the learned pursuit.

use crate::engine::{Runners, filled};
use crate::error::{NeuralError, network_failed};
use crate::model::Model;
use boresight_aoa::Plan;
use boresight_aoa::{
    AoaError, Data, Deviation, Estimate, EstimatorOptions, Method, Source, Warning, settle,
};
use boresight_core::{Array, Complex64, Direction, presets};
use ndarray::{Array2, ArrayView3, ArrayViewD, Axis};

/// Least confidence of a source where neither options nor card name one.
const CONFIDENCE: f64 = 0.5;

/// Least derivative of the sine by the azimuth, at the edge of what an array sees.
const LEAST_SLOPE: f64 = 1e-3;

/// The network with the positions of one array in it.
#[derive(Clone)]
pub(crate) struct TargetSet {
    method: Method,
    runners: Runners,
    elements: usize,
    confidence: f64,
    /// Sine of the half width of the field of view.
    limit: f64,
    most: usize,
    warning: Option<Warning>,
    /// Magnitudes of the cells at hand, each of which is scaled to one.
    scales: Vec<f64>,
}

impl TargetSet {
    pub fn new(
        model: &Model,
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, NeuralError> {
        let elements = model.elements().unwrap_or(array.len());
        if array.len() != elements {
            return Err(AoaError::Array {
                method: method.name(),
                expected: format!("an array of {elements} elements, as its model was made for"),
                given: format!("has {}", array.len()),
            }
            .into());
        }
        let card = model.card().and_then(|card| card.confidence);
        Ok(Self {
            method,
            runners: model.runners_for(array)?,
            elements,
            confidence: options.confidence.or(card).unwrap_or(CONFIDENCE),
            limit: options.field_of_view_rad.sin() + 1e-9,
            most: options.max_peaks,
            warning: outside_training(model, array, options),
            scales: Vec::new(),
        })
    }
}

impl Plan for TargetSet {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut estimate = Estimate::new(self.method);
        self.estimate_into(data, &mut estimate)?;
        Ok(estimate)
    }

    fn estimate_into(&mut self, data: Data<'_>, out: &mut Estimate) -> Result<(), AoaError> {
        let Data::Snapshots(snapshots) = data else {
            return Err(AoaError::NeedsSnapshots { method: self.method.name() });
        };
        self.estimate_cells(snapshots.insert_axis(Axis(0)), std::slice::from_mut(out))
    }

    fn cells_at_once(&self) -> usize {
        self.runners.most()
    }

    fn estimate_cells(
        &mut self,
        cells: ArrayView3<'_, Complex64>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        let (count, elements, snapshots) = cells.dim();
        if snapshots != 1 {
            return Err(AoaError::Snapshots {
                method: self.method.name(),
                expected: "one snapshot".into(),
                given: snapshots,
            });
        }
        debug_assert_eq!(elements, self.elements);
        self.scales.clear();
        self.scales.extend(
            cells
                .outer_iter()
                .map(|cell| cell.iter().map(|z| z.re.abs().max(z.im.abs())).fold(0.0, f64::max)),
        );
        let Self { method, runners, scales, confidence, limit, most, warning, .. } = self;
        let given = |from: usize, to: usize| {
            let stretch = cells.slice_axis(Axis(0), (from..to).into());
            let scales = &scales[from..to];
            let tensor = filled(&[to - from, elements, 2], |numbers| {
                let mut numbers = numbers.chunks_exact_mut(2);
                for (cell, &scale) in stretch.outer_iter().zip(scales) {
                    let gain = if scale > 0.0 { scale.recip() } else { 0.0 };
                    for (z, pair) in cell.iter().zip(&mut numbers) {
                        pair[0] = (z.re * gain) as f32;
                        pair[1] = (z.im * gain) as f32;
                    }
                }
            })?;
            Ok([tensor.into()].into_iter().collect())
        };
        let answers = |from: usize, outputs: &[ArrayViewD<'_, f32>]| {
            for (cell, targets) in outputs[0].outer_iter().enumerate() {
                let scale = scales[from + cell];
                let out = &mut out[from + cell];
                out.sources.clear();
                for target in targets.outer_iter().filter(|_| scale > 0.0) {
                    let value = |at| target.get(at).copied().map(f64::from);
                    let [sine, amplitude, sure] = [0, 1, 2].map(|at| value(at).unwrap_or_default());
                    if sure >= *confidence && sine.abs() <= limit.min(1.0) {
                        let direction = Direction::azimuth(sine.asin());
                        let slope = direction.azimuth_rad.cos().max(LEAST_SLOPE);
                        let deviation = value(3).zip(value(4)).map(|(of_sine, of_db)| Deviation {
                            azimuth_rad: of_sine / slope,
                            power_db: of_db,
                        });
                        out.sources.push(Source {
                            confidence: Some(sure),
                            deviation,
                            ..Source::new(direction, (amplitude * scale).powi(2))
                        });
                    }
                }
            }
        };
        runners.run(count, given, answers).map_err(|error| network_failed(method.name(), error))?;
        for out in out {
            out.method = *method;
            out.spectrum = None;
            out.iterations = 0;
            out.warnings.clear();
            out.warnings.extend(warning.clone());
            settle(out, None);
            out.sources.truncate(*most);
        }
        Ok(())
    }
}

/// A warning where array or field of view are not what the network was trained on.
fn outside_training(model: &Model, array: &Array, options: &EstimatorOptions) -> Option<Warning> {
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
