//! Tails of the normal and of Student's distribution.

use statrs::function::{beta::beta_reg, erf};
use std::f64::consts::SQRT_2;

/// Student's distribution is taken for the normal one above: it differs by less than one part in a thousand at any level used here.
const NORMAL_FREEDOM: f64 = 1e5;

/// Share of a normal distribution beyond `z` deviations on either side.
pub(crate) fn normal_tail(z: f64) -> f64 {
    erf::erfc(z.abs() / SQRT_2)
}

/// Deviations beyond which, on either side, a share `p` of a normal distribution lies.
pub(crate) fn normal_quantile(p: f64) -> f64 {
    SQRT_2 * erf::erfc_inv(p.clamp(f64::MIN_POSITIVE, 1.0))
}

/// Share of Student's distribution of so many degrees of freedom beyond `t` on either side.
pub(crate) fn student_tail(t: f64, freedom: f64) -> f64 {
    if !(freedom > 0.0 && t.is_finite()) {
        return if t.is_infinite() && freedom > 0.0 { 0.0 } else { 1.0 };
    }
    if freedom > NORMAL_FREEDOM {
        return normal_tail(t);
    }
    beta_reg(0.5 * freedom, 0.5, (freedom / (freedom + t * t)).clamp(0.0, 1.0))
}

/// The value beyond which, on either side, a share `p` of Student's distribution lies; infinite where there is none.
pub(crate) fn student_quantile(p: f64, freedom: f64) -> f64 {
    if freedom > NORMAL_FREEDOM {
        return normal_quantile(p);
    }
    let (mut low, mut high) = (0.0, 1.0);
    while student_tail(high, freedom) > p {
        low = high;
        high *= 2.0;
        if high > 1e12 {
            return f64::INFINITY;
        }
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if student_tail(middle, freedom) > p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Deviations of a normal distribution as rare as `t` of Student's.
pub(crate) fn as_normal(t: f64, freedom: f64) -> f64 {
    normal_quantile(student_tail(t, freedom))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published tables: Abramowitz and Stegun (1964), 26.10; closed forms of one and two degrees of freedom.
    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, p, t) in [
            (1.0, 0.001, 636.619),
            (2.0, 0.001, 31.599),
            (3.0, 0.01, 5.841),
            (4.0, 0.001, 8.610),
            (5.0, 0.05, 2.571),
            (10.0, 0.001, 4.587),
            (30.0, 0.001, 3.646),
            (120.0, 0.05, 1.980),
        ] {
            assert!((student_quantile(p, freedom) - t).abs() < 6e-4, "{freedom} {p}");
        }
        for p in [0.3, 1e-3, 1e-6, 1e-9] {
            let one = 1.0 / (std::f64::consts::FRAC_PI_2 * p).tan();
            assert!((student_quantile(p, 1.0) / one - 1.0).abs() < 1e-9);
            let two = (1.0 - p) * (2.0 / (p * (2.0 - p))).sqrt();
            assert!((student_quantile(p, 2.0) / two - 1.0).abs() < 1e-9);
        }
        for (p, z) in [(0.317_310_507_862_9, 1.0), (0.05, 1.959_963_985), (2e-9, 5.997_807_015)] {
            assert!((normal_quantile(p) - z).abs() < 1e-8, "{p}");
            assert!((normal_tail(z) / p - 1.0).abs() < 1e-7);
        }
        assert!((student_quantile(0.001, 99_000.0) - normal_quantile(0.001)).abs() < 1e-3);
    }

    #[test]
    fn rare_values_stay_rare() {
        assert!((as_normal(636.619, 1.0) - 3.2905).abs() < 1e-3);
        assert!(as_normal(1e200, 50.0) > 30.0);
        assert_eq!(student_tail(f64::INFINITY, 3.0), 0.0);
        assert_eq!(student_tail(f64::NAN, 3.0), 1.0);
        assert_eq!(student_quantile(1e-3, 0.0), f64::INFINITY);
    }
}
