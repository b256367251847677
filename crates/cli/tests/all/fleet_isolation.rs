//! Logs that hang or exhaust the memory while a fleet runs.

#![cfg(target_os = "linux")]

use crate::common::fleet::{lines, logs, planned, records, text, values};
use crate::common::{folder, stdout};
use serde_json::Value;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

/// The code of each log's record, by drive, in the order of the file.
fn codes(path: &Path) -> Vec<(String, String)> {
    let text = |value: &Value| value.as_str().unwrap_or("done").to_owned();
    let all = values(&lines(path));
    all.iter().map(|record| (text(&record["drive"]), text(&record["failed"]["code"]))).collect()
}

/// The one process that another has started, unless it has ended.
fn child_of(parent: u32) -> Option<String> {
    let mut found = std::fs::read_dir("/proc").unwrap().filter_map(|entry| {
        let entry = entry.unwrap();
        let stat = std::fs::read_to_string(entry.path().join("stat")).ok()?;
        // The name, in brackets, may hold anything; the state and the parent follow.
        let mut fields = stat.rsplit_once(") ")?.1.split(' ');
        let runs = !["Z", "X"].contains(&fields.next()?);
        (runs && fields.next()? == parent.to_string())
            .then(|| entry.file_name().into_string().unwrap())
    });
    let first = found.next();
    assert_eq!(found.next(), None, "one worker");
    first
}

/// A stopped worker cannot be told from one that computes forever.
#[test]
fn a_log_that_hangs_is_a_record_and_the_next_is_run() {
    let top = folder("fleet-hangs");
    let plan = lines(&planned(&top, &[]));
    let mut run = Command::new(env!("CARGO_BIN_EXE_boresight"))
        .args(["fleet", "run", "-", "--threads", "1", "--time-limit", "2"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = run.stdin.take().unwrap();
    let mut output = BufReader::new(run.stdout.take().unwrap());
    let mut next = |job: &str| {
        writeln!(input, "{job}").unwrap();
        let mut line = String::new();
        output.read_line(&mut line).unwrap();
        serde_json::from_str::<Value>(&line).unwrap()
    };
    assert!(next(&plan[0])["done"].is_object());
    let worker = || child_of(run.id());
    let first = worker().unwrap();
    assert!(Command::new("kill").args(["-STOP", &first]).status().unwrap().success());
    let hung = next(&plan[1]);
    assert_eq!(hung["failed"]["code"], "timed-out", "{hung}");
    assert!(next(&plan[2])["done"].is_object());
    let second = worker().unwrap();
    assert_ne!(second, first);
    // A worker that dies between two logs is the fault of neither.
    assert!(Command::new("kill").args(["-KILL", &second]).status().unwrap().success());
    while worker().is_some() {
        std::thread::yield_now();
    }
    assert!(next(&plan[3])["done"].is_object());
    drop(input);
    assert!(run.wait().unwrap().success());
}

#[test]
fn a_log_that_exhausts_the_memory_is_a_record_until_it_is_run_again() {
    let top = folder("fleet-memory");
    let large = top.join("car9").join("large");
    std::fs::create_dir_all(&large).unwrap();
    // Small to read and large once it is parsed: allocations of the parser end in an abort.
    let rows: String = (1_000_000..3_000_000).map(|time| format!("{time},1,0\n")).collect();
    let table = "time_s,azimuth_rad,range_rate_mps\n".to_owned() + &rows;
    std::fs::write(large.join("a.csv"), table).unwrap();
    let few: Vec<_> = logs().into_iter().take(2).collect();
    let mut list = String::new();
    for path in [&few[0], &large, &few[1]] {
        writeln!(list, "{}", text(path)).unwrap();
    }
    let listed = top.join("list.txt");
    std::fs::write(&listed, list).unwrap();
    let (plan, out) = (top.join("jobs.jsonl"), top.join("out"));
    stdout(&["fleet", "plan", "--list", text(&listed), "--out", text(&plan)]);
    let run = |further: &[&str]| {
        let all = ["fleet", "run", text(&plan), "--out", text(&out), "--threads", "1"];
        stdout(&[&all[..], further].concat())
    };
    let told = run(&["--memory-limit", "250"]);
    assert!(told.contains("2 logs calibrated, 1 failed"), "{told}");
    let file = out.join("records.jsonl");
    let crashed = ("large".to_owned(), "crashed".to_owned());
    assert_eq!(codes(&file).iter().filter(|found| **found == crashed).count(), 1);
    // Later runs leave it alone, unless they are asked to.
    let told = run(&[]);
    assert!(told.contains("0 logs calibrated, 0 failed, 3 had a record"), "{told}");
    std::fs::write(large.join("a.csv"), "time_s\n").unwrap();
    let told = run(&["--retry"]);
    assert!(told.contains("0 logs calibrated, 1 failed, 2 had a record"), "{told}");
    assert!(codes(&file).contains(&("large".to_owned(), "changed".to_owned())));
    assert_eq!(records(&out).len(), 4);
}
