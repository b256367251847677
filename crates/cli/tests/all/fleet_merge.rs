//! What the records of a fleet come to.

use crate::common::fleet::{DRIVES, lines, planned, records, text, unchecked, values};
use crate::common::{boresight, folder, stdout};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;

/// The folder of the plan and the records of the whole fleet.
fn whole() -> &'static (PathBuf, Vec<String>) {
    static WHOLE: OnceLock<(PathBuf, Vec<String>)> = OnceLock::new();
    WHOLE.get_or_init(|| {
        let top = folder(&format!("fleet-whole-{}", std::process::id()));
        let plan = planned(&top, &[]);
        stdout(&["fleet", "run", text(&plan), "--out", text(&top.join("records"))]);
        let records = records(&top.join("records"));
        (plan, records)
    })
}

fn code(output: &Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    let found = errors.lines().find_map(|line| line.trim().strip_prefix("code:"));
    found.unwrap_or_else(|| panic!("no error: {errors}")).trim().to_owned()
}

/// Records as a file in a folder of their own.
fn kept(name: &str, lines: &[String]) -> PathBuf {
    let path = folder(name).join("records.jsonl");
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    path
}

/// The notes of a merge.
fn notes(records: &Path) -> String {
    String::from_utf8(boresight(&["fleet", "merge", text(records)]).stderr).unwrap()
}

fn merged(records: &Path, further: &[&str]) -> Value {
    let out = stdout(&[&["fleet", "merge", text(records), "--json"], further].concat());
    serde_json::from_str(&out).unwrap()
}

