//! Phase of time-division MIMO: transmitters take turns, so that between one and the next a moving
//! target turns by its Doppler phase, which would otherwise pass for an angle.

use crate::error::SignalError;
use boresight_core::{Complex64, InputError};
use boresight_math::error::check_range;
use boresight_math::phasor::cis;
use std::f64::consts::TAU;

/// Doppler phase of a cell from one transmitter to the next, rad: `2 pi f_d T_chirp`, with the
/// Doppler frequency `f_d` of a bin (which need not be whole) of a transform whose zero is at
/// `dopplers / 2`, over `transmitters` chirps a loop.
///
/// Rates beyond the unambiguous one fold: a target `fold` times `2 max_rate_mps` faster than its
/// bin says turns by `fold / transmitters` turns more from one transmitter to the next. The bin
/// alone cannot tell; an estimator may try several folds and keep the one whose angle spectrum is
/// sharpest, where the virtual array has elements that coincide or is filled.
pub fn phase_step_rad(doppler_bin: f64, dopplers: usize, transmitters: usize, fold: i32) -> f64 {
    let turns = (doppler_bin - (dopplers / 2) as f64) / dopplers.max(1) as f64;
    TAU * (turns + f64::from(fold)) / transmitters.max(1) as f64
}

/// Takes the Doppler phase off the channels of a cell, in transmitter-major order: those of
/// transmitter `t` are multiplied by `exp(-j t phase_step_rad)`.
///
/// # Errors
/// [`InputError::Shape`] if there are not equally many channels a transmitter,
/// [`InputError::OutOfRange`] for a phase that is not finite.
pub fn compensate(
    snapshot: &mut [Complex64],
    transmitters: usize,
    phase_step_rad: f64,
) -> Result<(), SignalError> {
    check_range("phase_step_rad", phase_step_rad, -1e9, 1e9)?;
    if transmitters == 0 || !snapshot.len().is_multiple_of(transmitters) {
        return Err(SignalError::Argument(InputError::Shape {
            what: "snapshot".into(),
            expected: format!("a multiple of {transmitters} transmitters"),
            given: vec![snapshot.len()],
        }));
    }
    let receivers = snapshot.len() / transmitters;
    for (t, channels) in snapshot.chunks_exact_mut(receivers.max(1)).enumerate() {
        let turn = cis(-phase_step_rad * t as f64);
        channels.iter_mut().for_each(|z| *z *= turn);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;
    use std::f64::consts::PI;

    #[test]
    fn the_phase_of_each_transmitter_is_taken_off() {
        // A target at a quarter of the Doppler span, 3 transmitters: 2 pi / 4 a loop.
        let step = phase_step_rad(96.0, 128, 3, 0);
        assert!((step - PI / 6.0).abs() < 1e-15);
        let mut cell: Vec<Complex64> = (0..6).map(|k| cis(step * f64::from(k / 2))).collect();
        compensate(&mut cell, 3, step).unwrap();
        assert!(cell.iter().all(|z| (z - 1.0).norm() < 1e-15));
    }

    #[test]
    fn a_fold_is_a_turn_a_loop() {
        let difference = phase_step_rad(3.0, 16, 2, 1) - phase_step_rad(3.0, 16, 2, 0);
        assert!((difference - PI).abs() < 1e-15);
    }

    #[test]
    fn wrong_counts_are_named() {
        let mut cell = [Complex64::ZERO; 5];
        for transmitters in [0, 2] {
            assert!(matches!(
                compensate(&mut cell, transmitters, 0.1),
                Err(SignalError::Argument(InputError::Shape { .. }))
            ));
        }
        let refused = compensate(&mut cell, 5, f64::NAN).unwrap_err();
        assert_eq!(refused.details().what, "phase_step_rad");
        assert!(compensate(&mut [], 5, 0.0).is_ok());
    }
}
