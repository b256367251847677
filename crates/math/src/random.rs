//! Seeded random numbers that are the same, bit for bit, natively and in wasm.

use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// A generator of random numbers from a seed and a stream.
///
/// Streams of one seed are independent, so that trial `i` of a sweep takes stream `i` and gives
/// the same numbers whichever machine or thread runs it. Only operations that IEEE 754 defines
/// exactly and `libm`'s portable functions are used.
#[derive(Debug, Clone)]
pub struct Random {
    generator: ChaCha8Rng,
    spare: Option<f64>,
}

impl Random {
    /// A generator for stream `stream` of `seed`.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self { generator, spare: None }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// Uniform in `[0, 1)`, 53 random bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in `[low, high)`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform integer in `low..=high`; `low` if `high` is smaller. The bias of at most
    /// `(high - low) / 2^64` is of no consequence here.
    pub fn integer(&mut self, low: u64, high: u64) -> u64 {
        if high <= low {
            return low;
        }
        let count = u128::from(high - low) + 1;
        low + ((u128::from(self.bits()) * count) >> 64) as u64
    }

    /// Uniform phase in `[-pi, pi)`.
    pub fn phase(&mut self) -> f64 {
        self.uniform(-PI, PI)
    }

    /// Standard normal (Marsaglia's polar method, 1964).
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (u, v) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                let scale = (-2.0 * libm::log(s) / s).sqrt();
                self.spare = Some(v * scale);
                return u * scale;
            }
        }
    }

    /// Circular complex normal with `E|z|^2 = power`.
    pub fn complex_normal(&mut self, power: f64) -> Complex64 {
        let sigma = (power / 2.0).sqrt();
        let re = self.normal();
        let im = self.normal();
        Complex64::new(re * sigma, im * sigma)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_and_repeat() {
        let draw = |seed, stream| Random::new(seed, stream).bits();
        assert_eq!(draw(1, 2), draw(1, 2));
        assert_ne!(draw(1, 2), draw(1, 3));
        assert_ne!(draw(1, 2), draw(2, 2));
    }

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut random = Random::new(7, 0);
        let n = 200_000;
        let normals: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let moment = |k: i32| normals.iter().map(|x| x.powi(k)).sum::<f64>() / f64::from(n);
        // Standard errors of the moments: sqrt(1/n), sqrt(2/n), sqrt(96/n); five of each.
        assert!(moment(1).abs() < 0.0112, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 0.0158, "{}", moment(2));
        assert!((moment(4) - 3.0).abs() < 0.1096, "{}", moment(4));
        let mean = (0..n).map(|_| random.unit()).sum::<f64>() / f64::from(n);
        assert!((mean - 0.5).abs() < 5.0 * (1.0 / 12.0 / f64::from(n)).sqrt());
    }

    #[test]
    fn integers_cover_their_range() {
        let mut random = Random::new(1, 0);
        let mut seen = [0; 5];
        for _ in 0..1000 {
            seen[random.integer(3, 7) as usize - 3] += 1;
        }
        assert!(seen.iter().all(|&count| count > 120), "{seen:?}");
        assert_eq!(random.integer(4, 4), 4);
    }
}
