//! Drives of one file a scan: the point clouds of nuScenes and TruckScenes ([`crate::pcd`]), with their tables of JSON beside
//! them, and the frames of View-of-Delft ([`view_of_delft`]).
//!
//! Clouds are taken in one after the other, so that a long drive is never held as files; of the tables, which run
//! to gigabytes, only the rows of the clouds are kept.
//!
//! Radar and time are in the names of files: `LOG__CHANNEL__MICROSECONDS.pcd` in nuScenes, otherwise a name that ends in a Unix
//! time, with what stands before it, or the folder, as the radar.

mod name;
mod points;
mod poses;
mod rows;
mod tables;
pub mod view_of_delft;

pub use tables::Tables;

use super::open::{DriveFormat, DriveRead};
use super::report::{MountingSource, ReadReport};
use crate::drive_log::scans::sort_scans;
use crate::error::FormatError;
use crate::pcd::PointCloud;
use boresight_core::Remark;
use boresight_core::drive::{Detection, DriveLog, Scan, Sensor};
use name::CloudName;
use std::collections::BTreeMap;
use tables::Read;

/// Most radars of a drive.
const MOST_RADARS: usize = 255;

/// Whether a file's name is that of a scan in a file of its own.
pub fn is_cloud(name: &str) -> bool {
    format_of(name).is_some()
}

/// The format of a scan in a file of its own, by the file's name.
pub fn format_of(name: &str) -> Option<DriveFormat> {
    let lower = name.to_ascii_lowercase();
    if lower.ends_with(".pcd") {
        Some(DriveFormat::Pcd)
    } else {
        view_of_delft::frame_of(name, ".bin").map(|_| DriveFormat::ViewOfDelft)
    }
}

/// The recording that a cloud belongs to by its name, if it says so.
pub fn log_of(name: &str) -> Option<String> {
    name::parse(name).and_then(|name| name.log)
}

/// A scan as its file has it.
struct Taken {
    stamp_ns: i128,
    channel: String,
    detections: Vec<Detection>,
}

/// Takes in the clouds of a drive.
pub struct Clouds {
    format: DriveFormat,
    log: Option<String>,
    /// By the names of the files, without folders.
    scans: BTreeMap<String, Taken>,
    report: ReadReport,
}

impl Clouds {
    /// Of a format that has a file for each scan.
    pub fn new(format: DriveFormat) -> Self {
        Self { format, log: None, scans: BTreeMap::new(), report: ReadReport::default() }
    }

    /// Takes in a cloud by its file's name, with or without folders before it. The second of a name is left out and said.
    ///
    /// # Errors
    /// [`FormatError::Binary`] for a file that is none, [`FormatError::NoDriveLog`] for a name without a time and for clouds
    /// of two recordings.
    pub fn add(&mut self, path: &str, bytes: &[u8]) -> Result<(), FormatError> {
        let base = base(path);
        if self.scans.contains_key(base) {
            let message = format!("{base} was given twice and is taken once");
            self.report.remarks.push(Remark::new("duplicate-cloud", message));
            return Ok(());
        }
        let taken = if self.format == DriveFormat::ViewOfDelft {
            let stamp_ns = view_of_delft::stamp_ns(path)?;
            let detections = view_of_delft::points(bytes, &mut self.report)?;
            Taken { stamp_ns, channel: "radar".into(), detections }
        } else {
            let CloudName { log, channel, stamp_ns } =
                name::parse(path).ok_or_else(|| name::untimed(path))?;
            if let (Some(first), Some(given)) = (&self.log, &log)
                && first != given
            {
                return Err(FormatError::NoDriveLog {
                    expected: "clouds of one recording".into(),
                    given: format!("those of {first} and {given}"),
                });
            }
            self.log = log.or(self.log.take());
            let detections = points::detections(&PointCloud::parse(bytes)?, &mut self.report)?;
            Taken { stamp_ns, channel, detections }
        };
        self.scans.insert(base.to_owned(), taken);
        Ok(())
    }

