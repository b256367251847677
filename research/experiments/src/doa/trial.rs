//! Trials of one condition.

use super::answers::Answers;
use super::end_to_end::EndToEnd;
use super::region_methods::{RegionMethod, RegionPlan};
use super::{Condition, REGION, Targets};
use crate::EvaluateError;
use crate::entrants::{Entrants, Network};
use crate::told::{self, Candidate};
use boresight_aoa::bounds::{Signals, deterministic_bound, stochastic_bound, uncorrelated};
use boresight_aoa::order::counting::{CountOptions, Criterion, count_sources_in};
use boresight_aoa::{Data, Estimator, EstimatorOptions, SourceCount};
use boresight_core::{Array, Complex32, Complex64, Direction, InputError, Random, Waveform};
use boresight_math::decibels::db_to_power;
use boresight_math::linalg::hermitian_eigen;
use boresight_neural::{Kind, Model};
use boresight_options::Named;
use boresight_signal::region::{crop_region, range_spectrum, region_snapshots, strongest_range};
use boresight_signal::{Window, sample_covariance};
use boresight_simulate::cube::{CubeOptions, CubeTarget, simulate_cube};
use boresight_validate::experiment::Tell;
use ndarray::{Array2, Array3, Array5, Axis};
use serde::{Deserialize, Serialize};

/// Angles are the whole degrees up to this on either side.
pub const LARGEST_DEG: i32 = 10;
/// Deviations allowed to estimates rounded to whole degrees, deg.
pub const DEVIATIONS_DEG: [f64; 3] = [0.0, 2.0, 4.0];
/// Pairs nearer than this are close, deg.
pub const CLOSE_DEG: i32 = 4;
/// Far more than the conversion of an angle between radians and degrees rounds, and far less than any estimate is
/// worth, deg.
const ROUNDING_DEG: f64 = 1e-9;
/// Methods are told that targets are within this of boresight, rad (15 deg).
pub(super) const FIELD_OF_VIEW_RAD: f64 = 0.261_799_387_799_149_4;

/// Largest speed of a target that moves, either way, m/s. The phase turns by up to half a turn a chirp.
const MOST_MPS: f64 = 20.0;

/// A rule that counts: name, criterion, whether the covariance is averaged with its reversal.
pub type Counter = (&'static str, Criterion, bool);

/// Rules that count targets.
pub const COUNTERS: [Counter; 4] = [
    ("AIC", Criterion::Aic, false),
    ("MDL", Criterion::Mdl, false),
    ("AIC, forward-backward", Criterion::Aic, true),
    ("MDL, forward-backward", Criterion::Mdl, true),
];

/// Some trials of one condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DoaRecord {
    /// Index of the condition.
    pub condition: usize,
    /// Trials.
    pub trials: u32,
    /// Of which pairs closer than [`CLOSE_DEG`].
    pub close: u32,
    /// For each rule and counting network, how often it counted 0, 1, 2 and more targets.
    pub counted: Vec<[u32; 4]>,
    /// Methods and networks in order; none where there is no target, and nothing of networks that are for another
    /// number of targets.
    pub methods: Vec<Option<Tally>>,
}

/// What a method did.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Trials in which it gave as many angles as there are targets.
    pub found: u32,
    /// Sum over these of the squared errors, deg^2.
    pub squared_deg2: f64,
    /// The same of angles rounded to whole degrees.
    pub rounded_deg2: f64,
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
        self.rounded_deg2 += other.rounded_deg2;
        self.success += other.success;
        self.close_success += other.close_success;
        for k in 0..DEVIATIONS_DEG.len() {
            self.within[k] += other.within[k];
            self.close_within[k] += other.close_within[k];
        }
    }

    /// Counts a trial; both in ascending order.
    pub(super) fn count(&mut self, truth_deg: &[f64], found_rad: &[f64], close: bool) {
        let found_deg: Vec<f64> = found_rad.iter().map(|&azimuth| in_degrees(azimuth)).collect();
        let end = f64::from(LARGEST_DEG);
        let rounded_deg: Vec<f64> =
            found_deg.iter().map(|angle| angle.round().clamp(-end, end)).collect();
        let errors = |found: &[f64]| -> Vec<f64> {
            truth_deg.iter().zip(found).map(|(t, f)| (f - t).abs()).collect()
        };
        let largest = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
        let squares = |errors: &[f64]| errors.iter().map(|error| error.powi(2)).sum::<f64>();
        let (exact, rounded) = (errors(&found_deg), errors(&rounded_deg));
        self.found += 1;
        self.squared_deg2 += squares(&exact);
        self.rounded_deg2 += squares(&rounded);
        let success = u32::from(largest(&exact) <= 1.0);
        self.success += success;
        self.close_success += success * u32::from(close);
        let rounded = largest(&rounded);
        for (k, &deviation) in DEVIATIONS_DEG.iter().enumerate() {
            let within = u32::from(rounded <= deviation);
            self.within[k] += within;
            self.close_within[k] += within * u32::from(close);
        }
    }
}

