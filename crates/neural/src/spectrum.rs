//! Networks that answer with numbers over a grid of angles: UAA, the CNN of Papageorgiou et al. (2021) and DeepMUSIC.

use crate::card::Card;
use crate::classifier::rises;
use crate::engine::{Runners, filled};
use crate::error::{NeuralError, network_failed};
use crate::model::Model;
use crate::snapshots::{Scales, check_elements, one_cell, outside_training, scaled};
use boresight_aoa::{
    AoaError, Data, Estimate, EstimatorOptions, Grid, Method, Peak, PeakFinder, Plan, Source,
    SourceCount, Spectrum, SpectrumKind, Warning, settle, sources_at,
};
use boresight_core::{Array, Complex64, Direction};
use boresight_signal::sample_covariance;
use ndarray::{ArrayView2, ArrayView3, ArrayViewD, Axis};
use std::f64::consts::PI;
use tract_onnx::prelude::{TValue, TVec};

/// Least probability of a source where neither options nor card name one.
const PROBABILITY: f64 = 0.5;
/// Depth below the highest to which peaks of DeepMUSIC's spectrum count where the number of sources is not known, dB;
/// its range is 30 dB.
const PSEUDO_RANGE_DB: f64 = 10.0;
/// Points of the grid searched beyond the field of view.
const BEYOND: f64 = 2.0;
/// Channels of a covariance.
const CHANNELS: usize = 3;

/// What the numbers over the grid are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Told {
    /// Powers at one element, from one snapshot.
    Powers,
    /// Probabilities of sources, from a covariance.
    Probabilities,
    /// MUSIC's spectrum, from a covariance.
    NullSpectrum,
}

/// The network for one array.
#[derive(Clone)]
pub(crate) struct Spectral {
    method: Method,
    told: Told,
    runners: Runners,
    array: Array,
    /// Somewhat more than the field of view, for a maximum at the edge is no peak.
    grid: Grid,
    finder: PeakFinder,
    /// Sine of the half width of the field of view.
    limit: f64,
    most: usize,
    /// Whether the elements are counted the other way round than in training.
    mirrored: bool,
    known: Option<usize>,
    /// Least probability.
    least: f64,
    warning: Option<Warning>,
    card: Option<Card>,
    scales: Scales,
}

