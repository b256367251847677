//! Runs whose workers crash, hang or answer nonsense: each such log is a record, and the run continues.

#![cfg(unix)]

use boresight_core::Diagnose;
use boresight_fleet::job::{LogFile, Settings};
use boresight_fleet::run::{RunCounts, run};
use boresight_fleet::schema::SCHEMA;
use boresight_fleet::worker::Workers;
use boresight_fleet::{FleetError, Job, Record};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::process::Command;
use std::time::Duration;

/// A worker that does what the path of a log says, and otherwise answers with a record.
const WORKER: &str = r#"
echo ready
while read -r job; do
  key=${job#*'"key":"'}; key=${key%%'"'*}
  path=${job#*'"path":"'}; path=${path%%'"'*}
  [ "$leave" ] && exit 0
  echo accepted
  case $path in
    killed*) kill -9 $$ ;;
    exits*) exit 3 ;;
    hangs*) exec sleep 1000 ;;
    closes*) exec >&-; exec sleep 1000 ;;
    nonsense*) echo nonsense ;;
    stranger*) key=other ;;
    leaves*) leave=yes ;;
  esac
  printf '{"key":"%s","vehicle":"v","drive":"d","path":"%s","failed":' "$key" "$path"
  printf '{"code":"ran","message":"","what":"","expected":"","given":"%s"}}\n' $$
done
"#;

fn job(path: &str) -> Job {
    let name = path.to_owned();
    let files = vec![LogFile { name, bytes: 1, sha256: "00".repeat(32) }];
    let settings = Settings::default();
    let key = Job::key_of(&files, &settings);
    let [vehicle, drive] = ["v", "d"].map(String::from);
    Job { key, path: path.into(), vehicle, drive, time_s: None, files, settings, schema: SCHEMA }
}

fn workers(script: &'static str, time_limit: Duration) -> Workers<impl Fn() -> Command> {
    let command = move || {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    };
    Workers { command, time_limit }
}

fn records(
    paths: &[&str],
    threads: usize,
    time_limit: Duration,
) -> Result<Vec<Record>, FleetError> {
    let jobs = paths.iter().map(|path| Ok(job(path)));
    let mut all = vec![];
    let keep = |record: &Record| {
        all.push(record.clone());
        Ok(())
    };
    let workers = workers(WORKER, time_limit);
    let counts = run(jobs, threads, &workers, keep, |_| ControlFlow::Continue(()))?;
    assert_eq!(counts, RunCounts { done: 0, failed: paths.len() as u64 });
    Ok(all)
}

#[test]
fn a_log_that_ends_its_worker_is_a_record_and_the_others_are_run() {
    let paths = [
        "a", "killed", "b", "exits", "c", "closes", "d", "nonsense", "e", "stranger", "f",
        "leaves", "g", "h",
    ];
    for threads in [1, 3] {
        let found: BTreeMap<String, (String, String)> =
            records(&paths, threads, Duration::from_mins(1))
                .unwrap()
                .into_iter()
                .map(|record| {
                    let failed = record.failed.unwrap();
                    let given = if failed.code == "ran" { String::new() } else { failed.given };
                    (record.path, (failed.code, given))
                })
                .collect();
        assert_eq!(found.len(), paths.len());
        for (path, (code, given)) in &found {
            let expected = match &**path {
                "killed" | "closes" => ("crashed", "signal 9"),
                "exits" => ("crashed", "exit code 3"),
                "nonsense" | "stranger" => ("crashed", "an answer that is no record of the log"),
                _ => ("ran", ""),
            };
            assert_eq!((&**code, &**given), expected, "{path}");
        }
    }
}

#[test]
fn a_worker_is_kept_from_log_to_log() {
    let all = records(&["a", "b", "c"], 1, Duration::from_mins(1)).unwrap();
    let pids: Vec<String> = all.into_iter().map(|record| record.failed.unwrap().given).collect();
    assert!(pids.iter().all(|pid| *pid == pids[0]), "{pids:?}");
}

#[test]
fn a_log_that_hangs_times_out() {
    let all = records(&["hangs", "a"], 1, Duration::from_secs(1)).unwrap();
    let codes: Vec<&str> = all.iter().map(|r| &*r.failed.as_ref().unwrap().code).collect();
    assert_eq!(codes, ["timed-out", "ran"]);
    assert_eq!(all[0].failed.as_ref().unwrap().message, "hangs was not calibrated within 1 s");
}

#[test]
fn a_stop_ends_a_log_that_hangs_and_leaves_no_record_of_it() {
    // The run is stopped while the second log hangs, and while the worker of the second log has just ended, as by Ctrl-C.
    for second in ["hangs", "killed"] {
        let jobs = ["a", second].map(|path| Ok(job(path)));
        let mut kept = 0;
        let keep = |_: &Record| {
            kept += 1;
            Ok(())
        };
        let look = |counts: RunCounts| {
            if counts.all() == 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let workers = workers(WORKER, Duration::from_mins(1));
        let error = run(jobs.into_iter(), 1, &workers, keep, look).unwrap_err();
        assert_eq!((error.code(), kept), ("cancelled", 1), "{second}");
    }
}

#[test]
fn a_worker_that_does_not_start_is_no_fault_of_the_log() {
    for (script, given) in [("exit 7", "exit code 7"), ("echo hello", "hello"), ("", "exit code 0")]
    {
        let workers = workers(script, Duration::from_mins(1));
        let jobs = [Ok(job("a"))].into_iter();
        let keep = |_: &Record| -> Result<(), FleetError> { panic!("a record") };
        let error = run(jobs, 1, &workers, keep, |_| ControlFlow::Continue(())).unwrap_err();
        assert_eq!(error.code(), "worker");
        assert!(error.to_string().contains(given), "{error}");
    }
    let absent =
        Workers { command: || Command::new("/none/there"), time_limit: Duration::from_mins(1) };
    let keep = |_: &Record| Ok(());
    let error = run([Ok(job("a"))].into_iter(), 1, &absent, keep, |_| ControlFlow::Continue(()));
    assert_eq!(error.unwrap_err().code(), "file");
}
