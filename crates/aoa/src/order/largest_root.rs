//! The largest-root test: how large a share of the noise power the largest eigenvalue of a sample covariance may hold.
//!
//! For noise of unknown power, the largest eigenvalue over the sum of all is compared with the level that it exceeds
//! with a given probability (Kritchman and Nadler 2009). The largest eigenvalue of a Wishart matrix is nearly a shifted
//! and scaled Tracy-Widom variable, here by its approximation as a gamma variable (Chiani 2014). Dividing by the sum,
//! whose distribution is known and which is independent of the ratio, adds a term (Nadler 2011) without which the level
//! is far too high for the sizes of radar arrays. With two eigenvalues the distribution is known exactly.
//!
//! For three to 100 dimensions and as many vectors or more the probability differs from the given one by a factor of less
//! than 1.5; for three or four dimensions and vectors it is up to five times smaller.

use boresight_signal::ln_incomplete_gamma;

/// Number of independent vectors in a sample covariance, and whether it is averaged with its reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Freedom {
    /// Complex vectors.
    pub vectors: f64,
    /// Averaged with its reversal: its statistics are those of a real covariance of twice as many vectors.
    pub forward_backward: bool,
}

/// Shape, scale and shift of the gamma variable that stands for a Tracy-Widom one.
struct TracyWidom {
    shape: f64,
    scale: f64,
    shift: f64,
}

/// Of real matrices.
const REAL: TracyWidom = TracyWidom { shape: 46.444_604, scale: 0.186_054, shift: 9.848_01 };
/// Of complex ones.
const COMPLEX: TracyWidom = TracyWidom { shape: 79.659_504, scale: 0.101_036, shift: 9.819_61 };

/// What is added to the sizes of a complex matrix. Without it noise exceeds the level up to 1.8 times as often as stated, by
/// simulation of 2 to 12 dimensions and 2 to 100 vectors; of a real matrix the term is Johnstone's.
const COMPLEX_SHIFT: f64 = 0.125;

impl TracyWidom {
    fn density(&self, s: f64) -> f64 {
        let x = (s + self.shift) / self.scale;
        if x <= 0.0 {
            return 0.0;
        }
        ((self.shape - 1.0) * x.ln() - x - libm::lgamma(self.shape)).exp() / self.scale
    }

    fn slope(&self, s: f64) -> f64 {
        self.density(s) * ((self.shape - 1.0) / (s + self.shift) - 1.0 / self.scale)
    }

    /// Probability to exceed `s`.
    fn tail(&self, s: f64) -> f64 {
        ln_incomplete_gamma(self.shape, (s + self.shift).max(0.0) / self.scale).1.exp()
    }
}

/// The level of the largest of `dimension` eigenvalues as a share of their sum, which noise exceeds with probability
/// `false_alarm`. None where the share says nothing: of a single eigenvalue that is not zero.
pub(crate) fn level(dimension: usize, freedom: Freedom, false_alarm: f64) -> Option<f64> {
    let (law, vectors, order) = if freedom.forward_backward {
        (REAL, 2.0 * freedom.vectors, 1.0)
    } else {
        (COMPLEX, freedom.vectors, 2.0)
    };
    // Eigenvalues that are not zero are the same of a matrix and of its Gram matrix.
    let least = vectors.min(dimension as f64);
    let most = vectors.max(dimension as f64);
    if least < 2.0 {
        return None;
    }
    if least < 3.0 && most < 40.0 {
        return Some(level_of_two(most, freedom.forward_backward, false_alarm));
    }
    let shift = if freedom.forward_backward { -0.5 } else { COMPLEX_SHIFT };
    let (a, b) = ((most + shift).sqrt(), (least + shift).sqrt());
    let (mean, width) = ((a + b) * (a + b), (a + b) * (1.0 / a + 1.0 / b).cbrt());
    let total = most * least;
    let correction = (mean / width).powi(2) / (order * total);
    let tail = |s: f64| law.tail(s) + correction * law.slope(s);
    // Beyond its only crossing the sum is below the probability, and may be negative.
    let s = bisect(-2.0, 20.0, |s| tail(s) > false_alarm);
    Some(((mean + width * s) / total).min(1.0))
}

