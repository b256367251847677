use super::*;
use crate::mmwave_cfg::RadarConfig;
use serde_json::{Value, json};

const MMWAVE: &str = include_str!("../../../../tests/golden/mmwave-studio/awr1642.mmwave.json");
const SETUP: &str = include_str!("../../../../tests/golden/mmwave-studio/awr1642.setup.json");
const CFG: &str = include_str!("../../../../recordings/awr1642/profile.cfg");

fn value() -> Value {
    serde_json::from_str(MMWAVE).unwrap()
}

fn parsed(value: &Value) -> Result<RadarConfig, FormatError> {
    RadarConfig::parse(config_text(value.to_string().as_bytes(), None)?.as_bytes())
}

/// A configuration with one value changed; null removes it.
fn changed(pointer: &str, to: Value) -> Value {
    let mut value = value();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    let parent = value.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer}"));
    match parent {
        Value::Object(fields) => drop(fields.insert(name.into(), to)),
        Value::Array(items) => items[name.parse::<usize>().unwrap()] = to,
        _ => panic!("{pointer}"),
    }
    value
}

/// The same settings for four chips whose twelve transmitters take turns.
fn cascade() -> Value {
    let mut devices = vec![];
    for chip in 0..4 {
        let mut device = value()["mmWaveDevices"][0].take();
        let rf = &mut device["rfConfig"];
        rf["rlChanCfg_t"] =
            json!({ "rxChannelEn": "0xF", "txChannelEn": "0x7", "cascading": chip.min(1) + 1 });
        let chirp = rf["rlChirps"][0]["rlChirpCfg_t"].take();
        let chirps = (0..12).map(|index| {
            let mut chirp = chirp.clone();
            chirp["chirpStartIdx"] = json!(index);
            chirp["chirpEndIdx"] = json!(index);
            let own = index / 3 == chip;
            chirp["txEnable"] =
                json!(if own { format!("0x{}", 1 << (index % 3)) } else { "0x0".into() });
            json!({ "rlChirpCfg_t": chirp })
        });
        rf["rlChirps"] = chirps.collect();
        rf["rlFrameCfg_t"]["chirpEndIdx"] = json!(11);
        devices.push(device);
    }
    json!({ "mmWaveDevices": devices })
}

#[test]
fn json_says_the_same_as_the_cfg_of_the_same_settings() {
    let text = config_text(MMWAVE.as_bytes(), Some(SETUP.as_bytes())).unwrap();
    let translated = RadarConfig::parse(text.as_bytes()).unwrap();
    let mut wanted = RadarConfig::parse(CFG.as_bytes()).unwrap();
    assert_eq!(translated.platform.as_deref(), Some("awr1642"));
    (wanted.platform, wanted.sdk_version) = (translated.platform.clone(), None);
    // That of the file is neutral.
    wanted.compensation = None;
    assert_eq!(translated, wanted);
    // Without the setup, the board is unknown.
    let marked = format!("\u{feff}\r\n {MMWAVE}");
    let alone = config_text(marked.as_bytes(), None).unwrap();
    assert_eq!(text, format!("% Platform:awr1642\n{alone}"));
    let untranslated = RadarConfig::parse(marked.as_bytes()).unwrap_err();
    assert!(untranslated.to_string().contains("the text is JSON"), "{untranslated}");
}

#[test]
fn four_devices_are_a_cascade() {
    let config = parsed(&cascade()).unwrap();
    assert_eq!((config.receivers.len(), config.transmitters.len()), (16, 12));
    assert_eq!(config.transmitters, (0..12).collect::<Vec<_>>());
    for (pointer, to, path) in [
        (
            "/mmWaveDevices/2/rfConfig/rlChanCfg_t/rxChannelEn",
            json!(7),
            "mmWaveDevices[2].rfConfig.rlChanCfg_t.rxChannelEn",
        ),
        (
            "/mmWaveDevices/1/rfConfig/rlChanCfg_t/txChannelEn",
            json!(8),
            "mmWaveDevices[1].rfConfig.rlChanCfg_t.txChannelEn",
        ),
        (
            "/mmWaveDevices/1/rfConfig/rlChirps/0/rlChirpCfg_t/txEnable",
            json!(1),
            "mmWaveDevices[0].rfConfig.rlChirps[0].rlChirpCfg_t.txEnable",
        ),
        (
            "/mmWaveDevices/3/rfConfig/rlChirps/0/rlChirpCfg_t/chirpStartIdx",
            json!(5),
            "mmWaveDevices[3].rfConfig.rlChirps",
        ),
        (
            "/mmWaveDevices/0/rfConfig/rlFrameCfg_t/chirpEndIdx",
            json!(1e9),
            "mmWaveDevices[0].rfConfig.rlFrameCfg_t.chirpEndIdx",
        ),
        ("/mmWaveDevices/3", Value::Null, "mmWaveDevices[3].rfConfig.rlChanCfg_t.txChannelEn"),
    ] {
        let mut value = cascade();
        *value.pointer_mut(pointer).unwrap() = to;
        refused(&value, path, "");
    }
}

fn refused(value: &Value, path: &str, word: &str) {
    match parsed(value) {
        Err(error @ FormatError::ConfigField { .. }) => {
            let text = error.to_string();
            assert!(text.starts_with(&format!("configuration: {path}")), "{path}: {text}");
            assert!(text.contains(word), "{word}: {text}");
        }
        other => panic!("{path}: {other:?}"),
    }
}

