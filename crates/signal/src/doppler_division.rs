//! Doppler-division multiplexing: all transmitters send each chirp, transmitter `t` with the phase
//! `2 pi t l / B` in chirp `l`, so that its echoes lie `t` of `B` bands of Doppler frequencies
//! higher. With that phase taken off, each target is at its own Doppler bin in the channels of all
//! transmitters; at the bins that lie whole bands away, each channel holds the echo of another
//! transmitter, or of none, since there are more bands than transmitters. The bin at which no
//! channel is empty has the most power: the empty bands tell the rate over the whole chirp rate.
//!
//! Source: the scheme of Texas Instruments' AWR2944 with empty bands (SPRACY0, 2022); the
//! demodulation before the transform, instead of bins gathered behind it, is exact also where a
//! band is not a whole number of bins.

use boresight_core::{Complex32, Multiplexing, Waveform};
use ndarray::ArrayView2;

/// By how much more than its share of a stronger target's power a cell is a target of its own.
/// Transmitters differ in power by about 1 dB.
const GHOST_MARGIN: f32 = 1.5;

/// The transmitters' phases over the chirps of a frame.
pub(crate) struct Bands {
    /// Conjugate codes of each transmitter, times the Doppler window.
    weights: Vec<Vec<Complex32>>,
    codes: Vec<Vec<Complex32>>,
}

impl Bands {
    /// Those of a waveform in Doppler division; of no other.
    pub fn of(waveform: &Waveform, window: &[f32]) -> Option<Self> {
        if waveform.multiplexing != Multiplexing::DopplerDivision {
            return None;
        }
        let codes: Vec<Vec<Complex32>> = (0..waveform.transmitters)
            .map(|tx| {
                let code = |turn| waveform.code(tx, turn, 0);
                let narrow = |turn| Complex32::new(code(turn).re as f32, code(turn).im as f32);
                (0..waveform.loops).map(narrow).collect()
            })
            .collect();
        let weigh = |code: &Vec<Complex32>| -> Vec<Complex32> {
            code.iter().zip(window).map(|(c, w)| c.conj() * w).collect()
        };
        Some(Self { weights: codes.iter().map(weigh).collect(), codes })
    }

    /// Takes a transmitter's phase off the pulses and weighs them.
    pub fn weigh(&self, transmitter: usize, pulses: &mut [Complex32]) {
        for (pulse, weight) in pulses.iter_mut().zip(&self.weights[transmitter]) {
            *pulse *= weight;
        }
    }

    /// Takes what stands off the pulses: the mean of the echoes of each transmitter.
    pub fn subtract_static(&self, pulses: &mut [Complex32]) {
        let share = 1.0 / pulses.len() as f32;
        for code in &self.codes {
            let sum: Complex32 = pulses.iter().zip(code).map(|(z, c)| z * c.conj()).sum();
            pulses.iter_mut().zip(code).for_each(|(z, c)| *z -= sum * share * c);
        }
    }
}

