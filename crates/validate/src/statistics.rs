//! Sums over trials.

use serde::Serialize;

/// Mean and spread of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Default)]
pub struct Summary {
    /// How many.
    pub count: usize,
    /// Mean; 0 of nothing.
    pub mean: f64,
    /// Unbiased variance; 0 of fewer than two.
    pub variance: f64,
    /// Mean magnitude.
    pub mean_absolute: f64,
    /// Largest magnitude.
    pub largest: f64,
}

impl Summary {
    /// Of the numbers given.
    pub fn of(numbers: &[f64]) -> Self {
        let count = numbers.len();
        if count == 0 {
            return Self::default();
        }
        let n = count as f64;
        let mean = numbers.iter().sum::<f64>() / n;
        let squares: f64 = numbers.iter().map(|x| (x - mean).powi(2)).sum();
        Self {
            count,
            mean,
            variance: squares / (n - 1.0).max(1.0),
            mean_absolute: numbers.iter().map(|x| x.abs()).sum::<f64>() / n,
            largest: numbers.iter().fold(0.0, |most, x| most.max(x.abs())),
        }
    }

    /// Standard deviation of the mean.
    pub fn mean_sigma(&self) -> f64 {
        if self.count < 2 { f64::INFINITY } else { (self.variance / self.count as f64).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_is_what_it_says() {
        let s = Summary::of(&[1.0, -2.0, 4.0]);
        assert_eq!((s.count, s.mean, s.variance, s.largest), (3, 1.0, 9.0, 4.0));
        assert!((s.mean_absolute - 7.0 / 3.0).abs() < 1e-15);
        assert_eq!(s.mean_sigma(), 3.0_f64.sqrt());
        assert_eq!(Summary::of(&[]), Summary::default());
        assert_eq!(Summary::of(&[2.0]).mean_sigma(), f64::INFINITY);
    }
}
