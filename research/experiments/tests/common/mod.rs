//! Running the binary, and its networks.

#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder of this test's own.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the binary to its end.
pub fn experiments(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_boresight-experiments")).args(arguments).output().unwrap()
}

/// What a run that must succeed prints.
pub fn stdout(arguments: &[&str]) -> String {
    let output = experiments(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// The path of a network, of the product or of the comparisons.
pub fn model(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let paths = ["models", "research/models"].map(|at| root.join(at).join(format!("{name}.onnx")));
    paths.iter().find(|path| path.is_file()).unwrap().to_str().unwrap().to_owned()
}