/// Whether a cell of the power map is the echo of a target that is whole bands away in Doppler,
/// and no more than such an echo explains: in `m` bands' distance as many channels hold an echo as
/// there are transmitters whose neighbour `m` bands on is a transmitter too.
pub fn is_ghost(
    power: ArrayView2<'_, f32>,
    range_bin: usize,
    doppler_bin: usize,
    waveform: &Waveform,
) -> bool {
    let (bands, transmitters) = (waveform.bands(), waveform.transmitters);
    let dopplers = power.ncols();
    let here = power[[range_bin, doppler_bin]];
    (1..bands).any(|away| {
        let centre = doppler_bin + away * dopplers / bands + dopplers;
        let there = [centre - 1, centre, centre + 1]
            .iter()
            .fold(0.0_f32, |most, bin| most.max(power[[range_bin, bin % dopplers]]));
        let shared = (0..transmitters).filter(|t| (t + away) % bands < transmitters).count();
        let share = shared as f32 / transmitters as f32;
        there > here && here <= GHOST_MARGIN * share * there
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_math::phasor::cis;
    use ndarray::Array4;
    use std::f64::consts::TAU;

    use crate::{RangeDoppler, RangeDopplerOptions};

    fn waveform() -> Waveform {
        Waveform {
            start_frequency_hz: 77e9,
            slope_hz_per_s: 60e12,
            sample_rate_hz: 5e6,
            sampling: boresight_core::Sampling::Complex,
            samples: 8,
            adc_start_s: 2e-6,
            chirp_interval_s: 60e-6,
            transmitters: 4,
            loops: 96,
            frame_interval_s: 40e-3,
            multiplexing: Multiplexing::DopplerDivision,
            doppler_bands: None,
        }
    }

    /// A frame of one receiver with targets at range bin 0: Doppler in turns a chirp, and amplitude
    /// and a phase step from one transmitter to the next.
    fn frame(targets: &[(f64, f64, f64)]) -> Array4<Complex32> {
        let waveform = waveform();
        Array4::from_shape_fn((96, 1, 1, 8), |(l, ..)| {
            let sum: boresight_core::Complex64 = targets
                .iter()
                .flat_map(|&(turns, amplitude, step)| {
                    (0..4).map(move |t| (turns, amplitude, step, t))
                })
                .map(|(turns, amplitude, step, t)| {
                    waveform.code(t, l, 0)
                        * cis(TAU * turns * l as f64 + step * t as f64)
                        * amplitude
                })
                .sum();
            Complex32::new(sum.re as f32, sum.im as f32)
        })
    }

    #[test]
    fn each_target_stands_at_its_rate_with_all_transmitters() {
        for (bin, step) in [(90, 0.3), (0, -1.0), (48, 2.0), (17, 0.0)] {
            let turns = (f64::from(bin) - 48.0) / 96.0;
            let mut plan =
                RangeDoppler::new(&waveform(), 1, &RangeDopplerOptions::default()).unwrap();
            let mut map = plan.output();
            plan.process(frame(&[(turns, 0.5, step)]).view(), &mut map).unwrap();
            let bin = bin as usize;
            assert!((map.power[[0, bin]] - 0.25).abs() < 1e-4);
            assert!(!is_ghost(map.power.view(), 0, bin, plan.waveform()));
            let ghosts = (1..6).map(|m| (bin + 16 * m) % 96);
            assert!(ghosts.clone().all(|k| is_ghost(map.power.view(), 0, k, plan.waveform())));
            // 3, 2, 2, 2 and 3 of 4 channels.
            assert!((map.power[[0, (bin + 16) % 96]] - 0.75 * 0.25).abs() < 1e-4);
            let cell = map.snapshot(0, bin).unwrap();
            for t in 1..4 {
                let turn = (cell[t] / cell[t - 1]).arg();
                assert!((cis(turn) - cis(step)).norm() < 1e-4, "{bin} {t}: {turn}");
            }
            assert!((plan.range_profile(&map).unwrap()[0] - 0.25).abs() < 1e-4);
        }
    }

    #[test]
    fn what_stands_is_taken_off_all_bands() {
        let options =
            RangeDopplerOptions { static_clutter_removal: true, ..RangeDopplerOptions::default() };
        let mut plan = RangeDoppler::new(&waveform(), 1, &options).unwrap();
        let mut map = plan.output();
        let turns = 25.0 / 96.0;
        plan.process(frame(&[(0.0, 1.0, 0.4), (turns, 0.1, -1.0)]).view(), &mut map).unwrap();
        assert!((map.power[[0, 48 + 25]] - 0.01).abs() < 1e-4);
        let most = (0..6).map(|m| map.power[[0, (48 + 16 * m) % 96]]).fold(0.0, f32::max);
        assert!(most < 1e-6, "{most}");
    }

    #[test]
    fn a_second_target_is_kept_where_a_ghost_would_be_weaker() {
        // Three bands away two of four channels hold the stronger one's echo: half of its power,
        // and no ghost of it has nine tenths.
        let plan = RangeDoppler::new(&waveform(), 1, &RangeDopplerOptions::default()).unwrap();
        let mut power = ndarray::Array2::<f32>::zeros((1, 96));
        power[[0, 10]] = 1.0;
        power[[0, 58]] = 0.9;
        assert!(!is_ghost(power.view(), 0, 58, plan.waveform()));
        power[[0, 58]] = 0.6;
        assert!(is_ghost(power.view(), 0, 58, plan.waveform()));
    }
}
