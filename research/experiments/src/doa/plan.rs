//! What the trials of all conditions share: radar, conditions, methods, and the simulation of a frame.

use super::end_to_end::EndToEnd;
use super::region_methods::RegionMethod;
use super::tally::{CLOSE_DEG, FIELD_OF_VIEW_RAD, LARGEST_DEG};
use super::{Condition, REGION, Targets};
use crate::entrants::{Entrants, Network};
use crate::error::EvaluateError;
use crate::told::{self, Candidate};
use boresight_aoa::bounds::{Signals, deterministic_bound, stochastic_bound, uncorrelated};
use boresight_aoa::order::counting::Criterion;
use boresight_core::{Array, Complex32, Direction, InputError, Random, Waveform};
use boresight_math::decibels::db_to_power;
use boresight_neural::Kind;
use boresight_options::Named;
use boresight_simulate::cube::{CubeOptions, CubeTarget, simulate_cube};
use ndarray::Array5;

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

/// What trials share.
pub struct Plan {
    pub(super) waveform: Waveform,
    pub(super) array: Array,
    pub(super) range_m: [f64; 2],
    pub(super) seed: u64,
    pub(super) conditions: Vec<Condition>,
    pub(super) counters: Vec<Counter>,
    /// For one and for two targets.
    pub(super) candidates: [Vec<Candidate>; 2],
    pub(super) region_methods: Vec<RegionMethod>,
    pub(super) networks: Vec<Network>,
    pub(super) end_to_end: Option<EndToEnd>,
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

#[cfg(test)]
mod tests {
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
}
