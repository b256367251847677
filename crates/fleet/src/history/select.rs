//! Which knocks there are, and whether there is a drift.

use super::scan::{Best, Place, places};
use super::sums::Prefix;
use super::{HistoryOptions, MOST_KNOCKS};
use crate::tails::{as_normal, normal_quantile, normal_tail};
use std::f64::consts::TAU;
use std::ops::Range;

/// Drives' worth of knowledge that the stated deviations are right.
pub(super) const PRIOR_FREEDOM: f64 = 1.0;
/// How often the places of all knocks are refined after each that is found.
const REFINEMENTS: usize = 2;

/// Knocks, by their first drives after, and whether there is a drift.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Model {
    pub starts: Vec<usize>,
    pub rate: bool,
}

/// Thresholds of a series, in deviations of a normal distribution.
struct Levels {
    knock: f64,
    drift: f64,
    /// What a drift adds to a knock, where both explain more than chance although neither does alone.
    both: f64,
}

/// The model whose likelihood most exceeds what its knocks and drift have by chance.
pub(super) fn select(prefix: &Prefix, options: &HistoryOptions) -> Model {
    let whole = Best::of(places(prefix, 0..prefix.len(), prefix.centred(&[]), false));
    let knock = scan_level(whole.count, whole.odds, options.knock_false_alarm);
    let levels = Levels {
        knock,
        // Two parameters have exp(-x / 2) beyond a ratio of likelihoods x.
        both: (-2.0 * normal_tail(knock).ln() - knock * knock).max(0.0).sqrt(),
        drift: normal_quantile(options.drift_false_alarm),
    };
    let mut best = Model { starts: Vec::new(), rate: false };
    let mut best_score = score(prefix, &best, &levels);
    for rate in [false, true] {
        let mut model = Model { starts: Vec::new(), rate };
        loop {
            let mut pruned = model.clone();
            prune(prefix, &mut pruned, &levels);
            let drifts = !rate || drift_deviations(prefix, &pruned.starts) >= levels.drift;
            let score = score(prefix, &pruned, &levels);
            if drifts && score < best_score {
                (best, best_score) = (pruned, score);
            }
            if model.starts.len() >= MOST_KNOCKS || !grow(prefix, &mut model, &levels) {
                break;
            }
        }
    }
    best
}

/// Deviations that the highest of `count` places has by chance in a share `p` of series.
fn scan_level(count: f64, odds: f64, p: f64) -> f64 {
    let beyond = |z: f64| {
        let density = (-0.5 * z * z).exp() / TAU.sqrt();
        let continuous = z * density * ((1.0 - 1.0 / (z * z)) * odds + 4.0 / (z * z));
        (count * normal_tail(z)).min(continuous)
    };
    let (mut low, mut high) = (1.5, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if beyond(middle) > p { low = middle } else { high = middle }
    }
    high
}

/// Degrees of freedom that a model leaves, by the drives alone.
fn freedom(prefix: &Prefix, knocks: usize, rate: bool) -> f64 {
    prefix.all().n - 1.0 - knocks as f64 - f64::from(u8::from(rate))
}

/// Deviations of a parameter that lowers the squares from `left + gain` to `left`, as of a normal distribution.
fn deviations(gain: f64, left: f64, freedom: f64) -> f64 {
    if freedom <= 0.0 {
        return 0.0;
    }
    let freedom = freedom + PRIOR_FREEDOM;
    let variance = (PRIOR_FREEDOM + left.max(0.0)) / freedom;
    as_normal((gain.max(0.0) / variance).sqrt(), freedom)
}

fn drift_deviations(prefix: &Prefix, starts: &[usize]) -> f64 {
    let centred = prefix.centred(starts);
    if !centred.has_rate() {
        return 0.0;
    }
    let left = centred.left(true);
    deviations(centred.left(false) - left, left, freedom(prefix, starts.len(), true))
}

/// Twice the negative logarithm of the likelihood over all scatters, with for each knock and the drift what it takes to be beyond chance.
fn score(prefix: &Prefix, model: &Model, levels: &Levels) -> f64 {
    let left = prefix.centred(&model.starts).left(model.rate);
    let n = prefix.all().n + PRIOR_FREEDOM;
    let mut score = n * (PRIOR_FREEDOM + left).ln();
    // A threshold of z deviations as a ratio of likelihoods at so many degrees of freedom (Wallace 1959).
    let mut add = |z: f64, freedom: f64| {
        let freedom = freedom.max(0.0) + PRIOR_FREEDOM;
        let factor = (8.0 * freedom + 3.0) / (8.0 * freedom + 1.0);
        score += n / freedom * (z * factor).powi(2);
    };
    for knock in 1..=model.starts.len() {
        add(levels.knock, freedom(prefix, knock, model.rate));
    }
    if model.rate {
        add(
            if model.starts.is_empty() { levels.drift } else { levels.both },
            freedom(prefix, 0, true),
        );
    }
    score
}

/// The stretch that joins both sides of a knock.
pub(super) fn joined(prefix: &Prefix, starts: &[usize], j: usize) -> (Vec<usize>, Range<usize>) {
    let from = if j == 0 { 0 } else { starts[j - 1] };
    let end = starts.get(j + 1).copied().unwrap_or(prefix.len());
    let mut others = starts.to_vec();
    others.remove(j);
    (others, from..end)
}

/// Adds the knock that explains most; false where that is by chance.
fn grow(prefix: &Prefix, model: &mut Model, levels: &Levels) -> bool {
    let centred = prefix.centred(&model.starts);
    let mut best: Option<Place> = None;
    for range in prefix.segments(&model.starts) {
        let found = Best::of(places(prefix, range, centred, model.rate)).place;
        if let Some(place) = found.filter(|p| best.is_none_or(|b| p.gain > b.gain)) {
            best = Some(place);
        }
    }
    let Some(place) = best else { return false };
    let left = centred.left(model.rate) - place.gain;
    let freedom = freedom(prefix, model.starts.len() + 1, model.rate);
    if deviations(place.gain, left, freedom) < levels.knock {
        return false;
    }
    let at = model.starts.partition_point(|&start| start < place.start);
    model.starts.insert(at, place.start);
    refine(prefix, model);
    true
}

/// Moves each knock to its best place between its neighbours.
fn refine(prefix: &Prefix, model: &mut Model) {
    for _ in 0..REFINEMENTS {
        let mut moved = false;
        for j in 0..model.starts.len() {
            let (others, range) = joined(prefix, &model.starts, j);
            let centred = prefix.centred(&others);
            let best = Best::of(places(prefix, range, centred, model.rate)).place;
            if let Some(place) = best.filter(|p| p.start != model.starts[j]) {
                model.starts[j] = place.start;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
}

/// Drops knocks that are by chance beside the others, the least first.
fn prune(prefix: &Prefix, model: &mut Model, levels: &Levels) {
    while !model.starts.is_empty() {
        let left = prefix.centred(&model.starts).left(model.rate);
        let freedom = freedom(prefix, model.starts.len(), model.rate);
        let gains = (0..model.starts.len()).map(|j| {
            let (others, _) = joined(prefix, &model.starts, j);
            (prefix.centred(&others).left(model.rate) - left, j)
        });
        let Some((gain, j)) = gains.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        if deviations(gain, left, freedom) >= levels.knock {
            return;
        }
        model.starts.remove(j);
    }
}