/// The exact level of two eigenvalues of a Wishart matrix. With `y` the difference of the two over their sum, `y^2` has a beta
/// distribution: its tail is `(1 - y^2)^((n-1)/2)` of a real matrix, and of a complex one
/// `I_(1-y^2)(n - 1, 3/2)`.
fn level_of_two(vectors: f64, real: bool, false_alarm: f64) -> f64 {
    let difference = if real {
        (1.0 - false_alarm.powf(2.0 / (vectors - 1.0))).max(0.0).sqrt()
    } else {
        let density = |y: f64| y * y * (1.0 - y * y).max(0.0).powf(vectors - 2.0);
        let integral = |from: f64| {
            const STEPS: usize = 400;
            let step = (1.0 - from) / STEPS as f64;
            (0..STEPS).map(|i| density(from + (i as f64 + 0.5) * step)).sum::<f64>() * step
        };
        let whole = integral(0.0);
        bisect(0.0, 1.0, |y| integral(y) > false_alarm * whole)
    };
    0.5 * (1.0 + difference)
}

/// Where a condition that holds at `low` and not at `high` changes.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::size::sized;
    use boresight_core::Random;
    use boresight_math::linalg::hermitian_eigen;
    use boresight_signal::{forward_backward, sample_covariance};
    use ndarray::Array2;

    #[test]
    fn two_eigenvalues_have_their_exact_level() {
        // Two complex vectors: P(y > t) = 1 - t^3. Real: (1 - t^2)^(1/2) of two.
        let level = level_of_two(2.0, false, 0.01);
        assert!((2.0 * level - 1.0 - 0.99f64.cbrt()).abs() < 1e-4, "{level}");
        let level = level_of_two(2.0, true, 0.01);
        assert!((2.0 * level - 1.0 - (1.0 - 1e-4f64).sqrt()).abs() < 1e-9, "{level}");
    }

    /// Share of draws of noise whose largest eigenvalue exceeds the level.
    fn exceeds(dimension: usize, vectors: usize, reversed: bool, draws: usize) -> f64 {
        let mut random = Random::new(38, (1000 * dimension + vectors) as u64);
        let freedom = Freedom { vectors: vectors as f64, forward_backward: reversed };
        let level = level(dimension, freedom, 0.01).unwrap();
        let above = (0..draws).filter(|_| {
            let y = Array2::from_shape_fn((dimension, vectors), |_| random.complex_normal(1.0));
            let mut covariance = sample_covariance(y.view());
            if reversed {
                covariance = forward_backward(covariance.view());
            }
            let values = hermitian_eigen(covariance.view()).unwrap().values;
            values[0] > level * values.iter().map(|value| value.max(0.0)).sum::<f64>()
        });
        above.count() as f64 / draws as f64
    }

    #[test]
    fn noise_exceeds_the_level_as_often_as_stated() {
        let draws = sized(20_000, 4000);
        let margin = |rate: f64| 3.5 * (rate * (1.0 - rate) / draws as f64).sqrt();
        let sizes = [(2, 2), (2, 8), (4, 4), (5, 5), (8, 8), (5, 8), (8, 3), (8, 20), (3, 60)];
        for (dimension, vectors) in sizes {
            for reversed in [false, true] {
                let rate = exceeds(dimension, vectors, reversed, draws);
                let exact = dimension == 2 && vectors < 20;
                let [least, most] = if exact { [0.01; 2] } else { [0.0036, 0.0158] };
                let bounds = least - margin(least)..most + margin(most);
                assert!(bounds.contains(&rate), "{dimension} {vectors} {reversed}: {rate}");
            }
        }
    }

    #[test]
    fn a_single_eigenvalue_says_nothing() {
        let freedom = |vectors| Freedom { vectors, forward_backward: false };
        assert_eq!(level(8, freedom(1.0), 0.01), None);
        assert_eq!(level(1, freedom(8.0), 0.01), None);
    }
}
