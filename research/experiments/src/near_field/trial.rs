//! The snapshots of one condition through every method.

use super::{NearFieldExperiment, POWERS_DB, RANGES};
use crate::aoa::finder::{Candidate, Finder, Idle};
use crate::aoa::score::WITHIN_RAD;
use crate::apart::{BEAMS_APART, Drawn};
use crate::deviation::Deviation;
use crate::error::EvaluateError;
use boresight_aoa::refinement::Refinement;
use boresight_aoa::{BatchEstimate, Data, EstimatorOptions, Source};
use boresight_core::array::Position;
use boresight_core::presets::preset;
use boresight_core::{Array, InputError};
use boresight_math::decibels::db_to_power;
use boresight_math::error::check_range;
use boresight_simulate::SnapshotOptions;
use ndarray::{Array3, Axis};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Estimates this far below the strongest do not count, dB.
pub const DYNAMIC_RANGE_DB: f64 = 20.0;

/// Some snapshots of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NearFieldRecord {
    /// Index of the condition.
    pub condition: usize,
    /// Estimates against targets, of each method in order.
    pub methods: Vec<Deviation>,
}

/// What snapshots share.
pub struct Plan {
    /// As methods know it.
    array: Array,
    /// As it stands.
    centred: Array,
    pub(super) fraunhofer_m: f64,
    snr_db: f64,
    seed: u64,
    candidates: Vec<Candidate>,
    idle: Idle,
}

impl Plan {
    pub(super) fn new(options: &NearFieldExperiment) -> Result<Self, EvaluateError> {
        let array = preset(&options.array)?;
        // The least range would be a fraction of the wavelength for shorter ones.
        check_range("length of the array, half wavelengths", array.aperture(), 10.0, 1e6)?;
        options.entrants.check()?;
        let candidates = Candidate::all(&options.entrants)?;
        // Whether they take the array and one snapshot, before anything is run.
        let silence = Array3::zeros((1, array.len(), 1));
        for candidate in candidates.iter().filter(|candidate| candidate.finder.can_run()) {
            let mut estimator = candidate.finder.with_options(&array, angle_options())?;
            estimator.estimate_batch(silence.view(), false)?;
        }
        let wavelength_m = SnapshotOptions::default().wavelength_m;
        let length_m = 0.5 * wavelength_m * array.aperture();
        Ok(Self {
            centred: centred(&array)?,
            fraunhofer_m: 2.0 * length_m * length_m / wavelength_m,
            snr_db: options.snr_db,
            seed: options.seed,
            candidates,
            array,
            idle: Idle::default(),
        })
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
        first: u64,
        trials: u64,
    ) -> Result<NearFieldRecord, EvaluateError> {
        let (number, range) = (index / RANGES.len(), RANGES[index % RANGES.len()]);
        let drawn = Drawn {
            array: &self.centred,
            seed: self.seed,
            group: number as u64,
            snr_db: self.snr_db,
            snapshots: 1,
            beams_apart: BEAMS_APART,
            powers_db: POWERS_DB[number],
            range_m: range.map(|range| range * self.fraunhofer_m),
        };
        let (scenes, truths) = drawn.scenes(first, trials)?;
        let mut refinement = Refinement::new(&self.array, &angle_options())?;
        let mut found: Vec<(&Finder, BatchEstimate)> = vec![];
        let mut methods = vec![];
        for Candidate { finder, refined } in &self.candidates {
            if !found.iter().any(|(known, _)| *known == finder) {
                let new = || finder.with_options(&self.array, angle_options());
                found.push((finder, self.idle.estimate(finder, new, scenes.view(), false)?));
            }
            let Some((_, batch)) = found.iter().find(|(known, _)| *known == finder) else {
                continue;
            };
            let mut deviation = Deviation::default();
            for (trial, truth) in truths.iter().enumerate() {
                let all = batch.sources_of(trial);
                let mut sources: Vec<Source> = if *refined {
                    let y = Data::Snapshots(scenes.index_axis(Axis(0), trial));
                    refinement.refine(&finder.sure(all), y)?
                } else {
                    finder.sure_sources(all).copied().collect()
                };
                sources.sort_by(|a, b| b.power.total_cmp(&a.power));
                let strongest = sources.first().map_or(0.0, |source| source.power);
                let least = strongest * db_to_power(-DYNAMIC_RANGE_DB);
                sources.retain(|source| source.power >= least);
                // Among many false ones some would be near a target by chance.
                let (taken, rest) = sources.split_at(truth.len().min(sources.len()));
                deviation.add(&self.array, truth, taken, WITHIN_RAD);
                deviation.false_targets += rest.len() as u32;
            }
            methods.push(deviation);
        }
        Ok(NearFieldRecord { condition: index, methods })
    }
}

/// The array with the centres of its transmitters and of its receivers in the origin. Plane waves differ by a phase
/// that all elements share.
fn centred(array: &Array) -> Result<Array, InputError> {
    let shifted = |positions: &[Position]| -> Vec<Position> {
        let count = positions.len() as f64;
        let middle = [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis]).sum::<f64>() / count);
        positions.iter().map(|p| [0, 1, 2].map(|axis| p[axis] - middle[axis])).collect()
    };
    let (tx, rx) = (shifted(array.tx()), shifted(array.rx()));
    let kept: Vec<usize> = array.channels().iter().map(|c| c.tx * rx.len() + c.rx).collect();
    Array::mimo(&tx, &rx)?.select(&kept)
}

fn angle_options() -> EstimatorOptions {
    EstimatorOptions {
        grid_points: 2048,
        field_of_view_rad: FRAC_PI_2,
        dynamic_range_db: DYNAMIC_RANGE_DB,
        max_peaks: 64,
        ..EstimatorOptions::default()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_core::Direction;
    use boresight_core::steering::steering_vector;

    #[test]
    fn a_centred_array_answers_plane_waves_as_before_but_for_one_phase() {
        for name in ["lrr48", "cascade86"] {
            let array = preset(name).unwrap();
            let moved = centred(&array).unwrap();
            for positions in [moved.tx(), moved.rx()] {
                assert!(positions.iter().map(|p| p[1]).sum::<f64>().abs() < 1e-9);
            }
            let at = Direction::azimuth(0.4);
            let (a, b) = (steering_vector(&array, at), steering_vector(&moved, at));
            let phase = b[0] * a[0].conj();
            assert!(a.iter().zip(&b).all(|(a, b)| (a * phase - b).norm() < 1e-9), "{name}");
        }
    }
}
