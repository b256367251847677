//! Bias of the yaw rate from standing frames (equation 5 of Zhu et al.).

/// Standing frames from which their scatter tells the noise.
const ENOUGH: u64 = 10;
/// Noise of the yaw rate where it has not been measured, rad/s (0.1 deg/s).
const NOISE_RADPS: f64 = 0.001_745_329_251_994_329_5;

/// Mean and scatter of the yaw rate at standstill (Welford 1962).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Bias {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Bias {
    /// Adds the yaw rate of a standing frame, rad/s.
    pub fn add(&mut self, yaw_rate_radps: f64) {
        self.count += 1;
        let before = yaw_rate_radps - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (yaw_rate_radps - self.mean);
    }

    /// The bias, rad/s; 0 without a standing frame.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation of the yaw rate's noise, rad/s.
    pub fn noise(&self) -> f64 {
        if self.count < ENOUGH {
            return NOISE_RADPS;
        }
        (self.squares / (self.count - 1) as f64).sqrt()
    }

    /// Standard deviation of the bias, rad/s; infinite without a standing frame.
    pub fn sigma(&self) -> f64 {
        if self.count == 0 { f64::INFINITY } else { self.noise() / (self.count as f64).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_deviation_are_those_of_the_readings() {
        let mut bias = Bias::default();
        assert_eq!((bias.mean(), bias.sigma()), (0.0, f64::INFINITY));
        for i in 0..11 {
            bias.add(0.01 + 0.001 * f64::from(i - 5));
        }
        // Sum of squares 110, ten degrees of freedom.
        assert!((bias.mean() - 0.01).abs() < 1e-15);
        assert!((bias.noise() - 0.001 * 11.0_f64.sqrt()).abs() < 1e-15);
        assert!((bias.sigma() - 0.001).abs() < 1e-15);
    }
}
