//! Writes a drive in the layout of `RadarScenes`: the rows of `radar_data.h5`, and the JSON files
//! beside it.
//!
//! Places in the car's and the global frame and compensated range rates are derived here: from the
//! mounting the log states, and from the motion sample next to the scan.

use super::json::{SceneEntry, ScenesFile, SequenceEntry, SequencesFile, sensors_json};
use super::wrong;
use crate::error::FormatError;
use boresight_core::InputError;
use boresight_core::drive::{Detection, DriveLog, MotionSample, Mounting, STATIC_LABEL, Scan};
use hdf5_pure::{
    CharacterSet, CompoundTypeBuilder, Datatype, FileBuilder, LibVer, StringPadding, make_f32_type,
    make_i64_type, make_u8_type,
};
use std::collections::BTreeMap;
use std::io::Write;

/// The first time stamp written, us; all of one file have as many digits.
const FIRST_STAMP_US: i64 = 100_000_000_000;
/// Longest time a file spans, s.
const LONGEST_S: f64 = 100_000.0;
const TEXT_BYTES: u32 = 32;
/// Rows of a chunk where data is packed.
const CHUNK_ROWS: u64 = 4096;
const DEFLATE_LEVEL: u32 = 6;

/// How rows are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Packing {
    /// In one piece, in the format of HDF5 1.8.
    #[default]
    Contiguous,
    /// In chunks, each packed by deflate, in the format of HDF5 1.10.
    Deflate,
}

/// The files beside `radar_data.h5`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SequenceFiles {
    /// `scenes.json`, in the sequence's folder.
    pub scenes: String,
    /// `sensors.json`, in the folder above.
    pub sensors: String,
    /// `sequences.json`, in the folder above: this sequence alone.
    pub sequences: String,
}

/// Writes `radar_data.h5` to `radar_data` and gives the files beside it. `tracks` has the number of
/// the road user each detection of each scan comes from, 0 for none, or is empty; detections
/// labelled static have no track in the file. Time stamps are those of the log to the microsecond,
/// from a first one of 1e11 us, but each scan at least 1 us after the one before, as scenes are found
/// by it.
///
/// Beside the file's rows, 110 bytes a detection, nothing of its size is held in memory.
///
/// # Errors
/// [`InputError::Empty`] without scans or motion, [`InputError::Shape`] unless every detection has a
/// label (and a track, if there are any), [`InputError::OutOfRange`] for times beyond 100,000 s,
/// [`FormatError::TimeBackwards`], and [`FormatError::Hdf5`] if `radar_data` takes no bytes.
pub fn write(
    log: &DriveLog,
    tracks: &[Vec<u32>],
    name: &str,
    packing: Packing,
    radar_data: impl Write,
) -> Result<SequenceFiles, FormatError> {
    check(log, tracks)?;
    let start_s = log.scans[0].time_s.min(log.motion[0].time_s);
    let scan_stamps = stamps("scans", log.scans.iter().map(|scan| scan.time_s), start_s)?;
    let motion_stamps = stamps("motion", log.motion.iter().map(|s| s.time_s), start_s)?;
    let nearest: Vec<usize> =
        scan_stamps.iter().map(|stamp| nearest(&motion_stamps, *stamp)).collect();

    let mounting: BTreeMap<u8, Mounting> =
        log.sensors.iter().filter_map(|s| Some((s.id, s.mounting?))).collect();
    let count: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
    let mut rows = Rows::with_capacity(count * 110);
    let mut ends = Vec::with_capacity(log.scans.len());
    let mut number = 0_u64;
    for (i, scan) in log.scans.iter().enumerate() {
        let motion = &log.motion[nearest[i]];
        let sensor = mounting.get(&scan.sensor);
        for (k, (detection, &label)) in scan.detections.iter().zip(&scan.labels).enumerate() {
            let track = tracks.get(i).map_or(0, |tracks| tracks[k]);
            rows.number(scan_stamps[i].to_le_bytes());
            rows.number([scan.sensor]);
            rows.floats(&columns(detection, sensor, motion));
            number += 1;
            rows.text(Some(number));
            rows.text(Some(u64::from(track)).filter(|t| *t != 0 && label != STATIC_LABEL));
            rows.number([label]);
        }
        ends.push(number);
    }
    let mut odometry = Rows::with_capacity(log.motion.len() * 28);
    for (sample, stamp) in log.motion.iter().zip(&motion_stamps) {
        odometry.number(stamp.to_le_bytes());
        let pose = sample.pose.map_or([f64::NAN; 3], |pose| [pose.x_m, pose.y_m, pose.yaw_rad]);
        odometry.floats(&pose.map(|number| number as f32));
        odometry
            .floats(&[sample.speed_mps.unwrap_or(f64::NAN) as f32, sample.yaw_rate_radps as f32]);
    }
    write_tables(count, rows.0, log.motion.len(), odometry.0, packing, radar_data).map_err(
        |error| match error {
            hdf5_pure::Error::Io(error) => {
                FormatError::NotWritten { what: "radar_data.h5", given: error.to_string() }
            }
            other => wrong("radar_data.h5", "a file that can be written", other),
        },
    )?;

    let entry = SequenceEntry {
        category: "train".into(),
        num_scenes: log.scans.len() as u64,
        duration: (scan_stamps[scan_stamps.len() - 1] - scan_stamps[0]) as f64 / 1e6,
        sensors: log.sensors.iter().map(|sensor| format!("radar_{}", sensor.id)).collect(),
    };
    let scenes = ScenesFile {
        sequence_name: name.into(),
        category: entry.category.clone(),
        first_timestamp: scan_stamps[0],
        last_timestamp: scan_stamps[scan_stamps.len() - 1],
        scenes: scenes(&log.scans, &scan_stamps, &ends, &nearest, &motion_stamps),
    };
    Ok(SequenceFiles {
        scenes: scenes.text(),
        sensors: sensors_json(&log.sensors),
        sequences: SequencesFile { sequences: [(name.to_owned(), entry)].into() }.text(),
    })
}

