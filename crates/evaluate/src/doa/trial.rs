//! Trials of one condition.

use super::{Options, REGION, SNRS_DB, Targets, condition};
use crate::EvaluateError;
use crate::told::{self, Candidate};
use boresight_aoa::bounds::{Signals, deterministic_bound, stochastic_bound, uncorrelated};
use boresight_aoa::counting::{Criterion, count_sources_in};
use boresight_aoa::{Data, Estimator};
use boresight_core::linalg::hermitian_eigen;
use boresight_core::units::db_to_power;
use boresight_core::{Array, Complex64, Direction, Random, Waveform};
use boresight_signal::Window;
use boresight_signal::region::{crop_region, range_spectrum, region_covariance};
use boresight_simulate::cube::{CubeOptions, CubeTarget, simulate_cube};
use ndarray::{Array2, Axis};
use serde::{Deserialize, Serialize};

/// Angles are the whole degrees up to this on either side.
pub const LARGEST_DEG: i32 = 10;
/// Deviations allowed to estimates rounded to whole degrees, deg.
pub const DEVIATIONS_DEG: [f64; 3] = [0.0, 2.0, 4.0];
/// Pairs nearer than this are close, deg.
pub const CLOSE_DEG: i32 = 4;
/// Methods are told that targets are within this of boresight, rad (15 deg).
const FIELD_OF_VIEW_RAD: f64 = 0.261_799_387_799_149_4;

/// Rules that count targets.
pub const COUNTERS: [(&str, Criterion, bool); 4] = [
    ("AIC", Criterion::Aic, false),
    ("MDL", Criterion::Mdl, false),
    ("AIC, forward-backward", Criterion::Aic, true),
    ("MDL, forward-backward", Criterion::Mdl, true),
];

/// Some trials of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Index of the condition.
    pub condition: usize,
    /// Trials.
    pub trials: u32,
    /// Of which pairs closer than [`CLOSE_DEG`].
    pub close: u32,
    /// For each of [`COUNTERS`], how often it counted 0, 1, 2 and more targets.
    pub counted: Vec<[u32; 4]>,
    /// Methods in order; none where there is no target.
    pub methods: Vec<Tally>,
}

/// What a method did.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Trials in which it gave as many angles as there are targets.
    pub found: u32,
    /// Sum over these of the squared errors, deg^2.
    pub squared_deg2: f64,
    /// Trials in which every angle was within 1 deg.
    pub success: u32,
    /// Trials in which every angle, rounded to a whole degree, was within [`DEVIATIONS_DEG`].
    pub within: [u32; 3],
    /// `success` and `within` of close pairs.
    pub close_success: u32,
    /// See `close_success`.
    pub close_within: [u32; 3],
}

impl Tally {
    pub(super) fn add(&mut self, other: &Self) {
        self.found += other.found;
        self.squared_deg2 += other.squared_deg2;
        self.success += other.success;
        self.close_success += other.close_success;
        for k in 0..DEVIATIONS_DEG.len() {
            self.within[k] += other.within[k];
            self.close_within[k] += other.close_within[k];
        }
    }

    /// Counts a trial; both in ascending order.
    fn count(&mut self, truth_deg: &[f64], found_deg: &[f64], close: bool) {
        let largest = |found: &dyn Fn(f64) -> f64| {
            let errors = truth_deg.iter().zip(found_deg).map(|(t, f)| (found(*f) - t).abs());
            errors.fold(0.0, f64::max)
        };
        let squares = truth_deg.iter().zip(found_deg).map(|(t, f)| (f - t).powi(2));
        self.found += 1;
        self.squared_deg2 += squares.sum::<f64>();
        let success = u32::from(largest(&|angle| angle) <= 1.0);
        self.success += success;
        self.close_success += success * u32::from(close);
        let end = f64::from(LARGEST_DEG);
        let rounded = largest(&|angle| angle.round().clamp(-end, end));
        for (k, &deviation) in DEVIATIONS_DEG.iter().enumerate() {
            let within = u32::from(rounded <= deviation);
            self.within[k] += within;
            self.close_within[k] += within * u32::from(close);
        }
    }
}

/// What trials share.
pub struct Plan {
    waveform: Waveform,
    array: Array,
    range_m: [f64; 2],
    seed: u64,
    /// For one and for two targets.
    candidates: [Vec<Candidate>; 2],
}

