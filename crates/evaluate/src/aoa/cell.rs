//! The snapshots of one condition through every method.

use super::score::{Point, Score};
use super::{Condition, Options, TARGETS};
use crate::EvaluateError;
use boresight_aoa::bounds::{Signals, deterministic_bound, single_snapshot};
use boresight_aoa::refinement::Refinement;
use boresight_aoa::{
    AoaError, Data, Estimate, Estimator, Method, Options as AngleOptions, SourceCount,
};
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::presets::preset;
use boresight_core::steering::cis;
use boresight_core::units::{db_to_amplitude, db_to_power};
use boresight_core::{Array, Complex64, CoreError, Direction, Imperfections};
use boresight_simulate::snapshots::{
    Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator, Target,
};
use ndarray::Array2;
use serde::{Deserialize, Serialize};

/// Half width of the sector of targets, rad (60 deg).
const FIELD_OF_VIEW_RAD: f64 = 1.047_197_551_196_597_6;
/// Targets with at least this many beamwidths to the next are separated.
const SEPARATED_BEAMS: f64 = 2.0;
/// Most predictions of a snapshot.
const MOST: usize = 64;
/// What follows the name of a method whose sources are refined.
const REFINED: &str = "+refined";

/// A method, and whether its directions are refined on the snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Candidate {
    method: Method,
    refined: bool,
}

impl Candidate {
    fn from_name(name: &str) -> Result<Self, EvaluateError> {
        let method = name.strip_suffix(REFINED);
        Ok(Self { method: Method::from_name(method.unwrap_or(name))?, refined: method.is_some() })
    }

    fn name(&self) -> String {
        format!("{}{}", self.method.name(), if self.refined { REFINED } else { "" })
    }

    /// For `targets` targets, or as many as the method can find.
    fn estimator(&self, array: &Array, targets: usize) -> Result<Estimator, AoaError> {
        match Estimator::new(self.method, array, &angle_options(targets)) {
            Err(AoaError::TooManySources { most, .. }) => {
                Estimator::new(self.method, array, &angle_options(most))
            }
            result => result,
        }
    }
}

/// All predictions, so that their power can be swept.
fn angle_options(targets: usize) -> AngleOptions {
    AngleOptions {
        grid_points: 2048,
        field_of_view_rad: FIELD_OF_VIEW_RAD,
        dynamic_range_db: 40.0,
        max_peaks: MOST,
        sources: SourceCount::Known(targets),
        ..AngleOptions::default()
    }
}

/// What of a condition is kept for one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct MethodRecord {
    /// Detections against targets.
    pub score: Score,
    /// Sums over separated targets that were found, and their number: squared error, squared bound, deg^2.
    pub separated: (f64, f64, u32),
    /// Separated targets in all.
    pub separated_targets: u32,
}

/// Some snapshots of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Index of the condition.
    pub condition: usize,
    /// Methods in order.
    pub methods: Vec<MethodRecord>,
}

/// All that snapshots share.
pub struct Plan {
    array: Array,
    seed: u64,
    imperfections: ImperfectionSpread,
    candidates: Vec<Candidate>,
    beam: f64,
}

impl Plan {
    /// For an array.
    ///
    /// # Errors
    /// An array that is not known.
    pub fn new(options: &Options) -> Result<Self, EvaluateError> {
        let array = preset(&options.array)?;
        let mut candidates = vec![];
        for name in &options.methods {
            let candidate = Candidate::from_name(name)?;
            // Whether it takes the array, one snapshot and the most targets, before anything is run.
            let silence = Array2::zeros((array.len(), 1));
            candidate
                .estimator(&array, TARGETS[TARGETS.len() - 1])?
                .estimate(Data::Snapshots(silence.view()))?;
            if !candidates.contains(&candidate) {
                candidates.push(candidate);
            }
        }
        if candidates.is_empty() {
            return Err(CoreError::Empty {
                what: "methods".into(),
                expected: "at least one".into(),
            }
            .into());
        }
        let across: Vec<f64> = array.positions().iter().map(|position| position[1]).collect();
        let aperture = across.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - across.iter().copied().fold(f64::INFINITY, f64::min);
        // Between the first zeros of a line of that length, in half wavelengths, half of it.
        let beam = 2.0 / aperture.max(1.0);
        let (seed, imperfections) = (options.seed, options.imperfections);
        Ok(Self { array, seed, imperfections, candidates, beam })
    }

    /// Names of the methods in order.
    pub fn names(&self) -> Vec<String> {
        self.candidates.iter().map(Candidate::name).collect()
    }