impl Spectral {
    pub fn new(
        model: &Model,
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, NeuralError> {
        check_elements(model, method, array)?;
        let told = match method {
            Method::UnrolledIaa => Told::Powers,
            Method::DeepMusic => Told::NullSpectrum,
            _ => Told::Probabilities,
        };
        let on_snapshot = told == Told::Powers;
        let points = model.outputs().first().and_then(|port| port.axes.last()?.length());
        let mut options = EstimatorOptions { grid_points: points.unwrap_or(1), ..*options };
        if told == Told::NullSpectrum {
            options.dynamic_range_db = options.dynamic_range_db.min(PSEUDO_RANGE_DB);
        }
        let points = options.grid_points as f64;
        let limit = options.field_of_view_rad.sin() + 1e-9;
        let wider = (limit + BEYOND * 2.0 / points).min(1.0).asin();
        let searched =
            EstimatorOptions { elevation_points: 1, field_of_view_rad: wider, ..options };
        let grid = Grid::new(array, &searched);
        let mirrored = !on_snapshot && !rises(array, array.len(), method.name())?;
        let in_order = match mirrored {
            true => array.select(&(0..array.len()).rev().collect::<Vec<_>>())?,
            false => array.clone(),
        };
        let confidence = model.card().and_then(|card| card.confidence);
        Ok(Self {
            method,
            told,
            runners: if on_snapshot { model.runners_for(array)? } else { model.runners() },
            finder: PeakFinder::new(array, &grid, &searched),
            limit,
            most: options.max_peaks,
            mirrored,
            known: match options.sources {
                SourceCount::Known(count) if !on_snapshot => Some(count),
                _ => None,
            },
            least: options.confidence.or(confidence).unwrap_or(PROBABILITY),
            warning: outside_training(model, &in_order, &options),
            card: model.card().cloned(),
            array: array.clone(),
            grid,
            scales: Scales::default(),
        })
    }

    /// What the network answers to a cell, within the field of view.
    fn values(&self, row: impl Fn(usize) -> f32) -> Vec<f64> {
        let (first, points) = (self.grid.first, self.grid.full_points);
        let at = |g: usize| if self.mirrored { (points - g) % points } else { g };
        (first..first + self.grid.sines.len()).map(|g| f64::from(row(at(g)).max(0.0))).collect()
    }

    /// The estimate of a cell, whose scale for powers is given.
    fn answer(&self, values: Vec<f64>, scale: f64, data: Data<'_>, out: &mut Estimate) {
        let mut peaks = match self.known {
            Some(_) => self.finder.highest(&self.grid, &values, usize::MAX),
            None => self.finder.find(&self.grid, &values),
        };
        peaks.retain(|peak| peak.direction.azimuth_rad.sin().abs() <= self.limit);
        peaks.truncate(self.known.unwrap_or(self.most));
        *out = Estimate::new(self.method);
        out.sources = match self.told {
            Told::Powers => {
                let power = |peak: &Peak| scale * scale * self.top(&values, peak);
                peaks.iter().map(|peak| Source::new(peak.direction, power(peak))).collect()
            }
            Told::Probabilities => {
                let sure = |peak: &Peak| (*peak, self.top(&values, peak).min(1.0));
                let mut likely: Vec<(Peak, f64)> = peaks.iter().map(sure).collect();
                likely.retain(|&(_, p)| self.known.is_some() || p >= self.least);
                let mut sources = self.fitted(likely.iter().map(|(peak, _)| peak), data);
                for (source, (_, p)) in sources.iter_mut().zip(&likely) {
                    source.confidence = Some(*p);
                }
                sources
            }
            Told::NullSpectrum => self.fitted(peaks.iter(), data),
        };
        let inside = |at: &usize| self.grid.sines[*at].abs() <= self.limit;
        let inside = || (0..values.len()).filter(inside);
        out.spectrum = Some(Spectrum {
            azimuth_rad: inside().map(|at| self.grid.azimuth_rad[at]).collect(),
            elevation_rad: self.grid.elevation_rad.clone(),
            values: inside().map(|at| values[at] * scale * scale).collect(),
            kind: match self.told {
                Told::Powers => SpectrumKind::Power,
                _ => SpectrumKind::Pseudo,
            },
        });
        out.warnings.extend(self.warning.clone());
        out.warnings.extend(self.beyond_training(data));
        settle(out, self.known);
    }

    /// Sources at peaks, with the powers that fit the data best.
    fn fitted<'a>(&self, peaks: impl Iterator<Item = &'a Peak>, data: Data<'_>) -> Vec<Source> {
        let directions: Vec<Direction> = peaks.map(|peak| peak.direction).collect();
        sources_at(&self.array, &directions, data)
    }

    /// A warning where a covariance is of other numbers of snapshots or targets than in training.
    fn beyond_training(&self, data: Data<'_>) -> Option<Warning> {
        let card = self.card.as_ref()?;
        let mut differences = Vec::new();
        let given = match data {
            Data::Snapshots(y) => y.ncols(),
            Data::Covariance { snapshots, .. } => snapshots,
        };
        if let Some([fewest, most]) = card.data.snapshots
            && !(fewest..=most).contains(&given)
        {
            differences.push(format!("trained on {fewest} to {most} snapshots, used on {given}"));
        }
        if let (Some([_, most]), Some(asked)) = (card.data.targets, self.known)
            && asked > most
        {
            differences.push(format!("trained for up to {most} targets, asked for {asked}"));
        }
        let difference = format!("{} is {}", card.name, differences.join(" and "));
        (!differences.is_empty()).then_some(Warning::OutsideTraining { difference })
    }

