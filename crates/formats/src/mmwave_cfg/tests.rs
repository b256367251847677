use super::*;
use boresight_core::{ArrayCalibration, Diagnose, Multiplexing, presets};

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
    assert_eq!(config.adc, AdcFormat { bits: 16, q_first: false, layout: Layout::TwoLane });
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
        ("channelCfg 15 3 0", "channelCfg 15 3 1", "all 16 of the cascade"),
        ("channelCfg 15 3 0", "channelCfg 65535 8191 1", "12 of the cascade"),
        ("channelCfg 15 3 0", "channelCfg 15 3 2", "a slave by itself"),
        ("adcCfg 2 1", "adcCfg 2 0", "as adcCfg says"),
        ("adcCfg 2 1", "adcCfg 2 0\nadcbufCfg 1 0 0 1", "as adcCfg says"),
        ("adcCfg 2 1", "adcCfg 7 1", "number of bits"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 3", "one transmitter"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 5 0 0 0 2", "variation"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 1 0 0 0 0 2", "profiles"),
        ("chirpCfg 1 1 0 0 0 0 0 2", "", "chirpCfg line for chirp 1"),
        ("frameCfg 0 1 16 0 40", "frameCfg 0 1 0 0 40", "loops"),
        ("frameCfg 0 1 16 0 40", "frameCfg 0 1 16 0 2", "frame_interval_s"),
        ("frameCfg 0 1 16 0 40", "frameCfg 1 0 16 0 40", "last chirp"),
        ("bpmCfg -1 0 0 1", "bpmCfg -1 1 0 1", "the same two transmitters"),
        ("bpmCfg -1 0 0 1", "bpmCfg -1 1 1 0", "first the one in phase"),
        ("bpmCfg -1 0 0 1", "bpmCfg -1 1 0", "number of arguments"),
        ("bpmCfg -1 0 0 1", "bpmCfg 9 1 0 1", "sub-frame"),
        ("lvdsStreamCfg -1 0 0 0", "lvdsStreamCfg -1 1 1 0", "header"),
        ("dfeDataOutputMode 1", "dfeDataOutputMode 2", "frames of chirps"),
        ("dfeDataOutputMode 1", "dfeDataOutputMode 3", "advFrameCfg"),
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

#[test]
fn real_samples_are_said_by_both_commands() {
    let text = given("adcCfg 2 1", "adcCfg 2 0").replace("adcbufCfg 0", "adcbufCfg 1");
    let text = text.replace("adcbufCfg -1 0", "adcbufCfg -1 1");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!(config.waveform.sampling, Sampling::Real);
    assert_eq!(config.frame_bytes(), 65_536);
    let odd = text.replace("60 1 256", "60 1 255");
    let error = RadarConfig::parse(odd.as_bytes()).unwrap_err();
    assert!(error.to_string().contains("even number"), "{error}");
}

#[test]
fn waveforms_without_a_sampling_are_of_complex_samples() {
    let waveform = RadarConfig::parse(RECORDING.as_bytes()).unwrap().waveform;
    let mut old = serde_json::to_value(waveform).unwrap();
    let fields = old.as_object_mut().unwrap();
    assert_eq!(fields.remove("sampling"), Some("complex".into()));
    assert_eq!(serde_json::from_value::<Waveform>(old).unwrap(), waveform);
}

/// The recorded configuration with other lines for platform and buffer.
fn lanes_of(platform: &str, buffer: &str) -> RadarConfig {
    let kept = |line: &&str| !line.starts_with("adcbufCfg") && !line.contains("Platform:");
    let lines: Vec<&str> = RECORDING.lines().filter(kept).collect();
    let text = format!("% Platform:{platform}\n{buffer}\n{}", lines.join("\n"));
    RadarConfig::parse(text.as_bytes()).unwrap()
}

#[test]
fn lanes_are_the_buffers_or_else_the_platforms() {
    for (platform, buffer, layout, remark) in [
        ("xWR16xx", "adcbufCfg -1 0 0 1 0", Layout::TwoLane, None),
        ("xWR14xx", "adcbufCfg 0 0 0 1", Layout::FourLane, None),
        ("AWR1243", "adcbufCfg -1 0 0 0 0", Layout::FourLane, None),
        ("xWR14xx", "", Layout::FourLane, Some("assumed")),
        ("awr2243", "", Layout::FourLane, Some("assumed")),
        ("xWR68xx", "", Layout::TwoLane, Some("assumed")),
        ("", "", Layout::TwoLane, Some("assumed")),
        ("µµµ", "", Layout::TwoLane, Some("assumed")),
        ("xWR16xx", "adcbufCfg -1 0 0 0 0", Layout::FourLane, Some("lanes")),
        ("xWR14xx", "adcbufCfg -1 0 0 1 0", Layout::TwoLane, Some("lanes")),
    ] {
        let config = lanes_of(platform, buffer);
        // What board a platform is taken for is another matter.
        let codes = config.remarks.iter().map(|remark| remark.code);
        let codes: Vec<&str> = codes.filter(|&code| code != "board-assumed").collect();
        let expected: Vec<&str> = remark.into_iter().collect();
        assert_eq!((config.adc.layout, codes), (layout, expected), "{platform} {buffer}");
    }
}

#[test]
fn a_cascade_has_the_array_of_its_row() {
    let chirps = |transmitters: &[usize]| -> String {
        let line = |(k, tx): (usize, &usize)| format!("chirpCfg {k} {k} 0 0 0 0 0 {}\n", 1 << tx);
        transmitters.iter().enumerate().map(line).collect()
    };
    let of = |transmitters: &[usize]| {
        let kept = |line: &&str| !line.starts_with("chirpCfg") && !line.contains("Platform:");
        let text: Vec<&str> = RECORDING.lines().filter(kept).collect();
        let text = text.join("\n").replace("channelCfg 15 3 0", "channelCfg 65535 4095 1");
        let last = transmitters.len() - 1;
        let text = text.replace("frameCfg 0 1 ", &format!("frameCfg 0 {last} "));
        RadarConfig::parse(format!("{}{text}", chirps(transmitters)).as_bytes()).unwrap()
    };
    let row: Vec<usize> = (3..12).rev().collect();
    let config = of(&row);
    assert_eq!((config.adc.layout, config.array_preset), (Layout::Cascade, Some("cascade86")));
    assert_eq!(config.array(), presets::preset("cascade86").ok());
    assert_eq!(config.receivers.len(), 16);
    assert_eq!(config.frame_bytes(), 16 * 9 * 16 * 256 * 4);

    // With the elevated transmitters between them, and in another order: the same row out of other channels.
    let all: Vec<usize> = (0..12).collect();
    let config = of(&all);
    let array = config.array().unwrap();
    assert_eq!((config.array_preset, array.len(), array.tx().len()), (None, 86, 12));
    assert_eq!(array.positions(), presets::preset("cascade86").unwrap().positions());
    for (channel, position) in array.channels().iter().zip(array.positions()) {
        let sum = array.tx()[channel.tx][1] + array.rx()[channel.rx][1];
        assert_eq!(sum, position[1]);
    }
    // Elevated transmitters alone are no row.
    assert_eq!(of(&[0, 1]).array(), None);
}

/// Lines of three transmitters on a platform.
fn of_three(platform: &str, lines: &str) -> String {
    let three = "channelCfg 15 7 0\nchirpCfg 2 2 0 0 0 0 0 4\n".to_owned() + lines;
    given("channelCfg 15 3 0", &three)
        .replace("frameCfg 0 1 ", "frameCfg 0 2 ")
        .replace("Platform:xWR16xx", &format!("Platform:{platform}"))
}

const AOP: &str = "antGeometry0 -1 -1 0 0 -3 -3 -2 -2 -1 -1 0 0
antGeometry1 -1 0 -1 0 -3 -2 -3 -2 -3 -2 -3 -2
antPhaseRot 1 -1 1 -1 1 -1 1 -1 1 -1 1 -1
";

#[test]
fn platforms_name_their_boards() {
    for (platform, preset, assumed) in [
        ("xWR18xx", "awr1843", false),
        ("xWR68xx", "iwr6843isk", true),
        ("xWR68xx_AOP", "iwr6843aop", false),
        ("iwr6843ods", "iwr6843ods", false),
    ] {
        let config = RadarConfig::parse(of_three(platform, "").as_bytes()).unwrap();
        assert_eq!(config.array_preset, Some(preset), "{platform}");
        assert_eq!(config.array(), presets::preset(preset).ok());
        let remarked = config.remarks.iter().any(|remark| remark.code == "board-assumed");
        assert_eq!(remarked, assumed, "{platform}: {:?}", config.remarks);
    }
}

#[test]
fn antenna_lines_tell_the_board_whatever_the_platform() {
    for platform in ["xWR68xx", "unheard-of"] {
        // The sign of all together is that of no antenna.
        for turned in [
            AOP.to_owned(),
            AOP.replace("Rot 1 -1 1 -1 1 -1 1 -1 1 -1 1 -1", "Rot -1 1 -1 1 -1 1 -1 1 -1 1 -1 1"),
        ] {
            let config = RadarConfig::parse(of_three(platform, &turned).as_bytes()).unwrap();
            assert_eq!(config.array_preset, Some("iwr6843aop"), "{platform}");
            assert!(config.remarks.iter().all(|remark| remark.code != "board-assumed"));
        }
    }
    let turn = of_three("x", AOP)
        .replace("chirpCfg 0 0 0 0 0 0 0 1", "chirpCfg 0 0 0 0 0 0 0 2")
        .replace("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 1");
    let array = RadarConfig::parse(turn.as_bytes()).unwrap().array().unwrap();
    assert_eq!(array.positions()[1], [0.0, -2.0, -1.0]);
    assert_eq!(array.inverted_rx(), [false, true, false, true]);
}

#[test]
fn antenna_lines_that_are_no_array_are_refused() {
    for (good, bad, what) in [
        ("antPhaseRot 1 -1", "antPhaseRot 1 -2", "value"),
        ("antPhaseRot 1 -1 1 -1", "antPhaseRot 1 1 1 -1", "element 6"),
        ("antGeometry1 -1 0", "antGeometry1 -1 0.5", "element 6"),
        ("antGeometry1 -1 0 -1 0 -3 -2 -3 -2 -3 -2 -3 -2\n", "", "lines"),
        ("antPhaseRot 1 -1 1 -1", "antPhaseRot", "lines"),
        ("antPhaseRot 1 -1 1 -1", "antPhaseRot 1", "the number of arguments"),
    ] {
        let error =
            RadarConfig::parse(of_three("x", &AOP.replace(good, bad)).as_bytes()).unwrap_err();
        assert!(
            matches!(&error, FormatError::Config { what: named, .. } if named == what),
            "{error}"
        );
    }
}

const ADVANCED: &str = "dfeDataOutputMode 3
channelCfg 15 3 0
adcCfg 2 1
adcbufCfg -1 0 0 1 1
profileCfg 0 77 40 7 57.14 0 0 60 1 256 5209 0 0 30
profileCfg 1 76 10 6 30 0 0 20 1 128 6250 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 2
chirpCfg 2 3 1 0 0 0 0 3
advFrameCfg 2 0 10 1 0
subFrameCfg 0 0 0 2 16 20 0 1 1 20
subFrameCfg 1 0 2 2 8 10 0 1 1 15
bpmCfg 0 0 0 0
bpmCfg 1 1 2 3
% Platform:xWR16xx
";

#[test]
fn sub_frames_have_waveforms_of_their_own() {
    let config = RadarConfig::parse(ADVANCED.as_bytes()).unwrap();
    assert_eq!((config.sub_frame, config.sub_frames.len(), config.frames), (0, 2, Some(10)));
    assert_eq!((config.waveform.samples, config.waveform.loops), (256, 16));
    assert_eq!(config.waveform.multiplexing, Multiplexing::TimeDivision);
    assert!((config.waveform.frame_interval_s - 0.035).abs() < 1e-12);
    let first = 16 * 2 * 4 * 256 * 4;
    let second = 8 * 2 * 4 * 128 * 4;
    assert_eq!((config.frame_bytes(), config.sub_frame_bytes()), (first + second, 0..first));
    let other = config.clone().choose(1).unwrap();
    assert_eq!((other.waveform.samples, other.waveform.loops), (128, 8));
    assert_eq!(other.waveform.multiplexing, Multiplexing::BinaryPhase);
    assert!((other.waveform.start_frequency_hz - 76e9).abs() < 1.0);
    assert_eq!((other.transmitters.as_slice(), other.array_preset), (&[0, 1][..], Some("awr1642")));
    assert_eq!(other.sub_frame_bytes(), first..first + second);
    assert_eq!(other.remarks, []);
    assert!(config.choose(2).unwrap_err().to_string().contains("sub-frame"));
    // Sub-frames follow the profile that is forced on them.
    let forced = ADVANCED.replace("advFrameCfg 2 0 10 1 0", "advFrameCfg 2 1 10 1 0");
    let forced = RadarConfig::parse(forced.as_bytes()).unwrap();
    assert!(forced.sub_frames.iter().all(|part| part.waveform.samples == 256));
    // A comment chooses too.
    let text = format!("{ADVANCED}% Sub-frame: 1\n");
    assert_eq!(RadarConfig::parse(text.as_bytes()).unwrap(), other);
    let text = format!("{ADVANCED}% Sub-frame: 2\n");
    assert!(RadarConfig::parse(text.as_bytes()).is_err());
}

#[test]
fn impossible_sub_frames_are_refused() {
    for (from, to, word) in [
        ("advFrameCfg 2 0 10 1 0", "advFrameCfg 5 0 10 1 0", "sub-frames"),
        ("advFrameCfg 2 0 10 1 0", "advFrameCfg 3 0 10 1 0", "sub-frame 2"),
        ("advFrameCfg 2 0 10 1 0", "advFrameCfg 1 0 10 1 0", "below 1"),
        ("advFrameCfg 2 0 10 1 0", "", "advFrameCfg"),
        ("subFrameCfg 1 0 2 2 8 10 0 1 1 15", "subFrameCfg 1 0 2 2 8 10 0 2 1 15", "bursts"),
        ("subFrameCfg 1 0 2 2 8 10 0 1 1 15", "subFrameCfg 1 0 2 2 8 10 0 1 1", "arguments"),
        ("subFrameCfg 1 0 2 2 8 10 0 1 1 15", "subFrameCfg 1 0 511 2 8 10 0 1 1 15", "chirps"),
        ("subFrameCfg 1 0 2 2 8 10 0 1 1 15", "subFrameCfg 1 0 2 2 8 10 0 1 1 nan", "period"),
        ("bpmCfg 1 1 2 3", "bpmCfg 1 0 2 3", "one transmitter a chirp"),
        ("bpmCfg 1 1 2 3", "bpmCfg -1 1 2 3\nbpmCfg 1 0 0 0", "one transmitter a chirp"),
    ] {
        assert!(ADVANCED.contains(from), "{from}");
        let outcome = RadarConfig::parse(ADVANCED.replace(from, to).as_bytes());
        let error = outcome.unwrap_err();
        assert!(error.to_string().contains(word), "{to}: {error}");
    }
}

#[test]
fn binary_phase_of_two_transmitters_is_read() {
    let text = given("bpmCfg -1 0 0 1", "bpmCfg -1 1 0 1")
        .replace("chirpCfg 0 0 0 0 0 0 0 1", "chirpCfg 0 0 0 0 0 0 0 3")
        .replace("chirpCfg 1 1 0 0 0 0 0 2", "chirpCfg 1 1 0 0 0 0 0 3");
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    assert_eq!(config.waveform.multiplexing, Multiplexing::BinaryPhase);
    assert_eq!(config.transmitters, [0, 1]);
    assert_eq!((config.array_preset, config.frame_bytes()), (Some("awr1642"), 131_072));
}

#[test]
fn waveforms_that_older_versions_wrote_are_time_division() {
    let config = RadarConfig::parse(RECORDING.as_bytes()).unwrap();
    let written = serde_json::to_value(config.waveform).unwrap();
    assert!(written.get("multiplexing").is_none() && written.get("dopplerBands").is_none());
    assert_eq!(serde_json::from_value::<Waveform>(written).unwrap(), config.waveform);
    let coded = Waveform { multiplexing: Multiplexing::BinaryPhase, ..config.waveform };
    let written = serde_json::to_value(coded).unwrap();
    assert_eq!(written["multiplexing"], "binary-phase");
    assert_eq!(serde_json::from_value::<Waveform>(written).unwrap(), coded);
}
