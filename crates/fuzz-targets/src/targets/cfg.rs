//! Configurations, and mmWave Studio's JSON, which is translated into one: whatever is accepted describes a possible radar.

use boresight_formats::{RadarConfig, mmwave_studio};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    if let Ok(text) = mmwave_studio::config_text(bytes, Some(bytes)) {
        check_text(text.as_bytes());
    }
    match mmwave_studio::config_text(bytes, None) {
        Ok(text) => check_text(text.as_bytes()),
        Err(_) => check_text(bytes),
    }
}

fn check_text(bytes: &[u8]) {
    if let Ok(config) = RadarConfig::parse(bytes) {
        assert!(config.waveform.check().is_ok());
        assert_eq!(config.transmitters.len(), config.waveform.transmitters);
        assert!(!config.receivers.is_empty() && config.frame_bytes() > 0);
        if let Some(array) = config.array() {
            let channels = config.transmitters.len() * config.receivers.len();
            assert_eq!(array.tx().len() * array.rx().len(), channels);
            assert!(array.len() <= channels);
        }
    }
}
