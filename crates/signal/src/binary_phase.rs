//! Binary-phase multiplexing: all transmitters send each chirp of a loop, with the signs of a
//! Hadamard matrix. What each sent comes back as the sums over the chirps with the same signs,
//! once the Doppler phase from one chirp to the next is taken off, as in time division
//! ([`crate::tdm`]): a target that moves would otherwise leak from one transmitter to another.
//!
//! As all send at once, the sums gather as much more energy as there are transmitters.

use crate::error::SignalError;
use crate::tdm::compensate;
use boresight_core::Complex64;
use std::ops::{Add, Sub};

/// Turns the channels of a cell from chirps of the loop (chirp-major) to transmitters: the Doppler
/// phase of [`crate::tdm::phase_step_rad`] is taken off, and the sums over the signs are made,
/// divided by the number of chirps, so that amplitudes are those of one transmitter.
///
/// # Errors
/// As [`compensate`].
pub fn decode(
    snapshot: &mut [Complex64],
    transmitters: usize,
    phase_step_rad: f64,
) -> Result<(), SignalError> {
    compensate(snapshot, transmitters, phase_step_rad)?;
    hadamard(snapshot, transmitters);
    let share = 1.0 / transmitters as f64;
    snapshot.iter_mut().for_each(|z| *z *= share);
    Ok(())
}

/// Sums over chirps with the signs of [`boresight_core::Multiplexing::code`], a block of values
/// each, by Sylvester's construction. It is its own inverse but for the factor `blocks`, a power
/// of two.
pub(crate) fn hadamard<T>(values: &mut [T], blocks: usize)
where
    T: Copy + Add<Output = T> + Sub<Output = T>,
{
    let block = values.len() / blocks.max(1);
    let mut span = 1;
    while block > 0 && span < blocks {
        for group in values.chunks_exact_mut(2 * span * block) {
            let (first, second) = group.split_at_mut(span * block);
            for (a, b) in first.iter_mut().zip(second) {
                (*a, *b) = (*a + *b, *a - *b);
            }
        }
        span *= 2;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_core::Multiplexing;
    use boresight_math::phasor::cis;

    #[test]
    fn transmitters_come_back_from_what_moves() {
        for transmitters in [1, 2, 4, 8] {
            let step = 0.7;
            let sent = |t: usize, r: usize| cis(1.3 * t as f64 + 0.2 * r as f64);
            let mut cell: Vec<Complex64> = (0..transmitters * 3)
                .map(|k| {
                    let (chirp, r) = (k / 3, k % 3);
                    let sign = |t| Multiplexing::BinaryPhase.code(t, 0, chirp, 1);
                    let sum: Complex64 = (0..transmitters).map(|t| sign(t) * sent(t, r)).sum();
                    sum * cis(step * chirp as f64)
                })
                .collect();
            decode(&mut cell, transmitters, step).unwrap();
            for (k, z) in cell.iter().enumerate() {
                assert!((z - sent(k / 3, k % 3)).norm() < 1e-12, "{transmitters} {k}");
            }
        }
    }

    #[test]
    fn shapes_that_do_not_fit_are_named() {
        assert!(decode(&mut [Complex64::ZERO; 5], 2, 0.0).is_err());
        assert!(decode(&mut [Complex64::ZERO; 5], 0, 0.0).is_err());
        assert!(decode(&mut [], 2, 0.0).is_ok());
    }
}
