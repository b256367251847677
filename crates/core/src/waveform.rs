//! The FMCW waveform of a MIMO radar and the numbers that follow from it.

use crate::multiplexing::Multiplexing;
use crate::units::SPEED_OF_LIGHT_MPS;
use boresight_math::error::{InputError, check_positive, check_range};
use boresight_options::Described;
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// What the receivers' converters give.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// I and Q: beat frequencies from zero to the sample rate are told apart.
    #[default]
    Complex,
    /// I alone: beat frequencies from zero to half the sample rate. The spectrum is the same, mirrored, at negative
    /// ones, so that a target has half the signal-to-noise ratio in its bin that complex samples give.
    Real,
}

/// Timing and frequency plan of one frame: `loops` times through the chirps of a loop, which the
/// transmitters share as `multiplexing` says, `samples` samples a chirp.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Waveform {
    /// Frequency at the start of the ramp, Hz.
    pub start_frequency_hz: f64,
    /// Slope of the ramp, Hz per second.
    pub slope_hz_per_s: f64,
    /// Sample rate, Hz.
    pub sample_rate_hz: f64,
    /// Whether samples are complex or real.
    #[serde(default)]
    pub sampling: Sampling,
    /// Samples a chirp; an even number of real ones.
    pub samples: usize,
    /// Time from the start of the ramp to the first sample, s.
    pub adc_start_s: f64,
    /// Time from the start of one chirp to the start of the next, s.
    pub chirp_interval_s: f64,
    /// Number of transmitters.
    pub transmitters: usize,
    /// Loops in a frame: how often each transmitter's turn comes, or, in Doppler division, chirps.
    pub loops: usize,
    /// Time from the start of one frame to the start of the next, s.
    pub frame_interval_s: f64,
    /// How the transmitters share the chirps.
    #[serde(default, skip_serializing_if = "Multiplexing::is_time_division")]
    pub multiplexing: Multiplexing,
    /// Doppler bands of Doppler division, more than transmitters, so that some are empty and tell
    /// which band is whose; half as many more as transmitters if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doppler_bands: Option<usize>,
}

/// What follows from a waveform: the numbers engineers look for first.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct WaveformSummary {
    /// Bandwidth swept while samples are taken.
    pub bandwidth_hz: f64,
    /// Frequency in the middle of the samples.
    pub centre_frequency_hz: f64,
    /// Wavelength at the centre frequency.
    pub wavelength_m: f64,
    /// Range resolution.
    pub range_resolution_m: f64,
    /// Largest unambiguous range.
    pub max_range_m: f64,
    /// Range-rate resolution.
    pub rate_resolution_mps: f64,
    /// Largest unambiguous range rate of either sign.
    pub max_rate_mps: f64,
    /// Time over which the chirps of a frame are sent.
    pub frame_time_s: f64,
}

impl Waveform {
    /// Checks that every quantity is finite, in its domain and consistent with the others.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] naming the first that is not.
    pub fn check(&self) -> Result<(), InputError> {
        check_positive("start_frequency_hz", self.start_frequency_hz)?;
        check_positive("slope_hz_per_s", self.slope_hz_per_s)?;
        check_positive("sample_rate_hz", self.sample_rate_hz)?;
        check_range("samples", self.samples as f64, 2.0, 65_536.0)?;
        if self.sampling == Sampling::Real && !self.samples.is_multiple_of(2) {
            return Err(InputError::OutOfRange {
                what: "samples".into(),
                expected: "an even number of real samples".into(),
                given: self.samples as f64,
            });
        }
        check_range("adc_start_s", self.adc_start_s, 0.0, 1.0)?;
        check_range("transmitters", self.transmitters as f64, 1.0, 64.0)?;
        check_range("loops", self.loops as f64, 1.0, 65_536.0)?;
        check_range("chirp_interval_s", self.chirp_interval_s, self.sweep_s(), 1.0)?;
        match self.multiplexing {
            Multiplexing::TimeDivision => {}
            Multiplexing::BinaryPhase => self.check_binary_phase()?,
            Multiplexing::DopplerDivision => self.check_doppler_division()?,
        }
        let active = self.chirp_interval_s * (self.loops * self.chirps_per_loop()) as f64;
        check_range("frame_interval_s", self.frame_interval_s, active * (1.0 - 1e-9), 1e3)
    }