/// What trials share.
pub struct Plan {
    pub(super) waveform: Waveform,
    pub(super) array: Array,
    range_m: [f64; 2],
    seed: u64,
    pub(super) conditions: Vec<Condition>,
    counters: Vec<Counter>,
    /// For one and for two targets.
    candidates: [Vec<Candidate>; 2],
    region_methods: Vec<RegionMethod>,
    networks: Vec<Network>,
    end_to_end: Option<EndToEnd>,
}

/// Every method that runs on a radar's array, for that many targets.
pub(super) fn candidates(array: &Array, targets: usize) -> Vec<Candidate> {
    told::candidates(array, REGION[0] * REGION[1], targets, FIELD_OF_VIEW_RAD, true)
}

impl Plan {
    pub(super) fn new(options: &super::DoaExperiment) -> Result<Self, EvaluateError> {
        let (waveform, array, range_m) = options.setup.radar()?;
        options.entrants.check()?;
        let Entrants { methods, networks } = &options.entrants;
        let all = candidates(&array, 1);
        let known = COUNTERS.iter().map(|counter| counter.0).chain(all.iter().map(|c| &*c.name));
        let of_regions = RegionMethod::ALL.iter().map(|method| method.name());
        let known: Vec<&str> = known.chain(of_regions).collect();
        if let Some(name) = methods.iter().find(|name| !known.contains(&name.as_str())) {
            return Err(InputError::Unknown {
                what: "method".into(),
                expected: known.join("; "),
                given: name.clone(),
            }
            .into());
        }
        let named = |name: &str| methods.iter().any(|method| method == name);
        for network in networks {
            if network.kind.answers_target_set() {
                return Err(InputError::Incompatible {
                    what: format!("use of the network {}", network.name),
                    expected: "a network that counts, or one of a region or its covariance".into(),
                    given: network.kind.name().into(),
                }
                .into());
            }
        }
        let mut candidates = [all, candidates(&array, 2)];
        candidates.iter_mut().for_each(|all| all.retain(|candidate| named(&candidate.name)));
        let counters = COUNTERS.into_iter().filter(|counter| named(counter.0)).collect();
        let of_regions = RegionMethod::ALL.into_iter();
        let region_methods = of_regions.filter(|method| named(method.name())).collect();
        let conditions = options.axis.conditions();
        let networks = networks.clone();
        let end_to_end = options.end_to_end.clone();
        if let Some(flow) = &end_to_end {
            flow.check()?;
            if let Some(given) = methods.first().cloned() {
                let (what, expected) = ("methods from end to end".into(), "networks only".into());
                return Err(InputError::Incompatible { what, expected, given }.into());
            }
        }
        let seed = options.seed;
        Ok(Self {
            waveform,
            array,
            range_m,
            seed,
            conditions,
            counters,
            candidates,
            region_methods,
            networks,
            end_to_end,
        })
    }

    /// Names of what counts: rules, then networks.
    pub fn counters(&self) -> Vec<String> {
        let rules = self.counters.iter().map(|counter| counter.0.to_owned());
        rules.chain(self.networks_that(true).map(|network| network.name.clone())).collect()
    }

    /// Names of what estimates angles: methods, which are the same for one and two targets, then networks.
    pub fn names(&self) -> Vec<String> {
        let methods = self.candidates[0].iter().map(|candidate| candidate.name.clone());
        let of_regions = self.region_methods.iter().map(|method| method.name().to_owned());
        methods
            .chain(of_regions)
            .chain(self.networks_that(false).map(|network| network.name.clone()))
            .collect()
    }

    /// Networks that count, or that estimate angles.
    pub(super) fn networks_that(&self, count: bool) -> impl Iterator<Item = &Network> {
        self.networks.iter().filter(move |network| (network.kind == Kind::Counting) == count)
    }

