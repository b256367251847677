//! Intervals of mixtures of normal distributions.

use std::f64::consts::SQRT_2;

/// Share of a normal distribution within one deviation.
const WITHIN_ONE: f64 = 0.682_689_492_137_085_9;

/// A normal distribution and its share of the mixture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub share: f64,
    pub mean: f64,
    pub sigma: f64,
}

/// Half the width of the interval about `centre` that holds as much as one deviation of a normal distribution does; infinite of none.
pub(super) fn half_width(terms: &[Term], centre: f64) -> f64 {
    let total: f64 = terms.iter().map(|term| term.share).sum();
    if !(total > 0.0 && centre.is_finite()) {
        return f64::INFINITY;
    }
    let within = |width: f64| {
        let of = |term: &Term| {
            let up = to(centre + width - term.mean, term.sigma);
            term.share * 0.5 * (up - to(centre - width - term.mean, term.sigma))
        };
        terms.iter().map(of).sum::<f64>() / total
    };
    let reach = |term: &Term| (term.mean - centre).abs() + 2.0 * term.sigma;
    let (mut low, mut high) = (0.0, terms.iter().map(reach).fold(0.0, f64::max));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if within(middle) < WITHIN_ONE { low = middle } else { high = middle }
    }
    high
}

fn to(distance: f64, sigma: f64) -> f64 {
    libm::erf(distance / (sigma * SQRT_2))
}

/// Mean of a mixture.
pub(super) fn mean(terms: &[Term]) -> f64 {
    let total: f64 = terms.iter().map(|term| term.share).sum();
    terms.iter().map(|term| term.share * term.mean).sum::<f64>() / total
}
