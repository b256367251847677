//! `boresight augment`: recorded frames moved in range, seen by `boresight estimate`.

use crate::common::{boresight, folder, stdout};
use serde_json::Value;
use std::path::Path;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn strongest_range(arguments: &[&str]) -> f64 {
    let detections: Vec<Value> = serde_json::from_str(&stdout(arguments)).unwrap();
    let strongest = detections.iter().max_by(|a, b| {
        let power = |d: &Value| d["powerDb"].as_f64().unwrap();
        power(a).total_cmp(&power(b))
    });
    strongest.unwrap()["rangeM"].as_f64().unwrap()
}

#[test]
fn a_target_of_a_cube_stands_as_much_farther_as_its_frame_says() {
    let folder = folder("augment");
    let (cube, more) = (folder.join("cube.npy"), folder.join("more.npy"));
    let (cube, out) = (text(&cube), text(&more));
    let waveform = ["--waveform", "awr1642"];
    let target = ["--target", "range=4,azimuth=10"];
    let array = ["--array", "awr1642"];
    let simulate = ["simulate", "cube", "--seed", "1", "--out", cube];
    stdout(&[&simulate[..], &waveform, &array, &target].concat());
    let make = ["augment", cube, "--count", "3", "--seed", "7", "--shift", "-1,1", "--out", out];
    let said = stdout(&[&make[..], &waveform].concat());
    assert!(said.contains("of shape [3, "), "{said}");
    let told: Value =
        serde_json::from_slice(&std::fs::read(folder.join("more.json")).unwrap()).unwrap();
    let frames = told["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 3);
    for (index, frame) in frames.iter().enumerate() {
        assert_eq!(frame["frame"], 0);
        let shift = frame["shiftM"].as_f64().unwrap();
        let number = index.to_string();
        let estimate = ["estimate", out, "--frame", &number, "--json"];
        let range = strongest_range(&[&estimate[..], &waveform, &array].concat());
        // Half a range bin of 4.9 cm.
        assert!((range - 4.0 - shift).abs() < 0.03, "{index}: {range} m, shifted by {shift} m");
    }
}

#[test]
fn a_capture_is_read_by_its_configuration_and_mistakes_are_named() {
    let folder = folder("augment-capture");
    let out = folder.join("out.npy");
    let capture = format!("{ROOT}/recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin");
    let config = format!("{ROOT}/recordings/awr1642/profile.cfg");
    let base = ["augment", &capture, "--seed", "1", "--count", "2", "--out", text(&out)];
    let refused = |more: &[&str], part: &str| {
        let output = boresight(&[&base[..], more].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && errors.contains(part), "{more:?}: {errors}");
        assert!(!out.exists());
    };
    refused(&[], "--config");
    refused(&["--config", &config, "--shift", "900,901"], "shift");
    refused(&["--config", &config, "--shift", "1,-1"], "shift");
    let said = stdout(&[&base[..], &["--config", &config]].concat());
    assert!(said.contains("of shape [2, "), "{said}");
    assert!(out.with_extension("json").exists());
}
