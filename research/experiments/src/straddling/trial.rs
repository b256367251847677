//! The snapshots of one condition through every method on every grid.

use super::cost::operations;
use super::{CONDITIONS, Condition, GRIDS, StraddlingExperiment};
use crate::aoa::finder::{Candidate, Finder, Idle};
use crate::aoa::score::WITHIN_RAD;
use crate::apart::{BEAMS_APART, Drawn};
use crate::deviation::Deviation;
use crate::error::EvaluateError;
use boresight_aoa::bounds::{Signals, deterministic_bound, uncorrelated};
use boresight_aoa::refinement::Refinement;
use boresight_aoa::{
    AoaError, BatchEstimate, Data, EstimatorOptions, Source, SourceCount, SpectrumKind,
};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex64, Direction, Extent};
use boresight_math::decibels::db_to_power;
use boresight_simulate::Target;
use boresight_validate::experiment::Experiment;
use ndarray::{Array3, ArrayView2, Axis};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

/// What answers.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    candidate: Candidate,
    /// With points of the grid.
    on_grid: bool,
}

impl Line {
    /// Name in tables and figures.
    pub fn name(&self) -> String {
        let name = self.candidate.name();
        if self.on_grid { format!("{name}, grid points") } else { name }
    }

    /// The grids it is run on; none for what knows none.
    pub fn grids(&self) -> Vec<Option<usize>> {
        match &self.candidate.finder {
            Finder::Method(method, _) if method.requirements().spectrum => GRIDS.map(Some).to_vec(),
            _ => vec![None],
        }
    }

    pub(super) fn finder(&self) -> &Finder {
        &self.candidate.finder
    }

    pub(super) fn is_on_grid(&self) -> bool {
        self.on_grid
    }

    pub(super) fn is_refined(&self) -> bool {
        self.candidate.refined
    }

    /// What it answers to a snapshot of a batch that its finder was run on, strongest first.
    pub(super) fn answer(
        &self,
        batch: &BatchEstimate,
        trial: usize,
        y: ArrayView2<Complex64>,
        refinement: &mut Refinement,
    ) -> Result<Vec<Source>, EvaluateError> {
        let found = batch.sources_of(trial);
        let mut sources = if self.candidate.refined {
            refinement.refine(&self.finder().sure(found), Data::Snapshots(y))?
        } else {
            self.finder().sure_sources(found).copied().collect()
        };
        if self.on_grid {
            sources.iter_mut().for_each(|source| put_on_grid(source, batch, trial));
        }
        sources.sort_by(|a, b| b.power.total_cmp(&a.power));
        Ok(sources)
    }
}

/// Takes a source to the highest of the points of the grid beside it.
fn put_on_grid(source: &mut Source, batch: &BatchEstimate, trial: usize) {
    let Some(spectra) = &batch.spectra else { return };
    let azimuths = &spectra.azimuth_rad;
    let Some(values) = spectra.values.chunks_exact(azimuths.len()).nth(trial) else { return };
    let after = azimuths.partition_point(|&azimuth| azimuth < source.direction.azimuth_rad);
    let beside = after.saturating_sub(2)..(after + 2).min(azimuths.len());
    if let Some(highest) = beside.max_by(|&a, &b| values[a].total_cmp(&values[b])) {
        source.direction = Direction::azimuth(azimuths[highest]).into();
        source.power = f64::from(values[highest]);
    }
}

/// Some snapshots of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StraddlingRecord {
    /// Index of the condition.
    pub condition: usize,
    /// Sum of the variance of azimuth at the bound, deg^2; where there is a weak target that is its.
    pub bound_deg2: f64,
    /// Lines in order, each on its grids in order.
    pub variants: Vec<VariantRecord>,
}

/// What a line reached on one grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariantRecord {
    /// Estimates against the target; where there is a weak one against that.
    pub deviation: Deviation,
    /// Operations a snapshot, by formula.
    pub operations: Option<f64>,
}

/// What snapshots share.
pub struct Plan {
    pub(super) array: Array,
    seed: u64,
    lines: Vec<Line>,
    /// Of lines and their grids, once they are counted.
    operations: OnceLock<Vec<Option<f64>>>,
    idle: Idle,
}

impl Plan {
    pub(super) fn new(options: &StraddlingExperiment) -> Result<Self, EvaluateError> {
        let array = preset(&options.array)?;
        if array.extent() != Extent::Azimuth {
            return Err(AoaError::Array {
                method: StraddlingExperiment::NAME,
                expected: "elements on a line along y".into(),
                given: "has others".into(),
            }
            .into());
        }
        options.entrants.check()?;
        let mut lines = vec![];
        // Whether they take the array and one snapshot, before anything is run.
        let silence = Array3::zeros((1, array.len(), 1));
        for candidate in Candidate::all(&options.entrants)? {
            let finder = &candidate.finder;
            if finder.can_run() {
                let mut estimator = finder.with_options(&array, angle_options(1, None))?;
                let batch = estimator.estimate_batch(silence.view(), true)?;
                let has_power = batch.spectra.is_some_and(|s| s.kind == SpectrumKind::Power);
                if has_power && !candidate.refined {
                    lines.push(Line { candidate: candidate.clone(), on_grid: true });
                }
            }
            lines.push(Line { candidate, on_grid: false });
        }
        let (operations, idle) = (OnceLock::new(), Idle::default());
        Ok(Self { array, seed: options.seed, lines, operations, idle })
    }

