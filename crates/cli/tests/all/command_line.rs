//! Runs the binary as a user does.

use crate::common::{boresight, folder, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};

const BIN: &str = "xwr16xx_crw_dca_module_2018_1015v2.bin";
const DAT: &str = "xwr16xx_crw_demo_visualizer_2018_1015v2.dat";

fn recording(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../recordings/awr1642").join(name)
}

fn json(arguments: &[&str]) -> Vec<Value> {
    serde_json::from_str::<Value>(&stdout(arguments)).unwrap().as_array().unwrap().clone()
}

fn on_capture(extra: &[&str]) -> Vec<Value> {
    let (bin, cfg) = (recording(BIN), recording("profile.cfg"));
    let mut arguments = vec!["estimate", bin.to_str().unwrap(), "--config", cfg.to_str().unwrap()];
    arguments.extend(extra);
    arguments.push("--json");
    json(&arguments)
}

fn number(object: &Value, key: &str) -> f64 {
    object[key].as_f64().unwrap_or(f64::NAN)
}

/// The strongest object within 5 cm of `range_m`.
fn near(objects: &[Value], range_m: f64) -> Value {
    objects.iter().find(|o| (number(o, "rangeM") - range_m).abs() <= 0.05).unwrap().clone()
}

#[test]
fn the_targets_of_the_capture_are_printed() {
    for extra in
        [&[][..], &["--frame", "5"], &["--all", "--method", "root-music", "--sources", "1"]]
    {
        let objects = on_capture(extra);
        let (first, second) = (near(&objects, 2.95), near(&objects, 4.94));
        assert!((number(&first, "azimuthDeg") + 10.8).abs() <= 1.0, "{first}");
        assert!((number(&second, "azimuthDeg") - 1.8).abs() <= 3.0, "{second}");
        for object in &objects {
            for key in
                ["frame", "rangeM", "rateMps", "azimuthDeg", "elevationDeg", "powerDb", "snrDb"]
            {
                assert!(number(object, key).is_finite(), "{key}: {object}");
            }
        }
    }
    assert_eq!(on_capture(&["--frame", "5"])[0]["frame"], 5);
    // A method for one snapshot takes each frame by itself.
    let frames = on_capture(&["--method", "single-snapshot-music", "--sources", "1"]);
    assert!((0..8).all(|frame| frames.iter().any(|object| object["frame"] == frame)));
}

#[test]
fn the_board_s_own_detections_are_printed() {
    let dat = recording(DAT);
    let objects = json(&["estimate", dat.to_str().unwrap(), "--json", "--frame", "249"]);
    assert!((number(&near(&objects, 2.95), "azimuthDeg") + 10.79).abs() < 0.01);
    assert!((number(&near(&objects, 4.94), "azimuthDeg") - 1.79).abs() < 0.01);
    assert!(near(&objects, 2.95)["rateMps"].is_null());
}

#[test]
fn tables_and_csv_hold_the_same() {
    let (bin, cfg) = (recording(BIN), recording("profile.cfg"));
    let base = ["estimate", bin.to_str().unwrap(), "--config", cfg.to_str().unwrap()];
    let table = stdout(&base);
    assert!(table.lines().next().unwrap().contains("azimuth_deg"));
    assert!(table.lines().any(|line| line.contains("2.949") && line.contains("-11.1")));
    let csv = stdout(&[&base[..], &["--csv"]].concat());
    let rows = boresight_formats::tables::read_detections(csv.as_bytes()).unwrap();
    assert_eq!(rows.len() + 1, table.lines().count());
    assert_eq!(rows.len(), on_capture(&[]).len());
    assert!((rows[0].range_m - 2.95).abs() < 0.05);
}

#[test]
fn simulated_snapshots_are_estimated_and_repeat() {
    let folder = folder("snapshots");
    let out = folder.join("two.npy");
    let again = folder.join("again.npy");
    for path in [&out, &again] {
        stdout(&[
            "simulate",
            "snapshots",
            "--array",
            "ula8",
            "--target",
            "azimuth=-5",
            "--target",
            "azimuth=20,power=-3",
            "--snapshots",
            "100",
            "--seed",
            "7",
            "--out",
            path.to_str().unwrap(),
        ]);
    }
    assert_eq!(std::fs::read(&out).unwrap(), std::fs::read(&again).unwrap());
    let truth: Value =
        serde_json::from_slice(&std::fs::read(folder.join("two.json")).unwrap()).unwrap();
    assert!((number(&truth["scenes"][0][1], "azimuthDeg") - 20.0).abs() < 1e-9);
    let sources = json(&[
        "estimate",
        out.to_str().unwrap(),
        "--array",
        "ula8",
        "--method",
        "esprit",
        "--sources",
        "2",
        "--json",
    ]);
    let mut azimuths: Vec<f64> = sources.iter().map(|s| number(s, "azimuthDeg")).collect();
    azimuths.sort_by(f64::total_cmp);
    // Standard deviations by the bound are below 0.05 deg here; ten of them.
    assert!((azimuths[0] + 5.0).abs() < 0.5 && (azimuths[1] - 20.0).abs() < 0.5, "{azimuths:?}");
}

