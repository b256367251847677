//! Running the binary.

pub mod fleet;

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
pub fn boresight(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_boresight")).args(arguments).output().unwrap()
}

/// What a run that must succeed prints.
pub fn stdout(arguments: &[&str]) -> String {
    let output = boresight(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}
