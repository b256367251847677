//! Excision (Goldman and Bar-David 1988): noise is the mean of the training cells that are no targets themselves, so that
//! a strong neighbour does not hide a weaker target, and noise beside it keeps its false-alarm rate.
//!
//! Which cells are left out is found by screening the whole map first: a cell over a threshold of the ordered statistic,
//! whose middle rank holds while fewer than half of the training cells are targets. The screen takes a known share of
//! noise cells with it, those of most power; what that takes off the mean is made good. The factor is then that of cell
//! averaging over the cells that are left.

use super::cell_averaging::Mean;
use super::ordered_statistic::{self, OrderedStatistic};
use super::threshold::{Factors, factors, mean_factor};
use super::training_cells::TrainingCells;
use super::training_noise::TrainingNoise;
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
pub fn screen(options: &CfarOptions, noise: &TrainingNoise) -> Screen {
    let threshold = factors(&by_rank(options, SCREENED), noise).threshold;
    let (total, rank) = (noise.cells.total(), screen_rank(noise.cells));
    let statistic = OrderedStatistic::new(options.looks, total, rank, noise.pairs());
    let taken = statistic.power_above(threshold);
    Screen { threshold, bias: (1.0 - taken) / (1.0 - SCREENED) }
}

fn by_rank(options: &CfarOptions, false_alarm: f64) -> CfarOptions {
    CfarOptions { kind: CfarKind::OrderedStatistic, rank: RANK, false_alarm, ..*options }
}

/// Factors by the number of training cells left, each found when it is first asked for.
pub struct LeftFactors {
    options: CfarOptions,
    /// Of the cells of the fullest rows, and their mean.
    noise: TrainingNoise,
    mean: Mean,
    means: BTreeMap<usize, f64>,
    rank: Option<Factors>,
}

impl LeftFactors {
    pub fn new(options: &CfarOptions, noise: TrainingNoise) -> Self {
        let options = by_rank(options, options.false_alarm);
        let mean = noise.mean(options.looks);
        Self { options, noise, mean, means: BTreeMap::new(), rank: None }
    }

    /// Threshold over the mean of so many cells.
    pub fn of_mean(&mut self, cells: usize) -> f64 {
        let spare = (usize::BITS - cells.leading_zeros()).saturating_sub(BITS);
        let cells = (cells >> spare) << spare;
        let share = cells as f64 / self.noise.cells.total().max(1) as f64;
        let (options, mean) = (&self.options, &self.mean);
        *self.means.entry(cells).or_insert_with(|| mean_factor(options, &mean.of_share(share)))
    }

    /// Factors over the screen's statistic of the fullest rows, for cells that no training cell is left of.
    pub fn of_rank(&mut self) -> Factors {
        *self.rank.get_or_insert_with(|| factors(&self.options, &self.noise))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::cfar::stencil::Rectangle;
    use crate::cfar::training_noise::CellCorrelations;
    use boresight_core::Random;

    /// Eight independent cells on each side.
    fn noise() -> TrainingNoise {
        let side = |rows| vec![Rectangle { rows, offsets: 0..1 }];
        let correlations = CellCorrelations::new([None; 2], [12, 0]).unwrap();
        TrainingNoise::new(&[side(0..8), side(9..17)], &correlations)
    }

    /// Of 200,000 noise cells, each beside 16 of its own.
    #[test]
    fn the_mean_left_by_the_screen_is_as_computed() {
        for looks in [1, 8] {
            let options = CfarOptions { looks, ..CfarOptions::default() };
            let screen = screen(&options, &noise());
            let cells = noise().cells;
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
        let mut factors = LeftFactors::new(&CfarOptions::default(), noise());
        let few: Vec<f64> = (1..=300).map(|cells| factors.of_mean(cells)).collect();
        assert!(few.windows(2).all(|pair| pair[1] <= pair[0]));
        (300..100_000).for_each(|cells| {
            factors.of_mean(cells);
        });
        assert!(factors.means.len() < 2000);
    }
}
