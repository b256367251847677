//! Trials of one condition.

use super::{LowSnrExperiment, conditions};
use crate::apart::Drawn;
use crate::entrants::Entrants;
use crate::error::EvaluateError;
use crate::told;
use boresight_aoa::bounds::{Signals, deterministic_bound, uncorrelated};
use boresight_aoa::{Data, Estimator};
use boresight_core::presets::preset;
use boresight_core::{Array, Direction, InputError};
use boresight_math::decibels::db_to_power;
use boresight_signal::sample_covariance;
use ndarray::Axis;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_3;

/// Largest error of a source that was found, rad (2 deg).
const WITHIN_RAD: f64 = 0.034_906_585_039_886_59;
/// Half width of the sector that methods search, rad: 60 deg, where sources end, and as much as these may be off, since
/// a maximum at the edge of a grid is no peak.
const FIELD_OF_VIEW_RAD: f64 = FRAC_PI_3 + WITHIN_RAD;
/// Sources are as far apart as half the main beam: a beam is what lies between its first zeros.
const BEAMS_APART: f64 = 0.5;
/// Powers of the sources, dB.
const POWERS_DB: [f64; 2] = [0.0, 0.0];

/// Some trials of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LowSnrRecord {
    /// Index of the condition.
    pub condition: usize,
    /// What each method found.
    pub methods: Vec<Found>,
}

/// What a method found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Trials.
    pub trials: u32,
    /// Trials in which both sources were found.
    pub found: u32,
    /// Sum of the squared errors of the azimuths of these, deg^2.
    pub error_deg2: f64,
    /// The same of the variances at the Cramer-Rao bound.
    pub bound_deg2: f64,
}

impl Found {
    /// Adds what another record holds.
    pub fn merge(&mut self, other: &Self) {
        self.trials += other.trials;
        self.found += other.found;
        self.error_deg2 += other.error_deg2;
        self.bound_deg2 += other.bound_deg2;
    }
}

/// What trials share.
pub struct Plan {
    array: Array,
    seed: u64,
    entrants: Entrants,
    candidates: Vec<told::Candidate>,
}

impl Plan {
    pub(super) fn new(options: &LowSnrExperiment) -> Result<Self, EvaluateError> {
        let array = preset(&options.array)?;
        options.entrants.check()?;
        // Enough for every method.
        let all = told::candidates(&array, usize::MAX, POWERS_DB.len(), FIELD_OF_VIEW_RAD, false);
        let named = |name: &String| {
            let fits = |c: &&told::Candidate| c.name == *name && c.takes_covariance();
            all.iter().find(fits).cloned().ok_or_else(|| InputError::Unknown {
                what: "method".into(),
                expected: "one that takes a covariance of the array".into(),
                given: name.clone(),
            })
        };
        let entrants = options.entrants.clone();
        let candidates = entrants.methods.iter().map(named).collect::<Result<_, _>>()?;
        Ok(Self { array, seed: options.seed, candidates, entrants })
    }

    /// Names of methods, then networks.
    pub fn names(&self) -> Vec<String> {
        let methods = self.candidates.iter().map(|candidate| candidate.name.clone());
        methods.chain(self.entrants.networks.iter().map(|network| network.name.clone())).collect()
    }

    fn estimators(&self) -> Result<Vec<Estimator>, EvaluateError> {
        let mut all: Vec<Estimator> = vec![];
        for candidate in &self.candidates {
            all.push(candidate.estimator(&self.array)?);
        }
        let options = told::options(POWERS_DB.len(), FIELD_OF_VIEW_RAD);
        for network in &self.entrants.networks {
            all.push(network.model()?.estimator(&self.array, &options)?);
        }
        Ok(all)
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
    ) -> Result<LowSnrRecord, EvaluateError> {
        let (snapshots, snr_db) = conditions()[index];
        let drawn = Drawn {
            array: &self.array,
            seed: self.seed,
            group: index as u64,
            snr_db,
            snapshots,
            powers_db: &POWERS_DB,
            beams_apart: BEAMS_APART,
            range_m: None,
        };
        let (scenes, truths) = drawn.scenes(first, trials)?;
        let mut estimators = self.estimators()?;
        let mut methods = vec![Found::default(); estimators.len()];
        for (scene, truth) in scenes.axis_iter(Axis(0)).zip(&truths) {
            let mut truth: Vec<Direction> = truth.iter().map(|target| *target.direction).collect();
            truth.sort_by(|a, b| a.azimuth_rad.total_cmp(&b.azimuth_rad));
            let bound_deg2 = self.bound_deg2(&truth, snapshots, snr_db)?;
            let matrix = sample_covariance(scene);
            for (estimator, record) in estimators.iter_mut().zip(&mut methods) {
                record.trials += 1;
                let data = Data::Covariance { matrix: matrix.view(), snapshots };
                let Some(azimuths_rad) = told::azimuths(estimator, data, truth.len())? else {
                    continue;
                };
                let errors_rad: Vec<f64> =
                    azimuths_rad.iter().zip(&truth).map(|(a, t)| a - t.azimuth_rad).collect();
                if errors_rad.iter().all(|error| error.abs() <= WITHIN_RAD) {
                    record.found += 1;
                    record.error_deg2 +=
                        errors_rad.iter().map(|e| e.to_degrees().powi(2)).sum::<f64>();
                    record.bound_deg2 += bound_deg2;
                }
            }
        }
        Ok(LowSnrRecord { condition: index, methods })
    }

    /// Sum of the variances of the azimuths at the bound, deg^2.
    fn bound_deg2(
        &self,
        truth: &[Direction],
        snapshots: usize,
        snr_db: f64,
    ) -> Result<f64, EvaluateError> {
        let covariance = uncorrelated(&POWERS_DB.map(db_to_power));
        let noise_power = db_to_power(-snr_db);
        let signals = Signals { covariance: covariance.view(), noise_power, snapshots };
        let bound = deterministic_bound(&self.array, truth, &signals)?;
        Ok(bound.azimuth_rad.iter().map(|sigma| sigma.to_degrees().powi(2)).sum())
    }
}
