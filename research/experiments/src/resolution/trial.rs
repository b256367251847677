//! Trials of one condition.

use super::limit::beam_width;
use super::{Condition, ResolutionExperiment};
use crate::error::EvaluateError;
use crate::told::{self, Candidate};
use boresight_aoa::{Data, Estimator};
use boresight_core::presets::preset;
use boresight_core::{Array, Direction, Random};
use boresight_simulate::snapshots::{
    Fluctuation, Scene, SnapshotOptions, SnapshotSimulator, Target,
};
use serde::{Deserialize, Serialize};

/// Half width of the sector that methods search, rad (60 deg).
const FIELD_OF_VIEW_RAD: f64 = 1.047_197_551_196_597_6;
/// The middle of the targets lies within this of boresight, rad (15 deg).
const MIDDLE_RAD: f64 = 0.261_799_387_799_149_4;

/// Some trials of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResolutionRecord {
    /// Index of the condition.
    pub condition: usize,
    /// Trials.
    pub trials: u32,
    /// Trials that each method resolved.
    pub resolved: Vec<u32>,
}

/// What trials share.
pub struct Plan {
    array: Array,
    seed: u64,
    snapshots: Vec<usize>,
    conditions: Vec<Condition>,
    /// For each number of snapshots.
    pub(super) candidates: Vec<Vec<Candidate>>,
    /// Width of the beam, sine.
    pub(super) beam: f64,
}

impl Plan {
    pub(super) fn new(options: &ResolutionExperiment) -> Result<Self, EvaluateError> {
        let array = preset(&options.array)?;
        let of =
            |&snapshots: &usize| told::candidates(&array, snapshots, 2, FIELD_OF_VIEW_RAD, false);
        Ok(Self {
            seed: options.seed,
            snapshots: options.snapshots.clone(),
            conditions: options.conditions().collect(),
            candidates: options.snapshots.iter().map(of).collect(),
            beam: beam_width(&array),
            array,
        })
    }

    /// Names of the methods for each number of snapshots.
    pub fn names(&self) -> Vec<String> {
        let named = self.snapshots.iter().zip(&self.candidates);
        named.flat_map(|(n, all)| all.iter().map(move |c| format!("{n}: {}", c.name))).collect()
    }

    /// The array.
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// Runs trials `first` to `first + trials - 1` of a condition.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(
        &self,
        index: usize,
        first: u64,
        trials: u64,
    ) -> Result<ResolutionRecord, EvaluateError> {
        let condition = self.conditions[index];
        let mut estimators: Vec<Estimator> = vec![];
        for candidate in &self.candidates[condition.snapshots] {
            estimators.push(candidate.estimator(&self.array)?);
        }
        let mut record = ResolutionRecord {
            condition: index,
            trials: trials as u32,
            resolved: vec![0; estimators.len()],
        };
        let separation = condition.separation * self.beam;
        for trial in first..first + trials {
            let stream = ((index as u64) << 40) + trial;
            let mut random = Random::new(self.seed, stream);
            let middle = random.uniform(-MIDDLE_RAD, MIDDLE_RAD).sin();
            let truth = [-0.5, 0.5].map(|side| middle + side * separation);
            let targets = truth.map(|sine| Target {
                direction: Direction::azimuth(sine.clamp(-1.0, 1.0).asin()).into(),
                ..Target::default()
            });
            let simulator = SnapshotSimulator::new(
                &self.array,
                &SnapshotOptions {
                    scene: Scene::Given(targets.to_vec()),
                    snr_db: condition.snr_db,
                    snapshots: self.snapshots[condition.snapshots],
                    fluctuation: Fluctuation::RandomPhase,
                    seed: random.bits(),
                    ..SnapshotOptions::default()
                },
            )?;
            let (y, _) = simulator.scene(0)?;
            for (k, estimator) in estimators.iter_mut().enumerate() {
                let Some(found) = told::azimuths(estimator, Data::Snapshots(y.view()), 2)? else {
                    continue;
                };
                let errors = [found[0].sin() - truth[0], found[1].sin() - truth[1]];
                if errors.iter().all(|error| error.abs() < 0.5 * separation) {
                    record.resolved[k] += 1;
                }
            }
        }
        Ok(record)
    }
}