    /// Checks that samples are complex, for what has no other form.
    ///
    /// # Errors
    /// [`InputError::Incompatible`] for real samples.
    pub fn check_complex(&self) -> Result<(), InputError> {
        match self.sampling {
            Sampling::Complex => Ok(()),
            Sampling::Real => Err(InputError::Incompatible {
                what: "sampling".into(),
                expected: "complex".into(),
                given: "real".into(),
            }),
        }
    }

    fn check_binary_phase(&self) -> Result<(), InputError> {
        if self.transmitters.is_power_of_two() {
            return Ok(());
        }
        Err(InputError::OutOfRange {
            what: "transmitters".into(),
            expected: "a power of two in binary-phase multiplexing".into(),
            given: self.transmitters as f64,
        })
    }

    fn check_doppler_division(&self) -> Result<(), InputError> {
        let (fewest, bands) = (self.transmitters + 1, self.bands());
        check_range("doppler_bands", bands as f64, fewest as f64, 128.0)?;
        if self.loops.is_multiple_of(bands) {
            return Ok(());
        }
        Err(InputError::OutOfRange {
            what: "loops".into(),
            expected: format!("a multiple of the {bands} Doppler bands"),
            given: self.loops as f64,
        })
    }

    /// Chirps of a loop: as many as transmitters, or 1 in Doppler division.
    pub fn chirps_per_loop(&self) -> usize {
        self.multiplexing.chirps_per_loop(self.transmitters)
    }

    /// Doppler bands into which the transmitters are put in Doppler division; 1 otherwise.
    pub fn bands(&self) -> usize {
        if self.multiplexing != Multiplexing::DopplerDivision {
            return 1;
        }
        self.doppler_bands.unwrap_or(self.transmitters + (self.transmitters / 2).max(1))
    }

    /// The factor by which `transmitter` sends chirp `chirp` of loop `turn`.
    pub fn code(&self, transmitter: usize, turn: usize, chirp: usize) -> Complex64 {
        self.multiplexing.code(transmitter, turn, chirp, self.bands())
    }

    /// Chirps of a loop in which a transmitter sends: what a loop adds up in energy over one chirp
    /// of one transmitter.
    pub fn sent_per_loop(&self) -> usize {
        match self.multiplexing {
            Multiplexing::BinaryPhase => self.transmitters,
            Multiplexing::TimeDivision | Multiplexing::DopplerDivision => 1,
        }
    }

    /// Time over which samples are taken, s.
    pub fn sweep_s(&self) -> f64 {
        self.samples as f64 / self.sample_rate_hz
    }

    /// Bandwidth swept while samples are taken, Hz.
    pub fn bandwidth_hz(&self) -> f64 {
        self.slope_hz_per_s * self.sweep_s()
    }

    /// Frequency in the middle of the samples, Hz.
    pub fn centre_frequency_hz(&self) -> f64 {
        self.start_frequency_hz + self.slope_hz_per_s * (self.adc_start_s + self.sweep_s() / 2.0)
    }

    /// Wavelength at the centre frequency, m.
    pub fn wavelength_m(&self) -> f64 {
        SPEED_OF_LIGHT_MPS / self.centre_frequency_hz()
    }

    /// Range resolution `c / 2B`, m; the width of a range bin where the transform is not padded.
    pub fn range_resolution_m(&self) -> f64 {
        SPEED_OF_LIGHT_MPS / (2.0 * self.bandwidth_hz())
    }

    /// Width of the band of beat frequencies that are told apart, from zero: the sample rate, or half of it with real
    /// samples, Hz.
    pub fn beat_band_hz(&self) -> f64 {
        match self.sampling {
            Sampling::Complex => self.sample_rate_hz,
            Sampling::Real => self.sample_rate_hz / 2.0,
        }
    }

    /// Bins of a range transform without padding, over the band of [`Waveform::beat_band_hz`].
    pub fn range_bins(&self) -> usize {
        match self.sampling {
            Sampling::Complex => self.samples,
            Sampling::Real => self.samples / 2,
        }
    }

    /// Largest unambiguous range: `c / 2 slope` times the band of beat frequencies, m.
    pub fn max_range_m(&self) -> f64 {
        SPEED_OF_LIGHT_MPS * self.beat_band_hz() / (2.0 * self.slope_hz_per_s)
    }

    /// Time from one loop to the next, s.
    pub fn loop_interval_s(&self) -> f64 {
        self.chirp_interval_s * self.chirps_per_loop() as f64
    }

    /// Range-rate resolution `lambda / 2 T`, m/s, T being the time the loops take.
    pub fn rate_resolution_mps(&self) -> f64 {
        self.wavelength_m() / (2.0 * self.loops as f64 * self.loop_interval_s())
    }

