//! A small fleet of simulated drives, and plans and records of it.

use super::{folder, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Vehicles and their drives.
pub const DRIVES: [(&str, &str); 7] = [
    ("car1", "d1"),
    ("car1", "d2"),
    ("car1", "d10"),
    ("car2", "d1"),
    ("car2", "d2"),
    ("car3", "d1"),
    ("car3", "d2"),
];

/// The folder of the fleet: `car1/d1` and so on are the logs. Simulated once a test program.
pub fn fleet() -> &'static Path {
    static FLEET: OnceLock<PathBuf> = OnceLock::new();
    FLEET.get_or_init(|| {
        let top = folder(&format!("fleet-{}", std::process::id()));
        for (index, (vehicle, drive)) in DRIVES.iter().enumerate() {
            let out = top.join("made").join(vehicle).join(drive);
            let seed = (index + 1).to_string();
            let arguments = ["simulate", "drive", "--seed", &seed, "--duration", "6", "--out"];
            stdout(&[&arguments[..], &[text(&out)]].concat());
            let log = top.join("logs").join(vehicle).join(drive);
            std::fs::create_dir_all(&log).unwrap();
            let data = out.join("data");
            for name in ["radar_data.h5", "scenes.json"] {
                std::fs::copy(data.join("sequence_1").join(name), log.join(name)).unwrap();
            }
            std::fs::copy(data.join("sensors.json"), log.join("sensors.json")).unwrap();
        }
        top.join("logs")
    })
}

/// A path as text.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The logs of the fleet.
pub fn logs() -> Vec<PathBuf> {
    DRIVES.iter().map(|(vehicle, drive)| fleet().join(vehicle).join(drive)).collect()
}

/// Plans the whole fleet, with further arguments, into a folder.
pub fn planned(into: &Path, further: &[&str]) -> PathBuf {
    let plan = into.join("jobs.jsonl");
    let logs = logs();
    let logs: Vec<&str> = logs.iter().map(|path| text(path)).collect();
    stdout(&[&["fleet", "plan", "--out", text(&plan)], &logs[..], further].concat());
    plan
}

/// The lines of a file.
pub fn lines(path: &Path) -> Vec<String> {
    std::fs::read_to_string(path).unwrap().lines().map(Into::into).collect()
}

/// Lines as JSON.
pub fn values(lines: &[String]) -> Vec<Value> {
    lines.iter().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// All records in a folder, in an order of their own.
pub fn records(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of_records =
        |path: &PathBuf| text(path.file_name().unwrap().as_ref()).starts_with("records");
    let mut all: Vec<String> = entries.filter(of_records).flat_map(|path| lines(&path)).collect();
    all.sort();
    all
}

/// A record without its checksum, which an edit would make wrong.
pub fn unchecked(line: &str) -> String {
    let (text, _) = line.rsplit_once(",\"crc32\"").unwrap();
    text.to_owned() + "}"
}
