use super::*;
use boresight_core::{ArrayCalibration, Diagnose};

const RECORDING: &str = include_str!("../../../../recordings/awr1642/profile.cfg");

fn given(from: &str, to: &str) -> String {
    assert!(RECORDING.contains(from), "{from}");
    RECORDING.replace(from, to)
}

#[test]
fn reads_the_recorded_configuration() {
    let config = RadarConfig::parse(RECORDING.as_bytes()).unwrap();
    let w = config.waveform;
    assert_eq!((w.samples, w.loops, w.transmitters), (256, 16, 2));
    assert_eq!((w.start_frequency_hz, w.slope_hz_per_s, w.sample_rate_hz), (77e9, 60e12, 5.209e6));
    assert!((w.chirp_interval_s - 97.14e-6).abs() < 1e-12);
    assert!((w.adc_start_s - 7e-6).abs() < 1e-15 && (w.frame_interval_s - 0.04).abs() < 1e-15);
    assert_eq!(config.receivers, [0, 1, 2, 3]);
    assert_eq!(config.transmitters, [0, 1]);
    assert_eq!(config.array_preset, Some("awr1642"));
    assert_eq!(config.platform.as_deref(), Some("xWR16xx"));
    assert_eq!(config.sdk_version.as_deref(), Some("02.00"));
    assert_eq!(config.adc, AdcFormat { bits: 16, q_first: false, receiver_major: true });
    assert_eq!(config.frames, None);
    assert_eq!(config.frame_bytes(), 131_072);
    assert_eq!(config.remarks, []);
}

#[test]
fn line_endings_comments_and_a_missing_start_do_not_matter() {
    let plain = RadarConfig::parse(RECORDING.as_bytes()).unwrap();
    let unix = RECORDING.replace('\r', "");
    let windows = format!("\u{feff}{}", unix.replace('\n', "\r\n"));
    let commented = unix.replace("adcCfg 2 1", "adcCfg 2 1 % sixteen bits\n\n   % nothing");
    let unstarted = unix.replace("sensorStart", "");
    for text in [unix, windows, commented, unstarted] {
        assert_eq!(RadarConfig::parse(text.as_bytes()).unwrap(), plain);
    }
}

#[test]
fn errors_name_line_command_expected_and_given() {
    let text =
        given("profileCfg 0 77 40 7 57.14 0 0 60 1 256", "profileCfg 0 77 40 7 57.14 0 0 60 1 999");
    let error = RadarConfig::parse(text.as_bytes()).unwrap_err();
    let FormatError::Config { line, command, what, expected, given } = &error else {
        panic!("{error:?}")
    };
    assert_eq!((*line, command.as_str()), (25, "profileCfg"));
    assert_eq!(what, "time of the last sample");
    assert!(expected.contains("57.140 us") && given == "198.783 us", "{error}");
    assert_eq!(error.code(), "config-value");
}

