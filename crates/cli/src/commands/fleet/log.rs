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
            let source = source(&path)?;
            Ok(LogFile { name, bytes: source.bytes, sha256: source.sha256 })
        })
        .collect()
}