impl Plan {
    pub(super) fn new(options: &Options) -> Result<Self, EvaluateError> {
        let (waveform, array, range_m) = options.setup.radar()?;
        let vectors = REGION[0] * REGION[1];
        let of = |sources| told::candidates(&array, vectors, sources, FIELD_OF_VIEW_RAD, true);
        let candidates = [of(1), of(2)];
        Ok(Self { waveform, array, range_m, seed: options.seed, candidates })
    }

    /// Names of the methods, which are the same for one and two targets.
    pub fn names(&self) -> Vec<String> {
        self.candidates[0].iter().map(|candidate| candidate.name.clone()).collect()
    }

    /// Runs trials `first` to `first + trials - 1` of a condition.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(&self, index: usize, first: u64, trials: u64) -> Result<Record, EvaluateError> {
        let (targets, snr_db) = condition(index);
        let count = targets.count();
        let candidates: &[Candidate] = if count > 0 { &self.candidates[count - 1] } else { &[] };
        let mut estimators: Vec<(Estimator, bool)> = vec![];
        for candidate in candidates {
            estimators.push((candidate.estimator(&self.array)?, candidate.takes_covariance()));
        }
        let mut record = Record {
            condition: index,
            trials: trials as u32,
            close: 0,
            counted: vec![[0; 4]; COUNTERS.len()],
            methods: vec![Tally::default(); candidates.len()],
        };
        for trial in first..first + trials {
            let truth_deg = angles(targets, trial);
            let close = count == 2 && truth_deg[1] - truth_deg[0] < CLOSE_DEG;
            record.close += u32::from(close);
            let truth_deg: Vec<f64> = truth_deg.into_iter().map(f64::from).collect();
            let stream = ((index as u64) << 40) + trial;
            let covariance = self.covariance(targets, &truth_deg, snr_db, stream)?;
            let snapshots = root(&covariance)?;
            let vectors = REGION[0] * REGION[1];
            let data = Data::Covariance { matrix: covariance.view(), snapshots: vectors };
            for (counts, (_, criterion, reversed)) in record.counted.iter_mut().zip(COUNTERS) {
                let (_, counted) = count_sources_in(data, reversed, criterion)?;
                counts[counted.sources.min(3)] += 1;
            }
            for (tally, (estimator, covariance)) in record.methods.iter_mut().zip(&mut estimators) {
                let data = if *covariance { data } else { Data::Snapshots(snapshots.view()) };
                if let Some(found) = told::azimuths(estimator, data, count)? {
                    let found: Vec<f64> = found.into_iter().map(f64::to_degrees).collect();
                    tally.count(&truth_deg, &found, close);
                }
            }
        }
        Ok(record)
    }

    /// Simulates a frame and returns the covariance of its region of interest.
    fn covariance(
        &self,
        targets: Targets,
        truth_deg: &[f64],
        snr_db: f64,
        stream: u64,
    ) -> Result<Array2<Complex64>, EvaluateError> {
        let mut random = Random::new(self.seed, stream);
        let [near, far] = self.range_m;
        let mut range_m = random.uniform(near, far);
        let mut echoes = vec![];
        for (k, azimuth) in truth_deg.iter().enumerate() {
            if k > 0 && targets == Targets::Apart {
                range_m = random.uniform(near, far);
            }
            let direction = Direction::azimuth(azimuth.to_radians());
            echoes.push(CubeTarget { range_m, direction, ..CubeTarget::default() });
        }
        let options = CubeOptions { snr_db, seed: random.bits(), ..CubeOptions::default() };
        let cube = simulate_cube(&self.waveform, &self.array, &echoes, &options)?;
        let spectrum = range_spectrum(cube.index_axis(Axis(0), 0), Window::Rectangular)?;
        let power = |range: usize| {
            let cells = spectrum.index_axis(Axis(2), range);
            cells.iter().map(|z| f64::from(z.norm_sqr())).sum::<f64>()
        };
        let strongest = (0..spectrum.len_of(Axis(2)))
            .max_by(|&a, &b| power(a).total_cmp(&power(b)))
            .unwrap_or(0);
        let region = crop_region(spectrum.view(), strongest, REGION[0], REGION[1])?;
        Ok(region_covariance(region.view()))
    }

    /// Bounds of the error of one target's angle, root of the mean square over its angles, deg: of all samples of
    /// the frame with the echo known to be the same in all of them, and of the region's 260 vectors with the
    /// echo Gaussian in each, which MUSIC attains with many.
    ///
    /// # Errors
    /// None with the arrays used.
    pub fn bounds_deg(&self, snr_db: f64) -> Result<[f64; 2], EvaluateError> {
        let power = uncorrelated(&[1.0]);
        let samples = self.waveform.samples;
        let noise = db_to_power(-snr_db);
        let frame = Signals {
            covariance: power.view(),
            noise_power: noise,
            snapshots: samples * REGION[1],
        };
        let share = REGION[0] as f64 / samples as f64;
        let region =
            Signals { noise_power: noise * share, snapshots: REGION[0] * REGION[1], ..frame };
        let mut squares = [0.0; 2];
        for degrees in -LARGEST_DEG..=LARGEST_DEG {
            let truth = [Direction::azimuth(f64::from(degrees).to_radians())];
            let frame = deterministic_bound(&self.array, &truth, &frame)?;
            let region = stochastic_bound(&self.array, &truth, &region)?;
            squares[0] += frame.azimuth_rad[0].powi(2);
            squares[1] += region.azimuth_rad[0].powi(2);
        }
        Ok(squares.map(|sum| (sum / f64::from(2 * LARGEST_DEG + 1)).sqrt().to_degrees()))
    }
}

