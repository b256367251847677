//! `boresight evaluate` as a user runs it.

#![allow(clippy::unwrap_used)]

mod common;

use common::{boresight, folder, stdout};
use serde_json::Value;

#[test]
fn a_run_is_kept_goes_on_and_is_not_mixed_with_another() {
    let folder = folder("evaluate");
    let out = folder.join("run");
    let out = out.to_str().unwrap();
    let short = ["evaluate", "calibration", "--scenes", "1", "--duration", "12", "--out", out];
    let first = stdout(&short);
    assert!(first.contains("| recursive |"), "{first}");
    let records = std::fs::read_to_string(folder.join("run/calibration.jsonl")).unwrap();
    assert_eq!(records.lines().count(), 3);
    for file in ["calibration.md", "calibration.json", "convergence.svg", "angles.svg"] {
        assert!(folder.join("run").join(file).metadata().unwrap().len() > 500, "{file}");
    }
    // What is recorded is not run again, and says the same.
    let json: Value = serde_json::from_str(&stdout(&[&short[..], &["--json"]].concat())).unwrap();
    assert_eq!(json["conditions"][0]["methods"].as_array().unwrap().len(), 11);
    assert_eq!(stdout(&short), first);
    assert_eq!(std::fs::read_to_string(folder.join("run/calibration.jsonl")).unwrap(), records);

    let other = boresight(&[&short[..], &["--seed", "2"]].concat());
    assert!(!other.status.success());
    let error = String::from_utf8(other.stderr).unwrap();
    assert!(error.contains("other-run"), "{error}");
    let none = boresight(&["evaluate", "calibration", "--scenes", "0"]);
    assert!(String::from_utf8(none.stderr).unwrap().contains("scenes"));
}
