//! Drive logs from files and folders.

use crate::arguments::LogPaths;
use crate::error::CliError;
use crate::files::Files;
use boresight_core::DriveLog;
use boresight_formats::drive_log::clouds::{Clouds, Tables, format_of, is_cloud};
use boresight_formats::drive_log::{
    in_file, is_hdf5, is_mcap, is_mcap_name, is_table, no_drive_log, open_owned,
};
use boresight_formats::radarscenes::{Companions, read_path, sequence_names};
use boresight_formats::{DriveFormat, DriveRead, McapDriveReader, ReadReport};
use boresight_mounting::{CalibrationOptions, signs};
use std::error::Error;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

const RADAR_DATA: &str = "radar_data.h5";
/// What is read beside a sequence's data.
const SEQUENCE_JSON: [&str; 2] = ["scenes.json", "sensors.json"];

/// Reads a drive log, with the signs that its options say.
pub fn open_path(
    log: &LogPaths,
    format: Option<DriveFormat>,
    files: &Files,
) -> Result<DriveRead, CliError> {
    let mut read = read_log(log, format, files)?;
    let gap_s = CalibrationOptions::default().max_gap_s;
    read.report.remarks.extend(signs::apply(&mut read.log, log.signs.options, gap_s)?);
    Ok(read)
}

/// Reads a drive log from one folder, one file, or several files that belong together. Of a folder
/// only tables, HDF5 files, MCAP files and point clouds are read, and with HDF5 the JSON files of a sequence, in its
/// folder and the one above; of the folder of a data set, the sequence that is asked for; of point clouds also those of the
/// folders in it.
fn read_log(
    log: &LogPaths,
    format: Option<DriveFormat>,
    files: &Files,
) -> Result<DriveRead, CliError> {
    let sequence = log.sequence.as_deref();
    let paths: Vec<&Path> = log.paths.iter().map(AsRef::as_ref).collect();
    let mut found: Vec<PathBuf> = vec![];
    let mut names: Vec<String> = vec![];
    for path in &paths {
        if path.is_dir() {
            for path in entries(path)? {
                names.push(name(&path));
                let is_kind = [is_table, is_hdf5, is_mcap_name].iter().any(|is| is(&name(&path)));
                if path.is_file() && is_kind {
                    found.push(path);
                }
            }
        } else {
            names.push(name(path));
            found.push((*path).to_owned());
        }
    }
    if let Some(read) = read_clouds(&paths, format, sequence, files)? {
        return Ok(read);
    }
    found.sort();
    found.dedup();
    if format.is_none_or(|format| format == DriveFormat::Mcap) {
        let (parts, others): (Vec<_>, Vec<_>) = found.iter().partition(|path| is_recording(path));
        if !parts.is_empty() {
            not_wanted(sequence)?;
            return read_recording(log, &parts, &others, files);
        }
    }
    if format.is_none_or(|format| format == DriveFormat::Radarscenes) {
        let set = match paths[..] {
            [folder] if folder.is_dir() && !found.iter().any(|path| is_hdf5(&name(path))) => {
                Sequences::find(folder, files)?
            }
            _ => None,
        };
        if let Some(set) = set {
            return read_sequence(&set.choose(sequence)?, &[], files);
        }
        not_wanted(sequence)?;
        let (hdf5, others): (Vec<_>, Vec<_>) =
            found.iter().cloned().partition(|path| is_hdf5(&name(path)));
        if let [radar_data] = &hdf5[..] {
            return read_sequence(radar_data, &others, files);
        }
    }
    not_wanted(sequence)?;
    if found.is_empty() {
        return Err(no_drive_log(format, names.iter().map(String::as_str)).into());
    }
    let mut contents = vec![];
    for path in &found {
        contents.push((name(path), files.read(path)?));
    }
    Ok(open_owned(contents, format, &log.topics.options)?)
}

/// The drives in a folder, by name: the sequences of a data set of RadarScenes, or else the folders in it; without any the folder itself.
pub fn drives_in(folder: &Path, files: &Files) -> Result<Vec<(String, PathBuf)>, CliError> {
    if let Some(set) = Sequences::find(folder, files)? {
        let place = |name: &String| (name.clone(), set.folder.join(name));
        return Ok(set.names.iter().map(place).collect());
    }
    let folders: Vec<PathBuf> = entries(folder)?.into_iter().filter(|path| path.is_dir()).collect();
    let drives = if folders.is_empty() { vec![folder.to_owned()] } else { folders };
    Ok(drives.into_iter().map(|path| (name(&path), path)).collect())
}

