//! What is known of the angle now, the rate and the steps, over the scatter and over models beside the one selected.

use super::mixture::Term;
use super::scan::{Place, places};
use super::select::{Model, joined};
use super::sums::Prefix;
use std::f64::consts::PI;
use std::ops::Range;

/// Probability of a knock in a history, beforehand.
const KNOCK_SHARE: f64 = 0.1;
/// Odds of a drift, beforehand.
const DRIFT_ODDS: f64 = 0.5;
/// Deviation of steps, and of what a drift comes to over all drives, beforehand, rad.
const CHANGE: f64 = PI / 180.0;
/// The scatter's logarithm is as likely anywhere within this factor of 1, beforehand, and less beyond, by this deviation.
const SCATTER_FLAT: f64 = 3.0;
const SCATTER_EDGE: f64 = 0.5;
/// Logarithms of the scatter that are integrated over, about 0.
const SCATTER_REACH: f64 = 2.5;
const SCATTER_NODES: usize = 81;
/// From so many degrees of freedom on the scatter is taken at its best.
const SURE_FREEDOM: f64 = 200.0;
/// Models and scatters are left out that are less likely than the best by this logarithm, and models beyond so many.
const NEGLIGIBLE: f64 = 9.0;
const MOST_MODELS: usize = 64;

/// An estimate by a model of such knocks, with a rate or without, and its variance at a scatter of 1.
type Value<'a> = dyn Fn(&[usize], bool) -> (f64, f64) + 'a;

/// A model's evidence, as it depends on the scatter, and what it estimates.
#[derive(Debug, Clone, Copy)]
struct Component {
    /// Logarithm of the factors that do not depend on the scatter.
    ln_factor: f64,
    left: f64,
    freedom: f64,
    /// Estimate and its variance at a scatter of 1.
    value: (f64, f64),
}

/// What is known, as mixtures about the reference angle and over the length of the series.
pub(super) struct Posterior {
    pub now: Vec<Term>,
    pub rate: Vec<Term>,
    pub steps: Vec<Vec<Term>>,
    pub scatter: f64,
}

impl Posterior {
    pub fn of(prefix: &Prefix, model: &Model, now: f64) -> Self {
        let at_end = |starts: &[usize], rate: bool| value_now(prefix, starts, rate, now);
        let slope = |starts: &[usize], _: bool| value_rate(prefix, starts);
        let components = alternatives(prefix, model, &[false, true], &at_end);
        let with_rate = alternatives(prefix, model, &[true], &slope);
        let steps = (0..model.starts.len()).map(|j| steps(prefix, model, j)).collect();
        let base = component(prefix, &model.starts, model.rate, &at_end);
        Self {
            now: mixed(&components),
            rate: mixed(&with_rate),
            steps,
            scatter: base.map_or(1.0, |base| scatter(&base)),
        }
    }
}

/// The estimate of the angle at the end, and its variance.
fn value_now(prefix: &Prefix, starts: &[usize], rate: bool, now: f64) -> (f64, f64) {
    let from = starts.last().copied().unwrap_or(0);
    let last = prefix.over(from..prefix.len());
    let (mut mean, mut variance) = (last.mean_y(), 1.0 / last.w);
    if rate {
        let centred = prefix.centred(starts);
        let ahead = now - last.mean_t();
        mean += ahead * centred.ty / centred.tt;
        variance += ahead * ahead / centred.tt;
    }
    (mean, variance)
}

fn value_rate(prefix: &Prefix, starts: &[usize]) -> (f64, f64) {
    let centred = prefix.centred(starts);
    (centred.ty / centred.tt, 1.0 / centred.tt)
}

/// The step of knock `j` and its variance.
fn value_step(prefix: &Prefix, starts: &[usize], rate: bool, j: usize) -> (f64, f64) {
    let (_, range) = joined(prefix, starts, j);
    let (before, after) = (prefix.over(range.start..starts[j]), prefix.over(starts[j]..range.end));
    let (mut step, mut variance) =
        (after.mean_y() - before.mean_y(), 1.0 / before.w + 1.0 / after.w);
    let centred = prefix.centred(starts);
    if rate && centred.has_rate() {
        let apart = after.mean_t() - before.mean_t();
        step -= apart * centred.ty / centred.tt;
        variance += apart * apart / centred.tt;
    }
    (step, variance)
}

/// A model's component; none where it has a rate that the times do not tell.
fn component(prefix: &Prefix, starts: &[usize], rate: bool, value: &Value) -> Option<Component> {
    let centred = prefix.centred(starts);
    if rate && !centred.has_rate() {
        return None;
    }
    let changes = starts.len() as f64 + f64::from(u8::from(rate));
    let drives = prefix.all().n;
    // Information on the steps is the product of the levels' over that of all, which is the same in all models.
    let levels: f64 = prefix.segments(starts).map(|range| prefix.over(range).w.ln()).sum();
    let mut ln_factor = -0.5 * levels - changes * CHANGE.ln();
    let place = KNOCK_SHARE / prefix.len() as f64;
    ln_factor += starts.len() as f64 * place.ln();
    if rate {
        ln_factor += DRIFT_ODDS.ln() - 0.5 * centred.tt.ln();
    }
    Some(Component {
        ln_factor,
        left: centred.left(rate),
        freedom: (drives - 1.0 - changes).max(0.0),
        value: value(starts, rate),
    })
}

