//! What is written where, and what is not.

use crate::common::{boresight, folder, stdout};
use std::path::{Path, PathBuf};

const SNAPSHOTS: [&str; 8] =
    ["simulate", "snapshots", "--array", "ula8", "--target", "azimuth=5", "--seed", "1"];
const DRIVE: [&str; 6] = ["simulate", "drive", "--seed", "1", "--duration", "4"];
const MINE: &[u8] = b"mine";

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Runs what must be refused, with this code and exit status.
fn refused(arguments: &[&str], code: &str, status: i32) {
    let output = boresight(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(errors.contains(&format!("code:     {code}\n")), "{arguments:?}: {errors}");
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {errors}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

/// All files below a folder with their bytes.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = vec![];
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            let bytes = std::fs::read(&path).unwrap();
            all.push((path, bytes));
        }
    }
    all.sort();
    all
}

#[test]
fn a_file_that_is_there_is_replaced_by_force_only() {
    let folder = folder("exists");
    let sensors = folder.join("drive/data/sensors.json");
    let (npy, truth) = (folder.join("two.npy"), folder.join("two.json"));
    let motion = folder.join("tables/motion.csv");
    let (picture, way) = (folder.join("street-iaa.png"), folder.join("way.csv"));
    let given = folder.join("given");
    let drive = folder.join("drive");
    stdout(&[&DRIVE[..], &["--out", text(&given)]].concat());
    for path in [&sensors, &truth, &motion, &picture, &way] {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, MINE).unwrap();
    }
    let before = files(&folder);
    let tables = folder.join("tables");
    let street = folder.join("street.png");
    let commands: [(&[&str], &Path); 5] = [
        (&[&DRIVE[..], &["--out", text(&drive)]].concat(), &sensors),
        (&[&SNAPSHOTS[..], &["--out", text(&npy)]].concat(), &truth),
        (&["log", text(&given), "--export", text(&tables)], &motion),
        (
            &[
                "image",
                "street",
                "--radars",
                "left",
                "--method",
                "bartlett,iaa",
                "--cell",
                "1",
                "--out",
                text(&street),
            ],
            &picture,
        ),
        (&["calibrate", text(&given), "--sensor", "2", "--trajectory", text(&way)], &way),
    ];
    for (arguments, there) in commands {
        refused(arguments, "exists", 1);
        // Nothing beside it was begun.
        assert!(files(&folder) == before, "{arguments:?}");
        assert_eq!(std::fs::read(there).unwrap(), MINE);
    }
    for (arguments, there) in commands {
        stdout(&[arguments, &["--force"]].concat());
        assert_ne!(std::fs::read(there).unwrap(), MINE, "{arguments:?}");
    }
}

