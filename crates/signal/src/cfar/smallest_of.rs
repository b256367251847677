//! Smallest of (Trunk 1978): noise is the smaller of the means of the two halves of the training
//! cells, so that a second target in one half does not hide the first.

use super::cell_averaging::Mean;
use super::greatest_of;

/// Probability that a cell of noise exceeds `factor` times the smaller of two independent means: it exceeds one or the
/// other but for what exceeds both.
pub fn false_alarm(factor: f64, looks: usize, means: [&Mean; 2]) -> f64 {
    let either: f64 = means.iter().map(|mean| mean.false_alarm(factor, looks)).sum();
    either - greatest_of::false_alarm(factor, looks, means)
}

/// Expectation of the smaller mean, the noise power being 1.
pub fn expectation(means: [&Mean; 2]) -> f64 {
    2.0 - greatest_of::expectation(means)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of Gandhi and Kassam (1988) for one look and halves of `n` cells.
    #[test]
    fn one_look_is_the_published_form() {
        for (factor, n) in [(2.0, 1_u32), (8.0, 8), (15.0, 16)] {
            let t = factor / f64::from(n);
            let (mut choose, mut sum) = (1.0, 0.0);
            for k in 0..n {
                sum += choose * (2.0 + t).powi(-((n + k) as i32));
                choose *= f64::from(n + k) / f64::from(k + 1);
            }
            let given = false_alarm(factor, 1, [&Mean::gamma(f64::from(n)); 2]);
            assert!((given / (2.0 * sum) - 1.0).abs() < 1e-7, "{given:e} {:e}", 2.0 * sum);
        }
    }
}