/// The model, and those with one knock more, with one at another place, with one less; each with and without a rate as given.
fn alternatives(prefix: &Prefix, model: &Model, rates: &[bool], value: &Value) -> Vec<Component> {
    let mut components = Vec::new();
    for &rate in rates {
        components.extend(component(prefix, &model.starts, rate, value));
        for range in prefix.segments(&model.starts) {
            components.extend(with_one(prefix, &model.starts, range, rate, None, value));
        }
        for j in 0..model.starts.len() {
            let (others, range) = joined(prefix, &model.starts, j);
            components.extend(component(prefix, &others, rate, value));
            components.extend(with_one(prefix, &others, range, rate, Some(model.starts[j]), value));
        }
    }
    components
}

/// A model with one more knock within a stretch, at the most likely places except one.
fn with_one(
    prefix: &Prefix,
    starts: &[usize],
    range: Range<usize>,
    rate: bool,
    except: Option<usize>,
    value: &Value,
) -> Vec<Component> {
    likely(prefix, starts, range, rate)
        .into_iter()
        .filter(|place| Some(place.start) != except)
        .filter_map(|place| {
            let mut starts = starts.to_vec();
            starts.insert(starts.partition_point(|&s| s < place.start), place.start);
            component(prefix, &starts, rate, value)
        })
        .collect()
}

/// The most likely places for one more knock.
fn likely(prefix: &Prefix, starts: &[usize], range: Range<usize>, rate: bool) -> Vec<Place> {
    let centred = prefix.centred(starts);
    let left = centred.left(rate);
    let n = prefix.all().n;
    let evidence = |place: &Place| {
        -0.5 * n * (1.0 + (left - place.gain).max(0.0)).ln() - 0.5 * place.information.ln()
    };
    let mut found: Vec<(f64, Place)> =
        places(prefix, range, centred, rate).map(|place| (evidence(&place), place)).collect();
    let best = found.iter().map(|f| f.0).fold(f64::NEG_INFINITY, f64::max);
    found.retain(|f| f.0 > best - NEGLIGIBLE);
    if found.len() > MOST_MODELS {
        found.select_nth_unstable_by(MOST_MODELS, |a, b| b.0.total_cmp(&a.0));
        found.truncate(MOST_MODELS);
    }
    found.into_iter().map(|f| f.1).collect()
}

/// The step of knock `j` over its places.
fn steps(prefix: &Prefix, model: &Model, j: usize) -> Vec<Term> {
    let value = |starts: &[usize], rate: bool| value_step(prefix, starts, rate, j);
    let (others, range) = joined(prefix, &model.starts, j);
    mixed(&with_one(prefix, &others, range, model.rate, None, &value))
}

/// Logarithm of what is known of the scatter's logarithm beforehand.
fn ln_prior(x: f64) -> f64 {
    let beyond = (x.abs() - SCATTER_FLAT.ln()).max(0.0) / SCATTER_EDGE;
    -0.5 * beyond * beyond
}

impl Component {
    /// Logarithm of the evidence at the scatter `e^x`.
    fn ln_evidence(&self, x: f64) -> f64 {
        self.ln_factor + ln_prior(x) - self.freedom * x - 0.5 * self.left * (-2.0 * x).exp()
    }

    fn best_scatter(&self) -> f64 {
        0.5 * (self.left.max(f64::MIN_POSITIVE) / self.freedom.max(1.0)).ln()
    }
}

/// Logarithms of scatters to integrate over.
fn nodes(components: &[Component]) -> Vec<f64> {
    let best = components.iter().max_by(|a, b| {
        let of = |c: &Component| c.ln_evidence(c.best_scatter());
        of(a).total_cmp(&of(b))
    });
    match best {
        Some(best) if best.freedom > SURE_FREEDOM => vec![best.best_scatter()],
        Some(_) => {
            let step = 2.0 * SCATTER_REACH / (SCATTER_NODES - 1) as f64;
            (0..SCATTER_NODES).map(|k| k as f64 * step - SCATTER_REACH).collect()
        }
        None => Vec::new(),
    }
}

/// The mixture of models and scatters.
fn mixed(components: &[Component]) -> Vec<Term> {
    let nodes = nodes(components);
    let mut found = Vec::new();
    for component in components {
        found.extend(nodes.iter().map(|&x| (component.ln_evidence(x), x, component.value)));
    }
    let best = found.iter().map(|f| f.0).fold(f64::NEG_INFINITY, f64::max);
    found.retain(|f| f.0 > best - NEGLIGIBLE);
    let term = |&(ln, x, (mean, variance)): &(f64, f64, (f64, f64))| Term {
        share: (ln - best).exp(),
        mean,
        sigma: x.exp() * variance.sqrt(),
    };
    found.iter().map(term).collect()
}

/// The scatter: the mean of its logarithm.
fn scatter(component: &Component) -> f64 {
    let nodes = nodes(&[*component]);
    let best = nodes.iter().map(|&x| component.ln_evidence(x)).fold(f64::NEG_INFINITY, f64::max);
    let shares: Vec<f64> = nodes.iter().map(|&x| (component.ln_evidence(x) - best).exp()).collect();
    let total: f64 = shares.iter().sum();
    let mean: f64 = nodes.iter().zip(&shares).map(|(x, share)| x * share).sum::<f64>() / total;
    mean.exp()
}