#[test]
fn impossible_lines_are_refused() {
    for (from, to, word) in [
        ("profileCfg 0 77", "profileCfg 0 -77", "start frequency"),
        ("profileCfg 0 77", "profileCfg 0 nan", "start frequency"),
        ("256 5209", "256 0", "sample rate"),
        ("256 5209", "1 5209", "samples"),
        ("256 5209 0 0 30", "256 5209", "number of arguments"),
        ("channelCfg 15 3 0", "channelCfg 15 1 0", "mask 1"),
        ("channelCfg 15 3 0", "channelCfg 0 3 0", "receiver mask"),
        ("channelCfg 15 3 0", "channelCfg 15 3 1", "cascading"),
        ("adcCfg 2 1", "adcCfg 2 0", "complex"),
        ("adcCfg 2 1", "adcCfg 7 1", "number of bits"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 3", "one transmitter"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 5 0 0 0 2", "variation"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 1 0 0 0 0 2", "profiles"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "", "chirpCfg line for chirp 1"),
        ("frameCfg 0 1 16 0 40", "frameCfg 0 1 0 0 40", "loops"),
        ("frameCfg 0 1 16 0 40", "frameCfg 0 1 16 0 2", "frame_interval_s"),
        ("frameCfg 0 1 16 0 40", "frameCfg 1 0 16 0 40", "last chirp"),
        ("bpmCfg -1 0 0 1", "bpmCfg -1 1 0 1", "time division"),
        ("lvdsStreamCfg -1 0 0 0", "lvdsStreamCfg -1 1 1 0", "header"),
        ("dfeDataOutputMode 1", "dfeDataOutputMode 3", "frames of chirps"),
    ] {
        let error = RadarConfig::parse(given(from, to).as_bytes()).unwrap_err();
        assert!(error.to_string().contains(word), "{to}: {error}");
    }
}

#[test]
fn missing_commands_are_named() {
    for command in ["channelCfg", "profileCfg", "frameCfg"] {
        let text = given(command, "% ");
        let error = RadarConfig::parse(text.as_bytes()).unwrap_err();
        assert!(error.to_string().contains(command), "{error}");
    }
    let empty = RadarConfig::parse(b"").unwrap_err();
    assert!(matches!(empty, FormatError::MissingCommand { .. }), "{empty}");
}

#[test]
fn remarks_tell_what_was_not_understood() {
    let text = given("lowPower 0 1", "madeUpCfg 1 2 3");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!(config.remarks.len(), 1);
    assert_eq!(config.remarks[0].code, "unknown-command");
    assert!(config.remarks[0].message.contains("madeUpCfg"));

    let text = given("compRangeBiasAndRxChanPhase 0.0 1 0", "compRangeBiasAndRxChanPhase 0.1 1 0");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!(config.remarks[0].code, "compensation-applied");
    for line in [
        "compRangeBiasAndRxChanPhase",
        "compRangeBiasAndRxChanPhase 0.1 1",
        "compRangeBiasAndRxChanPhase 0.1 1 nan",
        "compRangeBiasAndRxChanPhase 0.1 1 0 1 0 1 0 1 0",
        "compRangeBiasAndRxChanPhase 0 0 0 1 0 1 0 1 0 1 0 1 0 1 0 1 0",
    ] {
        let config = with_compensation(line);
        assert_eq!(config.remarks[0].code, "compensation-not-applied", "{line}");
        let array = config.array().unwrap();
        assert_eq!(config.compensated(&array).unwrap(), array, "{line}");
    }
}

/// The recorded configuration with another line of compensation.
fn with_compensation(line: &str) -> RadarConfig {
    let has = |text: &str| text.starts_with("compRangeBiasAndRxChanPhase");
    let lines = RECORDING.lines().map(|text| if has(text) { line } else { text });
    RadarConfig::parse(lines.collect::<Vec<_>>().join("\n").as_bytes()).unwrap()
}

#[test]
fn coefficients_are_what_a_board_multiplies_its_channels_by() {
    // Transmitter 1, receiver 2 of the chip: the seventh pair. It lags by 90 deg at half the gain.
    let config = with_compensation(
        "compRangeBiasAndRxChanPhase 0.25 0.5 0 0.5 0 0.5 0 0.5 0 0.5 0 0.5 0 0 1 0.5 0",
    );
    let array = config.compensated(&config.array().unwrap()).unwrap();
    let mut channels = [boresight_core::Complex64::ONE; 8];
    channels[6] = boresight_core::Complex64::new(0.0, -0.5);
    let correction = array.correction().unwrap();
    correction.apply(&mut channels);
    // Alike but for the power they have in common.
    for value in channels {
        assert!((value - channels[0]).norm() < 1e-12, "{channels:?}");
    }
    assert!((correction.range_bias_m() - 0.25).abs() < 1e-12);
}

#[test]
fn a_line_of_compensation_is_written_as_it_was_read() {
    let line = "compRangeBiasAndRxChanPhase 0.0697 0.9 0.1 0.8 -0.3 -0.7 0.2 0 -1 0.6 0.6 0.5 0 0.25 0.5 -0.4 0.1";
    let config = with_compensation(line);
    let calibration = config.calibration(&config.array().unwrap()).unwrap();
    let written = config.compensation_of(&calibration).unwrap();
    let read = config.compensation.clone().unwrap();
    assert!((written.range_bias_m - 0.0697).abs() < 1e-12);
    // The greatest has magnitude 1 once written, so that they differ by one real factor.
    let factor = written.coefficients[0] / read.coefficients[0];
    assert!(factor.im.abs() < 1e-9, "{factor}");
    for (w, r) in written.coefficients.iter().zip(&read.coefficients) {
        assert!((w - r * factor).norm() < 1e-9, "{written}");
    }
    assert_eq!(with_compensation(&written.to_string()).remarks[0].code, "compensation-applied");
}

#[test]
fn channels_that_are_not_in_use_keep_their_place() {
    // The second transmitter first: the chip's order stays that of its transmitters.
    let text = given("chirpCfg 0 0 0 0 0 0 0 1", "chirpCfg 0 0 0 0 0 0 0 2")
        .replace("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 1");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    let mut calibration = ArrayCalibration::neutral(&config.array().unwrap());
    calibration.channels[1].phase_rad = std::f64::consts::PI;
    let written = config.compensation_of(&calibration).unwrap();
    let expected = "compRangeBiasAndRxChanPhase 0 1 0 1 0 1 0 1 0 1 0 -1 0 1 0 1 0";
    assert_eq!(written.to_string(), expected);
    let other = ArrayCalibration::neutral(&Array::ula(3).unwrap());
    assert_eq!(config.compensation_of(&other).unwrap_err().code(), "other-array");
}

#[test]
fn one_transmitter_in_several_chirps_counts_as_loops() {
    let text = given("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 1");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!((config.waveform.transmitters, config.waveform.loops), (1, 32));
    assert_eq!(config.array_preset, None);
    assert_eq!(config.array().unwrap().len(), 4);
}

#[test]
fn the_array_follows_the_order_of_transmission() {
    let text = given("chirpCfg 0 0 0 0 0 0 0 1", "chirpCfg 0 0 0 0 0 0 0 2")
        .replace("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 1");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!(config.array_preset, None);
    assert_eq!(config.array().unwrap().positions()[0], [0.0, -4.0, 0.0]);
}
