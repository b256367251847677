//! Drive logs from files and folders.

use crate::error::CliError;
use crate::files;
use boresight_formats::drive_log::{is_hdf5, is_table, open};
use boresight_formats::{DriveFormat, DriveRead};
use std::path::{Path, PathBuf};

/// Reads a drive log from one folder, one file, or several files that belong together. Of a folder
/// only tables and HDF5 files are read.
pub fn open_path(
    paths: &[impl AsRef<Path>],
    format: Option<DriveFormat>,
) -> Result<DriveRead, CliError> {
    let mut found: Vec<PathBuf> = vec![];
    for path in paths.iter().map(AsRef::as_ref) {
        if path.is_dir() {
            found.extend(tables(path)?);
        } else {
            found.push(path.to_owned());
        }
    }
    found.sort();
    found.dedup();
    let contents = found.iter().map(|path| files::read(path)).collect::<Result<Vec<_>, _>>()?;
    let names: Vec<_> =
        found.iter().map(|p| p.file_name().unwrap_or_default().to_string_lossy()).collect();
    let named: Vec<(&str, &[u8])> =
        names.iter().zip(&contents).map(|(name, bytes)| (&**name, &**bytes)).collect();
    Ok(open(&named, format)?)
}

fn tables(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let failed = |error| CliError::File { action: "read", path: folder.into(), error };
    let mut found = vec![];
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.to_string_lossy();
        if path.is_file() && (is_table(&name) || is_hdf5(&name)) {
            found.push(path);
        }
    }
    Ok(found)
}