    /// Runs snapshots `first` to `first + trials - 1` of a condition.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(
        &self,
        index: usize,
        condition: Condition,
        first: u64,
        trials: u64,
    ) -> Result<Record, EvaluateError> {
        let noise_power = db_to_power(-condition.snr_db);
        let mut estimators: Vec<Estimator> = vec![];
        for candidate in &self.candidates {
            if !estimators.iter().any(|known| known.method() == candidate.method) {
                estimators.push(candidate.estimator(&self.array, condition.targets)?);
            }
        }
        let mut refinement = Refinement::new(&self.array, &angle_options(condition.targets))?;
        let mut methods = vec![MethodRecord::default(); self.candidates.len()];
        for trial in first..first + trials {
            let (y, truth) = self.scene(index, condition, trial)?;
            let points: Vec<Point> = truth
                .iter()
                .map(|t| Point { azimuth_rad: t.direction.azimuth_rad, power_db: t.power_db })
                .collect();
            let bound = self.bound(&truth, noise_power);
            let mut estimates: Vec<(Method, Estimate)> = vec![];
            for estimator in &mut estimators {
                let estimate = estimator.estimate(Data::Snapshots(y.view()))?;
                estimates.push((estimator.method(), estimate));
            }
            for (candidate, record) in self.candidates.iter().zip(&mut methods) {
                let Some((_, estimate)) = estimates.iter().find(|e| e.0 == candidate.method) else {
                    continue;
                };
                let refined;
                let sources = if candidate.refined {
                    let directions: Vec<Direction> =
                        estimate.sources.iter().map(|s| s.direction).collect();
                    refined = refinement.refine(&directions, Data::Snapshots(y.view()))?;
                    &refined
                } else {
                    &estimate.sources
                };
                let found: Vec<Point> = sources
                    .iter()
                    .map(|s| Point {
                        azimuth_rad: s.direction.azimuth_rad,
                        power_db: 10.0 * s.power.log10(),
                    })
                    .collect();
                record.score.add(&points, &found);
                self.separated(record, &points, &found, &bound);
            }
        }
        Ok(Record { condition: index, methods })
    }

    fn scene(
        &self,
        index: usize,
        condition: Condition,
        trial: u64,
    ) -> Result<(Array2<Complex64>, Vec<Target>), EvaluateError> {
        // A condition has its own block of the seed's streams.
        let stream = ((index as u64) << 40) + trial;
        let imperfections = match self.imperfections == ImperfectionSpread::default() {
            true => None,
            false => Some(Imperfections::random(&self.array, self.imperfections, stream)?),
        };
        let sampling = SceneSampling {
            targets: [condition.targets; 2],
            field_of_view_rad: FIELD_OF_VIEW_RAD,
            ..SceneSampling::default()
        };
        let simulator = SnapshotSimulator::new(
            &self.array,
            &SnapshotOptions {
                scene: Scene::Sampled(sampling),
                snr_db: condition.snr_db,
                snapshots: 1,
                fluctuation: Fluctuation::RandomPhase,
                imperfections,
                seed: self.seed,
            },
        )?;
        Ok(simulator.scene(stream)?)
    }

    /// Standard deviation of each azimuth at the bound, deg; infinite where there is none.
    fn bound(&self, truth: &[Target], noise_power: f64) -> Vec<f64> {
        let amplitudes: Vec<Complex64> = truth
            .iter()
            .map(|t| cis(t.phase_rad.unwrap_or(0.0)) * db_to_amplitude(t.power_db))
            .collect();
        let covariance = single_snapshot(&amplitudes);
        let signals = Signals { covariance: covariance.view(), noise_power, snapshots: 1 };
        let directions: Vec<Direction> = truth.iter().map(|t| t.direction).collect();
        match deterministic_bound(&self.array, &directions, &signals) {
            Ok(bound) => bound.azimuth_rad.iter().map(|sigma| sigma.to_degrees()).collect(),
            Err(_) => vec![f64::INFINITY; truth.len()],
        }
    }

    /// Errors of targets that stand apart from all others, against the bound.
    fn separated(
        &self,
        record: &mut MethodRecord,
        truth: &[Point],
        found: &[Point],
        bound_deg: &[f64],
    ) {
        for (index, target) in truth.iter().enumerate() {
            let sine = target.azimuth_rad.sin();
            let apart = truth.iter().enumerate().all(|(other, t)| {
                other == index || (t.azimuth_rad.sin() - sine).abs() > SEPARATED_BEAMS * self.beam
            });
            if !apart || !bound_deg[index].is_finite() {
                continue;
            }
            record.separated_targets += 1;
            let near = found.iter().map(|p| (p.azimuth_rad - target.azimuth_rad).abs());
            let error = near.fold(f64::INFINITY, f64::min);
            if error <= super::score::WITHIN_RAD {
                record.separated.0 += error.to_degrees().powi(2);
                record.separated.1 += bound_deg[index].powi(2);
                record.separated.2 += 1;
            }
        }
    }
}