    /// Runs trials `first` to `first + trials - 1` of a condition, and tells of each its number, truth and answers.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(
        &self,
        index: usize,
        first: u64,
        trials: u64,
        tell: Option<Tell>,
    ) -> Result<DoaRecord, EvaluateError> {
        if let Some(flow) = &self.end_to_end {
            return self.run_end_to_end(flow, index, first, trials, tell);
        }
        let count = self.conditions[index].targets.count();
        let candidates: &[Candidate] = if count > 0 { &self.candidates[count - 1] } else { &[] };
        let mut estimators: Vec<(Estimator, bool)> = vec![];
        for candidate in candidates {
            estimators.push((candidate.estimator(&self.array)?, candidate.takes_covariance()));
        }
        let mut region_plans: Vec<RegionPlan> = vec![];
        for method in self.region_methods.iter().filter(|_| count > 0) {
            region_plans.push(method.plan(&self.array, self.waveform.samples, count)?);
        }
        let mut counting: Vec<&Model> = vec![];
        for network in self.networks_that(true) {
            counting.push(network.model()?);
        }
        // Where there are no targets none is of use.
        let mut networks: Vec<Option<Estimator>> = vec![];
        for network in self.networks_that(false).filter(|_| count > 0) {
            let model = network.model()?;
            let suits = model.card().and_then(|card| card.targets).is_none_or(|of| of == count);
            let estimator = || model.estimator(&self.array, &known(count));
            networks.push(suits.then(estimator).transpose()?);
        }
        let tallies = networks.iter().map(|network| network.as_ref().map(|_| Tally::default()));
        let mut record = DoaRecord {
            condition: index,
            trials: trials as u32,
            close: 0,
            counted: vec![[0; 4]; self.counters.len() + counting.len()],
            methods: (0..candidates.len() + region_plans.len())
                .map(|_| Some(Tally::default()))
                .chain(tallies)
                .collect(),
        };
        let vectors = REGION[0] * REGION[1];
        let mut cells = Array3::zeros((trials as usize, self.array.len(), vectors));
        let mut regions = vec![];
        let mut truths: Vec<(Vec<f64>, bool)> = vec![];
        for (trial, mut cell) in (first..).zip(cells.outer_iter_mut()) {
            let (frame, truth_deg, close) = self.frame(index, trial)?;
            record.close += u32::from(close);
            let spectrum = range_spectrum(frame.index_axis(Axis(0), 0), Window::Rectangular)?;
            let strongest = strongest_range(spectrum.view());
            let region = crop_region(spectrum.view(), strongest, REGION[0], REGION[1])?;
            cell.assign(&region_snapshots(region.view()));
            regions.push(region);
            truths.push((truth_deg, close));
        }
        let mut answers = vec![Answers::default(); truths.len()];
        let trials = cells.outer_iter().zip(&regions).zip(&truths).zip(&mut answers);
        for (((cell, region), (truth_deg, close)), told) in trials {
            let covariance = sample_covariance(cell);
            let snapshots = root(&covariance)?;
            let data = Data::Covariance { matrix: covariance.view(), snapshots: vectors };
            let mut counts = record.counted.iter_mut();
            for ((_, criterion, reversed), counts) in self.counters.iter().zip(&mut counts) {
                let options = CountOptions {
                    criterion: *criterion,
                    forward_backward: *reversed,
                    ..CountOptions::default()
                };
                let (_, counted) = count_sources_in(data, &options)?;
                counts[counted.sources.min(3)] += 1;
                told.counted.push(counted.sources);
            }
            for (model, counts) in counting.iter().zip(counts) {
                let counted = model.count(data)?.sources;
                counts[counted.min(3)] += 1;
                told.counted.push(counted);
            }
            let mut tallies = record.methods.iter_mut();
            for ((estimator, covariance), tally) in estimators.iter_mut().zip(&mut tallies) {
                let data = if *covariance { data } else { Data::Snapshots(snapshots.view()) };
                let found = told::azimuths(estimator, data, count)?;
                if let (Some(tally), Some(found)) = (tally, &found) {
                    tally.count(truth_deg, found, *close);
                }
                told.azimuths_rad.push(found);
            }
            for (plan, tally) in region_plans.iter_mut().zip(&mut tallies) {
                let found = plan.azimuths(region.view(), &covariance, count)?;
                if let (Some(tally), Some(found)) = (tally, &found) {
                    tally.count(truth_deg, found, *close);
                }
                told.azimuths_rad.push(found);
            }
        }
        let tallies = record.methods.iter_mut().skip(estimators.len() + region_plans.len());
        for (network, tally) in networks.iter_mut().zip(tallies) {
            let (Some(network), Some(tally)) = (network, tally) else {
                answers.iter_mut().for_each(|told| told.azimuths_rad.push(None));
                continue;
            };
            let batch = network.estimate_batch(cells.view(), false)?;
            for (cell, ((truth_deg, close), told)) in truths.iter().zip(&mut answers).enumerate() {
                let found = told::strongest(batch.sources_of(cell), count);
                if let Some(found) = &found {
                    tally.count(truth_deg, found, *close);
                }
                told.azimuths_rad.push(found);
            }
        }
        if let Some(tell) = tell {
            for (trial, ((truth_deg, _), answers)) in (first..).zip(truths.iter().zip(&answers)) {
                self.tell(index, trial, truth_deg, answers, &mut *tell);
            }
        }
        Ok(record)
    }

    /// Simulates the frame of a trial: a cube of one frame, the angles of its targets, deg, and whether they are a
    /// close pair.
    pub(super) fn frame(
        &self,
        index: usize,
        trial: u64,
    ) -> Result<(Array5<Complex32>, Vec<f64>, bool), EvaluateError> {
        let Condition { targets, snr_db, second_db } = self.conditions[index];
        let truth_deg = angles(targets, trial);
        let close = truth_deg.len() == 2 && truth_deg[1] - truth_deg[0] < CLOSE_DEG;
        let truth_deg: Vec<f64> = truth_deg.into_iter().map(f64::from).collect();
        let mut random = Random::new(self.seed, ((index as u64) << 40) + trial);
        let [near, far] = self.range_m;
        let mut range_m = random.uniform(near, far);
        let mut echoes = vec![];
        // Which of two is the weaker or the moving one.
        let are_unlike = second_db != 0.0 || targets == Targets::Moving;
        let second = if are_unlike && random.uniform(0.0, 1.0) < 0.5 { 0 } else { 1 };
        for (k, azimuth) in truth_deg.iter().enumerate() {
            if k > 0 && targets == Targets::Apart {
                range_m = random.uniform(near, far);
            }
            let flow = self.end_to_end.as_ref();
            let azimuth_rad = flow.map_or(azimuth.to_radians(), |flow| flow.azimuth_rad(*azimuth));
            let direction = Direction::azimuth(azimuth_rad);
            let power_db = if k == second { second_db } else { 0.0 };
            let moves = k == second && targets == Targets::Moving;
            let rate_mps = if moves { random.uniform(-MOST_MPS, MOST_MPS) } else { 0.0 };
            echoes.push(CubeTarget {
                range_m,
                direction: direction.into(),
                power_db,
                rate_mps,
                ..CubeTarget::default()
            });
        }
        let options = CubeOptions { snr_db, seed: random.bits(), ..CubeOptions::default() };
        let cube = simulate_cube(&self.waveform, &self.array, &echoes, &options)?;
        Ok((cube, truth_deg, close))
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

/// An angle in degrees, whole where it was a whole number of degrees before it was one of radians.
fn in_degrees(angle_rad: f64) -> f64 {
    let (degrees, whole) = (angle_rad.to_degrees(), angle_rad.to_degrees().round());
    if (degrees - whole).abs() < ROUNDING_DEG { whole } else { degrees }
}

/// A network answers with the most probable directions.
fn known(targets: usize) -> EstimatorOptions {
    let (sources, field_of_view_rad) = (SourceCount::Known(targets), FIELD_OF_VIEW_RAD);
    EstimatorOptions { sources, field_of_view_rad, ..EstimatorOptions::default() }
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
        let mut count = |truth_deg: &[f64], found_deg: &[f64], close| {
            let found_rad: Vec<f64> =
                found_deg.iter().map(|degrees| degrees.to_radians()).collect();
            tally.count(truth_deg, &found_rad, close);
            tally
        };
        // Off by 0.4 and 0.1 deg; rounded they are right.
        let tally = count(&[-2.0, 1.0], &[-2.4, 1.1], true);
        assert_eq!((tally.success, tally.within, tally.close_within), (1, [1; 3], [1; 3]));
        assert!((tally.squared_deg2 - 0.17).abs() < 1e-12);
        assert!(tally.rounded_deg2 < 1e-12);
        // Beyond 10 deg there is no class: 12.4 counts as 10.
        let tally = count(&[-2.0, 9.0], &[-2.0, 12.4], false);
        assert_eq!((tally.success, tally.within), (1, [1, 2, 2]));
        assert!((tally.rounded_deg2 - 1.0).abs() < 1e-12);
        let tally = count(&[5.0], &[5.0 + 3.4], false);
        assert_eq!((tally.found, tally.within, tally.close_success), (3, [1, 2, 3], 1));
        let mut sum = Tally::default();
        sum.add(&tally);
        assert_eq!(sum, tally);
    }

    #[test]
    fn an_error_of_one_degree_is_within_one_degree() {
        let mut errors = 0;
        for truth in -LARGEST_DEG..=LARGEST_DEG {
            for found in [truth - 1, truth + 1] {
                if found.abs() <= LARGEST_DEG {
                    let mut tally = Tally::default();
                    let found = f64::from(found);
                    tally.count(&[f64::from(truth)], &[found.to_radians()], false);
                    assert_eq!((tally.success, tally.squared_deg2), (1, 1.0), "{truth} {found}");
                    errors += 1;
                }
            }
        }
        assert_eq!(errors, 40);
        let mut tally = Tally::default();
        tally.count(&[5.0], &[6.000_001_f64.to_radians()], false);
        assert_eq!(tally.success, 0);
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