#[test]
fn what_a_command_reads_it_never_writes() {
    let folder = folder("own-input");
    let drive = folder.join("drive");
    let tables = folder.join("tables");
    stdout(&[&DRIVE[..], &["--out", text(&drive)]].concat());
    stdout(&["log", text(&drive), "--export", text(&tables)]);
    let array = folder.join("array.json");
    std::fs::write(&array, r#"{"positions": [[0, 0, 0], [0, 1, 0], [0, 2, 0]]}"#).unwrap();
    let before = files(&folder);
    let hdf5 = drive.join("data/sequence_1/radar_data.h5");
    let around = tables.join("../tables/detections.csv");
    let npy = folder.join("new.npy");
    let of_array = ["simulate", "snapshots", "--array", text(&array), "--seed", "1"];
    let target = ["--target", "azimuth=5", "--force", "--out"];
    for arguments in [
        &["log", text(&tables), "--export", text(&tables), "--force"][..],
        &["calibrate", text(&drive), "--sensor", "2", "--trajectory", text(&hdf5), "--force"],
        &[
            "calibrate",
            text(&tables),
            "--sensor",
            "2",
            "--x",
            "3",
            "--trajectory",
            text(&around),
            "--force",
        ],
        &[&of_array[..], &target, &[text(&array)]].concat(),
        &[&of_array[..], &target, &[text(&npy), "--truth", text(&array)]].concat(),
    ] {
        refused(arguments, "own-input", 2);
        assert!(files(&folder) == before, "{arguments:?}");
    }
    let twice = [&SNAPSHOTS[..], &["--out", text(&npy), "--truth", text(&npy)]].concat();
    refused(&twice, "same-output", 2);
    assert!(!npy.exists());
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::Read;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::process::Command;

    /// The snapshots as they come out in a file.
    fn expected(folder: &Path) -> Vec<u8> {
        let plain = folder.join("plain.npy");
        stdout(&[&SNAPSHOTS[..], &["--out", text(&plain)]].concat());
        std::fs::read(plain).unwrap()
    }

    #[test]
    fn links_are_followed_and_names_of_others_left_alone() {
        let folder = folder("links");
        let expected = expected(&folder);
        let part = folder.join("linked.npy.part");
        std::fs::write(&part, MINE).unwrap();
        let (link, behind) = (folder.join("linked.npy"), folder.join("there/data.npy"));
        std::fs::create_dir(folder.join("there")).unwrap();
        symlink("there/data.npy", &link).unwrap();
        let arguments = [&SNAPSHOTS[..], &["--out", text(&link)]].concat();
        // To where nothing is, and onto what is there.
        stdout(&arguments);
        assert_eq!(std::fs::read(&behind).unwrap(), expected);
        std::fs::write(&behind, MINE).unwrap();
        std::fs::set_permissions(&behind, PermissionsExt::from_mode(0o600)).unwrap();
        refused(&arguments, "exists", 1);
        stdout(&[&arguments[..], &["--force"]].concat());
        assert_eq!(std::fs::read(&behind).unwrap(), expected);
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(behind.metadata().unwrap().permissions().mode() & 0o777, 0o600);
        assert_eq!(std::fs::read(&part).unwrap(), MINE);
        let left: Vec<PathBuf> = files(&folder).into_iter().map(|(path, _)| path).collect();
        let names = ["linked.json", "linked.npy", "linked.npy.part", "plain.json", "plain.npy"];
        let names = names.map(|name| folder.join(name)).into_iter();
        assert_eq!(left, names.chain([behind]).collect::<Vec<_>>());
        // Links that lead nowhere else but to themselves.
        let circle = folder.join("circle.npy");
        symlink("circle.npy", &circle).unwrap();
        refused(&[&SNAPSHOTS[..], &["--out", text(&circle)]].concat(), "file", 1);
        // And a link to what is read.
        let array = folder.join("array.json");
        std::fs::write(&array, r#"{"positions": [[0, 0, 0], [0, 1, 0]]}"#).unwrap();
        let again = folder.join("again.npy");
        symlink("array.json", &again).unwrap();
        let onto = ["--array", text(&array), "--target", "azimuth=5", "--seed", "1", "--force"];
        let onto = [&["simulate", "snapshots", "--out", text(&again)][..], &onto].concat();
        refused(&onto, "own-input", 2);
    }

    /// Devices are named by links in a folder of the test: were one replaced, it would be the link.
    #[test]
    fn pipes_and_the_standard_output_are_written_in_place() {
        let folder = folder("pipes");
        let expected = expected(&folder);
        let pipe = folder.join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for truth in [None, Some(folder.join("truth.json"))] {
            let reader = {
                let pipe = pipe.clone();
                std::thread::spawn(move || {
                    let mut bytes = vec![];
                    std::fs::File::open(pipe).unwrap().read_to_end(&mut bytes).map(|_| bytes)
                })
            };
            let asked: &[&str] = match &truth {
                Some(truth) => &["--truth", text(truth)],
                None => &[],
            };
            stdout(&[&SNAPSHOTS[..], &["--out", text(&pipe)], asked].concat());
            assert_eq!(reader.join().unwrap().unwrap(), expected);
            // Beside what is no file the truth is written where it is asked for.
            assert!(!folder.join("pipe.json").exists());
            assert!(truth.is_none_or(|truth| truth.is_file()));
        }
        // The data alone goes to the standard output: to a pipe, and behind what is in a file already.
        for (name, target) in [("a.npy", "/dev/stdout"), ("b.npy", "/proc/self/fd/1")] {
            let shown = folder.join(name);
            symlink(target, &shown).unwrap();
            let output = boresight(&[&SNAPSHOTS[..], &["--out", text(&shown)]].concat());
            assert!(output.status.success(), "{name}");
            assert_eq!(output.stdout, expected, "{name}");
            assert!(String::from_utf8_lossy(&output.stderr).contains("shape [1, 8, 1]"));
        }
        let script = r#"(printf mine; "$0" "$@"; printf end) > "$FILE""#;
        let (file, shown) = (folder.join("redirected"), folder.join("a.npy"));
        let shell = Command::new("sh")
            .args(["-c", script, env!("CARGO_BIN_EXE_boresight")])
            .args([&SNAPSHOTS[..], &["--out", text(&shown)]].concat())
            .env("FILE", &file)
            .output()
            .unwrap();
        assert!(shell.status.success());
        assert_eq!(std::fs::read(file).unwrap(), [MINE, &expected, b"end"].concat());
    }
}