    /// The drive, with what tables say of its radars and of the car.
    ///
    /// # Errors
    /// [`FormatError::Json`] for a table that is none, [`FormatError::NoDriveLog`] without a cloud or with too many radars.
    pub fn finish(mut self, tables: Tables<'_>) -> Result<DriveRead, FormatError> {
        let Some(first_ns) = self.scans.values().map(|scan| scan.stamp_ns).min() else {
            return Err(super::no_drive_log(Some(self.format), std::iter::empty()));
        };
        let last_ns = self.scans.values().map(|scan| scan.stamp_ns).max().unwrap_or(first_ns);
        let read = Read::of(
            tables,
            &mut self.scans,
            self.log.as_deref(),
            [first_ns, last_ns],
            &mut self.report,
        )?;
        let first_ns = self.scans.values().map(|scan| scan.stamp_ns).min().unwrap_or(first_ns);
        let seconds = |stamp_ns: i128| (stamp_ns - first_ns) as f64 / 1e9;
        let mut channels: Vec<String> =
            self.scans.values().map(|scan| scan.channel.clone()).collect();
        boresight_math::order::sort_by(&mut channels, Ord::cmp);
        channels.dedup();
        if channels.len() > MOST_RADARS {
            return Err(FormatError::NoDriveLog {
                expected: format!("at most {MOST_RADARS} radars"),
                given: channels.len().to_string(),
            });
        }
        let mut log = DriveLog::default();
        let mut mirrored = vec![];
        for (channel, id) in channels.iter().zip(1..) {
            let placed = read.mountings.get(channel);
            if placed.is_some_and(|placed| placed.upside_down) {
                mirrored.push(id);
            }
            log.sensors.push(Sensor { id, mounting: placed.map(|placed| placed.mounting) });
        }
        let number =
            |channel: &String| channels.binary_search(channel).map_or(0, |at| at as u8 + 1);
        for taken in std::mem::take(&mut self.scans).into_values() {
            let sensor = number(&taken.channel);
            let mut detections = taken.detections;
            if mirrored.contains(&sensor) {
                detections.iter_mut().for_each(|d| d.azimuth_rad = -d.azimuth_rad);
            }
            log.scans.push(Scan {
                time_s: seconds(taken.stamp_ns),
                sensor,
                detections,
                labels: vec![],
            });
        }
        sort_scans(&mut log.scans);
        log.motion = read.motion(seconds, &mut self.report);
        self.remark(&channels, &mirrored, &log);
        self.report.mountings = log
            .sensors
            .iter()
            .any(|sensor| sensor.mounting.is_some())
            .then_some(MountingSource::CalibratedSensor);
        self.report.sequence = self.log.map(|log| (log.chars().take(60).collect(), None));
        Ok(DriveRead { log, report: self.report, format: self.format })
    }

    fn remark(&mut self, channels: &[String], mirrored: &[u8], log: &DriveLog) {
        let mut say = |code, message: String| self.report.remarks.push(Remark::new(code, message));
        let cut = |name: &String| name.chars().take(40).collect::<String>();
        let named: Vec<String> = channels
            .iter()
            .zip(1..)
            .take(16)
            .map(|(name, id): (_, u8)| format!("{id} {}", cut(name)))
            .collect();
        say("radar-names", format!("radars: {}", named.join(", ")));
        if !mirrored.is_empty() {
            let ids: Vec<String> = mirrored.iter().map(u8::to_string).collect();
            let message = "mounted upside down, so that their azimuths were turned round: radars";
            say("upside-down", format!("{message} {}", ids.join(", ")));
        }
        if log.motion.is_empty() {
            say("no-motion", "no file tells the car's motion".into());
        }
    }
}

/// A file's name without folders.
fn base(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Reads a drive of clouds from files, if there are clouds among them.
pub(super) fn open(
    files: &[(&str, std::borrow::Cow<'_, [u8]>)],
    format: Option<DriveFormat>,
) -> Result<Option<DriveRead>, FormatError> {
    let of = |name: &str| format_of(name).filter(|own| format.is_none_or(|format| format == *own));
    let Some(format) = files.iter().find_map(|(name, _)| of(name)) else { return Ok(None) };
    let mut clouds = Clouds::new(format);
    let mut tables = Tables::default();
    for (name, bytes) in files {
        if of(name) == Some(format) {
            clouds.add(name, bytes).map_err(|error| super::open::in_file(error, name))?;
        } else if !tables.take(name, Box::new(&**bytes)) {
            clouds.report.ignored(name);
        }
    }
    clouds.finish(tables).map(Some)
}

#[cfg(test)]
mod tests;
