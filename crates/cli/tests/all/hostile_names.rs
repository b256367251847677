//! Names from files and of files, with characters that a terminal obeys.

use crate::common::{boresight, folder};

/// A clear-screen sequence by C0 and by C1, DEL, an override of direction, and a line feed.
const HOSTILE: &str = "a\u{1b}[2J\u{9b}2J\u{7f}\u{202e}\u{2066}\nerror: b\rc";

/// Output of a run: every control character of it is a line feed, and no line begins with a forged error.
fn checked(arguments: &[&str]) -> (bool, String) {
    let output = boresight(arguments);
    let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    for one in text.iter().flat_map(|text| text.chars()) {
        let harmless = one == '\n' || !(one.is_control() || "\u{202e}\u{2066}".contains(one));
        assert!(harmless, "{arguments:?}: {one:?} in {text:?}");
    }
    let text = text.concat();
    assert!(!text.lines().any(|line| line.starts_with("error: b")), "{text}");
    (output.status.success(), text)
}

/// A record of an MCAP file.
fn record(code: u8, body: &[u8]) -> Vec<u8> {
    [&[code][..], &(body.len() as u64).to_le_bytes(), body].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

#[test]
fn headers_and_cells_of_a_table_are_escaped() {
    let path = folder("hostile-table").join("drive.csv");
    let path_text = path.to_str().unwrap();
    std::fs::write(&path, format!("\"{HOSTILE}\",\"{HOSTILE}\"\n1,2\n")).unwrap();
    let (success, text) = checked(&["log", path_text]);
    assert!(!success, "{text}");
    let cell = HOSTILE.replace(['\n', '\r'], "");
    let table = format!("time_s,sensor,azimuth_deg,range_rate_mps,{cell}\n1,1,{cell},2,3\n");
    std::fs::write(&path, table).unwrap();
    let (success, text) = checked(&["log", path_text]);
    assert!(!success && text.contains("a\\u001b[2J\\u009b2J\\u007f\\u202e\\u2066"), "{text}");
}

#[test]
fn a_topic_of_a_recording_is_escaped() {
    let path = folder("hostile-topic").join("drive.mcap");
    let magic = b"\x89MCAP0\r\n";
    let schema = [&[1, 0][..], &text(HOSTILE), &text("jsonschema"), &text("{}")].concat();
    let channel = [&[1, 0, 1, 0][..], &text(HOSTILE), &text("json"), &[0; 4]].concat();
    let message = [&[1, 0][..], &[0; 20], b"{}"].concat();
    let records = [
        record(1, &[text(""), text("")].concat()),
        record(3, &schema),
        record(4, &channel),
        record(5, &message),
        record(15, &[0; 4]),
        record(2, &[0; 20]),
    ];
    std::fs::write(&path, [&magic[..], &records.concat(), magic].concat()).unwrap();
    let path = path.to_str().unwrap();
    let (_, text) = checked(&["log", path]);
    assert!(text.contains("a\\u001b[2J\\u009b2J\\u007f\\u202e\\u2066"), "{text}");
    let (success, text) = checked(&["log", path, "--messages", "none"]);
    assert!(!success && text.contains("\\u001b"), "{text}");
}

#[test]
fn names_of_files_and_arguments_are_escaped() {
    let folder = folder("hostile-name");
    let path = folder.join(format!("{HOSTILE}.csv"));
    let path = path.to_str().unwrap();
    assert!(!checked(&["log", path]).0);
    let (_, text) = checked(&["log", &format!("--{}", HOSTILE.replace('\n', ""))]);
    assert!(text.contains("\\u009b"), "{text}");
    let npy = folder.join(format!("{HOSTILE}.npy"));
    let out = ["--out", npy.to_str().unwrap()];
    let simulate = ["simulate", "snapshots", "--array", "ula8", "--target", "azimuth=12"];
    let (success, text) = checked(&[&simulate[..], &["--seed", "1"], &out].concat());
    assert!(success && text.contains("a\\u001b[2J"), "{text}");
}
