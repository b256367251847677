//! The files of a raw recording: one, the parts of a long one, or those of a cascade of chips.

use crate::error::CliError;
use crate::files::Files;
use boresight_core::Remark;
use boresight_formats::RadarConfig;
use boresight_formats::dca1000::{cascade, parts::parts};
use std::path::{Path, PathBuf};

/// Files in order of time; of a cascade, of all its chips.
pub struct Recording {
    paths: Vec<PathBuf>,
    is_cascade: bool,
    missing: Vec<String>,
}

impl Recording {
    /// The recording of a path: of a folder all `.bin` files in it; of one file of a cascade those
    /// of the other chips too; otherwise the file alone.
    pub fn find(path: &Path) -> Result<Self, CliError> {
        let is_cascade = |path: &Path| path.to_str().is_some_and(cascade::is_part);
        let paths = match path.parent() {
            _ if path.is_dir() => recorded_in(path)?,
            Some(folder) if is_cascade(path) => {
                let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
                recorded_in(folder)?.into_iter().filter(|path| is_cascade(path)).collect()
            }
            _ => return Ok(Self { paths: vec![path.into()], is_cascade: false, missing: vec![] }),
        };
        if paths.is_empty() {
            return Err(CliError::Option {
                option: "FILE",
                expected: "a folder with .bin files of a recording".into(),
                given: format!("{} without any", path.display()),
            });
        }
        let names: Vec<_> = paths.iter().map(|path| path.display().to_string()).collect();
        let found = parts(&names.iter().map(String::as_str).collect::<Vec<_>>())?;
        let paths = found.order.into_iter().filter_map(|file| paths.get(file).cloned()).collect();
        Ok(Self { paths, is_cascade: found.is_cascade, missing: found.missing })
    }

    /// All samples, in the order of a single file.
    pub fn read(
        &self,
        config: &RadarConfig,
        remarks: &mut Vec<Remark>,
        files: &Files,
    ) -> Result<Vec<u8>, CliError> {
        if self.is_cascade {
            let read = |path: &PathBuf| Ok((path.display().to_string(), files.read(path)?));
            let read = self.paths.iter().map(read).collect::<Result<Vec<_>, CliError>>()?;
            let named: Vec<_> = read.iter().map(|(name, bytes)| (&**name, &**bytes)).collect();
            let joined = cascade::join(&named, config)?;
            remarks.extend(joined.remarks);
            return Ok(joined.bytes);
        }
        if !self.missing.is_empty() {
            let message = format!(
                "the recording lacks {}: frames are read as if nothing were missing, so their times are wrong from there on",
                self.missing.join(", ")
            );
            remarks.push(Remark::new("missing-file", message));
        }
        let mut bytes = vec![];
        for path in &self.paths {
            let more = files.read(path)?;
            if bytes.is_empty() {
                bytes = more;
            } else {
                bytes.extend_from_slice(&more);
            }
        }
        Ok(bytes)
    }
}

/// The `.bin` files of a folder, by name.
fn recorded_in(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let failed = |error| CliError::File { action: "read", path: folder.into(), error };
    let mut paths = vec![];
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bin")) {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