/// The sequences of a data set of RadarScenes, if the folder is that of one, in their order.
pub fn drives_of_data_set(path: &Path, files: &Files) -> Result<Option<Vec<PathBuf>>, CliError> {
    if !path.is_dir() || entries(path)?.iter().any(|path| is_hdf5(&name(path))) {
        return Ok(None);
    }
    let set = Sequences::find(path, files)?;
    Ok(set.map(|set| set.names.iter().map(|name| set.folder.join(name)).collect()))
}

/// The files that a log is read from, by their names within its folder, in order: those whose names readers go by, in the folder and the
/// folders in it, and the JSON files of a sequence.
pub fn log_files(path: &Path) -> Result<Vec<(String, PathBuf)>, CliError> {
    let mut found = vec![];
    if path.is_dir() {
        for path in entries(path)? {
            if path.is_dir() {
                let folder = name(&path);
                let inner = entries(&path)?.into_iter().filter(|path| path.is_file());
                found.extend(inner.map(|path| (format!("{folder}/{}", name(&path)), path)));
            } else {
                found.push((name(&path), path));
            }
        }
        let is_kind = [is_table, is_hdf5, is_mcap_name, is_cloud, is_json];
        found.retain(|(name, _)| is_kind.iter().any(|is| is(name)));
    } else {
        found.push((name(path), path.to_owned()));
    }
    // The companions of a sequence lie beside it and above it.
    if let Some(hdf5) = found.iter().find(|(name, _)| is_hdf5(name)).map(|(_, path)| path.clone()) {
        let folder = hdf5.parent().unwrap_or(Path::new(""));
        for wanted in SEQUENCE_JSON {
            for (name, path) in [
                (wanted.to_owned(), folder.join(wanted)),
                (format!("../{wanted}"), folder.join("..").join(wanted)),
            ] {
                if path.is_file() && !found.iter().any(|(known, _)| *known == name) {
                    found.push((name, path));
                    break;
                }
            }
        }
    }
    if found.is_empty() {
        let names: Vec<String> = entries(path)?.iter().map(|path| name(path)).collect();
        return Err(no_drive_log(None, names.iter().map(String::as_str)).into());
    }
    found.sort();
    Ok(found)
}

fn is_json(name: &str) -> bool {
    name.to_ascii_lowercase().ends_with(".json")
}

/// The log of one drive, for experiments.
pub fn load(path: &Path) -> Result<DriveLog, Box<dyn Error + Send + Sync>> {
    // A message in place of the error, which may not leave its thread.
    let log = LogPaths { paths: vec![path.into()], ..LogPaths::default() };
    open_path(&log, None, &Files::new(false))
        .map(|read| read.log)
        .map_err(|error| error.to_string().into())
}

/// Reads point clouds, one file at a time, with the tables beside, if there are clouds.
fn read_clouds(
    paths: &[&Path],
    format: Option<DriveFormat>,
    sequence: Option<&str>,
    files: &Files,
) -> Result<Option<DriveRead>, CliError> {
    let mut all: Vec<PathBuf> = vec![];
    for path in paths {
        if path.is_dir() {
            for path in entries(path)? {
                all.extend(if path.is_dir() { entries(&path)? } else { vec![path] });
            }
        } else {
            all.push((*path).to_owned());
        }
    }
    let of = |path: &PathBuf| {
        format_of(&name(path)).filter(|own| format.is_none_or(|format| format == *own))
    };
    let wanted = |path: &&PathBuf| sequence.is_none_or(|start| name(path).starts_with(start));
    let Some(format) = all.iter().find_map(of) else { return Ok(None) };
    let mut clouds = Clouds::new(format);
    let mut any = false;
    for path in all.iter().filter(|path| of(path) == Some(format)).filter(wanted) {
        any = true;
        // The folder names the radar where the file does not.
        let folder = path.parent().map(name).unwrap_or_default();
        let given = format!("{folder}/{}", name(path));
        clouds.add(&given, &files.read(path)?).map_err(|error| in_file(error, &name(path)))?;
    }
    if let (false, Some(given)) = (any, sequence) {
        return Err(CliError::Option {
            option: "--sequence",
            expected: "what the names of the clouds begin with".into(),
            given: format!("{given:?}"),
        });
    }
    let mut tables = Tables::default();
    for path in all.iter().filter(|path| !is_cloud(&name(path)) && Tables::has(&name(path))) {
        tables.take(&name(path), Box::new(files.open(path)?));
    }
    Ok(Some(clouds.finish(tables)?))
}

/// Whether a file is MCAP: by its name, or by its beginning.
fn is_recording(path: &Path) -> bool {
    let mut begin = vec![];
    is_mcap_name(&name(path))
        // A pipe would lose what is read here.
        || path.is_file()
            && File::open(path).is_ok_and(|file| file.take(8).read_to_end(&mut begin).is_ok())
            && is_mcap(&begin)
}

