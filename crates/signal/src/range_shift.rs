//! Moving all that a recording holds in range: equation 10 of Sang et al. (2021), with which they made 28,000 training
//! examples of a few ranges more out of recordings of one.

use crate::error::SignalError;
use boresight_core::units::SPEED_OF_LIGHT_MPS;
use boresight_core::{Complex32, InputError, Random, Waveform};
use boresight_math::error::check_range;
use boresight_math::phasor::cis;
use boresight_options::Described;
use ndarray::{ArrayViewMut4, Axis};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Moves all that a frame of raw samples holds by a range, in m; positive is farther away.
///
/// Sample `n` of every chirp, taken at `t = adc_start_s + n / sample_rate_hz`, is multiplied by
/// `exp(2 pi j (2 shift / c) (f0 + slope t))`, the factor by which the echo of a body at rest differs at the new range. `frame` is
/// loops x transmitters x receivers x samples. Powers and angles stay, though an echo from farther away would be weaker and of a
/// plainer wavefront, and so does noise. What leaves `0..max_range_m` comes back at the other end.
///
/// # Errors
/// [`InputError::Incompatible`] for real samples, which a phase cannot be put on; [`InputError::OutOfRange`] for a shift beyond the largest range either way, [`InputError::Shape`] for chirps of another length than
/// the waveform's; what is wrong with the waveform.
pub fn shift_range(
    mut frame: ArrayViewMut4<'_, Complex32>,
    waveform: &Waveform,
    shift_m: f64,
) -> Result<(), SignalError> {
    waveform.check()?;
    waveform.check_complex()?;
    let most = waveform.max_range_m();
    check_range("shift_m", shift_m, -most, most)?;
    let samples = frame.len_of(Axis(3));
    if samples != waveform.samples {
        return Err(SignalError::Argument(InputError::Shape {
            what: "frame".into(),
            expected: format!("{} samples a chirp, as the waveform has", waveform.samples),
            given: frame.shape().to_vec(),
        }));
    }
    let delay_s = 2.0 * shift_m / SPEED_OF_LIGHT_MPS;
    for (n, mut same_time) in frame.axis_iter_mut(Axis(3)).enumerate() {
        let time_s = waveform.adc_start_s + n as f64 / waveform.sample_rate_hz;
        let turns = delay_s * (waveform.start_frequency_hz + waveform.slope_hz_per_s * time_s);
        let turn = cis(TAU * turns.fract());
        let turn = Complex32::new(turn.re as f32, turn.im as f32);
        same_time.mapv_inplace(|sample| sample * turn);
    }
    Ok(())
}

/// How recorded frames are made into more by shifts in range.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct RangeAugmentation {
    /// Frames to make, from those recorded in turn.
    #[option(range = 1..=100_000)]
    pub count: usize,
    /// Least and greatest shift, between which each frame's is drawn; positive is farther away.
    pub shift_m: [f64; 2],
    /// Seed of the shifts.
    pub seed: u64,
}

impl Default for RangeAugmentation {
    /// One frame, shifted by what the paper shifts by.
    fn default() -> Self {
        Self { count: 1, shift_m: [-0.3, 0.3], seed: 0 }
    }
}

/// A frame to be made.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct ShiftedFrame {
    /// The recorded frame it is made from.
    pub frame: usize,
    /// By how much it is farther away.
    pub shift_m: f64,
}