    /// Largest unambiguous range rate `lambda / 4 Tloop`, m/s, of either sign.
    pub fn max_rate_mps(&self) -> f64 {
        self.wavelength_m() / (4.0 * self.loop_interval_s())
    }

    /// Time over which the chirps of a frame are sent, s.
    pub fn frame_time_s(&self) -> f64 {
        self.loop_interval_s() * self.loops as f64
    }

    /// The numbers above together.
    pub fn summary(&self) -> WaveformSummary {
        WaveformSummary {
            bandwidth_hz: self.bandwidth_hz(),
            centre_frequency_hz: self.centre_frequency_hz(),
            wavelength_m: self.wavelength_m(),
            range_resolution_m: self.range_resolution_m(),
            max_range_m: self.max_range_m(),
            rate_resolution_mps: self.rate_resolution_mps(),
            max_rate_mps: self.max_rate_mps(),
            frame_time_s: self.frame_time_s(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn awr1642() -> Waveform {
        Waveform {
            start_frequency_hz: 77e9,
            slope_hz_per_s: 60e12,
            sample_rate_hz: 5.209e6,
            sampling: Sampling::Complex,
            samples: 256,
            adc_start_s: 7e-6,
            chirp_interval_s: 97.14e-6,
            transmitters: 2,
            loops: 16,
            frame_interval_s: 40e-3,
            multiplexing: Multiplexing::TimeDivision,
            doppler_bands: None,
        }
    }

    #[test]
    fn derived_numbers_of_the_awr1642_profile() {
        let waveform = awr1642();
        waveform.check().unwrap();
        assert!((waveform.range_resolution_m() - 0.0508).abs() < 2e-4);
        assert!((waveform.max_range_m() - 13.013).abs() < 0.01);
        assert!((waveform.max_rate_mps() - 4.88).abs() < 0.1);
        assert!((waveform.rate_resolution_mps() - 0.61).abs() < 0.02);
    }

    #[test]
    fn real_samples_reach_half_as_far_at_the_same_resolution() {
        let complex = awr1642();
        let real = Waveform { sampling: Sampling::Real, ..complex };
        real.check().unwrap();
        assert_eq!(real.max_range_m(), complex.max_range_m() / 2.0);
        assert_eq!(real.range_resolution_m(), complex.range_resolution_m());
        assert_eq!((complex.range_bins(), real.range_bins()), (256, 128));
        let odd = Waveform { samples: 255, ..real };
        assert!(odd.check().unwrap_err().to_string().contains("even"), "{:?}", odd.check());
    }

    #[test]
    fn impossible_waveforms_name_the_quantity() {
        let broken = Waveform { chirp_interval_s: 1e-6, ..awr1642() };
        assert!(broken.check().unwrap_err().to_string().contains("chirp_interval_s"));
        let broken = Waveform { slope_hz_per_s: f64::NAN, ..awr1642() };
        assert!(broken.check().unwrap_err().to_string().contains("slope_hz_per_s"));
        let broken = Waveform { frame_interval_s: 1e-3, ..awr1642() };
        assert!(broken.check().unwrap_err().to_string().contains("frame_interval_s"));
        let multiplexing = Multiplexing::BinaryPhase;
        let broken = Waveform { transmitters: 3, multiplexing, ..awr1642() };
        assert!(broken.check().unwrap_err().to_string().contains("power of two"));
        let ddm = Waveform { multiplexing: Multiplexing::DopplerDivision, ..awr1642() };
        assert!(ddm.check().unwrap_err().to_string().contains("multiple of the 3"));
        for doppler_bands in [Some(0), Some(2), Some(usize::MAX)] {
            let broken = Waveform { doppler_bands, ..ddm };
            assert!(broken.check().unwrap_err().to_string().contains("doppler_bands"));
        }
    }

    #[test]
    fn sending_at_once_changes_what_a_loop_is() {
        let bpm = Waveform { multiplexing: Multiplexing::BinaryPhase, ..awr1642() };
        bpm.check().unwrap();
        assert_eq!((bpm.summary(), bpm.sent_per_loop()), (awr1642().summary(), 2));
        let multiplexing = Multiplexing::DopplerDivision;
        let ddm = Waveform { multiplexing, transmitters: 4, loops: 48, ..awr1642() };
        ddm.check().unwrap();
        assert_eq!((ddm.bands(), ddm.chirps_per_loop()), (6, 1));
        assert!((ddm.max_rate_mps() / awr1642().max_rate_mps() - 2.0).abs() < 1e-12);
    }
}