/// Reads the parts of a recording, none of which is held as a whole.
fn read_recording(
    log: &LogPaths,
    parts: &[&PathBuf],
    others: &[&PathBuf],
    files: &Files,
) -> Result<DriveRead, CliError> {
    let mut reader = McapDriveReader::new(log.topics.options.clone());
    for path in parts {
        let failed = |error| CliError::File { action: "read", path: (*path).into(), error };
        reader.push_all(files.open(path)?).map_err(failed)??;
        reader.end_file();
    }
    let mut read = reader.finish()?;
    for path in others {
        read.report.ignored(&name(path));
    }
    Ok(read)
}

/// Refuses `--sequence` where there is nothing to choose from.
fn not_wanted(sequence: Option<&str>) -> Result<(), CliError> {
    sequence.map_or(Ok(()), |given| {
        Err(CliError::Option {
            option: "--sequence",
            expected: "the folder of a data set of RadarScenes as PATH".into(),
            given: format!("{given:?}"),
        })
    })
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let failed = |error| CliError::File { action: "read", path: folder.into(), error };
    let mut paths = std::fs::read_dir(folder)
        .map_err(failed)?
        .map(|entry| Ok(entry.map_err(failed)?.path()))
        .collect::<Result<Vec<_>, CliError>>()?;
    paths.sort();
    Ok(paths)
}

/// Reads a sequence of RadarScenes with the JSON files among `others`, in its folder or in the one
/// above.
fn read_sequence(
    radar_data: &Path,
    others: &[PathBuf],
    files: &Files,
) -> Result<DriveRead, CliError> {
    let folder = radar_data.parent().unwrap_or(Path::new(""));
    let beside = |wanted: &str| -> Result<Option<Vec<u8>>, CliError> {
        let given = others.iter().find(|path| name(path) == wanted).cloned();
        given
            .into_iter()
            .chain([folder.join(wanted), folder.join("..").join(wanted)])
            .find(|path| path.is_file())
            .map(|path| files.read(&path))
            .transpose()
    };
    let [scenes, sensors] = SEQUENCE_JSON.map(beside);
    let (scenes, sensors) = (scenes?, sensors?);
    let companions = Companions { scenes: scenes.as_deref(), sensors: sensors.as_deref() };
    let mut report = ReadReport::default();
    let json = ["scenes.json", "sensors.json", "sequences.json"];
    for other in others.iter().map(|path| name(path)).filter(|name| !json.contains(&&**name)) {
        report.ignored(&other);
    }
    // The reader of a file that is not there would not say that.
    files.check_input(radar_data)?;
    let log = read_path(radar_data, companions, &mut report)?;
    Ok(DriveRead { log, report, format: DriveFormat::Radarscenes })
}

/// The sequences of a data set.
struct Sequences {
    folder: PathBuf,
    names: Vec<String>,
}

impl Sequences {
    /// Those in a folder or in `data` in it: the ones `sequences.json` names, without it all folders
    /// with recordings.
    fn find(folder: &Path, files: &Files) -> Result<Option<Self>, CliError> {
        for folder in [folder.to_owned(), folder.join("data")] {
            let list = folder.join("sequences.json");
            let mut names: Vec<String> = if list.is_file() {
                sequence_names(&files.read(&list)?)?
            } else if folder.is_dir() {
                entries(&folder)?.iter().map(|path| name(path)).collect()
            } else {
                continue;
            };
            names.retain(|name| folder.join(name).join(RADAR_DATA).is_file());
            if !names.is_empty() {
                // sequence_2 before sequence_10.
                names.sort_by_key(|name| (name.len(), name.clone()));
                return Ok(Some(Self { folder, names }));
            }
        }
        Ok(None)
    }

    /// The recording of the one asked for, or of the only one.
    fn choose(&self, wanted: Option<&str>) -> Result<PathBuf, CliError> {
        let found = match wanted {
            None if self.names.len() == 1 => self.names.first(),
            None => None,
            Some(wanted) => self
                .names
                .iter()
                .find(|name| *name == wanted || name.strip_prefix("sequence_") == Some(wanted)),
        };
        let found = found.ok_or_else(|| {
            let mut shown = self.names.clone();
            shown.truncate(8);
            let more = self.names.len() - shown.len();
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            CliError::Option {
                option: "--sequence",
                expected: format!("one of {}{more}", shown.join(", ")),
                given: wanted.map_or("not given".into(), |wanted| format!("{wanted:?}")),
            }
        })?;
        Ok(self.folder.join(found).join(RADAR_DATA))
    }
}