impl RangeAugmentation {
    /// Which of `frames` recorded frames each new one is made from, and its shift.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a count or limits out of range, a least shift above the greatest;
    /// [`InputError::Empty`] without frames.
    pub fn draw(
        &self,
        frames: usize,
    ) -> Result<impl ExactSizeIterator<Item = ShiftedFrame> + use<>, SignalError> {
        let Self { count, shift_m: [least, greatest], seed } = *self;
        check_range("count", count as f64, 1.0, 1e5)?;
        check_range("shift_m", least, -1e6, 1e6)?;
        check_range("shift_m", greatest, least, 1e6)?;
        if frames == 0 {
            let expected = "at least one".into();
            return Err(InputError::Empty { what: "frames".into(), expected }.into());
        }
        Ok((0..count).map(move |index| ShiftedFrame {
            frame: index % frames,
            shift_m: Random::new(seed, index as u64).uniform(least, greatest),
        }))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_core::{Multiplexing, Sampling};
    use ndarray::Array4;

    fn waveform() -> Waveform {
        Waveform {
            start_frequency_hz: 77e9,
            slope_hz_per_s: 60e12,
            sample_rate_hz: 5e6,
            sampling: Sampling::Complex,
            samples: 64,
            adc_start_s: 2e-6,
            chirp_interval_s: 60e-6,
            transmitters: 1,
            loops: 2,
            frame_interval_s: 40e-3,
            multiplexing: Multiplexing::TimeDivision,
            doppler_bands: None,
        }
    }

    /// The echo of a body at rest, by equation 9.
    fn echo(waveform: &Waveform, range_m: f64) -> Array4<Complex32> {
        Array4::from_shape_fn((2, 1, 3, 64), |(_, _, receiver, n)| {
            let time = waveform.adc_start_s + n as f64 / waveform.sample_rate_hz;
            let frequency = waveform.start_frequency_hz + waveform.slope_hz_per_s * time;
            let turns = 2.0 * range_m / SPEED_OF_LIGHT_MPS * frequency + 0.1 * receiver as f64;
            let z = cis(TAU * turns.fract());
            Complex32::new(z.re as f32, z.im as f32)
        })
    }

    #[test]
    fn real_samples_are_refused() {
        let real = Waveform { sampling: Sampling::Real, ..waveform() };
        let error = shift_range(Array4::zeros((2, 1, 1, 64)).view_mut(), &real, 0.1).unwrap_err();
        assert!(error.to_string().contains("complex"), "{error}");
    }

    #[test]
    fn an_echo_moves_to_the_echo_of_its_new_range() {
        let waveform = waveform();
        for shift_m in [0.0, 0.3, -1.7, 4.0] {
            let mut frame = echo(&waveform, 5.0);
            shift_range(frame.view_mut(), &waveform, shift_m).unwrap();
            let moved = echo(&waveform, 5.0 + shift_m);
            let error = (&frame - &moved).iter().map(|z| z.norm()).fold(0.0, f32::max);
            // Two roundings of numbers of magnitude 1 to single precision.
            assert!(error < 1e-6, "{shift_m} m: {error}");
        }
    }

    #[test]
    fn a_shift_and_its_opposite_leave_the_frame() {
        let waveform = waveform();
        let mut frame = echo(&waveform, 7.0);
        for shift_m in [0.21, -0.21] {
            shift_range(frame.view_mut(), &waveform, shift_m).unwrap();
        }
        let error = (&frame - &echo(&waveform, 7.0)).iter().map(|z| z.norm()).fold(0.0, f32::max);
        assert!(error < 1e-6, "{error}");
    }

    #[test]
    fn wrong_shifts_and_frames_are_named() {
        let waveform = waveform();
        let mut frame = echo(&waveform, 5.0);
        let far = shift_range(frame.view_mut(), &waveform, 1.01 * waveform.max_range_m());
        assert!(matches!(far, Err(SignalError::Argument(InputError::OutOfRange { .. }))));
        let nowhere = shift_range(frame.view_mut(), &waveform, f64::NAN);
        assert!(matches!(nowhere, Err(SignalError::Argument(InputError::OutOfRange { .. }))));
        let other = Waveform { samples: 32, ..waveform };
        let short = shift_range(frame.view_mut(), &other, 0.1);
        assert!(matches!(short, Err(SignalError::Argument(InputError::Shape { .. }))));
    }

    #[test]
    fn frames_come_in_turn_with_shifts_within_the_limits() {
        let options = RangeAugmentation { count: 700, shift_m: [-0.3, 0.1], seed: 5 };
        let drawn: Vec<ShiftedFrame> = options.draw(3).unwrap().collect();
        assert_eq!(drawn.len(), 700);
        assert!(drawn.iter().enumerate().all(|(k, shifted)| shifted.frame == k % 3));
        assert!(drawn.iter().all(|shifted| (-0.3..0.1).contains(&shifted.shift_m)));
        let mean = drawn.iter().map(|shifted| shifted.shift_m).sum::<f64>() / 700.0;
        // Four deviations of the mean of 700 uniform numbers over 0.4 m.
        assert!((mean + 0.1).abs() < 4.0 * 0.4 / 12_f64.sqrt() / 700_f64.sqrt(), "{mean}");
        assert!(options.draw(0).is_err());
        assert!(RangeAugmentation { shift_m: [0.1, -0.1], ..options }.draw(1).is_err());
        assert!(RangeAugmentation { count: 0, ..options }.draw(1).is_err());
    }
}
