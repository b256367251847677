//! The snapshots of one condition through every method.

use super::finder::{Candidate, Finder, Idle, angle_options};
use super::score::{Point, Prediction, Score, Threshold, WITHIN_RAD, odds_db};
use super::stated::Stated;
use super::{AoaExperiment, Condition, SPREAD_DB};
use crate::apart::half_beam;
use crate::entrants::Entrants;
use crate::error::EvaluateError;
use boresight_aoa::bounds::{Signals, deterministic_bound, single_snapshot};
use boresight_aoa::refinement::Refinement;
use boresight_aoa::{BatchEstimate, Data, Source};
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::presets::preset;
use boresight_core::{Array, Complex64, Direction, Imperfections, Random};
use boresight_math::decibels::{db_to_amplitude, db_to_power};
use boresight_math::phasor::cis;
use boresight_simulate::snapshots::{
    Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator, Target,
};
use boresight_validate::experiment::Tell;
use ndarray::{Array2, Array3, ArrayView3, Axis};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::sync::Arc;

/// Half width of the sector of targets, rad (60 deg).
pub(super) const TARGETS_WITHIN_RAD: f64 = 1.047_197_551_196_597_6;
/// Targets with at least this many beamwidths to the next are separated.
const SEPARATED_BEAMS: f64 = 2.0;
/// What of a condition is kept for one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodRecord {
    /// Detections against targets.
    pub score: Score,
    /// Sums over separated targets that were found, and their number: squared error, squared bound, deg^2.
    pub separated: (f64, f64, u32),
    /// Separated targets in all.
    pub separated_targets: u32,
    /// What became of the deviations stated.
    #[serde(default, skip_serializing_if = "Stated::is_empty")]
    pub stated: Stated,
}

impl MethodRecord {
    /// Nothing yet.
    pub(crate) fn new(threshold: Threshold) -> Self {
        Self {
            score: Score::new(threshold),
            separated: (0.0, 0.0, 0),
            separated_targets: 0,
            stated: Stated::default(),
        }
    }
}

fn prediction(source: &Source, threshold: Threshold) -> Prediction {
    let power_db = 10.0 * source.power.log10();
    let point = Point { azimuth_rad: source.direction.azimuth_rad, power_db };
    let level_db = match threshold {
        Threshold::Power => power_db,
        Threshold::Confidence => odds_db(source.confidence.unwrap_or(1.0)),
    };
    Prediction { point, level_db }
}

/// Names of methods and networks in the order of records.
pub(crate) fn names(entrants: &Entrants) -> Result<Vec<String>, EvaluateError> {
    Ok(Candidate::all(entrants)?.iter().map(Candidate::name).collect())
}

/// A target or prediction among the answers: azimuth in degrees, power in dB (`null` where there is none), and the
/// confidence that a network has in it.
fn row(point: Point, confidence: Option<f64>) -> Value {
    let row = [Some(point.azimuth_rad.to_degrees()), Some(point.power_db), confidence];
    row.into_iter().flatten().map(Value::from).collect()
}

/// Some snapshots of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AoaRecord {
    /// Index of the condition.
    pub condition: usize,
    /// Methods in order.
    pub methods: Vec<MethodRecord>,
}

/// What a candidate does with snapshots.
pub(super) type Task = Box<dyn FnMut(ArrayView3<Complex64>) -> Result<(), EvaluateError>>;

/// All that snapshots share.
#[derive(Clone)]
pub struct Plan {
    array: Array,
    seed: u64,
    imperfections: ImperfectionSpread,
    candidates: Vec<Candidate>,
    beam: f64,
    /// Shared by clones, which are for the same array.
    idle: Arc<Idle>,
    /// Largest error of a right prediction, rad.
    within_rad: f64,
    spread_db: f64,
}

impl Plan {
    /// For an array.
    ///
    /// # Errors
    /// An array that is not known; as [`Plan::of`].
    pub fn new(options: &AoaExperiment) -> Result<Self, EvaluateError> {
        let most = options.targets.iter().copied().max().unwrap_or(1);
        let plan = Self::of(preset(&options.array)?, most, options.seed, &options.entrants)?;
        Ok(Self { imperfections: options.imperfections, spread_db: options.spread_db, ..plan })
    }

