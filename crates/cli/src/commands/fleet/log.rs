//! The files of a log, and their digests.

use crate::drive::log_files;
use crate::error::CliError;
use crate::files::source;
use boresight_fleet::job::LogFile;
use std::path::Path;

/// The files that a log is read from, each with the digest of its bytes.
pub(super) fn digests(log: &Path) -> Result<Vec<LogFile>, CliError> {
    let files = log_files(log)?;
    files
        .into_iter()
        .map(|(name, path)| {
            // A pipe or a device may never end.
            let kind = std::fs::metadata(&path).map_err(|error| unreadable(&path, error))?;
            if !kind.is_file() {
                return Err(unreadable(&path, std::io::Error::other("no regular file")));
            }
            let source = source(&path)?;
            Ok(LogFile { name, bytes: source.bytes, sha256: source.sha256 })
        })
        .collect()
}

fn unreadable(path: &Path, error: std::io::Error) -> CliError {
    CliError::File { action: "read", path: path.into(), error }
}
