//! Threshold factors from false-alarm probabilities.

use super::cell_averaging::Mean;
use super::ordered_statistic::{self, OrderedStatistic};
use super::training_noise::TrainingNoise;
use super::{CfarKind, CfarOptions, greatest_of, smallest_of};

/// What turns the noise statistic of a kind of CFAR into threshold and noise power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Threshold over the statistic.
    pub threshold: f64,
    /// Expectation of the statistic over the noise power.
    pub bias: f64,
}

/// Factors that give `false_alarm` in noise whose cells are means of `looks` exponential powers, for each kind and any
/// number of training cells of at least one; of excision those where all are left. Exact for independent cells. Of
/// correlated ones the rate is between 0.78 and 1.1 of the one asked for, as long as the guard cells cover the main lobe.
pub fn factors(options: &CfarOptions, noise: &TrainingNoise) -> Factors {
    let CfarOptions { kind, rank, looks, false_alarm, .. } = *options;
    let cells = noise.cells;
    let one_sided = cells.before == 0 || cells.after == 0;
    let halves = || [noise.half(0, looks), noise.half(1, looks)];
    match kind {
        CfarKind::OrderedStatistic => {
            let rank = ordered_statistic::rank_of(rank, cells.total());
            let statistic = OrderedStatistic::new(looks, cells.total(), rank, noise.pairs());
            Factors {
                threshold: solve(false_alarm, |factor| statistic.false_alarm(factor)),
                bias: statistic.expectation(),
            }
        }
        CfarKind::GreatestOf if !one_sided => {
            let [before, after] = &halves();
            Factors {
                threshold: solve(false_alarm, |f| {
                    greatest_of::false_alarm(f, looks, [before, after])
                }),
                bias: greatest_of::expectation([before, after]),
            }
        }
        CfarKind::SmallestOf if !one_sided => {
            let [before, after] = &halves();
            Factors {
                threshold: solve(false_alarm, |f| {
                    smallest_of::false_alarm(f, looks, [before, after])
                }),
                bias: smallest_of::expectation([before, after]),
            }
        }
        _ => Factors { threshold: mean_factor(options, &noise.mean(looks)), bias: 1.0 },
    }
}

/// Threshold over a mean of training cells.
pub fn mean_factor(options: &CfarOptions, mean: &Mean) -> f64 {
    solve(options.false_alarm, |factor| mean.false_alarm(factor, options.looks))
}

/// The factor at which a falling probability reaches `false_alarm`: regula falsi with Illinois
/// weights on logarithms of both.
fn solve(false_alarm: f64, probability: impl Fn(f64) -> f64) -> f64 {
    let excess = |ln_factor: f64| (probability(ln_factor.exp()).ln() - false_alarm.ln()).max(-1e3);
    let (mut low, mut high) = (0.0, 0.0);
    let mut at_low = excess(low);
    let mut at_high = at_low;
    let mut step = 1.0;
    while at_low < 0.0 && low > -60.0 {
        (high, at_high) = (low, at_low);
        low -= step;
        step *= 2.0;
        at_low = excess(low);
    }
    step = 1.0;
    while at_high >= 0.0 && high < 60.0 {
        (low, at_low) = (high, at_high);
        high += step;
        step *= 1.5;
        at_high = excess(high);
    }
    let mut last_side = 0;
    for _ in 0..100 {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let at_middle = excess(middle);
        if at_middle.abs() < 1e-7 || high - low < 1e-12 {
            return middle.exp();
        }
        if at_middle > 0.0 {
            (low, at_low) = (middle, at_middle);
            if last_side == 1 {
                at_high *= 0.5;
            }
            last_side = 1;
        } else {
            (high, at_high) = (middle, at_middle);
            if last_side == -1 {
                at_low *= 0.5;
            }
            last_side = -1;
        }
    }
    (0.5 * (low + high)).exp()
}