    /// What answers, in order.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// Lines and their grids, in the order of records.
    pub fn variants(&self) -> impl Iterator<Item = (&Line, Option<usize>)> {
        self.lines.iter().flat_map(|line| line.grids().into_iter().map(move |grid| (line, grid)))
    }

    /// Operations of lines and their grids, by formula. Those of networks take seconds to count.
    fn operations(&self) -> Result<&[Option<f64>], EvaluateError> {
        if let Some(known) = self.operations.get() {
            return Ok(known);
        }
        let of = |(line, grid)| operations(line, &self.array, grid);
        let all = self.variants().map(of).collect::<Result<Vec<_>, _>>()?;
        Ok(self.operations.get_or_init(|| all))
    }

    /// Finders and their grids.
    pub(super) fn runs(&self) -> Vec<(&Finder, Option<usize>)> {
        let mut runs = vec![];
        for (line, grid) in self.variants() {
            if !runs.contains(&(line.finder(), grid)) {
                runs.push((line.finder(), grid));
            }
        }
        runs
    }

    /// Runs snapshots `first` to `first + trials - 1` of a condition.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(
        &self,
        index: usize,
        first: u64,
        trials: u64,
    ) -> Result<StraddlingRecord, EvaluateError> {
        let condition = CONDITIONS[index];
        let (scenes, truths) = self.scenes(index, first, trials)?;
        // Of two targets the weak one is looked for, among the two strongest estimates, as near as a hit is.
        let (targets, within_rad) = match condition.weak_db {
            Some(_) => (2, WITHIN_RAD),
            None => (1, f64::INFINITY),
        };
        let mut bound_deg2 = 0.0;
        for truth in &truths {
            bound_deg2 += self.bound_deg2(truth, condition)?;
        }
        let none = |&operations| VariantRecord { deviation: Deviation::default(), operations };
        let mut variants: Vec<VariantRecord> = self.operations()?.iter().map(none).collect();
        let mut refinement = Refinement::new(&self.array, &angle_options(targets, None))?;
        for (finder, grid) in self.runs() {
            let new = || finder.with_options(&self.array, angle_options(targets, grid));
            let batch = self.idle.estimate(finder, new, scenes.view(), grid.is_some())?;
            for ((line, of), record) in self.variants().zip(&mut variants) {
                if line.finder() != finder || of != grid {
                    continue;
                }
                for (trial, truth) in truths.iter().enumerate() {
                    let y = scenes.index_axis(Axis(0), trial);
                    let mut sources = line.answer(&batch, trial, y, &mut refinement)?;
                    sources.truncate(targets);
                    let last = &truth[truth.len() - 1..];
                    record.deviation.add(&self.array, last, &sources, within_rad);
                }
            }
        }
        Ok(StraddlingRecord { condition: index, bound_deg2, variants })
    }

    /// Snapshots `first` to `first + trials - 1` of a condition, each with its targets.
    pub(super) fn scenes(
        &self,
        index: usize,
        first: u64,
        trials: u64,
    ) -> Result<(Array3<Complex64>, Vec<Vec<Target>>), EvaluateError> {
        let Condition { snr_db, weak_db } = CONDITIONS[index];
        let powers_db: Vec<f64> = [0.0].into_iter().chain(weak_db).collect();
        let (array, seed, group) = (&self.array, self.seed, index as u64);
        Drawn {
            array,
            seed,
            group,
            snr_db,
            snapshots: 1,
            beams_apart: BEAMS_APART,
            powers_db: &powers_db,
            range_m: None,
        }
        .scenes(first, trials)
    }

    /// Variance of the azimuth of the last target at the bound, deg^2.
    fn bound_deg2(&self, truth: &[Target], condition: Condition) -> Result<f64, EvaluateError> {
        let powers: Vec<f64> = truth.iter().map(|t| db_to_power(t.power_db)).collect();
        let covariance = uncorrelated(&powers);
        let noise_power = db_to_power(-condition.snr_db);
        let signals = Signals { covariance: covariance.view(), noise_power, snapshots: 1 };
        let directions: Vec<Direction> = truth.iter().map(|t| *t.direction).collect();
        let bound = deterministic_bound(&self.array, &directions, &signals)?;
        Ok(bound.azimuth_rad.last().map_or(f64::NAN, |sigma| sigma.to_degrees().powi(2)))
    }
}

/// Options on a grid, or on what a method takes without one; for some targets.
pub(super) fn angle_options(targets: usize, grid: Option<usize>) -> EstimatorOptions {
    let default = EstimatorOptions::default();
    EstimatorOptions {
        grid_points: grid.unwrap_or(default.grid_points),
        // A maximum at the end of all angles counts as a peak; one at the edge of a sector would not.
        field_of_view_rad: FRAC_PI_2,
        dynamic_range_db: 60.0,
        sources: SourceCount::Known(targets),
        ..default
    }
}