fn check(log: &DriveLog, tracks: &[Vec<u32>]) -> Result<(), FormatError> {
    let empty = |what: &str, expected: &str| -> FormatError {
        InputError::Empty { what: what.into(), expected: expected.into() }.into()
    };
    if log.scans.is_empty() {
        return Err(empty("scans", "at least one scan"));
    }
    if log.motion.is_empty() {
        return Err(empty("motion", "at least one motion sample"));
    }
    let shape = |what: &str, expected: usize, given: usize| -> Result<(), FormatError> {
        if given == expected {
            return Ok(());
        }
        let expected = format!("{expected}, one for each");
        Err(InputError::Shape { what: what.into(), expected, given: vec![given] }.into())
    };
    if !tracks.is_empty() {
        shape("tracks", log.scans.len(), tracks.len())?;
    }
    for (i, scan) in log.scans.iter().enumerate() {
        shape("labels", scan.detections.len(), scan.labels.len())?;
        if let Some(tracks) = tracks.get(i) {
            shape("tracks of a scan", scan.detections.len(), tracks.len())?;
        }
    }
    Ok(())
}

/// Time stamps, us, each later than the one before.
fn stamps(
    what: &str,
    times: impl Iterator<Item = f64>,
    start_s: f64,
) -> Result<Vec<i64>, FormatError> {
    let mut previous = (f64::NEG_INFINITY, i64::MIN);
    times
        .map(|time_s| {
            let since_s = time_s - start_s;
            if !(-1e-6..=LONGEST_S).contains(&since_s) {
                return Err(InputError::OutOfRange {
                    what: format!("time of {what}"),
                    expected: format!("{start_s} to {} s", start_s + LONGEST_S),
                    given: time_s,
                }
                .into());
            }
            if time_s < previous.0 {
                return Err(FormatError::TimeBackwards {
                    place: what.into(),
                    previous: previous.0,
                    given: time_s,
                });
            }
            let stamp = FIRST_STAMP_US + (since_s * 1e6).round() as i64;
            previous = (time_s, stamp.max(previous.1.saturating_add(1)));
            Ok(previous.1)
        })
        .collect()
}

/// The stamp next to a time.
fn nearest(stamps: &[i64], stamp: i64) -> usize {
    let after = stamps.partition_point(|s| *s < stamp);
    match after.checked_sub(1) {
        Some(before) if after == stamps.len() || stamp - stamps[before] < stamps[after] - stamp => {
            before
        }
        _ => after,
    }
}

/// `range_sc`, `azimuth_sc`, `rcs`, `vr`, `vr_compensated`, `x_cc`, `y_cc`, `x_seq`, `y_seq`; NaN
/// where the log does not tell.
fn columns(detection: &Detection, sensor: Option<&Mounting>, motion: &MotionSample) -> [f32; 9] {
    let nan = Mounting { x_m: f64::NAN, y_m: f64::NAN, yaw_rad: f64::NAN };
    let Mounting { x_m, y_m, yaw_rad } = *sensor.unwrap_or(&nan);
    let (sin, cos) = (f64::from(detection.azimuth_rad) + yaw_rad).sin_cos();
    let range_m = f64::from(detection.range_m);
    let (x_cc, y_cc) = (x_m + range_m * cos, y_m + range_m * sin);
    let turn = motion.yaw_rate_radps;
    let own_mps = (motion.speed_mps.unwrap_or(f64::NAN) - turn * y_m) * cos + turn * x_m * sin;
    let (x_seq, y_seq) = motion.pose.map_or((f64::NAN, f64::NAN), |pose| {
        let (sin, cos) = pose.yaw_rad.sin_cos();
        (pose.x_m + x_cc * cos - y_cc * sin, pose.y_m + x_cc * sin + y_cc * cos)
    });
    let compensated = f64::from(detection.range_rate_mps) + own_mps;
    [
        detection.range_m,
        detection.azimuth_rad,
        detection.rcs_dbsm,
        detection.range_rate_mps,
        compensated as f32,
        x_cc as f32,
        y_cc as f32,
        x_seq as f32,
        y_seq as f32,
    ]
}

