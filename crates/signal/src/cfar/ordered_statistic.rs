//! Ordered statistic (Rohling 1983): noise is the training cell of a given rank, so that a few
//! strong neighbours do not matter.
//!
//! The cell of rank `k` lies below a level where `k` cells do. Of independent cells that number is binomial. Correlated
//! cells raise its variance by a factor that depends on the level (Kibble's bivariate gamma distribution gives it for each
//! pair), and fewer cells by that factor stand for them.

use super::gamma::{integrate_log_concave, ln_density_of_ln, ln_incomplete, ln_incomplete_beta};

/// See [`OrderedStatistic::ln_split`].
const STEP: f64 = 0.1;

/// The training cell of a rank, in noise of power 1.
pub struct OrderedStatistic {
    looks: f64,
    cells: f64,
    rank: f64,
    /// Weights of the squared polynomials of order 0, 1, ... in the covariance of all pairs of cells; see
    /// [`OrderedStatistic::excess`].
    weights: Vec<f64>,
}

impl OrderedStatistic {
    /// The `rank`-th smallest of `cells` cells, each the mean of `looks` exponential powers, with the sums of powers of
    /// squared correlations of the cells ([`super::training_noise::TrainingNoise::pairs`]).
    pub fn new(looks: usize, cells: usize, rank: usize, pairs: &[f64]) -> Self {
        let order = looks as f64;
        // k! Gamma(L) / Gamma(k + L), by recurrence.
        let mut ratio = 1.0;
        let weight = |(index, pairs): (usize, &f64)| {
            let k = (index + 1) as f64;
            ratio *= k / (k - 1.0 + order);
            pairs * ratio / (k * k)
        };
        let weights = pairs.iter().enumerate().map(weight).collect();
        Self { looks: order, cells: cells as f64, rank: rank as f64, weights }
    }

    /// Logarithms of the probabilities that it is below and above `exp(ln_level)`.
    fn ln_split(&self, ln_level: f64) -> (f64, f64) {
        let level = self.looks * ln_level.exp();
        let (ln_p, ln_q) = ln_incomplete(self.looks, level);
        let spread = 1.0 + self.excess(level, ln_p + ln_q);
        // A whole cell less a cluster of cells is not a whole step: a tenth of a cell makes good most of that (by simulation
        // of all windows, with and without padding, 1 and 4 looks).
        let cells = self.cells / spread;
        let rank = (self.rank - STEP) / spread + STEP;
        ln_incomplete_beta(rank, cells - rank + 1.0, ln_p, ln_q)
    }

    /// By what share correlation raises the variance of the number of cells below a level. The covariance of a pair is
    /// `sum_k r^2k (x^L e^-x L_(k-1)^(L)(x) / k)^2 k! / (Gamma(L) Gamma(k + L))`, with generalised Laguerre polynomials.
    fn excess(&self, x: f64, ln_variance: f64) -> f64 {
        if self.weights.is_empty() || x <= 0.0 {
            return 0.0;
        }
        let order = self.looks;
        let ln_front = 2.0 * (order * x.ln() - x - libm::lgamma(order)) - ln_variance;
        let (mut before, mut polynomial) = (0.0, 1.0);
        let mut sum = 0.0;
        for (index, weight) in self.weights.iter().enumerate() {
            let k = (index + 1) as f64;
            sum += weight * polynomial * polynomial;
            // L_k from L_(k-1) and L_(k-2).
            let next = ((2.0 * k - 1.0 + order - x) * polynomial - (k - 1.0 + order) * before) / k;
            (before, polynomial) = (polynomial, next);
        }
        let excess = ln_front.exp() * sum / self.cells;
        // Far up the polynomials outgrow what doubles hold; nothing depends on the variance there.
        if excess.is_finite() { excess.min(self.cells) } else { 0.0 }
    }

    /// Probability that a cell of noise exceeds `factor` times it. For one look and independent cells Rohling's product.
    pub fn false_alarm(&self, factor: f64) -> f64 {
        integrate_log_concave(|t| {
            ln_density_of_ln(self.looks, t) + self.ln_split(t - factor.ln()).0
        })
    }

    /// Mean power of a cell of noise where it exceeds `factor` times the statistic, and nothing elsewhere.
    pub fn power_above(&self, factor: f64) -> f64 {
        integrate_log_concave(|t| {
            t + ln_density_of_ln(self.looks, t) + self.ln_split(t - factor.ln()).0
        })
    }

    /// Its expectation.
    pub fn expectation(&self) -> f64 {
        integrate_log_concave(|t| t + self.ln_split(t).1)
    }
}

/// Rank, from 1, of a share of the cells.
pub fn rank_of(share: f64, cells: usize) -> usize {
    ((share * cells as f64).ceil() as usize).clamp(1, cells.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_look_is_rohlings_product() {
        for (factor, cells, rank) in [(3.0, 8, 6), (9.0, 16, 12), (25.0, 32, 24), (2.0, 1, 1)] {
            let expected: f64 =
                (0..rank).map(|i| (cells - i) as f64).map(|left| left / (left + factor)).product();
            let given = OrderedStatistic::new(1, cells, rank, &[]).false_alarm(factor);
            assert!((given / expected - 1.0).abs() < 1e-7, "{given:e} {expected:e}");
        }
    }

    #[test]
    fn the_smallest_of_n_exponentials_is_an_nth() {
        let expectation = |cells, rank| OrderedStatistic::new(1, cells, rank, &[]).expectation();
        assert!((expectation(5, 1) - 0.2).abs() < 1e-8);
        let harmonic = 1.0 + 1.0 / 2.0 + 1.0 / 3.0;
        assert!((expectation(3, 3) - harmonic).abs() < 1e-8);
    }

    /// Two cells of correlation r: both lie below a level with probability `P^2 + c`, which the series gives; fully
    /// correlated, c is the variance `P (1 - P)` of one.
    #[test]
    fn pairs_that_are_alike_count_as_one() {
        // 1 - r^2 = 0.01: nearly alike, 64 powers do not reach further.
        let r2: f64 = 0.99;
        let pairs: Vec<f64> = (1..=64).map(|k| 2.0 * r2.powi(k)).collect();
        for looks in [1, 4] {
            let statistic = OrderedStatistic::new(looks, 2, 1, &pairs);
            let x = looks as f64;
            let (ln_p, ln_q) = ln_incomplete(x, x);
            let excess = statistic.excess(x, ln_p + ln_q);
            assert!(excess > 0.85 && excess < 1.0, "{looks}: {excess}");
        }
        // Of exponentials, r^2 = 0.25 and a level of 1, by quadrature (scipy.integrate.dblquad).
        let pairs: Vec<f64> = (1..=64).map(|k| 2.0 * 0.25f64.powi(k)).collect();
        let statistic = OrderedStatistic::new(1, 2, 1, &pairs);
        let (ln_p, ln_q) = ln_incomplete(1.0, 1.0);
        let covariance = statistic.excess(1.0, ln_p + ln_q) * (ln_p + ln_q).exp();
        assert!((covariance - BOTH_BELOW_ONE).abs() < 1e-9, "{covariance}");
    }

    const BOTH_BELOW_ONE: f64 = 0.036_013_337_541_460_74;

    #[test]
    fn ranks_stay_within_the_cells() {
        assert_eq!([0.0, 0.7, 0.75, 1.0].map(|share| rank_of(share, 8)), [1, 6, 6, 8]);
    }
}
