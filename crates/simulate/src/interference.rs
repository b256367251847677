//! Interference of another FMCW radar.
//!
//! Where its frequency comes within the band that the receiver passes after mixing, the other radar's ramp leaves a chirp
//! whose slope is the difference of both (Brooker 2007): short where ramps cross, long where they are alike.

use boresight_core::{Complex64, Direction, InputError, Random, Waveform};
use boresight_math::error::check_range;
use boresight_math::phasor::cis;
use boresight_options::{Described, Flat};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Another radar that transmits.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct Interferer {
    /// Where it is.
    pub direction: Flat<Direction>,
    /// Power of one raw sample at one element, while it is in the band.
    #[option(default = 0.0, range = -200..=200)]
    pub power_db: f64,
    /// Frequency at which its ramps start.
    #[option(default = 77e9, range = 1e6..=1e12)]
    pub start_frequency_hz: f64,
    /// Slope of its ramps.
    #[option(default = -15e12, range = -1e16..=1e16)]
    pub slope_hz_per_s: f64,
    /// Length of a ramp.
    #[option(default = 50e-6, range = 1e-9..=1)]
    pub ramp_s: f64,
    /// Time from one ramp to the next.
    #[option(default = 60e-6, range = 1e-9..=1)]
    pub interval_s: f64,
    /// Time of its first ramp after the start of the first chirp.
    #[option(range = -1..=1)]
    pub delay_s: f64,
}

impl Interferer {
    pub(crate) fn check(&self) -> Result<(), InputError> {
        self.direction.0.check()?;
        for (what, value, least, most) in [
            ("power_db", self.power_db, -200.0, 200.0),
            ("start_frequency_hz", self.start_frequency_hz, 1e6, 1e12),
            ("slope_hz_per_s", self.slope_hz_per_s, -1e16, 1e16),
            ("ramp_s", self.ramp_s, 1e-9, 1.0),
            ("interval_s", self.interval_s, self.ramp_s, 1.0),
            ("delay_s", self.delay_s, -1.0, 1.0),
        ] {
            check_range(&format!("interferer {what}"), value, least, most)?;
        }
        Ok(())
    }
}

/// One of them as a cube sees it.
pub(crate) struct Received<'a> {
    of: &'a Interferer,
    waveform: &'a Waveform,
    /// Factor of each receiver.
    pub gains: Vec<Complex64>,
    seed: u64,
    stream: u64,
    /// Number and phase of the ramp that was looked at last.
    ramp: (f64, f64),
}

impl<'a> Received<'a> {
    /// `gains` are those of the receivers; the phase of each ramp is drawn from the seed, from a stream of its own after `stream`.
    pub fn new(
        of: &'a Interferer,
        waveform: &'a Waveform,
        gains: Vec<Complex64>,
        seed: u64,
        stream: u64,
    ) -> Self {
        Self { of, waveform, gains, seed, stream, ramp: (f64::NAN, 0.0) }
    }

    /// The sample at a time after the start of the chirp that starts at `start_s`, of amplitude 1: zero further than half the
    /// sample rate from the transmitted frequency.
    pub fn sample(&mut self, start_s: f64, time_s: f64) -> Complex64 {
        let (of, own) = (self.of, self.waveform);
        let since_s = start_s + time_s - of.delay_s;
        let ramp = (since_s / of.interval_s).floor();
        let ramp_s = since_s - ramp * of.interval_s;
        let frequency = of.start_frequency_hz + of.slope_hz_per_s * ramp_s;
        let mixed = own.start_frequency_hz + own.slope_hz_per_s * time_s;
        if ramp_s > of.ramp_s || (frequency - mixed).abs() > 0.5 * own.sample_rate_hz {
            return Complex64::ZERO;
        }
        if self.ramp.0 != ramp {
            let stream = self.stream.wrapping_add(ramp as i64 as u64);
            self.ramp = (ramp, Random::new(self.seed, stream).phase());
        }
        let turns = |start: f64, slope: f64, time: f64| (start + 0.5 * slope * time) * time;
        let apart = turns(own.start_frequency_hz, own.slope_hz_per_s, time_s)
            - turns(of.start_frequency_hz, of.slope_hz_per_s, ramp_s);
        cis(TAU * (apart - apart.floor()) + self.ramp.1)
    }
}
