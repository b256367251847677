//! How the transmitters of a MIMO radar share the chirps: the factor by which each sends each chirp.

use boresight_math::phasor::cis;
use boresight_options::Described;
use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// How transmitters share the chirps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Multiplexing {
    /// One transmitter a chirp, in turn.
    #[default]
    TimeDivision,
    /// All transmitters in each chirp, with the signs of a Hadamard matrix over the chirps of a
    /// loop; transmitters are a power of two.
    BinaryPhase,
    /// All transmitters in each chirp, each with its own phase step from chirp to chirp, which
    /// moves it to its own band of Doppler frequencies; a loop is one chirp.
    DopplerDivision,
}

impl Multiplexing {
    /// Whether it is time division.
    #[must_use]
    pub fn is_time_division(&self) -> bool {
        *self == Self::TimeDivision
    }

    /// Chirps of a loop.
    #[must_use]
    pub fn chirps_per_loop(self, transmitters: usize) -> usize {
        match self {
            Self::TimeDivision | Self::BinaryPhase => transmitters,
            Self::DopplerDivision => 1,
        }
    }

    /// The factor by which `transmitter` sends chirp `chirp` of loop `turn`, with `bands` Doppler
    /// bands. That of binary phase is the element of the Hadamard matrix of Sylvester's order:
    /// with two transmitters, both in phase first, then the second inverted.
    #[must_use]
    pub fn code(self, transmitter: usize, turn: usize, chirp: usize, bands: usize) -> Complex64 {
        match self {
            Self::TimeDivision => Complex64::from(f64::from(transmitter == chirp)),
            Self::BinaryPhase if (transmitter & chirp).count_ones() % 2 == 1 => (-1.0).into(),
            Self::BinaryPhase => 1.0.into(),
            Self::DopplerDivision => {
                let bands = bands.max(1);
                cis(TAU * (transmitter * turn % bands) as f64 / bands as f64)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_transmitters_are_orthogonal() {
        for (kind, transmitters, loops, bands) in [
            (Multiplexing::TimeDivision, 3, 2, 0),
            (Multiplexing::BinaryPhase, 8, 2, 0),
            (Multiplexing::DopplerDivision, 4, 12, 6),
        ] {
            let chirps = kind.chirps_per_loop(transmitters);
            let product = |a, b| -> Complex64 {
                (0..loops * chirps)
                    .map(|n| {
                        let code = |t| kind.code(t, n / chirps, n % chirps, bands);
                        code(a) * code(b).conj()
                    })
                    .sum()
            };
            for (a, b) in (0..transmitters).flat_map(|a| (0..transmitters).map(move |b| (a, b))) {
                let expected = match (a == b, kind) {
                    (false, _) => 0.0,
                    (true, Multiplexing::TimeDivision) => loops as f64,
                    (true, _) => (loops * chirps) as f64,
                };
                assert!((product(a, b) - expected).norm() < 1e-12, "{kind:?} {a} {b}");
            }
        }
    }

    #[test]
    fn two_transmitters_of_binary_phase_are_as_boards_send_them() {
        let code = |t, chirp| Multiplexing::BinaryPhase.code(t, 0, chirp, 0).re;
        assert_eq!([code(0, 0), code(1, 0), code(0, 1), code(1, 1)], [1.0, 1.0, 1.0, -1.0]);
    }
}
