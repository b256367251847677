//! Fluctuation of a target's reflection (Swerling 1954).

use boresight_core::Random;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// How the power of each reflection fluctuates about its mean. Phases stay as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SwerlingModel {
    /// Not at all.
    #[default]
    Steady,
    /// Exponential power, as of many scatterers alike, new in each frame.
    Swerling1,
    /// The same, new in each chirp.
    Swerling2,
    /// Power of a chi-squared distribution of four degrees of freedom, as of one large scatterer among many, new in each
    /// frame.
    Swerling3,
    /// The same, new in each chirp.
    Swerling4,
}

impl SwerlingModel {
    /// Whether it is new in each chirp.
    pub(crate) fn is_fast(self) -> bool {
        matches!(self, Self::Swerling2 | Self::Swerling4)
    }

    /// Draws the factor of an amplitude.
    pub(crate) fn draw(self, random: &mut Random) -> f64 {
        let mut exponential = || -(1.0 - random.unit()).ln();
        let power = match self {
            Self::Steady => return 1.0,
            Self::Swerling1 | Self::Swerling2 => exponential(),
            Self::Swerling3 | Self::Swerling4 => 0.5 * (exponential() + exponential()),
        };
        power.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance of the power: 1 and 1, or 1 and 1/2. 40,000 draws tell them to 0.5 and 2 %.
    #[test]
    fn powers_have_the_moments_of_their_distribution() {
        for (fluctuation, variance) in
            [(SwerlingModel::Swerling1, 1.0), (SwerlingModel::Swerling4, 0.5)]
        {
            let mut random = Random::new(1, 0);
            let powers: Vec<f64> =
                (0..40_000).map(|_| fluctuation.draw(&mut random).powi(2)).collect();
            let mean = powers.iter().sum::<f64>() / 4e4;
            let spread = powers.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / 4e4;
            assert!((mean - 1.0).abs() < 0.025, "{mean}");
            assert!((spread / variance - 1.0).abs() < 0.1, "{spread}");
        }
        assert_eq!(SwerlingModel::Steady.draw(&mut Random::new(1, 0)), 1.0);
    }
}