    /// For an array of any elements and at most so many targets.
    ///
    /// # Errors
    /// Those of methods and networks that do not take it.
    pub fn of(
        array: Array,
        most: usize,
        seed: u64,
        entrants: &Entrants,
    ) -> Result<Self, EvaluateError> {
        entrants.check()?;
        let candidates = Candidate::all(entrants)?;
        // Whether they take the array, one snapshot and the most targets, before anything is run.
        let silence = Array2::zeros((array.len(), 1));
        for candidate in candidates.iter().filter(|c| c.finder.can_run()) {
            candidate.finder.estimator(&array, most)?.estimate(Data::Snapshots(silence.view()))?;
        }
        let beam = half_beam(&array);
        let (imperfections, idle) = (ImperfectionSpread::default(), Arc::default());
        let (within_rad, spread_db) = (WITHIN_RAD, SPREAD_DB);
        Ok(Self { array, seed, imperfections, candidates, beam, idle, within_rad, spread_db })
    }

    /// With another error of what is right, rad.
    #[must_use]
    pub fn within(self, within_rad: f64) -> Self {
        Self { within_rad, ..self }
    }

    /// With errors of the array that no method knows of.
    #[must_use]
    pub fn with_imperfections(self, imperfections: ImperfectionSpread) -> Self {
        Self { imperfections, ..self }
    }

    /// Half the width of the main beam between its zeros, sine.
    pub fn beam(&self) -> f64 {
        self.beam
    }

    /// Names of the methods in order.
    pub fn names(&self) -> Vec<String> {
        self.candidates.iter().map(Candidate::name).collect()
    }

