//! Plans of fleets, and running them.

use crate::common::fleet::{DRIVES, fleet, lines, logs, planned, records, text, values};
use crate::common::{boresight, folder, stdout};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// The code of the error that a run ended with.
fn code(output: &Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    let found = errors.lines().find_map(|line| line.trim().strip_prefix("code:"));
    found.unwrap_or_else(|| panic!("no error: {errors}")).trim().to_owned()
}

fn fed(arguments: &[&str], input: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_boresight"));
    let piped = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = piped.stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

/// Runs a plan into a folder.
fn run(plan: &Path, out: &Path, further: &[&str]) -> String {
    stdout(&[&["fleet", "run", text(plan), "--out", text(out)], further].concat())
}

#[test]
fn a_plan_names_vehicles_and_drives_by_paths_and_leaves_copies_out() {
    let top = folder("fleet-plan");
    let plan = planned(&top, &["--min-speed", "3", "--azimuth-sigma", "0.4"]);
    let jobs = values(&lines(&plan));
    let names: Vec<(&str, &str)> = jobs
        .iter()
        .map(|job| (job["vehicle"].as_str().unwrap(), job["drive"].as_str().unwrap()))
        .collect();
    let mut expected = DRIVES.to_vec();
    expected.sort_unstable();
    assert_eq!(names, expected);
    let settings = &jobs[0]["settings"]["calibration"];
    assert_eq!(settings["minSpeedMps"], 3.0);
    assert!((settings["azimuthSigmaDeg"].as_f64().unwrap() - 0.4).abs() < 1e-12);
    assert_eq!(settings.as_object().unwrap().len(), 2, "options that are not given are not told");
    let files: Vec<&str> =
        jobs[0]["files"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    assert_eq!(files, ["radar_data.h5", "scenes.json", "sensors.json"]);

    // A copy of a log elsewhere in the same vehicle's folder is the same job; as another vehicle's it is an error.
    let copy = |vehicle: &str| {
        let to = top.join(vehicle).join("copy");
        std::fs::create_dir_all(&to).unwrap();
        for name in &files {
            std::fs::copy(fleet().join("car1/d1").join(name), to.join(name)).unwrap();
        }
        to
    };
    let (own, foreign) = (copy("car1"), copy("car9"));
    let d1 = fleet().join("car1/d1");
    let told = boresight(&["fleet", "plan", text(&d1), text(&own)]);
    assert_eq!(String::from_utf8_lossy(&told.stdout).lines().count(), 1);
    assert!(String::from_utf8_lossy(&told.stderr).contains("1 log is a copy"), "{told:?}");
    assert_eq!(code(&boresight(&["fleet", "plan", text(&d1), text(&foreign)])), "conflict");
    // Other settings make another job of the same log.
    let key = |further: &[&str]| {
        let out = stdout(&[&["fleet", "plan", text(&d1)], further].concat());
        values(&[out])[0]["key"].clone()
    };
    assert_eq!(key(&[]), key(&["--vehicle", "any name"]));
    assert_ne!(key(&[]), key(&["--min-speed", "3"]));
    assert_ne!(key(&[]), key(&["--sensor", "2"]));
}

#[test]
fn names_and_times_come_from_patterns_and_lists() {
    let d1 = fleet().join("car1/d1");
    let job = |out: Output| values(&[String::from_utf8(out.stdout).unwrap()])[0].clone();
    let by = |pattern: &str| boresight(&["fleet", "plan", text(&d1), "--vehicle", pattern]);
    assert_eq!(job(by("lone wolf"))["vehicle"], "lone wolf");
    let found = job(by("car{vehicle}/d*"));
    assert_eq!((found["vehicle"].as_str(), found["drive"].as_str()), (Some("1"), Some("d1")));
    assert_eq!(code(&by("{vehicle}/e*")), "name");
    assert_eq!(code(&by("{car}/{drive}")), "name");
    let listed =
        serde_json::json!({"path": text(&d1), "vehicle": "v", "drive": "x", "timeS": 1.8e9});
    let list = format!("{listed}\n\n{}\n", text(&fleet().join("car2/d2")));
    let told = fed(&["fleet", "plan", "--list", "-"], &list);
    let jobs = values(
        &String::from_utf8(told.stdout).unwrap().lines().map(Into::into).collect::<Vec<_>>(),
    );
    assert_eq!((&jobs[0]["vehicle"], &jobs[0]["timeS"]), (&"v".into(), &1.8e9.into()));
    assert_eq!(jobs[1]["vehicle"], "car2");
    assert!(jobs[1].get("timeS").is_none());
    assert_eq!(code(&fed(&["fleet", "plan", "--list", "-"], "{\"pth\": 1}\n")), "malformed-plan");
    assert_eq!(code(&boresight(&["fleet", "plan", "/none/there"])), "file");
    assert_eq!(boresight(&["fleet", "plan"]).status.code(), Some(2));
}

#[test]
fn records_are_the_same_in_any_number_of_parts_and_any_order() {
    let top = folder("fleet-parts");
    let plan = planned(&top, &[]);
    let whole = top.join("whole");
    let told = run(&plan, &whole, &["--threads", "1"]);
    assert!(told.contains("7 logs calibrated, 0 failed, 0 had a record"), "{told}");
    let expected = records(&whole);
    assert_eq!(expected.len(), DRIVES.len());
    let done = values(&expected);
    let radars = done[0]["done"]["radars"].as_array().unwrap();
    assert_eq!(radars.len(), 4);
    assert!(radars[0]["result"]["angleDeg"].is_f64(), "{}", done[0]);
    assert_eq!(radars[0]["equations"]["right"].as_array().unwrap().len(), 5);
    // The angle is that of `calibrate`.
    let path = done[0]["path"].as_str().unwrap();
    let mut alone: Vec<serde_json::Value> =
        serde_json::from_str(&stdout(&["calibrate", path, "--json"])).unwrap();
    alone[0].as_object_mut().unwrap().remove("outlook").unwrap();
    assert_eq!(alone[0], radars[0]["result"]);

    let mut shuffled = lines(&plan);
    shuffled.reverse();
    shuffled.swap(1, 4);
    let other = top.join("shuffled.jsonl");
    std::fs::write(&other, shuffled.join("\n") + "\n").unwrap();
    for (name, plan, parts) in [("two", &plan, 2), ("three", &other, 3), ("seven", &plan, 7)] {
        let out = top.join(name);
        for part in (1..=parts).rev() {
            run(plan, &out, &["--threads", "3", "--part", &format!("{part}/{parts}")]);
        }
        assert_eq!(std::fs::read_dir(&out).unwrap().count(), parts);
        assert_eq!(records(&out), expected, "{name}");
    }
    // A plan that lies beside records is none of them.
    std::fs::copy(&plan, top.join("seven/jobs.jsonl")).unwrap();
    assert_eq!(records(&top.join("seven")), expected);
    // Who goes on with another number of parts runs nothing again.
    let told = run(&other, &top.join("seven"), &["--part", "1/1"]);
    assert!(told.contains("0 logs calibrated, 0 failed, 7 had a record"), "{told}");
    // As a worker does.
    let worked = fed(&["fleet", "run", "-"], &std::fs::read_to_string(&other).unwrap());
    let mut worked: Vec<String> =
        String::from_utf8(worked.stdout).unwrap().lines().map(Into::into).collect();
    worked.sort();
    assert_eq!(worked, expected);
}

#[test]
fn schedulers_name_the_part() {
    let top = folder("fleet-auto");
    let plan = planned(&top, &[]);
    let out = top.join("out");
    let mut command = Command::new(env!("CARGO_BIN_EXE_boresight"));
    command.args(["fleet", "run", text(&plan), "--out", text(&out), "--part", "auto"]);
    for name in ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "CONDOR_PROCESS", "_CONDOR_JOB_AD"]
    {
        command.env_remove(name);
    }
    let refused = command.output().unwrap();
    assert_eq!((code(&refused).as_str(), refused.status.code()), ("option", Some(2)));
    command.envs([("JOB_COMPLETION_INDEX", "6"), ("JOB_COMPLETIONS", "7")]);
    assert!(command.output().unwrap().status.success());
    assert_eq!(lines(&out.join("records-7-of-7.jsonl")).len(), 1);
}

#[cfg(unix)]
#[test]
fn a_run_that_was_killed_or_stopped_goes_on_and_loses_nothing() {
    let top = folder("fleet-killed");
    let plan = planned(&top, &[]);
    let whole = top.join("whole");
    run(&plan, &whole, &[]);
    for (name, signal) in [("killed", "-KILL"), ("stopped", "-INT")] {
        let out = top.join(name);
        let file = out.join("records.jsonl");
        let mut child = Command::new(env!("CARGO_BIN_EXE_boresight"))
            .args(["fleet", "run", text(&plan), "--out", text(&out), "--threads", "1"])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let waited = Instant::now();
        while !std::fs::read(&file).is_ok_and(|bytes| bytes.contains(&b'\n')) {
            assert!(waited.elapsed() < Duration::from_mins(2), "no record");
            std::thread::sleep(Duration::from_millis(2));
        }
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        let status = child.wait().unwrap();
        let left = lines(&file).len();
        assert!(left < DRIVES.len(), "{name}: it ended before it was to");
        if signal == "-INT" {
            assert_eq!(status.code(), Some(130));
            values(&lines(&file));
        }
        // What a process that is killed while it writes leaves.
        let mut torn = std::fs::OpenOptions::new().append(true).open(&file).unwrap();
        torn.write_all(b"{\"key\":\"00").unwrap();
        let told = run(&plan, &out, &[]);
        assert!(told.contains("had a record"), "{told}");
        assert_eq!(records(&out), records(&whole), "{name}");
    }
}

#[test]
fn what_fails_is_a_record_and_runs_again_when_asked() {
    let top = folder("fleet-failures");
    let copied = |name: &str| {
        let to = top.join("car").join(name);
        std::fs::create_dir_all(&to).unwrap();
        for file in ["radar_data.h5", "scenes.json", "sensors.json"] {
            std::fs::copy(logs()[0].join(file), to.join(file)).unwrap();
        }
        to
    };
    let all = ["changed", "corrupt", "gone", "grown"].map(copied);
    let [changed, corrupt, gone, grown] = &all;
    std::fs::write(corrupt.join("radar_data.h5"), b"no HDF5 at all").unwrap();
    // Four logs that differ.
    for (log, text) in [(changed, "1"), (gone, "2"), (grown, "3")] {
        std::fs::write(log.join("note.json"), text).unwrap();
    }
    let plan = top.join("jobs.jsonl");
    let paths = all.each_ref().map(|path| text(path));
    stdout(&[&["fleet", "plan", "--out", text(&plan)], &paths[..]].concat());
    let kept = std::fs::read(changed.join("scenes.json")).unwrap();
    std::fs::write(changed.join("scenes.json"), b"{}").unwrap();
    std::fs::write(grown.join("more.csv"), b"a,b\n").unwrap();
    std::fs::remove_dir_all(gone).unwrap();
    let out = top.join("out");
    let told = run(&plan, &out, &[]);
    assert!(told.contains("0 logs calibrated, 4 failed"), "{told}");
    let codes = || -> Vec<(String, String)> {
        let mut all: Vec<_> = values(&lines(&out.join("records.jsonl")))
            .iter()
            .map(|record| {
                let text = |value: &serde_json::Value| value.as_str().unwrap_or("done").to_owned();
                (text(&record["drive"]), text(&record["failed"]["code"]))
            })
            .collect();
        all.sort();
        all
    };
    let found = codes();
    let expected =
        [("changed", "changed"), ("corrupt", "malformed"), ("gone", "file"), ("grown", "changed")];
    for ((drive, code), (name, begins)) in found.iter().zip(expected) {
        assert!(drive == name && code.starts_with(begins), "{found:?}");
    }
    // Failures count as done, until they are to run again.
    assert!(run(&plan, &out, &[]).contains("0 logs calibrated, 0 failed, 4 had a record"));
    std::fs::write(changed.join("scenes.json"), kept).unwrap();
    let told = run(&plan, &out, &["--retry"]);
    assert!(told.contains("1 logs calibrated, 3 failed, 0 had a record"), "{told}");
    assert!(codes().contains(&("changed".into(), "done".into())));
    let told = run(&plan, &out, &["--retry"]);
    assert!(told.contains("0 logs calibrated, 3 failed, 1 had a record"), "{told}");
}

#[test]
fn plans_that_were_edited_or_are_none_are_refused() {
    let top = folder("fleet-edited");
    let plan = planned(&top, &[]);
    let mut jobs = lines(&plan);
    let refused = |jobs: &[String]| {
        let input = jobs.join("\n") + "\n";
        let output = fed(&["fleet", "run", "-", "--threads", "1"], &input);
        assert_eq!(output.status.code(), Some(1));
        (code(&output), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let whole = jobs[0].clone();
    jobs[0] = whole.replace("\"settings\":{}", "\"settings\":{\"sensor\":2}");
    assert_ne!(jobs[0], whole);
    assert_eq!(refused(&jobs[..1]).0, "edited-plan");
    jobs[0] = whole.replace("\"vehicle\"", "\"veicle\"");
    let (found, message) = refused(&jobs[..1]);
    assert!(found == "malformed-plan" && message.contains("line 1"), "{message}");
    jobs[0] = whole[..40].into();
    assert_eq!(refused(&jobs).0, "malformed-plan");
    // Names, places and times may be changed.
    jobs[0] = whole.replace("car1", "another car");
    let output = fed(&["fleet", "run", "-"], &jobs[0]);
    let record = values(&[String::from_utf8(output.stdout).unwrap()]).remove(0);
    assert_eq!(record["vehicle"], "another car");
    assert_eq!(record["failed"]["code"], "file", "the path was changed as well");
}

#[test]
fn records_that_are_damaged_are_run_again() {
    let top = folder("fleet-damaged");
    let plan = planned(&top, &[]);
    let (out, whole) = (top.join("out"), top.join("whole"));
    run(&plan, &whole, &[]);
    let file = out.join("records.jsonl");
    let kept = lines(&whole.join("records.jsonl"));
    let zeros = "\0".repeat(4096);
    let half = |line: &str| line[line.len() / 2..].to_owned();
    // A block of zeros behind the records, over the end of one and the beginning of the next, and over all of them; and a byte that was turned.
    for (damaged, had) in [
        ([&kept[..3].join("\n"), "\n", &zeros].concat(), 3),
        (
            [&kept[0], "\n", &kept[1][..90], &zeros, &half(&kept[2]), "\n", &kept[3], "\n"]
                .concat(),
            2,
        ),
        (zeros.clone(), 0),
        ([&zeros, "\n", &kept[0], "\n"].concat(), 1),
        (kept.join("\n").replacen("\"sensor\":1", "\"sensor\":9", 1) + "\n", 6),
    ] {
        std::fs::create_dir_all(&out).unwrap();
        std::fs::write(&file, &damaged).unwrap();
        let told = run(&plan, &out, &[]);
        let expected = format!("{} logs calibrated, 0 failed, {had} had a record", 7 - had);
        assert!(told.contains(&expected), "{told}");
        stdout(&["fleet", "merge", text(&out), "--plan", text(&plan)]);
        assert!(run(&plan, &out, &[]).contains("7 had a record"));
    }
}

#[test]
fn files_of_others_are_left_as_they_are() {
    let top = folder("fleet-foreign");
    let plan = planned(&top, &[]);
    let out = top.join("out");
    std::fs::create_dir_all(&out).unwrap();
    let file = out.join("records.jsonl");
    let elsewhere = top.join("elsewhere.txt");
    let first = ["fleet", "run", text(&plan), "--out", text(&out)];
    for content in [
        "one line without an end",
        "{\"key\":\"of something else\"}",
        "{\"a\":1}\n{\"b\":",
        "a,b\n1,2\n3,",
        "\0\0\nPAR1",
    ] {
        for linked in [false, true] {
            let _ = std::fs::remove_file(&file);
            std::fs::write(&elsewhere, content).unwrap();
            if linked {
                #[cfg(unix)]
                std::os::unix::fs::symlink(&elsewhere, &file).unwrap();
                #[cfg(not(unix))]
                continue;
            } else {
                std::fs::write(&file, content).unwrap();
            }
            assert_eq!(code(&boresight(&first)), "exists", "{content:?}");
            assert_eq!(std::fs::read_to_string(&file).unwrap(), content);
            assert_eq!(std::fs::read_to_string(&elsewhere).unwrap(), content);
        }
    }
    std::fs::remove_file(&file).unwrap();
    std::fs::write(&file, "one line without an end").unwrap();
    let told = stdout(&[&first[..], &["--force"]].concat());
    assert!(told.contains("7 logs calibrated"), "{told}");
    // Records that are there are the run's own, with --force too.
    let told = stdout(&[&first[..], &["--force"]].concat());
    assert!(told.contains("7 had a record"), "{told}");
}

#[cfg(unix)]
#[test]
fn pipes_are_no_logs_and_no_files_of_records() {
    let top = folder("fleet-pipes");
    let log = top.join("car/log");
    std::fs::create_dir_all(&log).unwrap();
    let pipe = |path: &Path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    let (inside, alone) = (log.join("a.csv"), top.join("car/b.csv"));
    pipe(&inside);
    pipe(&alone);
    for path in [&log, &alone] {
        let output = boresight(&["fleet", "plan", text(path)]);
        assert_eq!(code(&output), "file");
        assert!(String::from_utf8_lossy(&output.stderr).contains("no regular file"));
    }
    let plan = planned(&top, &[]);
    let out = top.join("out");
    assert_eq!(code(&boresight(&["fleet", "run", text(&alone), "--out", text(&out)])), "file");
    assert!(!out.exists());
    std::fs::create_dir_all(&out).unwrap();
    pipe(&out.join("records.jsonl"));
    assert_eq!(code(&boresight(&["fleet", "run", text(&plan), "--out", text(&out)])), "file");
}

#[test]
fn two_runs_do_not_write_to_one_file() {
    let top = folder("fleet-busy");
    let plan = planned(&top, &[]);
    let out = top.join("out");
    std::fs::create_dir_all(&out).unwrap();
    let file = std::fs::File::create(out.join("records-1-of-2.jsonl")).unwrap();
    file.try_lock().unwrap();
    let first = ["fleet", "run", text(&plan), "--out", text(&out), "--part", "1/2"];
    let output = boresight(&first);
    assert_eq!((code(&output).as_str(), output.status.code()), ("busy", Some(1)));
    run(&plan, &out, &["--part", "2/2"]);
    file.unlock().unwrap();
    run(&plan, &out, &["--part", "1/2"]);
    assert_eq!(records(&out).len(), DRIVES.len());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_what_was_there_stays() {
    let top = folder("fleet-full");
    let plan = planned(&top, &[]);
    let out = top.join("out");
    // A limit on the size of files, which ends in an error and no signal: room for two records.
    run(&plan, &out, &["--threads", "1", "--part", "1/7"]);
    let record = std::fs::metadata(out.join("records-1-of-7.jsonl")).unwrap().len();
    std::fs::remove_dir_all(&out).unwrap();
    let blocks = 5 * record / 2 / 512;
    let script = format!(
        "trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" fleet run \"$1\" --out \"$2\" --threads 1"
    );
    let output = Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_boresight"), text(&plan), text(&out)])
        .output()
        .unwrap();
    assert_eq!((code(&output).as_str(), output.status.code()), ("disk-full", Some(1)));
    let left = values(&lines(&out.join("records.jsonl"))).len();
    assert!((1..=2).contains(&left), "{left}");
    run(&plan, &out, &[]);
    assert_eq!(records(&out).len(), DRIVES.len());
    // The same of a disk behind the standard output.
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_boresight"))
        .args(["fleet", "run", text(&plan)])
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(code(&output), "disk-full");
}
