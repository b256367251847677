//! Waveforms of the literature and of boards.

use boresight_core::{InputError, Multiplexing, Sampling, Waveform};

/// A waveform's name, and the function that makes it.
type Preset = (&'static str, fn() -> Waveform);

/// The waveforms known by name.
const PRESETS: [Preset; 4] = [
    ("awr1642", waveform_awr1642),
    ("corner", waveform_corner),
    ("3dcnn-simulated", waveform_3dcnn_simulated),
    ("3dcnn-experiment", waveform_3dcnn_experiment),
];

/// The names of the waveforms known by name.
pub fn waveform_presets() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// The waveform of a name.
///
/// # Errors
/// [`InputError::Unknown`], listing the known names.
pub fn waveform_preset(name: &str) -> Result<Waveform, InputError> {
    let preset = PRESETS.iter().find(|(known, _)| *known == name);
    preset.map(|(_, make)| make()).ok_or_else(|| InputError::Unknown {
        what: "waveform".into(),
        expected: waveform_presets().collect::<Vec<_>>().join(", "),
        given: name.into(),
    })
}

/// Table 3 of the 3D-CNN paper (Sang et al. 2021): 150 MHz in 256 samples at 3.476 MHz/us, so
/// range bins of 1 m, one transmitter; 4 chirps, as its network takes. The paper names no chirp
/// interval; 50 us leaves 7 us between chirps.
pub fn waveform_3dcnn_simulated() -> Waveform {
    let slope_hz_per_s = 3.476e12;
    Waveform {
        start_frequency_hz: 77e9,
        slope_hz_per_s,
        sample_rate_hz: 256.0 * slope_hz_per_s / 0.15e9,
        sampling: Sampling::Complex,
        samples: 256,
        adc_start_s: 0.0,
        chirp_interval_s: 50e-6,
        transmitters: 1,
        loops: 4,
        frame_interval_s: 40e-3,
        multiplexing: Multiplexing::TimeDivision,
        doppler_bands: None,
    }
}

/// Table 4 of the 3D-CNN paper: 3.5 GHz in 512 samples at 4.2 MHz/us, so range bins of 43 mm, two
/// transmitters in turn; 4 loops. The paper names no chirp interval; 850 us leaves 17 us between
/// chirps.
pub fn waveform_3dcnn_experiment() -> Waveform {
    let slope_hz_per_s = 4.2e12;
    Waveform {
        start_frequency_hz: 77e9,
        slope_hz_per_s,
        sample_rate_hz: 512.0 * slope_hz_per_s / 3.5e9,
        sampling: Sampling::Complex,
        samples: 512,
        adc_start_s: 0.0,
        chirp_interval_s: 850e-6,
        transmitters: 2,
        loops: 4,
        frame_interval_s: 40e-3,
        multiplexing: Multiplexing::TimeDivision,
        doppler_bands: None,
    }
}

/// A short-range profile of Texas Instruments' AWR1642: 60 MHz/us, 256 samples at 5.209 Msps, two
/// transmitters in turn, 16 loops.
pub fn waveform_awr1642() -> Waveform {
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

/// A corner radar of six transmitters in turn: 256 samples over 375 MHz and 128 loops, so 0.4 m and
/// 0.2 m/s a bin, unambiguous to 102 m and +-13 m/s.
pub fn waveform_corner() -> Waveform {
    Waveform {
        start_frequency_hz: 76.5e9,
        slope_hz_per_s: 375e6 / 10.24e-6,
        sample_rate_hz: 25e6,
        sampling: Sampling::Complex,
        samples: 256,
        adc_start_s: 1e-6,
        chirp_interval_s: 12.5e-6,
        transmitters: 6,
        loops: 128,
        frame_interval_s: 50e-3,
        multiplexing: Multiplexing::TimeDivision,
        doppler_bands: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_sound_and_have_the_papers_bins() {
        for (waveform, bandwidth_hz, bin_m) in [
            (waveform_3dcnn_simulated(), 0.15e9, 0.9993),
            (waveform_3dcnn_experiment(), 3.5e9, 0.04283),
            (waveform_awr1642(), 2.949e9, 0.0508),
            (waveform_corner(), 0.375e9, 0.3997),
        ] {
            waveform.check().unwrap();
            assert!((waveform.bandwidth_hz() / bandwidth_hz - 1.0).abs() < 1e-3);
            assert!((waveform.range_resolution_m() / bin_m - 1.0).abs() < 1e-3);
        }
    }
}
