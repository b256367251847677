//! Cell averaging (Finn and Johnson 1968): noise is the mean of all training cells.
//!
//! The mean of correlated cells is a sum of independent gamma variables, scaled by the eigenvalues of the cells'
//! correlation matrix. Its Laplace transform and derivatives give the false-alarm rate in closed form.

use super::gamma::ln_incomplete;

/// Distribution of a mean of training cells of noise power 1: a sum of independent gamma variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Mean {
    /// Scale and shape of each variable; the products sum to 1.
    parts: Vec<(f64, f64)>,
}

impl Mean {
    /// A single variable of a shape: the number of independent cells times the looks.
    pub fn gamma(shape: f64) -> Self {
        Self { parts: vec![(1.0 / shape, shape)] }
    }

    /// One variable of `shape` for each weight, the weights as shares of their sum.
    pub fn weighted(weights: &[f64], shape: f64) -> Self {
        let total: f64 = weights.iter().map(|weight| weight * shape).sum();
        let share = |weight: &&f64| **weight > 1e-12 * total;
        Self { parts: weights.iter().filter(share).map(|w| (w / total, shape)).collect() }
    }

    /// Of both halves, `share` of the cells in the first.
    pub fn joined(&self, other: &Self, share: f64) -> Self {
        let scaled = |mean: &Self, share: f64| -> Vec<(f64, f64)> {
            mean.parts.iter().map(|&(scale, shape)| (scale * share, shape)).collect()
        };
        Self { parts: [scaled(self, share), scaled(other, 1.0 - share)].concat() }
    }

    /// Of a share of the cells.
    pub fn of_share(&self, share: f64) -> Self {
        Self {
            parts: self.parts.iter().map(|(scale, shape)| (scale / share, shape * share)).collect(),
        }
    }

    /// Shape of the gamma variable of the same variance.
    pub fn shape(&self) -> f64 {
        1.0 / self.parts.iter().map(|(scale, shape)| shape * scale * scale).sum::<f64>()
    }

    /// Logarithm of the expectation of `exp(-s mean)`.
    fn ln_transform(&self, s: f64) -> f64 {
        -self.parts.iter().map(|(scale, shape)| shape * (scale * s).ln_1p()).sum::<f64>()
    }

    /// Probability that a cell of noise exceeds `factor` times the mean, for cells that are means of `looks` exponential
    /// powers: `sum_k E[(s mean)^k exp(-s mean)] / k!` over `k < looks`, with `s = looks factor`. For one look and `n`
    /// independent cells `(1 + factor / n)^-n`.
    pub fn false_alarm(&self, factor: f64, looks: usize) -> f64 {
        let s = looks as f64 * factor;
        let mut terms = vec![self.ln_transform(s).exp()];
        // Of the logarithm's derivatives.
        let mut sums = Vec::with_capacity(looks);
        let mut powers: Vec<f64> = self.parts.iter().map(|(_, shape)| *shape).collect();
        for k in 1..looks {
            for (power, (scale, _)) in powers.iter_mut().zip(&self.parts) {
                *power *= scale * s / (1.0 + scale * s);
            }
            sums.push(powers.iter().sum::<f64>());
            let next: f64 = sums.iter().zip(terms.iter().rev()).map(|(p, c)| p * c).sum();
            terms.push(next / k as f64);
        }
        terms.iter().sum()
    }

    /// A gamma variable times a constant that agrees with the mean where `exp(-s mean)` does: in the logarithm of its
    /// expectation and two derivatives. Exact for a single variable.
    pub fn tilted(&self, s: f64) -> Tilted {
        let (mut first, mut second) = (0.0, 0.0);
        for (scale, shape) in &self.parts {
            let u = scale / (1.0 + scale * s);
            first += shape * u;
            second += shape * u * u;
        }
        let u = second / first;
        let shape = first / u;
        let scale = u / (1.0 - u * s).max(f64::MIN_POSITIVE);
        Tilted { ln_factor: self.ln_transform(s) + shape * (scale * s).ln_1p(), shape, scale }
    }
}

/// The lower tail of a mean; see [`Mean::tilted`].
#[derive(Debug, Clone, Copy)]
pub struct Tilted {
    ln_factor: f64,
    shape: f64,
    scale: f64,
}

impl Tilted {
    /// Logarithm of the probability that the mean is at most `level`.
    pub fn ln_below(&self, level: f64) -> f64 {
        (self.ln_factor + ln_incomplete(self.shape, level / self.scale).0).min(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_look_is_the_textbook_form() {
        for (factor, cells) in [(3.0_f64, 4), (12.0, 16), (20.0, 64)] {
            let n = f64::from(cells);
            let expected = (1.0 + factor / n).powi(-cells);
            for mean in [Mean::gamma(n), Mean::weighted(&vec![1.0; cells as usize], 1.0)] {
                assert!((mean.false_alarm(factor, 1) / expected - 1.0).abs() < 1e-12);
            }
        }
    }

    /// scipy.stats.f.sf(factor, 2 looks, 2 shape).
    #[test]
    fn several_looks_are_the_tail_of_an_f_distribution() {
        for (factor, looks, shape, expected) in GOLDEN {
            let given = Mean::gamma(shape).false_alarm(factor, looks);
            assert!((given / expected - 1.0).abs() < 1e-10, "{given:e} {expected:e}");
        }
    }

    const GOLDEN: [(f64, usize, f64, f64); 4] = [
        (2.0, 4, 32.0, 0.06052397790789693),
        (3.5, 8, 128.0, 1.0964312303032951e-05),
        (6.0, 2, 7.3, 0.004582568012815672),
        (1.4, 86, 900.0, 0.0008090566911978747),
    ];

    /// A sum of two exponentials of scales 0.7 and 0.3: partial fractions.
    #[test]
    fn two_eigenvalues_have_their_closed_form() {
        let mean = Mean::weighted(&[0.7, 0.3], 1.0);
        let expected = 1.0 / (1.0 + 0.7 * 20.0) / (1.0 + 0.3 * 20.0);
        assert!((mean.false_alarm(20.0, 1) / expected - 1.0).abs() < 1e-12);
        assert!((mean.shape() - 1.0 / 0.58).abs() < 1e-12);
        let below = |z: f64| 1.0 - (0.7 * (-z / 0.7f64).exp() - 0.3 * (-z / 0.3f64).exp()) / 0.4;
        for (s, level) in [(20.0, 0.05), (20.0, 0.15), (5.0, 0.3)] {
            let given = mean.tilted(s).ln_below(level).exp();
            assert!((given / below(level) - 1.0).abs() < 0.03, "{given} {}", below(level));
        }
        let single = Mean::gamma(5.5).tilted(30.0);
        assert!((single.ln_below(0.4) - ln_incomplete(5.5, 2.2).0).abs() < 1e-10);
    }
}
