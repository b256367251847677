//! Ordered statistic (Rohling 1983): noise is the training cell of a given rank, so that a few
//! strong neighbours do not matter.

use super::gamma::{integrate_log_concave, ln_density_of_ln, ln_incomplete};

/// Probability that a cell of noise exceeds `factor` times the `rank`-th smallest of `cells`
/// training cells, all means of `looks` exponential powers: the expectation of the cell's tail over
/// the density of the order statistic. For one look Rohling's product. Rank and number of cells
/// need not be whole, to stand for correlated cells.
pub fn false_alarm(factor: f64, looks: usize, cells: f64, rank: f64) -> f64 {
    let shape = looks as f64;
    integrate_log_concave(|t| {
        ln_density(t, shape, cells, rank) + ln_incomplete(shape, shape * factor * t.exp()).1
    })
}

/// Expectation of the `rank`-th smallest cell, the noise power being 1.
pub fn expectation(looks: usize, cells: f64, rank: f64) -> f64 {
    integrate_log_concave(|t| t + ln_density(t, looks as f64, cells, rank))
}

/// Rank, from 1, of a share of the cells.
pub fn rank_of(share: f64, cells: usize) -> usize {
    ((share * cells as f64).ceil() as usize).clamp(1, cells.max(1))
}

/// Independent cells that so many stand for. Whether a cell lies below a level is less correlated than powers, by the root.
pub fn independent(cells: usize, correlation: f64) -> f64 {
    (cells as f64 / correlation.sqrt()).max(1.0)
}

/// Rank of a share of the cells among the independent ones.
pub fn effective_rank(share: f64, cells: usize, correlation: f64) -> f64 {
    let share = rank_of(share, cells) as f64 / cells as f64;
    (share * independent(cells, correlation)).max(1.0)
}

/// Logarithm of the density of the logarithm of the `rank`-th smallest.
pub fn ln_density(t: f64, shape: f64, cells: f64, rank: f64) -> f64 {
    let (ln_p, ln_q) = ln_incomplete(shape, shape * t.exp());
    let (below, above) = (rank - 1.0, cells - rank);
    let ln_count =
        libm::lgamma(cells + 1.0) - libm::lgamma(below + 1.0) - libm::lgamma(above + 1.0);
    let mut ln = ln_count + ln_density_of_ln(shape, t);
    if below > 0.0 {
        ln += below * ln_p;
    }
    if above > 0.0 {
        ln += above * ln_q;
    }
    ln
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_look_is_rohlings_product() {
        for (factor, cells, rank) in [(3.0, 8, 6), (9.0, 16, 12), (25.0, 32, 24), (2.0, 1, 1)] {
            let expected: f64 = (0..rank)
                .map(|i| f64::from(cells - i))
                .map(|left| left / (left + factor))
                .product();
            let given = false_alarm(factor, 1, f64::from(cells), f64::from(rank));
            assert!((given / expected - 1.0).abs() < 1e-7, "{given:e} {expected:e}");
        }
    }

    #[test]
    fn the_smallest_of_n_exponentials_is_an_nth() {
        assert!((expectation(1, 5.0, 1.0) - 0.2).abs() < 1e-8);
        let harmonic = 1.0 + 1.0 / 2.0 + 1.0 / 3.0;
        assert!((expectation(1, 3.0, 3.0) - harmonic).abs() < 1e-8);
    }

    #[test]
    fn ranks_stay_within_the_cells() {
        assert_eq!([0.0, 0.7, 0.75, 1.0].map(|share| rank_of(share, 8)), [1, 6, 6, 8]);
    }
}
