//! `boresight validate` as a user runs it.

use crate::common::{boresight, folder, stdout};
use crate::size::sized;
use serde_json::Value;

#[test]
fn drives_from_files_are_cut_into_pieces_and_taken_up_again() {
    let folder = folder("validate");
    let drives = folder.join("drives");
    let [duration, pieces, longest] = sized(["14", "6,12", "12"], ["9", "4,8", "8"]);
    for seed in ["1", "2"] {
        let drive = drives.join(format!("drive-{seed}"));
        let simulated = [
            "simulate",
            "drive",
            "--duration",
            duration,
            "--seed",
            seed,
            "--scenario",
            "city",
            "--out",
        ];
        stdout(&[&simulated[..], &[drive.to_str().unwrap()]].concat());
    }
    let out = folder.join("run");
    let validate = ["validate", drives.to_str().unwrap(), "--pieces", pieces];
    let run = [&validate[..], &["--out", out.to_str().unwrap()]].concat();
    let first = stdout(&run);
    assert!(
        first.contains("# 2 drives from files")
            && first.contains(&format!("## Pieces of {longest} s")),
        "{first}"
    );
    let records = std::fs::read_to_string(out.join("calibration-drives.jsonl")).unwrap();
    assert_eq!(records.lines().count(), 3);
    let json: Value = serde_json::from_str(&stdout(&[&run[..], &["--json"]].concat())).unwrap();
    assert_eq!(json["lengths"][0]["radars"].as_array().unwrap().len(), 4);
    assert_eq!(std::fs::read_to_string(out.join("calibration-drives.jsonl")).unwrap(), records);
    // In two parts that are merged it is the same to the byte, and what is read is not written over.
    let [parts, whole] = ["parts", "whole"].map(|name| folder.join(name));
    let [parts, whole] = [&parts, &whole].map(|path| path.to_str().unwrap());
    for part in ["1/2", "2/2"] {
        let said = stdout(&[&validate[..], &["--out", parts, "--part", part]].concat());
        assert!(said.contains("1 records"), "{said}");
    }
    assert_eq!(stdout(&["validate", "--merge", parts, "--out", whole]), first);
    let own = boresight(&["validate", "--merge", whole, "--out", whole, "--force"]);
    assert!(String::from_utf8(own.stderr).unwrap().contains("own-input"));
    // Records of another experiment are refused by its name.
    let other = folder.join("other.jsonl");
    std::fs::write(&other, "{\"experiment\":\"aoa\",\"options\":{}}\n").unwrap();
    let refused = boresight(&["validate", "--merge", other.to_str().unwrap(), "--out", whole]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("other-run") && said.contains("aoa"), "{said}");
    // A folder without drives says what is wrong with which.
    let empty = folder.join("empty");
    std::fs::create_dir_all(empty.join("nothing")).unwrap();
    let refused = boresight(&["validate", empty.to_str().unwrap()]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && said.contains("drive nothing"), "{said}");
}
