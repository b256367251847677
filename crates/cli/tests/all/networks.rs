//! Trained networks on the command line.

use crate::common::{boresight, folder, stdout};
use crate::size::sized;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn model(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    folder.join(format!("{name}.onnx")).to_str().unwrap().into()
}

/// Two targets at 30 dB in one snapshot of the long-range array.
fn snapshot(folder: &Path) -> PathBuf {
    let out = folder.join("two.npy");
    stdout(&[
        "simulate",
        "snapshots",
        "--array",
        "lrr48",
        "--target",
        "azimuth=-5",
        "--target",
        "azimuth=20,power=-3",
        "--snr",
        "30",
        "--seed",
        "1",
        "--out",
        out.to_str().unwrap(),
    ]);
    out
}

#[test]
fn a_network_estimates_like_any_method() {
    let folder = folder("network-estimates");
    let file = snapshot(&folder);
    let base =
        ["estimate", file.to_str().unwrap(), "--array", "lrr48", "--method", "learned-pursuit"];
    let run = |extra: &[&str]| {
        let text = stdout(&[&base[..], extra].concat());
        serde_json::from_str::<Vec<Value>>(&text).unwrap()
    };
    let path = model("learned-pursuit");
    for extra in sized(&[&[][..], &["--refine"]][..], &[&["--refine"][..]]) {
        let sources =
            run(&[&["--model", &path, "--field-of-view", "60", "--json"][..], *extra].concat());
        assert_eq!(sources.len(), 2, "{sources:?}");
        for (source, (azimuth, power)) in sources.iter().zip([(-5.0, 0.0), (20.0, -3.0)]) {
            assert!((source["azimuthDeg"].as_f64().unwrap() - azimuth).abs() < 0.1, "{source}");
            assert!((source["powerDb"].as_f64().unwrap() - power).abs() < 1.0, "{source}");
        }
    }
}

#[test]
fn a_model_tells_what_it_is() {
    let text = stdout(&["network", &model("learned-pursuit")]);
    for part in [
        "learned-pursuit",
        "snapshots [batch, 48, 2]",
        "targets [batch, 96, 3]",
        "lrr48",
        "SHA-256",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn errors_name_the_file() {
    let folder = folder("network-errors");
    let file = snapshot(&folder);
    let refused = |extra: &[&str]| {
        let base =
            ["estimate", file.to_str().unwrap(), "--array", "lrr48", "--method", "learned-pursuit"];
        let output = boresight(&[&base[..], extra].concat());
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(refused(&[]).contains("--model"));
    let other = refused(&["--model", &model("counting-small")]);
    assert!(other.contains("counting-small.onnx") && other.contains("wrong-network"), "{other}");
    let whole = std::fs::read(model("learned-pursuit")).unwrap();
    let cut = folder.join("cut.onnx");
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let truncated = refused(&["--model", cut.to_str().unwrap()]);
    assert!(truncated.contains("cut.onnx") && truncated.contains("truncated-file"), "{truncated}");
    let text = folder.join("text.onnx");
    std::fs::write(&text, "no network").unwrap();
    assert!(refused(&["--model", text.to_str().unwrap()]).contains("not-onnx"));
    let card = folder.join("card.json");
    std::fs::write(&card, "{}").unwrap();
    let bad = refused(&["--model", &model("learned-pursuit"), "--card", card.to_str().unwrap()]);
    assert!(bad.contains("card.json") && bad.contains("malformed-card"), "{bad}");
}

#[test]
fn an_image_of_a_street_is_made_by_a_network() {
    let path = model("learned-pursuit");
    let base = [
        "image",
        "street",
        "--radars",
        "front-right",
        "--cell",
        "1",
        "--json",
        "--method",
        "iaa,learned-pursuit",
    ];
    let text = stdout(&[&base[..], &["--from", "targets", "--model", &path]].concat());
    let rows: Vec<Value> = serde_json::from_str(&text).unwrap();
    let lit = |row: &Value| row["litTargets"].as_f64().unwrap();
    assert_eq!(rows[1]["method"], "learned-pursuit");
    assert!(lit(&rows[1]) > 0.7 * lit(&rows[0]), "{rows:?}");
}

#[test]
fn regions_are_found_counted_and_told_apart() {
    let folder = folder("network-regions");
    let cube = folder.join("three.npy");
    let cube = cube.to_str().unwrap();
    let radar = ["--waveform", "3dcnn-simulated", "--array", "ula8"];
    let targets = ["range=70,azimuth=-4", "range=160,azimuth=-6", "range=166,azimuth=5"];
    let targets: Vec<&str> = targets.iter().flat_map(|target| ["--target", target]).collect();
    let simulate = ["simulate", "cube", "--snr", "10", "--seed", "2", "--out", cube];
    stdout(&[&simulate[..], &radar, &targets].concat());
    let [counting, one, two] = ["counting-small", "dnn-small-1", "dnn-small-2"].map(model);
    let networks = ["--counting", &counting, "--one", &one, "--two", &two];
    let base = [&["regions", cube][..], &radar, &networks].concat();
    let frames: Vec<Value> =
        serde_json::from_str(&stdout(&[&base[..], &["--json"]].concat())).unwrap();
    let regions = frames[0]["regions"].as_array().unwrap();
    let mut counted: Vec<i64> = regions.iter().map(|r| r["sources"].as_i64().unwrap()).collect();
    counted.sort_unstable();
    assert_eq!(counted, [1, 2]);
    let text = stdout(&[&base[..], &["--csv"]].concat());
    let mut rows: Vec<String> = text
        .lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            format!("{:.0}", fields[7].parse::<f64>().unwrap())
        })
        .collect();
    rows.sort();
    assert_eq!(rows, ["-4", "-6", "5"]);
    // Errors name the file that is wrong.
    let swapped =
        [&["regions", cube][..], &radar, &["--counting", &one, "--one", &one, "--two", &two]];
    let error = boresight(&swapped.concat());
    assert!(!error.status.success());
    let error = String::from_utf8(error.stderr).unwrap();
    assert!(error.contains("dnn-small-1") && error.contains("wrong-network"), "{error}");
}

#[test]
fn sources_are_counted_by_a_network_where_one_is_given() {
    let folder = folder("network-counts");
    let file = folder.join("one.npy");
    let file = file.to_str().unwrap();
    let target = ["--target", "azimuth=3", "--snapshots", "260", "--snr", "10", "--seed", "1"];
    stdout(&[&["simulate", "snapshots", "--array", "ula8", "--out", file][..], &target].concat());
    let base = ["estimate", file, "--array", "ula8", "--method", "music", "--sources", "network"];
    let refused = boresight(&base);
    let error = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && error.contains("--counting-model"), "{error}");
    let counting = model("counting-small");
    let text = stdout(&[&base[..], &["--counting-model", &counting, "--json"]].concat());
    let sources: Vec<Value> = serde_json::from_str(&text).unwrap();
    assert_eq!(sources.len(), 1, "{sources:?}");
    assert!((sources[0]["azimuthDeg"].as_f64().unwrap() - 3.0).abs() < 0.3, "{sources:?}");
}
