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
        assert!(svg.starts_with("<svg") && svg.contains("<polyline"), "{file}");
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
    let alone = boresight(&["evaluate", "calibration", "--part", "1/2"]);
    assert_eq!(alone.status.code(), Some(2));

    let other = boresight(&[&short[..], &["--seed", "2"]].concat());
    assert!(!other.status.success());
    let error = String::from_utf8(other.stderr).unwrap();
    assert!(error.contains("other-run"), "{error}");
    let none = boresight(&["evaluate", "calibration", "--scenes", "0"]);
    assert!(String::from_utf8(none.stderr).unwrap().contains("scenes"));
}

#[test]
fn drives_from_files_are_cut_into_pieces_and_taken_up_again() {
    let folder = folder("evaluate-drives");
    let drives = folder.join("drives");
    for seed in ["1", "2"] {
        let drive = drives.join(format!("drive-{seed}"));
        let simulated = [
            "simulate",
            "drive",
            "--duration",
            "14",
            "--seed",
            seed,
            "--scenario",
            "city",
            "--out",
        ];
        stdout(&[&simulated[..], &[drive.to_str().unwrap()]].concat());
    }
    let out = folder.join("run");
    let run = [
        "evaluate",
        "calibration",
        "--drives",
        drives.to_str().unwrap(),
        "--pieces",
        "6,12",
        "--out",
        out.to_str().unwrap(),
    ];
    let first = stdout(&run);
    assert!(
        first.contains("# 2 drives from files") && first.contains("## Pieces of 12 s"),
        "{first}"
    );
    let records = std::fs::read_to_string(out.join("calibration-drives.jsonl")).unwrap();
    assert_eq!(records.lines().count(), 3);
    let json: Value = serde_json::from_str(&stdout(&[&run[..], &["--json"]].concat())).unwrap();
    assert_eq!(json["lengths"][0]["radars"].as_array().unwrap().len(), 4);
    assert_eq!(std::fs::read_to_string(out.join("calibration-drives.jsonl")).unwrap(), records);
    // A folder without drives says what is wrong with which.
    let empty = folder.join("empty");
    std::fs::create_dir_all(empty.join("nothing")).unwrap();
    let refused = boresight(&["evaluate", "calibration", "--drives", empty.to_str().unwrap()]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && said.contains("drive nothing"), "{said}");
}