    /// Runs snapshots `first` to `first + trials - 1` of a condition, whose scenes are those of the streams `index`, and
    /// tells of each its number, truth and answers.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(
        &self,
        index: usize,
        condition: Condition,
        [first, trials]: [u64; 2],
        mut tell: Option<Tell>,
    ) -> Result<AoaRecord, EvaluateError> {
        let noise_power = db_to_power(-condition.snr_db);
        let (scenes, truths) = self.scenes(index, condition, first, trials)?;
        let mut found: Vec<(&Finder, BatchEstimate)> = vec![];
        for Candidate { finder, .. } in &self.candidates {
            if !found.iter().any(|(known, _)| *known == finder) {
                let new = || finder.estimator(&self.array, condition.targets);
                found.push((finder, self.idle.estimate(finder, new, scenes.view(), false)?));
            }
        }
        let mut refinement = Refinement::new(&self.array, &angle_options(condition.targets))?;
        let mut methods: Vec<MethodRecord> =
            self.candidates.iter().map(|c| MethodRecord::new(c.threshold())).collect();
        for (trial, truth) in truths.iter().enumerate() {
            let y = Data::Snapshots(scenes.index_axis(Axis(0), trial));
            let points: Vec<Point> = truth
                .iter()
                .map(|t| Point { azimuth_rad: t.direction.azimuth_rad, power_db: t.power_db })
                .collect();
            let bound = self.bound(truth, noise_power);
            let mut answers = serde_json::Map::new();
            for (candidate, record) in self.candidates.iter().zip(&mut methods) {
                let finder = &candidate.finder;
                let Some((_, batch)) = found.iter().find(|(known, _)| *known == finder) else {
                    continue;
                };
                let all = batch.sources_of(trial);
                let refined;
                let (sources, sure) = if candidate.refined {
                    refined = refinement.refine(&finder.sure(all), y)?;
                    (&*refined, refined.iter().map(|s| *s.direction).collect())
                } else {
                    (all, finder.sure(all))
                };
                let predictions: Vec<Prediction> =
                    sources.iter().map(|s| prediction(s, candidate.threshold())).collect();
                record.score.add_within(self.within_rad, &points, &predictions);
                for source in finder.sure_sources(sources) {
                    record.stated.add(self.within_rad, &points, source);
                }
                self.separated(record, &points, &sure, &bound);
                if tell.is_some() {
                    let rows = sources
                        .iter()
                        .zip(&predictions)
                        .map(|(source, prediction)| row(prediction.point, source.confidence));
                    answers.insert(candidate.name(), rows.collect());
                }
            }
            if let Some(tell) = &mut tell {
                let truth: Value = points.iter().map(|&point| row(point, None)).collect();
                tell(json!({
                    "condition": index,
                    "targets": condition.targets,
                    "snrDb": condition.snr_db,
                    "trial": first + trial as u64,
                    "truth": truth,
                    "answers": answers,
                }));
            }
        }
        Ok(AoaRecord { condition: index, methods })
    }

    /// Snapshots `first` to `first + trials - 1` of a condition, each with its targets.
    pub(super) fn scenes(
        &self,
        index: usize,
        condition: Condition,
        first: u64,
        trials: u64,
    ) -> Result<(Array3<Complex64>, Vec<Vec<Target>>), EvaluateError> {
        let mut scenes = Array3::zeros((trials as usize, self.array.len(), 1));
        let mut truths = vec![];
        for (trial, mut scene) in (first..).zip(scenes.outer_iter_mut()) {
            let (y, truth) = self.scene(index, condition, trial)?;
            scene.assign(&y);
            truths.push(truth);
        }
        Ok((scenes, truths))
    }

    /// What each candidate does with snapshots.
    pub(super) fn tasks(&self, targets: usize) -> Result<Vec<(String, Task)>, EvaluateError> {
        let task = |candidate: &Candidate| {
            let mut estimator = candidate.finder.estimator(&self.array, targets)?;
            let mut refinement = Refinement::new(&self.array, &angle_options(targets))?;
            let Candidate { finder, refined } = candidate.clone();
            let task: Task = Box::new(move |scenes| {
                let batch = estimator.estimate_batch(scenes, false)?;
                for (trial, y) in scenes.outer_iter().enumerate().filter(|_| refined) {
                    let directions = finder.sure(batch.sources_of(trial));
                    refinement.refine(&directions, Data::Snapshots(y))?;
                }
                Ok(())
            });
            Ok((candidate.name(), task))
        };
        self.candidates.iter().map(task).collect()
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
        let (scene, seed, stream) = match condition.pair_beams {
            None => (Scene::Sampled(self.sampling(condition.targets)), self.seed, stream),
            Some(beams) => {
                let mut random = Random::new(self.seed, stream);
                let targets = self.pair_among(condition.targets, beams, &mut random);
                (Scene::Given(targets), random.bits(), 0)
            }
        };
        let simulator = SnapshotSimulator::new(
            &self.array,
            &SnapshotOptions {
                scene,
                snr_db: condition.snr_db,
                snapshots: 1,
                fluctuation: Fluctuation::RandomPhase,
                imperfections,
                seed,
                ..SnapshotOptions::default()
            },
        )?;
        Ok(simulator.scene(stream)?)
    }

    fn sampling(&self, targets: usize) -> SceneSampling {
        SceneSampling {
            count: [targets; 2],
            field_of_view_rad: TARGETS_WITHIN_RAD,
            power_db: [-self.spread_db, 0.0],
            ..SceneSampling::default()
        }
    }

    /// Random targets, of which the second one is so many beams to one side of the first, within the sector.
    fn pair_among(&self, targets: usize, beams: f64, random: &mut Random) -> Vec<Target> {
        let half = TARGETS_WITHIN_RAD;
        let mut all: Vec<Target> = (0..targets)
            .map(|_| Target {
                direction: Direction::azimuth(random.uniform(-half, half)).into(),
                power_db: random.uniform(-self.spread_db, 0.0),
                ..Target::default()
            })
            .collect();
        if let [first, second, ..] = &mut all[..] {
            let side = if random.uniform(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 };
            let sine = first.direction.azimuth_rad.sin();
            let apart = beams * self.beam * side;
            let within = (sine + apart).abs() <= half.sin();
            let beside = if within { sine + apart } else { sine - apart };
            second.direction = Direction::azimuth(beside.asin()).into();
        }
        all
    }

    /// Standard deviation of each azimuth at the bound, deg; infinite where there is none.
    fn bound(&self, truth: &[Target], noise_power: f64) -> Vec<f64> {
        let amplitudes: Vec<Complex64> = truth
            .iter()
            .map(|t| cis(t.phase_rad.unwrap_or(0.0)) * db_to_amplitude(t.power_db))
            .collect();
        let covariance = single_snapshot(&amplitudes);
        let signals = Signals { covariance: covariance.view(), noise_power, snapshots: 1 };
        let directions: Vec<Direction> = truth.iter().map(|t| *t.direction).collect();
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
        found: &[Direction],
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
            let near = found.iter().map(|d| (d.azimuth_rad - target.azimuth_rad).abs());
            let error = near.fold(f64::INFINITY, f64::min);
            if error <= self.within_rad {
                record.separated.0 += error.to_degrees().powi(2);
                record.separated.1 += bound_deg[index].powi(2);
                record.separated.2 += 1;
            }
        }
    }
}
