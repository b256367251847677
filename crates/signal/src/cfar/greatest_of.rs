//! Greatest of (Hansen and Sawyers 1980): noise is the larger of the means of the two halves of
//! the training cells, which holds the false-alarm rate at clutter edges.

use super::cell_averaging::Mean;
use super::gamma::{integrate_log_concave, ln_density_of_ln, ln_incomplete};

/// Probability that a cell of noise exceeds `factor` times the larger of two independent means: the expectation over the
/// cell of both means lying below it. The halves may differ. Of correlated cells within a few percent.
pub fn false_alarm(factor: f64, looks: usize, means: [&Mean; 2]) -> f64 {
    let looks = looks as f64;
    // Each half holds the cell back by about half of the exponent.
    let tails = means.map(|mean| mean.tilted(0.5 * looks * factor));
    integrate_log_concave(|t| {
        let level = t.exp() / factor;
        ln_density_of_ln(looks, t) + tails[0].ln_below(level) + tails[1].ln_below(level)
    })
}

/// Expectation of the larger mean, the noise power being 1.
pub fn expectation(means: [&Mean; 2]) -> f64 {
    let shapes = means.map(Mean::shape);
    let one_side = |this: f64, other: f64| {
        integrate_log_concave(|t| {
            t + ln_density_of_ln(this, t) + ln_incomplete(other, other * t.exp()).0
        })
    };
    one_side(shapes[0], shapes[1]) + one_side(shapes[1], shapes[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Equation 14 of Gandhi and Kassam (1988), for one look and halves of `n` cells, where the
    /// sums of a half are multiplied by `t = factor / n`.
    fn gandhi_kassam(factor: f64, n: u32) -> f64 {
        let t = factor / f64::from(n);
        let mut choose = 1.0;
        let mut sum = 0.0;
        for k in 0..n {
            sum += choose * (2.0 + t).powi(-((n + k) as i32));
            choose *= f64::from(n + k) / f64::from(k + 1);
        }
        2.0 * ((1.0 + t).powi(-(n as i32)) - sum)
    }

    #[test]
    fn one_look_is_the_published_form() {
        for (factor, n) in [(2.0, 1), (8.0, 8), (15.0, 16)] {
            let mean = Mean::gamma(f64::from(n));
            let given = false_alarm(factor, 1, [&mean; 2]);
            let expected = gandhi_kassam(factor, n);
            assert!((given / expected - 1.0).abs() < 1e-7, "{given:e} {expected:e}");
        }
    }

    #[test]
    fn the_larger_of_two_exponentials_is_half_as_much_again() {
        let one = Mean::gamma(1.0);
        assert!((expectation([&one; 2]) - 1.5).abs() < 1e-8);
        let steady = Mean::gamma(1e4);
        assert!((expectation([&one, &steady]) - (1.0 + (-1.0_f64).exp())).abs() < 1e-4);
    }
}