/// Bytes of packed rows.
struct Rows(Vec<u8>);

impl Rows {
    fn with_capacity(bytes: usize) -> Self {
        Self(Vec::with_capacity(bytes))
    }

    fn number<const N: usize>(&mut self, bytes: [u8; N]) {
        self.0.extend_from_slice(&bytes);
    }

    fn floats(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|number| self.number(number.to_le_bytes()));
    }

    /// A number as 32 hexadecimal digits, or no text.
    fn text(&mut self, number: Option<u64>) {
        match number {
            Some(number) => self.0.extend_from_slice(format!("{number:032x}").as_bytes()),
            None => self.number([0; TEXT_BYTES as usize]),
        }
    }
}

fn write_tables(
    rows: usize,
    radar: Vec<u8>,
    samples: usize,
    odometry: Vec<u8>,
    packing: Packing,
    out: impl Write,
) -> Result<(), hdf5_pure::Error> {
    let text = || Datatype::String {
        size: TEXT_BYTES,
        padding: StringPadding::NullPad,
        charset: CharacterSet::Ascii,
    };
    let floats = |builder: CompoundTypeBuilder, names: &[&str]| {
        names.iter().fold(builder, |builder, name| builder.field(name, make_f32_type()))
    };
    let builder = CompoundTypeBuilder::new()
        .field("timestamp", make_i64_type())
        .field("sensor_id", make_u8_type());
    let radar_type = floats(
        builder,
        &[
            "range_sc",
            "azimuth_sc",
            "rcs",
            "vr",
            "vr_compensated",
            "x_cc",
            "y_cc",
            "x_seq",
            "y_seq",
        ],
    )
    .field("uuid", text())
    .field("track_id", text())
    .field("label_id", make_u8_type())
    .build()?;
    let odometry_type = floats(
        CompoundTypeBuilder::new().field("timestamp", make_i64_type()),
        &["x_seq", "y_seq", "yaw_seq", "vx", "yaw_rate"],
    )
    .build()?;
    let mut file = FileBuilder::new();
    if packing == Packing::Contiguous {
        file.with_libver_bounds(LibVer::Earliest, LibVer::V18);
    }
    for (name, datatype, bytes, count) in
        [("radar_data", radar_type, radar, rows), ("odometry", odometry_type, odometry, samples)]
    {
        let count = count as u64;
        let dataset = file.create_dataset(name).with_compound_data(datatype, bytes, count);
        if packing == Packing::Deflate && count > 0 {
            dataset.with_chunks(&[count.min(CHUNK_ROWS)]).with_deflate(DEFLATE_LEVEL);
        }
    }
    file.finish_to(out)
}

/// The scenes in order of time, each with its neighbours.
fn scenes(
    scans: &[Scan],
    stamps: &[i64],
    ends: &[u64],
    nearest: &[usize],
    motion_stamps: &[i64],
) -> Vec<(i64, SceneEntry)> {
    let mut latest: BTreeMap<u8, usize> = BTreeMap::new();
    let mut entries: Vec<(i64, SceneEntry)> = Vec::with_capacity(scans.len());
    for (i, scan) in scans.iter().enumerate() {
        let before = latest.insert(scan.sensor, i);
        if let Some(before) = before {
            entries[before].1.next_timestamp_same_sensor = Some(stamps[i]);
        }
        let start = i.checked_sub(1).map_or(0, |before| ends[before]);
        entries.push((
            stamps[i],
            SceneEntry {
                sensor_id: scan.sensor,
                prev_timestamp: i.checked_sub(1).map(|before| stamps[before]),
                next_timestamp: stamps.get(i + 1).copied(),
                prev_timestamp_same_sensor: before.map(|before| stamps[before]),
                next_timestamp_same_sensor: None,
                odometry_timestamp: motion_stamps[nearest[i]],
                odometry_index: nearest[i] as u64,
                image_name: String::new(),
                radar_indices: [start, ends[i]],
            },
        ));
    }
    entries
}
