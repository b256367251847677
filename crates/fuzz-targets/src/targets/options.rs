//! Options, waveforms and positions of arrays as JSON: what passes its check comes back as it was written, and plans are made or refused.

use boresight_aoa::{Estimator, EstimatorOptions, Method};
use boresight_core::array::Position;
use boresight_core::{Array, Multiplexing, Sampling, Waveform, presets};
use boresight_options::{Described, Named, Naming};
use boresight_pipeline::{Chain, ChainOptions};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// What a target has time for.
const MOST: usize = 512;
const WAVEFORM: Waveform = Waveform {
    start_frequency_hz: 77e9,
    slope_hz_per_s: 60e12,
    sample_rate_hz: 5e6,
    sampling: Sampling::Complex,
    samples: 32,
    adc_start_s: 0.0,
    chirp_interval_s: 1e-4,
    transmitters: 2,
    loops: 8,
    frame_interval_s: 0.04,
    multiplexing: Multiplexing::TimeDivision,
    doppler_bands: None,
};

fn read<T: DeserializeOwned + Serialize + Described + PartialEq + std::fmt::Debug>(
    json: &[u8],
) -> Option<T> {
    let read: T = serde_json::from_slice(json).ok()?;
    boresight_options::check(&read, Naming::Rust).ok()?;
    let text = serde_json::to_vec(&read).expect("options are JSON");
    let again = serde_json::from_slice(&text).expect("what was written is read");
    assert_eq!(read, again);
    Some(read)
}

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let Some((&choice, json)) = bytes.split_first() else { return };
    let method = Method::VARIANTS[usize::from(choice) % Method::VARIANTS.len()];
    let names = ["awr1642", "awr1843", "lrr48"];
    let array = presets::preset(names[usize::from(choice) % names.len()]).expect("a preset");
    if let Some(mut options) = read::<EstimatorOptions>(json) {
        options.grid_points = options.grid_points.min(MOST);
        options.elevation_points = options.elevation_points.min(9);
        let _ = Estimator::new(method, &array, &options);
    }
    if let Some(waveform) = read::<Waveform>(json)
        && waveform.check().is_ok()
    {
        assert!(waveform.wavelength_m() > 0.0);
    }
    if let Ok(positions) = serde_json::from_slice::<Vec<Position>>(json) {
        let half = positions.len() / 2;
        let _ = Array::mimo(&positions[..half], &positions[half..]);
        if let Ok(array) = Array::new(&positions) {
            assert_eq!(array.len(), positions.len());
            let _ = Estimator::new(
                method,
                &array,
                &EstimatorOptions { grid_points: MOST, ..Default::default() },
            );
        }
    }
    if let Some(mut options) = read::<ChainOptions>(json) {
        options.angle.options.grid_points = options.angle.options.grid_points.min(MOST);
        let _ = Chain::new(&WAVEFORM, 4, &array, &options);
    }
}
