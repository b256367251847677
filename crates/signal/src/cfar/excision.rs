//! Excision (Goldman and Bar-David 1988): noise is the mean of the training cells that are no targets themselves, so that
//! a strong neighbour does not hide a weaker target, and noise beside it keeps its false-alarm rate.
//!
//! Which cells are left out is found by screening the whole map first: a cell over a threshold of the ordered statistic,
//! whose middle rank holds while fewer than half of the training cells are targets. The screen takes a known share of
//! noise cells with it, those of most power; what that takes off the mean is made good. The factor is then that of cell
//! averaging over the cells that are left.

use super::gamma::{integrate_log_concave, ln_incomplete};
use super::ordered_statistic;
use super::threshold::{Factors, TrainingCells, factors, mean_factor};
use super::{CfarKind, CfarOptions};
use std::collections::BTreeMap;

/// Probability that the screen takes a cell of noise for a target: low enough to leave the mean nearly whole, high
/// enough to see targets that would matter.
const SCREENED: f64 = 1e-3;

/// The rank of the screen, as a share of the training cells: the middle one.
const RANK: f64 = 0.5;

/// Significant bits of a number of cells: above 256 factors differ by less than 0.2 % from one number to the next that is
/// kept.
const BITS: u32 = 8;

/// The screen's factor over its statistic, and the mean of the cells it leaves over that of all, in noise.
#[derive(Debug, Clone, Copy)]
pub struct Screen {
    pub threshold: f64,
    pub bias: f64,
}

/// Rank of the screen among so many cells.
pub fn screen_rank(cells: TrainingCells) -> usize {
    ordered_statistic::rank_of(RANK, cells.total())
}

/// The screen of cells with these training cells.
pub fn screen(options: &CfarOptions, cells: TrainingCells, correlation: f64) -> Screen {
    let ranked = by_rank(options, SCREENED);
    let threshold = factors(&ranked, cells, correlation).threshold;
    let total = ordered_statistic::independent(cells.total(), correlation);
    let rank = ordered_statistic::effective_rank(RANK, cells.total(), correlation);
    let shape = options.looks as f64;
    // Power of the noise cells that the screen takes: of a gamma variable of shape L and mean 1 above c, Q(L + 1, L c).
    let taken = integrate_log_concave(|t| {
        ordered_statistic::ln_density(t, shape, total, rank)
            + ln_incomplete(shape + 1.0, shape * threshold * t.exp()).1
    });
    Screen { threshold, bias: (1.0 - taken) / (1.0 - SCREENED) }
}

fn by_rank(options: &CfarOptions, false_alarm: f64) -> CfarOptions {
    CfarOptions { kind: CfarKind::OrderedStatistic, rank: RANK, false_alarm, ..*options }
}

/// Factors by the number of training cells left, each found when it is first asked for.
pub struct LeftFactors {
    options: CfarOptions,
    correlation: f64,
    means: BTreeMap<usize, f64>,
    ranks: BTreeMap<usize, Factors>,
}

impl LeftFactors {
    pub fn new(options: &CfarOptions, correlation: f64) -> Self {
        let options = by_rank(options, options.false_alarm);
        Self { options, correlation, means: BTreeMap::new(), ranks: BTreeMap::new() }
    }

    /// Threshold over the mean of so many cells.
    pub fn of_mean(&mut self, cells: usize) -> f64 {
        let spare = (usize::BITS - cells.leading_zeros()).saturating_sub(BITS);
        let (options, correlation) = (&self.options, self.correlation);
        let cells = (cells >> spare) << spare;
        *self.means.entry(cells).or_insert_with(|| mean_factor(options, cells, correlation))
    }

    /// Factors over the screen's statistic, for cells that no training cell is left of.
    pub fn of_rank(&mut self, cells: TrainingCells) -> Factors {
        let (options, correlation) = (&self.options, self.correlation);
        *self.ranks.entry(cells.total()).or_insert_with(|| factors(options, cells, correlation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Random;

    /// Of 200,000 noise cells, each beside 16 of its own.
    #[test]
    fn the_mean_left_by_the_screen_is_as_computed() {
        for looks in [1, 8] {
            let options = CfarOptions { looks, ..CfarOptions::default() };
            let cells = TrainingCells { before: 8, after: 8 };
            let screen = screen(&options, cells, 1.0);
            let mut random = Random::new(3, looks as u64);
            let mut power = || {
                let product: f64 = (0..looks).map(|_| 1.0 - random.unit()).product();
                -product.ln() / looks as f64
            };
            let (mut sum, mut left, trials) = (0.0, 0, 200_000);
            for _ in 0..trials {
                let mut training: Vec<f64> = (0..16).map(|_| power()).collect();
                training.sort_by(f64::total_cmp);
                let x = power();
                if x <= screen.threshold * training[screen_rank(cells) - 1] {
                    sum += x;
                    left += 1;
                }
            }
            let taken = 1.0 - f64::from(left) / f64::from(trials);
            assert!((taken / SCREENED - 1.0).abs() < 0.35, "{looks}: {taken}");
            let mean = sum / f64::from(left);
            assert!((mean - screen.bias).abs() < 4.0 / (f64::from(trials) * looks as f64).sqrt());
        }
    }

    #[test]
    fn many_cells_share_their_factors() {
        let mut factors = LeftFactors::new(&CfarOptions::default(), 1.0);
        let few: Vec<f64> = (1..=300).map(|cells| factors.of_mean(cells)).collect();
        assert!(few.windows(2).all(|pair| pair[1] <= pair[0]));
        (300..100_000).for_each(|cells| {
            factors.of_mean(cells);
        });
        assert!(factors.means.len() < 2000);
    }
}
