//! Whole degrees of azimuth: the DNN from a covariance, the 3D-CNN from a region of the range spectrum.

use crate::engine::{Runners, filled};
use crate::error::{NeuralError, network_failed};
use crate::features::{ELEMENTS, covariance_features};
use crate::model::Model;
use boresight_aoa::Plan;
use boresight_aoa::{
    AoaError, Data, Estimate, EstimatorOptions, Method, SourceCount, Warning, settle, sources_at,
};
use boresight_core::{Array, Complex64, Direction};
use ndarray::{ArrayView2, ArrayView3, ArrayViewD};

/// Range bins and chirps of a region.
const REGION: [usize; 2] = [65, 4];

/// Whole degrees on each side of boresight.
const DEGREES: i32 = 10;

/// Least probability of a source where neither options nor card name one.
const PROBABILITY: f64 = 0.5;

/// Elements lie half a wavelength apart to this.
const SPACING_TOLERANCE: f64 = 1e-3;

/// The network for one array.
#[derive(Clone)]
pub(crate) struct Classifier {
    runners: Runners,
    method: Method,
    array: Array,
    least: f64,
    /// The number of sources, where it is known.
    known: Option<usize>,
    most: usize,
    limit_rad: f64,
    /// -1 where the elements are counted the other way round than in training.
    sign: f64,
    warning: Option<Warning>,
}

impl Classifier {
    pub fn new(
        model: &Model,
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, NeuralError> {
        let rises = rises(array, ELEMENTS, method.name())?;
        let known = match options.sources {
            SourceCount::Known(count) => Some(count),
            _ => None,
        };
        let classes = 2 * DEGREES as usize + 1;
        if let Some(given) = known.filter(|&count| count > classes) {
            let (method, most) = (method.name(), classes);
            return Err(AoaError::TooManySources { method, most, given }.into());
        }
        let card = model.card();
        // Of the waveforms trained on, this one's board counts its elements to the right.
        let trained_rising =
            card.and_then(|card| card.data.waveform.as_deref()) != Some("3dcnn-experiment");
        let probability = card.and_then(|card| card.confidence).unwrap_or(PROBABILITY);
        let trained_for = card.and_then(|card| card.targets).unwrap_or(classes);
        Ok(Self {
            runners: model.runners(),
            method,
            array: array.clone(),
            least: options.confidence.unwrap_or(probability),
            known,
            most: known.unwrap_or(trained_for).min(options.max_peaks),
            limit_rad: options.field_of_view_rad + 1e-9,
            sign: if rises == trained_rising { 1.0 } else { -1.0 },
            warning: outside_training(model, options, known),
        })
    }

    /// The inputs of one example.
    fn features(&self, data: Data<'_>) -> Result<Vec<f32>, AoaError> {
        let Method::Cnn3d = self.method else {
            return Ok(covariance_features(data));
        };
        let [bins, chirps] = REGION;
        match data {
            Data::Covariance { .. } => Err(AoaError::NeedsSnapshots { method: self.method.name() }),
            Data::Snapshots(y) if y.ncols() != bins * chirps => Err(AoaError::Snapshots {
                method: self.method.name(),
                expected: format!(
                    "the {} snapshots of a region, {bins} range bins x {chirps} chirps",
                    bins * chirps
                ),
                given: y.ncols(),
            }),
            Data::Snapshots(y) => Ok(region_features(y)),
        }
    }

    fn estimates<'a>(
        &mut self,
        data: impl Fn(usize) -> Data<'a>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        let features: Vec<Vec<f32>> =
            (0..out.len()).map(|cell| self.features(data(cell))).collect::<Result<_, _>>()?;
        let mut probabilities: Vec<Vec<f64>> = Vec::with_capacity(out.len());
        let method = self.method;
        let given = |from: usize, to: usize| {
            let count = to - from;
            let shape = match method {
                Method::Cnn3d => vec![count, REGION[0], ELEMENTS, REGION[1], 3],
                _ => vec![count, features[from].len()],
            };
            let tensor = filled(&shape, |numbers| {
                let cells = numbers.chunks_exact_mut(features[from].len());
                for (cell, features) in cells.zip(&features[from..to]) {
                    cell.copy_from_slice(features);
                }
            })?;
            Ok([tensor.into()].into_iter().collect())
        };
        let answers = |_, outputs: &[ArrayViewD<'_, f32>]| {
            let rows = outputs[0].outer_iter();
            probabilities.extend(rows.map(|row| row.iter().map(|&p| f64::from(p)).collect()));
        };
        let failed = |error| network_failed(method.name(), error);
        self.runners.run(out.len(), given, answers).map_err(failed)?;
        for (cell, (out, probability)) in out.iter_mut().zip(&probabilities).enumerate() {
            self.answer(probability, data(cell), out);
        }
        Ok(())
    }