#[test]
fn what_records_come_to_does_not_hang_on_parts_or_order() {
    let (plan, all) = whole();
    let top = folder("merge-parts");
    let results = |name: &str, sources: &[&str]| -> Vec<Vec<u8>> {
        let out = top.join(name);
        let arguments = ["fleet", "merge", "--plan", text(plan), "--out", text(&out)];
        stdout(&[&arguments[..], sources].concat());
        ["fleet.json", "drives.parquet", "radars.parquet"]
            .iter()
            .map(|name| std::fs::read(out.join(name)).unwrap())
            .collect()
    };
    let one = kept("merge-one", all);
    let expected = results("one", &[text(&one)]);
    let fleet: Value = serde_json::from_slice(&expected[0]).unwrap();
    assert_eq!(fleet["logs"]["done"], DRIVES.len());
    assert_eq!(fleet["vehicles"].as_array().unwrap().len(), 3);
    let car = &fleet["vehicles"][0];
    let names: Vec<&str> =
        car["drives"].as_array().unwrap().iter().map(|d| d["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["d1", "d2", "d10"], "numbers in names count");
    assert_eq!((&car["timed"], &car["drives"][2]["at"]), (&false.into(), &json!(2.0)));
    let radar = &car["radars"][1];
    assert_eq!(radar["source"], "joint");
    let alone = &radar["drives"];
    assert_eq!(alone.as_array().unwrap().len(), 3);
    // What three drives say together is better known than what one says.
    let sigma = |value: &Value| value["sigmaDeg"].as_f64().unwrap();
    assert!((0..3).all(|at| sigma(radar) < sigma(&alone[at])), "{radar}");
    let off = radar["angleDeg"].as_f64().unwrap() - radar["nominalDeg"].as_f64().unwrap();
    assert!(off.abs() < 4.0 * sigma(radar), "{off}");

    for parts in [2, 3, 7] {
        let files: Vec<PathBuf> = (0..parts)
            .map(|part| {
                let lines: Vec<String> =
                    all.iter().skip(part).step_by(parts).rev().cloned().collect();
                kept(&format!("merge-{part}-of-{parts}"), &lines)
            })
            .collect();
        let mut names: Vec<&str> = files.iter().map(|path| text(path)).collect();
        names.reverse();
        assert_eq!(results(&parts.to_string(), &names), expected, "{parts} parts");
    }
    let reversed: Vec<String> = all.iter().rev().cloned().collect();
    let other = kept("merge-reversed", &reversed);
    let folder = other.parent().unwrap();
    assert_eq!(results("reversed", &[text(folder), text(&other)]), expected);
    // However often a record is there, and whatever else is.
    let mut again = all.clone();
    again.extend(all.iter().take(3).cloned());
    again.push("\0".repeat(5000));
    let repeated = kept("merge-again", &again);
    std::fs::write(repeated.with_file_name("records-torn.jsonl"), &all[2][..40]).unwrap();
    assert_eq!(results("again", &[text(repeated.parent().unwrap())]), expected);
    let page = std::fs::read_to_string(top.join("one/report.html")).unwrap();
    assert!(page.contains("car1") && page.trim_end().ends_with("</html>"));
    // Results are not replaced unasked.
    let there = top.join("one");
    let again = ["fleet", "merge", text(&one), "--out", text(&there)];
    assert_eq!(code(&boresight(&again)), "exists");
    stdout(&[&again[..], &["--force"]].concat());
}

#[test]
fn every_record_is_counted_once() {
    let (plan, all) = whole();
    let mut lines = all.clone();
    lines.push(all[0].clone());
    // Failures of a log that was done elsewhere.
    let mut failed: Value = serde_json::from_str(&all[1]).unwrap();
    failed.as_object_mut().unwrap().remove("done").unwrap();
    failed["failed"] =
        json!({"code": "file", "message": "m", "what": "w", "expected": "e", "given": "g"});
    lines.insert(0, failed.to_string());
    lines.push(failed.to_string());
    let path = kept("merge-repeated", &lines);
    let torn = path.with_file_name("records-torn.jsonl");
    std::fs::write(&torn, &all[2][..40]).unwrap();
    let fleet = merged(path.parent().unwrap(), &["--plan", text(plan)]);
    let logs = &fleet["logs"];
    assert_eq!((&logs["done"], &logs["failed"]), (&7.into(), &0.into()));
    let notes = notes(path.parent().unwrap());
    assert!(notes.contains("3 records of logs that have another are counted once"), "{notes}");
    assert!(notes.contains("1 records are damaged or unfinished"), "{notes}");
    assert_eq!(fleet["vehicles"], merged(&kept("merge-plain", all), &[])["vehicles"]);

    // A copy of a log that was run without a plan: which of the two comes first changes nothing.
    let mut copy: Value = serde_json::from_str(&all[0]).unwrap();
    copy["path"] = json!("elsewhere");
    copy["drive"] = json!("a copy");
    let behind = [all.clone(), vec![copy.to_string()]].concat();
    let ahead = [vec![copy.to_string()], all.clone()].concat();
    let of = |name: &str, lines: &[String]| merged(&kept(name, lines), &[])["vehicles"].clone();
    assert_eq!(of("merge-copy-behind", &behind), of("merge-copy-ahead", &ahead));

    // Records of other plans.
    let short = folder("merge-short").join("jobs.jsonl");
    let jobs = crate::common::fleet::lines(plan);
    std::fs::write(&short, jobs[..5].join("\n") + "\n").unwrap();
    let fleet = merged(path.parent().unwrap(), &["--plan", text(&short)]);
    assert_eq!((&fleet["logs"]["done"], &fleet["logs"]["foreign"]), (&5.into(), &2.into()));

    // Logs without a record.
    let few = kept("merge-few", &all[..4]);
    let refused = boresight(&["fleet", "merge", text(&few), "--plan", text(plan)]);
    assert_eq!(code(&refused), "incomplete");
    assert!(String::from_utf8_lossy(&refused.stderr).contains("3 of 7 logs have no record"));
    let fleet = merged(&few, &["--plan", text(plan), "--partial"]);
    assert_eq!((&fleet["logs"]["done"], &fleet["logs"]["missing"]), (&4.into(), &3.into()));
}

#[test]
fn failures_are_counted_by_their_codes() {
    let (_, all) = whole();
    let mut lines = all[..5].to_vec();
    for (at, code) in [(3, "malformed-hdf5"), (4, "file"), (2, "malformed-hdf5")] {
        let mut failed: Value = serde_json::from_str(&lines[at]).unwrap();
        failed.as_object_mut().unwrap().remove("done").unwrap();
        let message = format!("message {at}");
        failed["failed"] =
            json!({"code": code, "message": message, "what": "", "expected": "", "given": ""});
        lines[at] = failed.to_string();
    }
    let path = kept("merge-failures", &lines);
    let fleet = merged(&path, &[]);
    assert_eq!((&fleet["logs"]["done"], &fleet["logs"]["failed"]), (&2.into(), &3.into()));
    let found: Vec<(&str, u64)> = fleet["failures"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| (f["code"].as_str().unwrap(), f["count"].as_u64().unwrap()))
        .collect();
    assert_eq!(found, [("malformed-hdf5", 2), ("file", 1)]);
    // All of them failed: there is no vehicle, and that is no error.
    let none = kept("merge-none", &lines[2..]);
    let fleet = merged(&none, &[]);
    assert_eq!(fleet["vehicles"], json!([]));
    assert!(stdout(&["fleet", "merge", text(&none)]).contains('3'));
}

#[test]
fn records_that_differ_or_are_none_are_refused() {
    let (_, all) = whole();
    let refused = |name: &str, lines: &[String]| {
        let output = boresight(&["fleet", "merge", text(&kept(name, lines))]);
        assert_eq!(output.status.code(), Some(1), "{name}");
        code(&output)
    };
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut record: Value = serde_json::from_str(&unchecked(&all[0])).unwrap();
        change(&mut record);
        record.to_string()
    };
    let angle = |value: Value| {
        changed(&|record| record["done"]["radars"][0]["result"]["angleDeg"] = value.clone())
    };
    let pair = |other: String| vec![all[0].clone(), other];
    assert_eq!(refused("merge-conflict", &pair(angle(json!(1.0)))), "conflict");
    let elsewhere = changed(&|record| record["vehicle"] = json!("another"));
    assert_eq!(refused("merge-vehicle", &pair(elsewhere)), "conflict");
    let odd = [
        unchecked(&all[0]).replacen("\"angleDeg\":", "\"angleDeg\":1e999, \"x\":", 1),
        angle(Value::Null),
        changed(&|record| record["done"]["radars"][0]["result"]["sigmaDeg"] = json!(-1.0)),
        changed(&|record| {
            record["done"]["radars"][0]["equations"]["priorInformation"][1] = json!(0)
        }),
        changed(&|record| record["done"]["radars"][0]["equations"]["right"] = json!([1.0])),
        changed(&|record| {
            record["failed"] =
                json!({"code": "", "message": "", "what": "", "expected": "", "given": ""})
        }),
        changed(&|record| drop(record.as_object_mut().unwrap().remove("done"))),
        "{}".into(),
        "no JSON".into(),
        "[".repeat(100_000),
    ];
    for (at, line) in odd.into_iter().enumerate() {
        assert_eq!(refused(&format!("merge-odd-{at}"), &pair(line)), "malformed-record", "{at}");
    }
    // What its checksum or its zeros show to be damaged is left out, and its log is missing.
    let (plan, _) = whole();
    let turned = all[0].replacen("\"angleDeg\":", "\"angleDeg\":1", 1);
    for (name, line) in [("merge-turned", turned), ("merge-zeros", "\0".repeat(4096))] {
        let mut lines = all.clone();
        lines[0] = line;
        let path = kept(name, &lines);
        let output = boresight(&["fleet", "merge", text(&path), "--plan", text(plan)]);
        assert_eq!(code(&output), "incomplete");
        let fleet = merged(&path, &["--plan", text(plan), "--partial"]);
        assert_eq!((&fleet["logs"]["done"], &fleet["logs"]["missing"]), (&6.into(), &1.into()));
        assert!(notes(&path).contains("1 records are damaged or unfinished"));
    }
    // A folder without records comes to nothing.
    let fleet = merged(&folder("merge-empty"), &[]);
    assert_eq!(fleet["logs"]["planned"], 0);
    assert_eq!(code(&boresight(&["fleet", "merge", "/none/there"])), "file");
}

#[test]
fn drives_with_times_lie_in_days() {
    let (plan, all) = whole();
    let mut jobs = values(&lines(plan));
    for job in &mut jobs {
        let number = job["drive"].as_str().unwrap()[1..].parse::<f64>().unwrap();
        job["timeS"] = json!(1.8e9 - 86_400.0 * number);
    }
    let timed = folder("merge-timed").join("jobs.jsonl");
    let text_of: Vec<String> = jobs.iter().map(Value::to_string).collect();
    std::fs::write(&timed, text_of.join("\n") + "\n").unwrap();
    let fleet = merged(&kept("merge-times", all), &["--plan", text(&timed)]);
    let car = &fleet["vehicles"][0];
    let drives: Vec<(&str, f64)> = car["drives"]
        .as_array()
        .unwrap()
        .iter()
        .map(|d| (d["name"].as_str().unwrap(), d["at"].as_f64().unwrap()))
        .collect();
    assert_eq!(drives, [("d10", 0.0), ("d2", 8.0), ("d1", 9.0)]);
    assert_eq!(car["timed"], true);
}

#[test]
fn options_are_checked_and_used() {
    let (_, all) = whole();
    let path = kept("merge-options", all);
    let wrong = boresight(&["fleet", "merge", text(&path), "--alarm", "-1"]);
    assert_eq!(wrong.status.code(), Some(2));
    let alignment = |alarm: &str| {
        let fleet = merged(&path, &["--alarm", alarm]);
        fleet["vehicles"][0]["radars"][0]["alignment"].as_str().unwrap().to_owned()
    };
    assert_eq!(alignment("5"), "aligned");
    assert_ne!(alignment("0.001"), "aligned");
    // Each drive has a scale of its own.
    let fleet = merged(&path, &["--joint-scale", "drive"]);
    let car = &fleet["vehicles"][0];
    assert!(car["shared"]["scale"].is_null() && car["drives"][0]["own"]["scale"].is_f64(), "{car}");
    let fleet = merged(&path, &[]);
    let car = &fleet["vehicles"][0];
    assert!(car["shared"]["scale"].is_f64() && car["drives"][0]["own"]["scale"].is_null(), "{car}");
    assert!(car["drives"][0]["own"]["biasDegps"].is_f64());
}
