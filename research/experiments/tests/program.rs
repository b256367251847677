//! The program as a user runs it.

#![allow(clippy::unwrap_used)]

mod common;

use common::{experiments, folder, model, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};

const MINE: &[u8] = b"not an experiment's";

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Files of a folder with what is in them, in order.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut all: Vec<_> = paths.map(|path| (path.clone(), std::fs::read(path).unwrap())).collect();
    all.sort();
    all
}

/// That a run is refused with a code of errors and of the process.
fn refused(arguments: &[&str], code: &str, exit: i32) {
    let output = experiments(arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains(&format!("code:     {code}")), "{arguments:?}: {said}");
    assert_eq!(output.status.code(), Some(exit), "{said}");
}

#[test]
fn a_run_is_kept_goes_on_and_is_not_mixed_with_another() {
    let folder = folder("calibration");
    let out = folder.join("run");
    let out = out.to_str().unwrap();
    let short = ["calibration", "--scenes", "1", "--duration", "12", "--out", out];
    let first = stdout(&short);
    assert!(first.contains("| recursive |"), "{first}");
    let records = std::fs::read_to_string(folder.join("run/calibration.jsonl")).unwrap();
    assert_eq!(records.lines().count(), 5);
    let read = |run: &str, file: &str| std::fs::read(folder.join(run).join(file)).unwrap();
    assert!(read("run", "calibration.md") == first.as_bytes());
    let figures = [
        "convergence.svg",
        "states.svg",
        "angles.svg",
        "angles-dense.svg",
        "angles-radarscenes.svg",
        "angles-radarscenes-dense.svg",
    ];
    for file in figures {
        let svg = String::from_utf8(read("run", file)).unwrap();
        // A path with a corner is a line of the figure; those of axes and grid have none.
        let mut paths = svg.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next());
        assert!(svg.starts_with("<svg") && paths.any(|path| path.contains('L')), "{file}");
    }
    // What is recorded is not run again, and says the same.
    let json = stdout(&[&short[..], &["--json"]].concat());
    assert!(read("run", "calibration.json") == json.as_bytes());
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["conditions"][0]["methods"].as_array().unwrap().len(), 16);
    assert_eq!(stdout(&short), first);
    assert_eq!(std::fs::read_to_string(folder.join("run/calibration.jsonl")).unwrap(), records);

    // In two parts, one after the other, and put together: the same files.
    let parts = folder.join("parts");
    let parts = parts.to_str().unwrap();
    for (part, records) in [("1/2", "2 records"), ("2/2", "2 records")] {
        let said = stdout(&[&short[..5], &["--out", parts, "--part", part]].concat());
        assert!(said.contains(records), "{said}");
    }
    let whole = folder.join("whole");
    let merge = ["merge", parts, "--out", whole.to_str().unwrap()];
    assert_eq!(stdout(&merge), first);
    // Records come in the order in which threads end; what they come to is the same to the byte.
    for file in ["calibration.md", "calibration.json", "calibration.brief.json", "calibration.csv"]
    {
        assert!(read("run", file) == read("whole", file), "{file}");
    }
    for file in figures {
        assert!(read("run", file) == read("whole", file), "{file}");
    }
    let sorted = |run: &str| {
        let text = String::from_utf8(read(run, "calibration.jsonl")).unwrap();
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        lines[1..].sort();
        lines
    };
    assert!(sorted("run") == sorted("whole"));
    let alone = experiments(&["calibration", "--part", "1/2"]);
    assert_eq!(alone.status.code(), Some(2));

    let other = experiments(&[&short[..], &["--seed", "2"]].concat());
    assert!(!other.status.success());
    let error = String::from_utf8(other.stderr).unwrap();
    assert!(error.contains("other-run"), "{error}");
    let none = experiments(&["calibration", "--scenes", "0"]);
    assert!(String::from_utf8(none.stderr).unwrap().contains("scenes"));
}

#[test]
fn an_experiment_takes_networks_and_keeps_their_records_apart() {
    let folder = folder("network-evaluates");
    let out = folder.join("run");
    let path = model("learned-pursuit");
    let short = ["--trials", "2", "--validation", "1", "--seed", "3", "--methods", "iaa"];
    let run = [&["aoa"], &short[..]].concat();
    let at = ["--out", out.to_str().unwrap()];
    let text = stdout(&[&run[..], &["--model", &path], &at].concat());
    for row in ["| iaa |", "| learned-pursuit |", "| learned-pursuit+refined |"] {
        assert!(text.contains(row), "{row} in {text}");
    }
    let records = std::fs::read_to_string(out.join("aoa-learned-pursuit.jsonl")).unwrap();
    let card: Value =
        serde_json::from_slice(&std::fs::read(path.replace(".onnx", ".json")).unwrap()).unwrap();
    assert!(records.lines().next().unwrap().contains(card["sha256"].as_str().unwrap()));
    // Nothing is run again, with another network added neither.
    let methods = std::fs::read(out.join("aoa.jsonl")).unwrap();
    let other = model("learned-pursuit-displaced");
    let both = stdout(&[&run[..], &["--model", &path, "--model", &other], &at].concat());
    assert!(both.contains("| learned-pursuit-displaced+refined |"), "{both}");
    assert_eq!(std::fs::read(out.join("aoa.jsonl")).unwrap(), methods);
    assert_eq!(std::fs::read_to_string(out.join("aoa-learned-pursuit.jsonl")).unwrap(), records);

    let wrong = experiments(&[&run[..], &["--model", &model("counting")], &at].concat());
    assert!(!wrong.status.success());
    let error = String::from_utf8(wrong.stderr).unwrap();
    assert!(error.contains("counting") && !error.contains("panicked"), "{error}");
}

#[test]
fn merged_records_are_not_written_onto_those_read() {
    let folder = folder("own-records");
    let out = text(&folder);
    let run = ["resolution", "--trials", "1", "--snapshots", "1", "--array", "ula4"];
    stdout(&[&run[..], &["--part", "1/1", "--out", out]].concat());
    let before = files(&folder);
    refused(&["merge", out, "--out", out, "--force"], "own-input", 2);
    assert!(files(&folder) == before);
}

#[test]
fn results_of_another_making_are_not_replaced_and_own_ones_are() {
    let folder = folder("results");
    let run = ["resolution", "--trials", "1", "--snapshots", "1", "--array", "ula4"];
    let figure = folder.join("resolution.svg");
    std::fs::write(&figure, MINE).unwrap();
    let run = [&run[..], &["--out", text(&folder)]].concat();
    refused(&run, "exists", 1);
    assert_eq!(files(&folder), [(figure.clone(), MINE.to_vec())]);
    stdout(&[&run[..], &["--force"]].concat());
    let first = files(&folder);
    assert!(first.len() > 4);
    // It goes on from its records, and its results are its own.
    std::fs::write(&figure, MINE).unwrap();
    stdout(&run);
    assert!(files(&folder) == first);
}
