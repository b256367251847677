//! Phase noise of the oscillator that transmits and receives.
//!
//! The oscillator's phase is a Wiener process, whose spectrum falls by 20 dB a decade: `L(f) = K / f^2`. An echo of delay
//! `tau` is mixed with it, so that its phase is off by `phi(t) - phi(t - tau)`, of variance `4 pi^2 K tau`: near targets
//! have hardly any (Budge and Burt 1993).

use boresight_core::units::SPEED_OF_LIGHT_MPS;
use boresight_core::{Random, Waveform};
use boresight_math::decibels::db_to_power;
use std::f64::consts::PI;

/// Distance from the carrier at which the level is given, Hz.
const OFFSET_HZ: f64 = 1e6;
/// Steps of the phase to a sample.
const STEPS: f64 = 4.0;

/// The oscillator's phase over one chirp at a time.
pub(crate) struct PhaseNoise {
    /// Time of the first step after the start of the chirp, s.
    first_s: f64,
    step_s: f64,
    /// Deviation of a step, rad.
    deviation: f64,
    phase_rad: Vec<f64>,
}

impl PhaseNoise {
    /// For a level at 1 MHz from the carrier, dBc/Hz.
    pub fn new(waveform: &Waveform, level_dbc_hz: f64) -> Self {
        let longest_s = 2.0 * waveform.max_range_m() / SPEED_OF_LIGHT_MPS;
        let step_s = 1.0 / waveform.sample_rate_hz / STEPS;
        let sampled_s = waveform.samples as f64 / waveform.sample_rate_hz;
        let steps = ((sampled_s + longest_s) / step_s).ceil() as usize + 2;
        let slope = db_to_power(level_dbc_hz) * OFFSET_HZ * OFFSET_HZ;
        Self {
            first_s: waveform.adc_start_s - longest_s,
            step_s,
            deviation: 2.0 * PI * (slope * step_s).sqrt(),
            phase_rad: vec![0.0; steps],
        }
    }

    /// Draws the next chirp's phase.
    pub fn redraw(&mut self, random: &mut Random) {
        let mut phase = 0.0;
        for place in &mut self.phase_rad {
            *place = phase;
            phase += self.deviation * random.normal();
        }
    }

    /// What an echo of a delay is off by, at a time after the start of the chirp, rad.
    pub fn error_rad(&self, time_s: f64, delay_s: f64) -> f64 {
        self.phase(time_s) - self.phase(time_s - delay_s)
    }

    fn phase(&self, time_s: f64) -> f64 {
        let place = ((time_s - self.first_s) / self.step_s).max(0.0);
        let low = (place as usize).min(self.phase_rad.len() - 2);
        let share = (place - low as f64).min(1.0);
        self.phase_rad[low] + share * (self.phase_rad[low + 1] - self.phase_rad[low])
    }
}