    /// The height of the parabola through a peak and its neighbours, in dB, where its direction is.
    fn top(&self, values: &[f64], peak: &Peak) -> f64 {
        let beside = |step: isize| {
            let value = values.get(peak.index.checked_add_signed(step)?)?;
            Some(value.max(f64::MIN_POSITIVE).ln())
        };
        let Some((left, right)) = beside(-1).zip(beside(1)) else { return peak.value };
        let step = 2.0 / self.grid.full_points as f64;
        let offset = (peak.direction.azimuth_rad.sin() - self.grid.sines[peak.index]) / step;
        peak.value * (0.25 * (right - left) * offset).exp()
    }
}

impl Plan for Spectral {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut estimate = Estimate::new(self.method);
        let out = std::slice::from_mut(&mut estimate);
        if self.told == Told::Powers {
            self.estimate_cells(one_cell(self.method, data)?, out)?;
        } else {
            let features = match data {
                Data::Snapshots(y) => covariance_image(sample_covariance(y).view()),
                Data::Covariance { matrix, .. } => covariance_image(matrix),
            };
            self.on_covariances(&[features], |_| data, out)?;
        }
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
        let data = |cell| Data::Snapshots(cells.index_axis_move(Axis(0), cell));
        if self.told != Told::Powers {
            let features: Vec<Vec<f32>> = cells
                .outer_iter()
                .map(|cell| covariance_image(sample_covariance(cell).view()))
                .collect();
            return self.on_covariances(&features, data, out);
        }
        let mut scales = std::mem::take(&mut self.scales);
        let of = scales.of(self.method, cells)?;
        let given = |from: usize, to: usize| {
            Ok([scaled(cells, of, from, to)?.into()].into_iter().collect())
        };
        self.run(of.len(), given, |plan, cell, values| {
            let values = if of[cell] > 0.0 { values } else { vec![0.0; values.len()] };
            plan.answer(values, of[cell], data(cell), &mut out[cell]);
        })?;
        self.scales = scales;
        Ok(())
    }
}

impl Spectral {
    fn on_covariances<'a>(
        &mut self,
        features: &[Vec<f32>],
        data: impl Fn(usize) -> Data<'a>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        let elements = self.array.len();
        let given = |from: usize, to: usize| {
            let tensor = filled(&[to - from, CHANNELS, elements, elements], |numbers| {
                let images = numbers.chunks_exact_mut(CHANNELS * elements * elements);
                for (image, features) in images.zip(&features[from..to]) {
                    image.copy_from_slice(features);
                }
            })?;
            Ok([tensor.into()].into_iter().collect())
        };
        self.run(features.len(), given, |plan, cell, values| {
            plan.answer(values, 1.0, data(cell), &mut out[cell]);
        })
    }

    /// Runs the network on so many cells and takes the values of each.
    fn run(
        &mut self,
        count: usize,
        given: impl FnMut(usize, usize) -> Result<TVec<TValue>, NeuralError>,
        mut take: impl FnMut(&Self, usize, Vec<f64>),
    ) -> Result<(), AoaError> {
        let mut runners = self.runners.clone();
        let answers = |from: usize, outputs: &[ArrayViewD<'_, f32>]| {
            for (cell, row) in outputs[0].outer_iter().enumerate() {
                take(self, from + cell, self.values(|g| row[[g]]));
            }
        };
        let name = self.method.name();
        runners.run(count, given, answers).map_err(|error| network_failed(name, error))?;
        self.runners = runners;
        Ok(())
    }
}

/// Real part, imaginary part and phase over pi of a covariance over its mean diagonal entry, 3 x elements x elements.
fn covariance_image(matrix: ArrayView2<'_, Complex64>) -> Vec<f32> {
    let mean = matrix.diag().iter().map(|z| z.re).sum::<f64>() / matrix.nrows().max(1) as f64;
    let gain = if mean > 0.0 { mean.recip() } else { 0.0 };
    let channels: [fn(Complex64, f64) -> f64; CHANNELS] =
        [|z, gain| z.re * gain, |z, gain| z.im * gain, |z, _| z.arg() / PI];
    let numbers = channels.iter().flat_map(|channel| matrix.iter().map(move |&z| channel(z, gain)));
    numbers.map(|x| x as f32).collect()
}