/// Angles of a trial, deg, ascending: all single ones, or all pairs, in turn.
fn angles(targets: Targets, trial: u64) -> Vec<i32> {
    let all = u64::from(2 * LARGEST_DEG.unsigned_abs() + 1);
    match targets.count() {
        0 => vec![],
        1 => vec![(trial % all) as i32 - LARGEST_DEG],
        _ => {
            let pairs = (0..all).flat_map(|low| (low + 1..all).map(move |high| [low, high]));
            let pair = pairs.cycle().nth((trial % (all * (all - 1) / 2)) as usize);
            pair.into_iter().flatten().map(|angle| angle as i32 - LARGEST_DEG).collect()
        }
    }
}

/// As many snapshots as elements with the given covariance.
fn root(covariance: &Array2<Complex64>) -> Result<Array2<Complex64>, EvaluateError> {
    let eigen = hermitian_eigen(covariance.view())?;
    let elements = covariance.nrows() as f64;
    let mut vectors = eigen.vectors;
    for (mut column, value) in vectors.columns_mut().into_iter().zip(&eigen.values) {
        column.mapv_inplace(|z| z * (value.max(0.0) * elements).sqrt());
    }
    Ok(vectors)
}

/// Signal-to-noise ratios of conditions, for the report.
pub(super) fn conditions() -> impl Iterator<Item = (usize, Targets, f64)> {
    (0..Targets::ALL.len() * SNRS_DB.len()).map(|index| {
        let (targets, snr_db) = condition(index);
        (index, targets, snr_db)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn angles_go_through_all_pairs() {
        let pairs: BTreeSet<Vec<i32>> =
            (0..210).map(|trial| angles(Targets::Apart, trial)).collect();
        assert_eq!(pairs.len(), 210);
        assert!(pairs.iter().all(|pair| -10 <= pair[0] && pair[0] < pair[1] && pair[1] <= 10));
        assert_eq!(angles(Targets::Together, 210), [-10, -9]);
        let single: BTreeSet<i32> = (0..21).map(|trial| angles(Targets::One, trial)[0]).collect();
        assert_eq!(single.len(), 21);
        assert!(angles(Targets::None, 3).is_empty());
    }

    #[test]
    fn errors_are_counted_exactly_and_rounded() {
        let mut tally = Tally::default();
        // Off by 0.4 and 0.1 deg; rounded they are right.
        tally.count(&[-2.0, 1.0], &[-2.4, 1.1], true);
        assert_eq!((tally.success, tally.within, tally.close_within), (1, [1; 3], [1; 3]));
        assert!((tally.squared_deg2 - 0.17).abs() < 1e-12);
        // Beyond 10 deg there is no class: 12.4 counts as 10.
        tally.count(&[-2.0, 9.0], &[-2.0, 12.4], false);
        assert_eq!((tally.success, tally.within), (1, [1, 2, 2]));
        tally.count(&[5.0], &[5.0 + 3.4], false);
        assert_eq!((tally.found, tally.within, tally.close_success), (3, [1, 2, 3], 1));
        let mut sum = Tally::default();
        sum.add(&tally);
        assert_eq!(sum, tally);
    }

    #[test]
    fn the_snapshots_have_the_covariance() {
        let mut random = Random::new(1, 0);
        let y = Array2::from_shape_fn((4, 9), |_| random.complex_normal(1.0));
        let covariance = boresight_signal::sample_covariance(y.view());
        let again = boresight_signal::sample_covariance(root(&covariance).unwrap().view());
        assert!((again - covariance).iter().all(|z| z.norm() < 1e-12));
    }
}
