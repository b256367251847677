//! Finds which format files are in, by their contents.

use super::mcap::{McapDriveReader, TopicOptions, is_mcap, is_mcap_name, no_radar};
use super::report::ReadReport;
use super::text::{Rows, is_gzip};
use super::{clouds, delphi, table};
use crate::error::FormatError;
use crate::radarscenes::{self, Companions};
use boresight_core::InputError;
use boresight_core::drive::DriveLog;
use boresight_options::{Described, Named};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A format of drive logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DriveFormat {
    /// [`crate::radarscenes`]: `radar_data.h5` of a sequence.
    Radarscenes,
    /// [`delphi`]: tracks of a Delphi front radar and poses.
    Delphi,
    /// [`table`]: the general tables.
    Csv,
    /// Point clouds, a file a scan, as of nuScenes and TruckScenes.
    Pcd,
    /// Frames of View-of-Delft.
    ViewOfDelft,
    /// Recordings of ROS and others in MCAP.
    Mcap,
}

impl DriveFormat {
    /// Its name.
    pub fn name(self) -> &'static str {
        Named::name(self)
    }

    /// The format of a name.
    ///
    /// # Errors
    /// [`InputError::Unknown`] with the names there are.
    pub fn from_name(name: &str) -> Result<Self, InputError> {
        Named::from_name("format", name)
    }
}

/// A drive log, what was left out of it, and the format it was in.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveRead {
    /// The drive.
    pub log: DriveLog,
    /// What was kept and left out.
    pub report: ReadReport,
    /// The format.
    pub format: DriveFormat,
}

/// What a file holds, by its contents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Radarscenes,
    Scenes,
    Sensors,
    Sequences,
    DelphiRadar,
    DelphiPose,
    Detections,
    Motion,
    Mcap,
}

fn role(name: &str, bytes: &[u8]) -> Result<Option<Role>, FormatError> {
    if is_hdf5(name) {
        return Ok(Some(Role::Radarscenes));
    }
    if is_mcap(bytes) || is_mcap_name(name) {
        return Ok(Some(Role::Mcap));
    }
    match name.rsplit(['/', '\\']).next() {
        Some("scenes.json") => return Ok(Some(Role::Scenes)),
        Some("sensors.json") => return Ok(Some(Role::Sensors)),
        Some("sequences.json") => return Ok(Some(Role::Sequences)),
        _ => {}
    }
    if !(is_table(name) || is_gzip(bytes)) {
        return Ok(None);
    }
    let rows = match Rows::open(bytes) {
        // A damaged pack may be the very table looked for.
        Err(error @ FormatError::Compressed { .. }) => return Err(in_file(error, name)),
        Err(_) => return Ok(None),
        Ok(rows) => rows,
    };
    let has = |columns: &[&str]| columns.iter().all(|name| rows.columns.find(name).is_some());
    let yaw_rate = has(&["yaw_rate_radps"]) || has(&["yaw_rate_degps"]);
    Ok(if has(&["t_s", "frame"]) {
        Some(Role::DelphiRadar)
    } else if has(&["t_s"]) && yaw_rate {
        Some(Role::DelphiPose)
    } else if has(&["range_rate_mps"]) {
        Some(Role::Detections)
    } else {
        yaw_rate.then_some(Role::Motion)
    })
}

/// Whether a file's name is that of a table: `.csv` or `.csv.gz`.
pub fn is_table(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.ends_with(".csv") || name.ends_with(".csv.gz")
}

/// Whether a file's name is that of an HDF5 file.
pub fn is_hdf5(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.ends_with(".h5") || name.ends_with(".hdf5")
}

/// Names the file in an error.
pub fn in_file(error: FormatError, name: &str) -> FormatError {
    let name: String = name.chars().take(60).collect();
    match error {
        FormatError::Table { line, what, expected, given } => {
            FormatError::Table { line, what: format!("{what} in {name}"), expected, given }
        }
        FormatError::Compressed { given } => {
            FormatError::Compressed { given: format!("{name}: {given}") }
        }
        FormatError::Hdf5 { what, expected, given } => {
            FormatError::Hdf5 { what: format!("{what} in {name}"), expected, given }
        }
        FormatError::Binary { format, offset, what, expected, given } => FormatError::Binary {
            format,
            offset,
            what: format!("{what} in {name}"),
            expected,
            given,
        },
        other => other,
    }
}

