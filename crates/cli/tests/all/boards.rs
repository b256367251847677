//! Captures of other boards than the recorded one, simulated, and what overrides a configuration.

use crate::common::{boresight, folder, stdout};
use boresight_core::Direction;
use boresight_core::presets::preset;
use boresight_formats::RadarConfig;
use boresight_formats::dca1000::{cascade, write};
use boresight_simulate::{CubeOptions, CubeTarget, simulate_cube};
use serde_json::Value;
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn recorded() -> (String, String) {
    let of = |name: &str| format!("{ROOT}/recordings/awr1642/{name}");
    (of("xwr16xx_crw_dca_module_2018_1015v2.bin"), of("profile.cfg"))
}

/// The strongest detection.
fn first(arguments: &[&str]) -> [f64; 2] {
    let found: Value = serde_json::from_str(&stdout(arguments)).unwrap();
    ["rangeM", "azimuthDeg"].map(|key| found[0][key].as_f64().unwrap())
}

#[test]
fn the_order_of_i_and_q_and_the_lanes_can_be_asked_for() {
    let (bin, cfg) = recorded();
    let swapped = folder("boards-swapped").join("swapped.cfg");
    let text = std::fs::read_to_string(&cfg).unwrap();
    let changed = text.replace("adcbufCfg -1 0 0 1 0", "adcbufCfg -1 0 1 1 0");
    assert_ne!(text, changed);
    std::fs::write(&swapped, changed).unwrap();
    let swapped = swapped.to_str().unwrap();
    let run = |cfg: &str, more: &[&str]| {
        let mut arguments = vec!["estimate", &*bin, "--config", cfg, "--json"];
        arguments.extend(more);
        let output = boresight(&arguments);
        assert!(output.status.success());
        let said = String::from_utf8(output.stderr).unwrap();
        (String::from_utf8(output.stdout).unwrap(), said)
    };
    let (right, said) = run(&cfg, &[]);
    assert!(!said.contains("I and Q"), "{said}");
    let (wrong, said) = run(swapped, &[]);
    assert!(said.contains("I and Q seem to be the other way round"), "{said}");
    assert_ne!(wrong, right);
    let (mended, said) = run(swapped, &["--iq-order", "auto"]);
    assert!(said.contains("read with I first, other than configured"), "{said}");
    assert_eq!(mended, right);
    assert_eq!(run(swapped, &["--iq-order", "iq"]).0, right);
    let (_, said) = run(&cfg, &["--lanes", "four"]);
    assert!(said.contains("two lanes"), "{said}");
}

#[test]
fn a_cascade_is_its_folder_or_one_of_its_files() {
    let place = folder("boards-cascade");
    let chirps: String =
        (0..9).map(|k| format!("chirpCfg {k} {k} 0 0 0 0 0 {}\n", 1 << (11 - k))).collect();
    let text = format!(
        "channelCfg 65535 4095 1\nadcCfg 2 1\nadcbufCfg -1 0 0 0 0\n\
         profileCfg 0 77 40 7 57.14 0 0 60 1 64 5209 0 0 30\n{chirps}frameCfg 0 8 2 0 40 1 0\n"
    );
    let config = RadarConfig::parse(text.as_bytes()).unwrap();
    let direction = Direction::azimuth(0.3);
    let target = CubeTarget { range_m: 4.0, direction: direction.into(), ..CubeTarget::default() };
    let options = CubeOptions { seed: 1, ..CubeOptions::default() };
    let array = preset("cascade86").unwrap();
    let mut cube = simulate_cube(&config.waveform, &array, &[target], &options).unwrap();
    cube.mapv_inplace(|z| z * 0.05);
    let bytes = write(cube.view(), &config).unwrap();
    let chips = cascade::split(&bytes, &config).unwrap();
    for (name, chip) in cascade::CHIP_NAMES.iter().zip(chips) {
        std::fs::write(place.join(format!("{name}_0000_data.bin")), chip).unwrap();
    }
    let cfg = place.join("cascade.cfg");
    std::fs::write(&cfg, &text).unwrap();
    let of = |file: &Path| {
        first(&["estimate", file.to_str().unwrap(), "--config", cfg.to_str().unwrap(), "--json"])
    };
    let found = of(&place);
    assert!((found[0] - 4.0).abs() < 0.1 && (found[1] - 0.3_f64.to_degrees()).abs() < 0.3);
    assert_eq!(of(&place.join("slave2_0000_data.bin")), found);
    std::fs::remove_file(place.join("slave3_0000_data.bin")).unwrap();
    let files = [place.to_str().unwrap(), "--config", cfg.to_str().unwrap()];
    let output = boresight(&[&["estimate"], &files[..]].concat());
    assert!(!output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("no slave3_0000_data.bin"), "{said}");
}

#[test]
fn mmwave_studio_json_and_split_recordings_give_the_results_of_one_file_and_its_cfg() {
    let (bin, cfg) = recorded();
    let golden = format!("{ROOT}/tests/golden/mmwave-studio/awr1642.mmwave.json");
    let estimate = |file: &str, config: &str| {
        let output = boresight(&["estimate", file, "--config", config, "--json"]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        (String::from_utf8(output.stdout).unwrap(), said)
    };
    let (wanted, _) = estimate(&bin, &cfg);
    let (found, said) = estimate(&bin, &golden);
    assert_eq!(found, wanted);
    assert!(said.contains("awr1642.setup.json"), "{said}");

    let parts = folder("boards-parts");
    let bytes = std::fs::read(&bin).unwrap();
    // More than nine parts: order by number is not order by name.
    for (k, part) in bytes.chunks(bytes.len().div_ceil(11)).enumerate() {
        std::fs::write(parts.join(format!("adc_data_Raw_{k}.bin")), part).unwrap();
    }
    assert_eq!(estimate(parts.to_str().unwrap(), &cfg).0, wanted);
    std::fs::remove_file(parts.join("adc_data_Raw_4.bin")).unwrap();
    let (_, said) = estimate(parts.to_str().unwrap(), &cfg);
    assert!(said.contains("lacks adc_data_Raw_4.bin"), "{said}");

    // Without the setup, the board is not known.
    let alone = folder("boards-studio").join("x.mmwave.json");
    std::fs::copy(&golden, &alone).unwrap();
    let output = boresight(&["estimate", &bin, "--config", alone.to_str().unwrap()]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("--array"), "{said}");
}
