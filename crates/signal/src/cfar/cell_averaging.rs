//! Cell averaging (Finn and Johnson 1968): noise is the mean of all training cells.

/// Probability that a cell of noise exceeds `factor` times the mean of training cells, for cells
/// that are means of `looks` exponential powers and a training mean of gamma shape `shape`
/// (`looks` times the number of independent cells).
///
/// The ratio follows an F distribution; with a whole number of looks its tail is the sum
/// `sum_k C(shape + k - 1, k) s^k (1 + s)^-(shape + k)` over `k < looks`, with
/// `s = looks factor / shape`; for one look `(1 + factor / n)^-n`.
pub fn false_alarm(factor: f64, looks: usize, shape: f64) -> f64 {
    let s = looks as f64 * factor / shape;
    let ln_share = s.ln() - s.ln_1p();
    let mut ln_term = -shape * s.ln_1p();
    let mut sum = 0.0;
    for k in 0..looks {
        sum += ln_term.exp();
        let k = k as f64;
        ln_term += ln_share + ((shape + k) / (k + 1.0)).ln();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_look_is_the_textbook_form() {
        for (factor, cells) in [(3.0_f64, 4), (12.0, 16), (20.0, 64)] {
            let n = f64::from(cells);
            let expected = (1.0 + factor / n).powi(-cells);
            assert!((false_alarm(factor, 1, n) / expected - 1.0).abs() < 1e-12);
        }
    }

    /// scipy.stats.f.sf(factor, 2 looks, 2 shape).
    #[test]
    fn several_looks_are_the_tail_of_an_f_distribution() {
        for (factor, looks, shape, expected) in GOLDEN {
            let given = false_alarm(factor, looks, shape);
            assert!((given / expected - 1.0).abs() < 1e-10, "{given:e} {expected:e}");
        }
    }

    const GOLDEN: [(f64, usize, f64, f64); 4] = [
        (2.0, 4, 32.0, 0.06052397790789693),
        (3.5, 8, 128.0, 1.0964312303032951e-05),
        (6.0, 2, 7.3, 0.004582568012815672),
        (1.4, 86, 900.0, 0.0008090566911978747),
    ];
}