#[test]
fn fields_that_cannot_be_used_are_named() {
    for (pointer, to, path, word) in [
        (
            "rfConfig/rlProfiles/0/rlProfileCfg_t/numAdcSamples",
            Value::Null,
            "rfConfig.rlProfiles[0].rlProfileCfg_t.numAdcSamples is missing",
            "a number",
        ),
        (
            "rfConfig/rlProfiles/0/rlProfileCfg_t/digOutSampleRate",
            json!("fast"),
            "rfConfig.rlProfiles[0].rlProfileCfg_t.digOutSampleRate is \"fast\"",
            "a number",
        ),
        ("rfConfig/rlProfiles", json!([]), "rfConfig.rlProfiles is []", "at least one"),
        (
            "rfConfig/rlFrameCfg_t",
            Value::Null,
            "rfConfig.rlFrameCfg_t.chirpStartIdx is missing",
            "",
        ),
        (
            "rfConfig/rlChirps/1/rlChirpCfg_t/txEnable",
            json!("0x3"),
            "rfConfig.rlChirps[1].rlChirpCfg_t.txEnable is \"0x3\"",
            "one transmitter",
        ),
        (
            "rfConfig/rlChirps/1/rlChirpCfg_t/txEnable",
            json!(1.5),
            "rfConfig.rlChirps[1].rlChirpCfg_t.txEnable is 1.5",
            "",
        ),
        (
            "rfConfig/rlChirps/1/rlChirpCfg_t/startFreqVar_MHz",
            json!(2),
            "rfConfig.rlChirps[1].rlChirpCfg_t.startFreqVar_MHz is 2",
            "",
        ),
        (
            "rfConfig/rlChanCfg_t/cascading",
            json!(1),
            "rfConfig.rlChanCfg_t.cascading is 1",
            "one chip",
        ),
        (
            "rfConfig/waveformType",
            json!("advancedFrameChirp"),
            "rfConfig.waveformType is \"advancedFrameChirp\"",
            "legacyFrameChirp",
        ),
        ("rfConfig/MIMOScheme", json!(["TDM"]), "rfConfig.MIMOScheme is [\"TDM\"]", "\"TDM\""),
        (
            "rfConfig/rlAdcOutCfg_t/fmt/b2AdcOutFmt",
            json!(3),
            "rfConfig.rlAdcOutCfg_t.fmt.b2AdcOutFmt is 3",
            "real",
        ),
        (
            "rfConfig/rlBpmChirps",
            json!([{ "rlBpmChirpCfg_t": { "constBpmVal": "0x1" } }]),
            "rfConfig.rlBpmChirps[0].rlBpmChirpCfg_t.constBpmVal is \"0x1\"",
            "",
        ),
        (
            "rawDataCaptureConfig/rlDevDataFmtCfg_t/chInterleave",
            json!(0),
            "rawDataCaptureConfig.rlDevDataFmtCfg_t.chInterleave is 0",
            "two lanes",
        ),
        (
            "rawDataCaptureConfig/rlDevLaneEnable_t/laneEn",
            json!("0xF"),
            "rawDataCaptureConfig.rlDevDataFmtCfg_t.chInterleave is 1",
            "four lanes",
        ),
        (
            "rawDataCaptureConfig/rlDevLaneEnable_t/laneEn",
            json!("0x1"),
            "rawDataCaptureConfig.rlDevLaneEnable_t.laneEn is \"0x1\"",
            "two lanes",
        ),
        (
            "rawDataCaptureConfig/rlDevDataPathCfg_t/transferFmtPkt0",
            json!("0x6"),
            "rawDataCaptureConfig.rlDevDataPathCfg_t.transferFmtPkt0 is \"0x6\"",
            "",
        ),
    ] {
        let value = changed(&format!("/mmWaveDevices/0/{pointer}"), to);
        refused(&value, &format!("mmWaveDevices[0].{path}"), word);
    }
    let mut two = value();
    let device = two["mmWaveDevices"][0].clone();
    two["mmWaveDevices"].as_array_mut().unwrap().push(device);
    refused(&two, "mmWaveDevices is 2 devices", "four of a cascade");
    refused(&json!({}), "mmWaveDevices is missing", "at least one device");
    // Long values are shortened.
    let long = changed("/mmWaveDevices/0/rfConfig/waveformType", json!("ä".repeat(999)));
    assert!(parsed(&long).unwrap_err().to_string().len() < 300);
}

#[test]
fn values_are_checked_by_the_reader_of_the_commands() {
    for (field, to, command) in [
        ("rlProfiles/0/rlProfileCfg_t/rampEndTime_usec", 20, "profileCfg: time of the last sample"),
        ("rlFrameCfg_t/chirpEndIdx", 5, "frameCfg: chirps"),
    ] {
        let value = changed(&format!("/mmWaveDevices/0/rfConfig/{field}"), json!(to));
        let error = parsed(&value).unwrap_err().to_string();
        assert!(error.contains(command), "{field}: {error}");
    }
}

#[test]
fn text_that_is_not_json_is_refused() {
    let error = |mmwave: &str, setup| config_text(mmwave.as_bytes(), setup).unwrap_err();
    assert!(matches!(error("hello", None), FormatError::Json { file: ".mmwave.json", .. }));
    assert!(matches!(error("[1]", None), FormatError::ConfigField { .. }));
    assert!(matches!(error(&"[".repeat(100_000), None), FormatError::Json { .. }));
    assert!(matches!(
        error(MMWAVE, Some(b"{".as_slice())),
        FormatError::Json { file: ".setup.json", .. }
    ));
    for setup in [
        "{}",
        "{\"mmWaveDevice\": 5}",
        "{\"mmWaveDevice\": \"awr\"}",
        "{\"mmWaveDevice\": \"ä1842\"}",
        "{\"mmWaveDevice\": \"awr1842\\nsensorStop\"}",
    ] {
        let error = error(MMWAVE, Some(setup.as_bytes())).to_string();
        assert!(error.contains("mmWaveDevice is"), "{setup}: {error}");
    }
}
