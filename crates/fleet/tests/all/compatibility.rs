//! Plans and records of earlier releases, as they were written, and lines of later ones.

use boresight_core::Diagnose;
use boresight_fleet::gather::{Gathered, gather};
use boresight_fleet::schema::SCHEMA;
use boresight_fleet::store::{Store, keys_of};
use boresight_fleet::{Fleet, FleetError, FleetOptions, Job, Jobs, merge};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The formats so far, each with a plan of four logs, three of which were calibrated. A release that changes a format adds a folder.
const FORMATS: [&str; 2] = ["unversioned", "schema-1"];

fn fixtures(format: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(format)
}

fn plan(format: &str) -> Vec<Job> {
    let path = fixtures(format).join("jobs.jsonl");
    Jobs::new(BufReader::new(File::open(&path).unwrap()), &path).map(Result::unwrap).collect()
}

fn gathered(format: &str, plan: &[Job]) -> Result<Gathered, FleetError> {
    gather(&[fixtures(format).join("records.jsonl")], Some(plan), false)
}

fn merged(gathered: Gathered) -> Fleet {
    merge::merge(gathered, &FleetOptions::default(), 1).unwrap()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

#[test]
fn every_format_so_far_is_read_and_comes_to_the_same() {
    let of = |format: &str| merged(gathered(format, &plan(format)).unwrap());
    let expected = of(FORMATS[FORMATS.len() - 1]);
    assert_eq!((expected.logs.planned, expected.logs.done, expected.logs.failed), (4, 3, 1));
    let angle = expected.vehicles[0].radars[1].angle_rad.to_degrees();
    assert!((angle - -25.0).abs() < 0.2, "{angle}");
    for format in FORMATS {
        assert!(format!("{:?}", of(format)) == format!("{expected:?}"), "{format}");
    }
}

#[test]
fn a_plan_goes_with_the_records_of_another_release() {
    let keys =
        |format: &str| -> Vec<String> { plan(format).into_iter().map(|job| job.key).collect() };
    for format in FORMATS {
        assert_eq!(keys(format), keys(FORMATS[0]));
        for other in FORMATS {
            assert_eq!(gathered(other, &plan(format)).unwrap().counts.missing, 0);
        }
        // A run continues in the folder of an earlier release.
        let out = folder(&format!("continued-{format}"));
        std::fs::copy(fixtures(format).join("records.jsonl"), out.join("records.jsonl")).unwrap();
        drop(Store::open(&out.join("records.jsonl"), false).unwrap());
        let there = keys_of(&out, false).unwrap();
        assert!(keys(format).iter().all(|key| there.contains(key)));
        assert_eq!(keys_of(&out, true).unwrap().len(), 3);
    }
}

#[test]
fn a_later_release_counts_before_an_earlier_one() {
    let out = folder("two-releases");
    let lines = std::fs::read_to_string(fixtures("unversioned").join("records.jsonl")).unwrap();
    let angle = |text: &str| text.replacen("\"angleDeg\":-85.", "\"angleDeg\":-84.", 1);
    let release = |text: &str, name: &str| {
        text.replacen("{\"key\"", &format!("{{\"version\":\"{name}\",\"key\""), 1)
    };
    let line = lines.lines().next().unwrap();
    let (old, new) = (release(line, "0.9.0"), release(&angle(line), "0.10.0"));
    let mut found = vec![];
    for text in [[&*old, &*new], [&*new, &*old]] {
        let path = out.join("records.jsonl");
        std::fs::write(&path, text.join("\n") + "\n").unwrap();
        let fleet = merged(gather(&[path], None, false).unwrap());
        found.push(fleet.vehicles[0].radars[0].angle_rad.to_degrees());
    }
    assert!(found.iter().all(|angle| (angle - -84.0).abs() < 0.1), "{found:?}");
    // Of one release two angles are a contradiction.
    let path = out.join("records.jsonl");
    std::fs::write(&path, [line, &*angle(line)].join("\n") + "\n").unwrap();
    assert_eq!(gather(&[path], None, false).unwrap_err().code(), "conflict");
}

#[test]
fn lines_of_later_formats_have_an_error_of_their_own() {
    let later = format!("\"schema\":{}", SCHEMA + 1);
    let now = format!("\"schema\":{SCHEMA}");
    let out = folder("later");
    let plan = std::fs::read_to_string(fixtures("schema-1").join("jobs.jsonl")).unwrap();
    let records = std::fs::read_to_string(fixtures("schema-1").join("records.jsonl")).unwrap();
    for more in ["", ",\"unheard\":[1]"] {
        let plan = plan.replace(&now, &format!("{later}{more}"));
        let path = Path::new("jobs.jsonl");
        let error = Jobs::new(plan.as_bytes(), path).next().unwrap().unwrap_err();
        assert_eq!(error.code(), "unsupported-version");
        assert!(error.to_string().contains("line 1"), "{error}");
        // Without its checksum, which such a change makes wrong.
        let line = records.lines().next().unwrap();
        let (text, _) = line.rsplit_once(",\"crc32\"").unwrap();
        let text = text.replace(&now, &format!("{later}{more}")) + "}\n";
        let path = out.join("records.jsonl");
        for text in [text.clone(), text.replace("\"done\":", "\"made\":")] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(keys_of(&out, false).unwrap_err().code(), "unsupported-version");
            let error = gather(std::slice::from_ref(&path), None, false).unwrap_err();
            assert_eq!(error.code(), "unsupported-version");
        }
    }
}