/// Number of the one file of a role.
fn find(
    files: &[File<'_>],
    roles: &[Option<Role>],
    role: Role,
) -> Result<Option<usize>, FormatError> {
    let mut found = (0..files.len()).filter(|i| roles[*i] == Some(role));
    let first = found.next();
    if let (Some(first), Some(second)) = (first, found.next()) {
        return Err(FormatError::NoDriveLog {
            expected: "one file of each kind".into(),
            given: format!("both {} and {}", files[first].0, files[second].0),
        });
    }
    Ok(first)
}

type File<'a> = (&'a str, Cow<'a, [u8]>);

/// Reads a drive log from named files, in any order, each recognised by its columns or, other than
/// tables, its name (with or without folders before it); with a remark for each that belongs to no
/// format. Tables may be packed with gzip. An HDF5 file is copied: see [`open_owned`].
///
/// With `format` given only files of that format are looked for.
///
/// # Errors
/// [`FormatError::NoDriveLog`] if the files are no drive log, with what was looked for; otherwise
/// those of the format's reader.
pub fn open(
    files: &[(&str, &[u8])],
    format: Option<DriveFormat>,
) -> Result<DriveRead, FormatError> {
    let files = files.iter().map(|(name, bytes)| (*name, Cow::Borrowed(*bytes))).collect();
    open_files(files, format, &TopicOptions::default())
}

/// As [`open`], from files that are given away, so that none is held twice; `topics` are those of MCAP files.
///
/// # Errors
/// As [`open`].
pub fn open_owned(
    files: Vec<(String, Vec<u8>)>,
    format: Option<DriveFormat>,
    topics: &TopicOptions,
) -> Result<DriveRead, FormatError> {
    let (names, contents): (Vec<_>, Vec<_>) = files.into_iter().unzip();
    let owned = contents.into_iter().map(Cow::Owned);
    open_files(names.iter().map(String::as_str).zip(owned).collect(), format, topics)
}

fn open_files(
    mut files: Vec<File<'_>>,
    format: Option<DriveFormat>,
    topics: &TopicOptions,
) -> Result<DriveRead, FormatError> {
    if let Some(read) = clouds::open(&files, format)? {
        return Ok(read);
    }
    let roles: Vec<_> =
        files.iter().map(|(name, bytes)| role(name, bytes)).collect::<Result<_, _>>()?;
    let wanted = |candidate| format.is_none_or(|format| format == candidate);
    if wanted(DriveFormat::Mcap) && roles.contains(&Some(Role::Mcap)) {
        return open_mcap(files, &roles, topics);
    }
    let mut read = None;
    for (candidate, radar, beside) in [
        (
            DriveFormat::Radarscenes,
            Role::Radarscenes,
            &[Role::Scenes, Role::Sensors, Role::Sequences][..],
        ),
        (DriveFormat::Delphi, Role::DelphiRadar, &[Role::DelphiPose]),
        (DriveFormat::Csv, Role::Detections, &[Role::Motion]),
    ] {
        if read.is_none()
            && wanted(candidate)
            && let Some(radar) = find(&files, &roles, radar)?
        {
            let beside: Vec<_> =
                beside.iter().map(|role| find(&files, &roles, *role)).collect::<Result<_, _>>()?;
            read = Some((candidate, radar, beside));
        }
    }
    // One table that is none of these still gets the general reader's word on what it lacks.
    if let [(name, _)] = files[..]
        && wanted(DriveFormat::Csv)
        && read.is_none()
        && is_table(name)
    {
        read = Some((DriveFormat::Csv, 0, vec![]));
    }
    let Some((format, radar, beside)) = read else {
        return Err(no_drive_log(format, files.iter().map(|(name, _)| *name)));
    };
    let mut report = ReadReport::default();
    for (i, (name, _)) in files.iter().enumerate() {
        if i != radar && !beside.contains(&Some(i)) {
            report.ignored(name);
        }
    }
    let (name, bytes) = (files[radar].0, std::mem::take(&mut files[radar].1));
    let radar_error = |error| in_file(error, name);
    let bytes_beside = |k: usize| {
        let file = beside.get(k).copied().flatten()?;
        Some((files[file].0, &*files[file].1))
    };
    let mut log = match format {
        DriveFormat::Radarscenes => {
            let beside = Companions {
                scenes: bytes_beside(0).map(|file| file.1),
                sensors: bytes_beside(1).map(|file| file.1),
            };
            return radarscenes::read(bytes.into_owned(), beside, &mut report)
                .map(|log| DriveRead { log, report, format })
                .map_err(radar_error);
        }
        DriveFormat::Delphi => delphi::read_radar(&bytes, &mut report).map_err(radar_error)?,
        _ => table::read_detections(&bytes, &mut report).map_err(radar_error)?,
    };
    if let Some((name, bytes)) = bytes_beside(0) {
        log.motion = match format {
            DriveFormat::Delphi => delphi::read_poses(bytes, &mut report),
            _ => table::read_motion(bytes, &mut report),
        }
        .map_err(|error| in_file(error, name))?;
    }
    Ok(DriveRead { log, report, format })
}

/// Reads the parts of a recording in the order of their names.
fn open_mcap(
    mut files: Vec<File<'_>>,
    roles: &[Option<Role>],
    topics: &TopicOptions,
) -> Result<DriveRead, FormatError> {
    let mut reader = McapDriveReader::new(topics.clone());
    let (parts, others): (Vec<_>, Vec<_>) =
        (0..files.len()).partition(|i| roles[*i] == Some(Role::Mcap));
    let mut parts: Vec<_> = parts.into_iter().map(|i| (files[i].0, i)).collect();
    boresight_math::order::sort_by(&mut parts, Ord::cmp);
    for (name, i) in parts {
        let bytes = std::mem::take(&mut files[i].1);
        reader.push(&bytes).map_err(|error| in_file(error, name))?;
        reader.end_file();
    }
    let mut read = reader.finish()?;
    for i in others {
        read.report.ignored(files[i].0);
    }
    Ok(read)
}

/// The error for files that are no drive log, by their names.
pub fn no_drive_log<'a>(
    format: Option<DriveFormat>,
    names: impl Iterator<Item = &'a str>,
) -> FormatError {
    let one = |format| match format {
        DriveFormat::Radarscenes => {
            "radar_data.h5 with the datasets radar_data and odometry (a sequence of RadarScenes)"
                .to_owned()
        }
        DriveFormat::Delphi => {
            format!("a CSV with the columns {}", delphi::RADAR_COLUMNS.join(", "))
        }
        DriveFormat::Csv => {
            "a CSV with the columns time_s, azimuth_rad or azimuth_deg, range_rate_mps".to_owned()
        }
        DriveFormat::Pcd => {
            "point clouds of a radar, a .pcd a scan (nuScenes, TruckScenes)".to_owned()
        }
        DriveFormat::ViewOfDelft => "frames of View-of-Delft, as in 00549.bin".to_owned(),
        DriveFormat::Mcap => no_radar(),
    };
    let expected = match format {
        Some(format) => one(format),
        None => DriveFormat::VARIANTS.iter().copied().map(one).collect::<Vec<_>>().join("; or "),
    };
    let mut shown: Vec<String> = names.map(|name| name.chars().take(60).collect()).collect();
    let count = shown.len();
    shown.truncate(8);
    let given = match count {
        0 => "no files".to_owned(),
        1..=8 => shown.join(", "),
        _ => format!("{} and {} more", shown.join(", "), count - 8),
    };
    FormatError::NoDriveLog { expected, given }
}
