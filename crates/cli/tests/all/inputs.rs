//! Inputs that have no end or never begin.

#![cfg(unix)]

use crate::common::{boresight, folder};
use std::process::{Command, Stdio};

#[test]
fn devices_named_pipes_and_sockets_are_refused() {
    let folder = folder("inputs");
    let cfg = concat!(env!("CARGO_MANIFEST_DIR"), "/../../recordings/awr1642/profile.cfg");
    let kinds = ["a device", "a named pipe", "a socket"];
    for kind in kinds {
        let named = |ending: &str| {
            let path = folder.join(format!("{}.{ending}", kind.replace(' ', "-")));
            match kind {
                "a device" => std::os::unix::fs::symlink("/dev/zero", &path).unwrap(),
                "a socket" => drop(std::os::unix::net::UnixListener::bind(&path).unwrap()),
                _ => assert!(Command::new("mkfifo").arg(&path).status().unwrap().success()),
            }
            path.into_os_string().into_string().unwrap()
        };
        let [npy, bin, csv, mcap, config, json, onnx, h5, pcd, network] =
            ["npy", "bin", "csv", "mcap", "cfg", "json", "onnx", "h5", "pcd", "weights"].map(named);
        let out = folder.join("out");
        let out = out.to_str().unwrap();
        let drive = concat!(env!("CARGO_MANIFEST_DIR"), "/../../recordings/delphi");
        for arguments in [
            &["estimate", &npy, "--array", "ula8"][..],
            &["estimate", &bin, "--config", cfg],
            &["estimate", &bin, "--config", &config],
            &["estimate", &mcap],
            &["estimate", &npy, "--array", &json],
            &[
                "regions",
                &bin,
                "--config",
                cfg,
                "--counting",
                &onnx,
                "--one",
                &onnx,
                "--two",
                &onnx,
            ],
            &["augment", &bin, "--config", cfg, "--out", out, "--count", "1", "--seed", "1"],
            &["log", &csv],
            &["log", &h5],
            &["log", &pcd],
            &["log", &mcap],
            &["log", &mcap, "--messages", "/a"],
            &["calibrate", &csv],
            &[
                "calibrate",
                drive,
                "--method",
                "least-squares",
                "--motion",
                "deepego",
                "--network",
                &network,
            ],
            &["odometry", &csv],
            &["serve", &csv],
            &["bridge", "--config", &config],
            &["bridge", "--config", cfg, "--replay", &bin],
            &["network", &onnx],
            &["validate", "--merge", &json, "--out", out],
            &["array", "show", &json],
        ] {
            let output = boresight(arguments);
            let text = String::from_utf8_lossy(&output.stderr);
            assert!(!output.status.success(), "{arguments:?}");
            assert!(
                text.contains(&format!("it is {kind}; expected a file")),
                "{arguments:?}: {text}"
            );
        }
    }
}

#[test]
fn a_pipe_on_the_standard_input_is_read() {
    let table = format!("t,a,v\n{}", "0,0,0\n".repeat(3));
    let mut child = Command::new(env!("CARGO_BIN_EXE_boresight"))
        .args(["log", "/dev/stdin"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::io::Write::write_all(child.stdin.as_mut().unwrap(), table.as_bytes()).unwrap();
    let text = child.wait_with_output().unwrap().stderr;
    // The name of a pipe tells no format, and its bytes are still all there.
    let text = String::from_utf8_lossy(&text);
    assert!(text.contains("no-drive-log"), "{text}");
}