#[test]
fn a_moving_target_in_a_simulated_cube_is_found() {
    let folder = folder("cube");
    let (out, truth) = (folder.join("cube.npy"), folder.join("truth.json"));
    stdout(&[
        "simulate",
        "cube",
        "--array",
        "awr1642",
        "--target",
        "range=5,rate=-2.2,azimuth=25,power=-20",
        "--snr",
        "10",
        "--seed",
        "3",
        "--frames",
        "2",
        "--out",
        out.to_str().unwrap(),
        "--truth",
        truth.to_str().unwrap(),
    ]);
    let objects = json(&[
        "estimate",
        out.to_str().unwrap(),
        "--waveform",
        truth.to_str().unwrap(),
        "--array",
        "awr1642",
        "--frame",
        "0",
        "--json",
    ]);
    assert_eq!(objects.len(), 1, "{objects:?}");
    let target = &objects[0];
    assert!((number(target, "rangeM") - 5.0).abs() < 0.02, "{target}");
    assert!((number(target, "rateMps") + 2.2).abs() < 0.1, "{target}");
    assert!((number(target, "azimuthDeg") - 25.0).abs() < 0.5, "{target}");
    assert!((number(target, "powerDb") + 20.0).abs() < 1.0, "{target}");
}

#[test]
fn lists_are_complete() {
    let methods = json(&["methods", "--json"]);
    let known = boresight_aoa::Method::ALL.len() + boresight_aoa::Method::NETWORKS.len();
    assert_eq!(methods.len(), known);
    assert!(methods.iter().all(|m| m["name"].is_string() && m["reference"].is_string()));
    assert!(stdout(&["methods"]).contains("root-music"));
    let arrays = json(&["arrays", "--json"]);
    assert!(arrays.iter().any(|a| a["name"] == "awr1642" && a["elements"] == 8));
    assert!(stdout(&["arrays"]).contains("lrr48"));
}

#[test]
fn errors_say_what_was_expected_and_given() {
    let (bin, cfg) = (recording(BIN), recording("profile.cfg"));
    let (bin, cfg) = (bin.to_str().unwrap(), cfg.to_str().unwrap());
    let folder = folder("errors");
    let short = folder.join("short.bin");
    std::fs::write(&short, [0; 1000]).unwrap();
    let short = short.to_str().unwrap();
    let nan = folder.join("nan.npy");
    let bytes = boresight_formats::npy::write(&[8], &[f64::NAN; 8]).unwrap();
    std::fs::write(&nan, bytes).unwrap();
    let nan = nan.to_str().unwrap();
    for (arguments, status, words) in [
        (&["estimate", bin][..], 2, "--config"),
        (&["estimate", short, "--config", cfg], 1, "131072"),
        (&["estimate", "nowhere.bin", "--config", cfg], 1, "nowhere.bin"),
        (&["estimate", cfg], 2, ".cfg"),
        (&["estimate", bin, "--config", cfg, "--method", "guess"], 2, "root-music"),
        (&["estimate", bin, "--config", cfg, "--array", "ula7"], 1, "2 transmitters x 4"),
        (&["estimate", bin, "--config", cfg, "--frame", "8"], 2, "0 to 7"),
        (&["estimate", bin, "--config", cfg, "--cfar-guard-cells", "4"], 2, "comma"),
        (&["estimate", bin, "--config", cfg, "--region-range", "5,3"], 1, "region.range_m"),
        (&["estimate", bin, "--config", cfg, "--method", "esprit", "--sources", "9"], 1, "at most"),
        (&["estimate", nan, "--array", "ula8"], 1, "finite"),
        (&["estimate", nan, "--array", "ula9"], 1, "[9, snapshots]"),
        (&["estimate", nan], 2, "--array"),
        (&["simulate", "snapshots", "--array", "ula8", "--seed", "1", "--out", nan], 2, "--target"),
        (
            &[
                "simulate", "cube", "--array", "ula8", "--target", "rate=1", "--seed", "1",
                "--out", nan,
            ],
            2,
            "range=NUMBER",
        ),
    ] {
        let output = boresight(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {errors}");
        assert!(errors.contains(words), "{arguments:?}: {errors}");
        assert!(output.stdout.is_empty());
    }
}
