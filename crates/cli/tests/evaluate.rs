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
    let read = |run: &str, file: &str| std::fs::read(folder.join(run).join(file)).unwrap();
    assert!(read("run", "calibration.md") == first.as_bytes());
    for file in ["convergence.svg", "angles.svg", "angles-dense.svg"] {
        let svg = String::from_utf8(read("run", file)).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("<polyline"), "{file}");
    }
    // What is recorded is not run again, and says the same.
    let json = stdout(&[&short[..], &["--json"]].concat());
    assert!(read("run", "calibration.json") == json.as_bytes());
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["conditions"][0]["methods"].as_array().unwrap().len(), 11);
    assert_eq!(stdout(&short), first);
    assert_eq!(std::fs::read_to_string(folder.join("run/calibration.jsonl")).unwrap(), records);

    // In two parts, one after the other, and put together: the same files.
    let parts = folder.join("parts");
    let parts = parts.to_str().unwrap();
    for (part, records) in [("1/2", "1 records"), ("2/2", "1 records")] {
        let said = stdout(&[&short[..6], &["--out", parts, "--part", part]].concat());
        assert!(said.contains(records), "{said}");
    }
    let whole = folder.join("whole");
    let merge = ["evaluate", "merge", parts, "--out", whole.to_str().unwrap()];
    assert_eq!(stdout(&merge), first);
    // Records come in the order in which threads end; what they come to is the same to the byte.
    for file in ["calibration.md", "calibration.json", "calibration.brief.json", "calibration.csv"]
    {
        assert!(read("run", file) == read("whole", file), "{file}");
    }
    for file in ["angles.svg", "angles-dense.svg", "convergence.svg"] {
        assert!(read("run", file) == read("whole", file), "{file}");
    }
    let sorted = |run: &str| {
        let text = String::from_utf8(read(run, "calibration.jsonl")).unwrap();
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        lines[1..].sort();
        lines
    };
    assert!(sorted("run") == sorted("whole"));
    let alone = boresight(&["evaluate", "calibration", "--part", "1/2"]);
    assert_eq!(alone.status.code(), Some(2));

    let other = boresight(&[&short[..], &["--seed", "2"]].concat());
    assert!(!other.status.success());
    let error = String::from_utf8(other.stderr).unwrap();
    assert!(error.contains("other-run"), "{error}");
    let none = boresight(&["evaluate", "calibration", "--scenes", "0"]);
    assert!(String::from_utf8(none.stderr).unwrap().contains("scenes"));
}
