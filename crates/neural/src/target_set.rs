//! A set of targets from one snapshot: AAETR and the learned pursuit.

use crate::engine::Runners;
use crate::error::{NeuralError, network_failed};
use crate::model::Model;
use crate::snapshots::{Scales, check_elements, one_cell, outside_training, scaled};
use boresight_aoa::Plan;
use boresight_aoa::{
    AoaError, Data, Deviation, Estimate, EstimatorOptions, Method, Source, Warning, settle,
};
use boresight_core::{Array, Complex64, Direction};
use ndarray::{ArrayView3, ArrayViewD};

/// Least confidence of a source where neither options nor card name one.
const CONFIDENCE: f64 = 0.5;

/// Least derivative of the sine by the azimuth, at the edge of what an array sees.
const LEAST_SLOPE: f64 = 1e-3;

/// The network with the positions of one array in it.
#[derive(Clone)]
pub(crate) struct TargetSet {
    method: Method,
    runners: Runners,
    confidence: f64,
    /// Sine of the half width of the field of view.
    limit: f64,
    most: usize,
    warning: Option<Warning>,
    scales: Scales,
}

impl TargetSet {
    pub fn new(
        model: &Model,
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, NeuralError> {
        check_elements(model, method, array)?;
        let card = model.card().and_then(|card| card.confidence);
        Ok(Self {
            method,
            runners: model.runners_for(array)?,
            confidence: options.confidence.or(card).unwrap_or(CONFIDENCE),
            limit: options.field_of_view_rad.sin() + 1e-9,
            most: options.max_peaks,
            warning: outside_training(model, array, options),
            scales: Scales::default(),
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
        self.estimate_cells(one_cell(self.method, data)?, std::slice::from_mut(out))
    }

    fn operations(&self) -> Result<f64, AoaError> {
        self.runners.of_estimate(self.method)
    }

    fn cells_at_once(&self) -> usize {
        self.runners.most()
    }

    fn estimate_cells(
        &mut self,
        cells: ArrayView3<'_, Complex64>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        let Self { method, runners, scales, confidence, limit, most, warning } = self;
        let scales = scales.of(*method, cells)?;
        let given = |from: usize, to: usize| {
            Ok([scaled(cells, scales, from, to)?.into()].into_iter().collect())
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
        runners
            .run(scales.len(), given, answers)
            .map_err(|error| network_failed(method.name(), error))?;
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