    /// The most probable degrees as sources, with the powers that fit the data best.
    fn answer(&self, probability: &[f64], data: Data<'_>, out: &mut Estimate) {
        let mut likely: Vec<(Direction, f64)> = probability
            .iter()
            .zip(-DEGREES..)
            .map(|(&p, degree)| (self.sign * f64::from(degree).to_radians(), p))
            .filter(|(azimuth_rad, _)| azimuth_rad.abs() <= self.limit_rad)
            .map(|(azimuth_rad, p)| (Direction::azimuth(azimuth_rad), p))
            .filter(|&(_, p)| self.known.is_some() || p >= self.least)
            .collect();
        likely.sort_by(|a, b| b.1.total_cmp(&a.1));
        likely.truncate(self.most);
        let directions: Vec<Direction> = likely.iter().map(|(direction, _)| *direction).collect();
        *out = Estimate::new(self.method);
        out.sources = sources_at(&self.array, &directions, data);
        for (source, (_, p)) in out.sources.iter_mut().zip(&likely) {
            source.confidence = Some(*p);
        }
        out.warnings.extend(self.warning.clone());
        settle(out, self.known);
    }
}

impl Plan for Classifier {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut estimate = Estimate::new(self.method);
        self.estimates(|_| data, std::slice::from_mut(&mut estimate))?;
        Ok(estimate)
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
        self.estimates(|cell| Data::Snapshots(cells.index_axis_move(ndarray::Axis(0), cell)), out)
    }
}

/// Checks that the elements are those the networks are for, and tells whether they are counted to the left.
pub(crate) fn rises(
    array: &Array,
    elements: usize,
    method: &'static str,
) -> Result<bool, AoaError> {
    let lattice = array.lattice().filter(|lattice| {
        let half_wavelength = (lattice.spacing - 1.0).abs() < SPACING_TOLERANCE;
        array.len() == elements && lattice.is_uniform() && half_wavelength
    });
    let lattice = lattice.ok_or_else(|| AoaError::Array {
        method,
        expected: format!("{elements} elements half a wavelength apart along y, in order"),
        given: format!("has {} elements, or they lie otherwise", array.len()),
    })?;
    Ok(lattice.indices[0] == 0)
}

/// Magnitude, real and imaginary part of a region given as snapshots, bins x elements x chirps x 3, the largest magnitude
/// being one.
fn region_features(snapshots: ArrayView2<Complex64>) -> Vec<f32> {
    let largest = snapshots.iter().map(|z| z.norm()).fold(0.0, f64::max);
    let gain = if largest > 0.0 { largest.recip() } else { 0.0 };
    let [bins, chirps] = REGION;
    let mut features = Vec::with_capacity(bins * ELEMENTS * chirps * 3);
    for bin in 0..bins {
        for row in snapshots.rows() {
            for chirp in 0..chirps {
                let z = row[bin * chirps + chirp] * gain;
                features.extend([z.norm(), z.re, z.im].map(|x| x as f32));
            }
        }
    }
    features
}

fn outside_training(
    model: &Model,
    options: &EstimatorOptions,
    known: Option<usize>,
) -> Option<Warning> {
    let degrees = f64::from(DEGREES);
    let mut differences = Vec::new();
    if options.field_of_view_rad.to_degrees() > degrees + 1e-6 {
        differences.push(format!(
            "trained within {degrees} deg of boresight, asked for {:.0}",
            options.field_of_view_rad.to_degrees()
        ));
    }
    if let (Some(known), Some(trained)) = (known, model.card().and_then(|card| card.targets))
        && known != trained
    {
        differences.push(format!("trained for {trained} targets, asked for {known}"));
    }
    let name = model.card().map_or("the network", |card| card.name.as_str());
    let difference = format!("{name} is {}", differences.join(" and "));
    (!differences.is_empty()).then_some(Warning::OutsideTraining { difference })
}
