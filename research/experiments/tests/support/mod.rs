//! What several tests do with records.

use boresight_experiments::merge;
use boresight_validate::Outcome;
use std::path::{Path, PathBuf};

/// Puts records together, and keeps them in a folder.
pub fn merged(sources: &[PathBuf], folder: &Path) -> Outcome {
    let merged = merge(sources).unwrap();
    std::fs::create_dir_all(folder).unwrap();
    for (name, text) in merged.records {
        std::fs::write(folder.join(name), text).unwrap();
    }
    merged.outcome
}
