//! Mounting angles on drives from files, whose true angles their logs state: every method on pieces of each drive.

use crate::candidates::{CANDIDATES, Candidate};
use crate::drives_report::DrivesReport;
use crate::error::ValidateError;
use crate::experiment::Experiment;
use crate::whole::{Answer, DRIVING_MPS, Drive, Radar, WholeRecord, joint_estimates, run};
use boresight_core::drive::{Mounting, STATIC_LABEL, Scan, Sensor};
use boresight_core::{DriveLog, InputError};
use boresight_math::error::check_range;
use boresight_mounting::{CalibrationOptions, Method};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Reads a drive's log.
pub type Load = fn(&Path) -> Result<DriveLog, Box<dyn Error + Send + Sync>>;

/// How far off the true angle calibrations are started, beside the true one, deg.
const STARTS_DEG: [f64; 3] = [2.0, 5.0, 8.0];

/// What to run.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct DrivesExperiment {
    /// Names of the drives.
    pub drives: Vec<String>,
    /// Lengths of the pieces that drives are cut into, s.
    pub pieces_s: Vec<f64>,
    /// Where the drives are, in the order of their names.
    #[serde(skip)]
    pub paths: Vec<PathBuf>,
    /// Reads one.
    #[serde(skip)]
    pub load: Option<Load>,
}

impl PartialEq for DrivesExperiment {
    fn eq(&self, other: &Self) -> bool {
        (&self.drives, &self.pieces_s) == (&other.drives, &other.pieces_s)
    }
}

/// What is kept of one drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DriveRecord {
    /// Its name.
    pub drive: String,
    /// Length of its log, s.
    pub duration_s: f64,
    /// Every method on all of it.
    pub whole: WholeRecord,
    /// Pieces of all lengths, radar by radar.
    pub pieces: Vec<PieceRecord>,
}

/// A radar on a piece of a drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PieceRecord {
    /// The radar's number.
    pub sensor: u8,
    /// Its true mounting angle, deg.
    pub true_deg: f64,
    /// Length of the piece, s.
    pub length_s: f64,
    /// Its beginning after that of the drive, s.
    pub start_s: f64,
    /// Answers in the order of [`CANDIDATES`]; `None` where the method gave no angle.
    pub answers: Vec<Option<Answer>>,
    /// Largest change of the recursive answer in its standard deviations when it begins up to 8 deg off.
    pub start_sigmas: Option<f64>,
}

impl Experiment for DrivesExperiment {
    const NAME: &'static str = "calibration-drives";
    const REVISION: u32 = 1;
    type Plan = ();
    type Error = ValidateError;
    type Record = DriveRecord;
    type Report = DrivesReport;

    fn plan(&self) -> Result<(), ValidateError> {
        if self.drives.is_empty() {
            let expected = "at least one folder with a drive".into();
            return Err(InputError::Empty { what: "drives".into(), expected }.into());
        }
        for (i, length_s) in self.pieces_s.iter().enumerate() {
            check_range(&format!("piecesS[{i}]"), *length_s, 1.0, 1e5)?;
        }
        Ok(())
    }

    fn methods((): &()) -> Vec<String> {
        CANDIDATES.iter().map(|candidate| candidate.name.into()).collect()
    }

    fn scenes(&self) -> u64 {
        self.drives.len() as u64
    }

    fn scene(&self, (): &(), number: u64) -> Result<DriveRecord, ValidateError> {
        let index = number as usize;
        let name = &self.drives[index];
        let unreadable = |source| ValidateError::Drive { name: name.clone(), source };
        let (Some(load), Some(path)) = (self.load, self.paths.get(index)) else {
            return Err(unreadable("its place is not known".into()));
        };
        let log = load(path).map_err(unreadable)?;
        let (Some(first), Some(last)) = (log.scans.first(), log.scans.last()) else {
            return Err(unreadable("it has no scans".into()));
        };
        let (start_s, duration_s) = (first.time_s, last.time_s - first.time_s);
        let radars = radars(&log);
        let gap_s = CalibrationOptions::default().max_gap_s;
        let whole = run(
            &Drive {
                log: &log,
                radars: radars.clone(),
                pose_at: &|time_s| log.pose_at(time_s, gap_s),
                speed_at: &|time_s| log.speed_at(time_s, gap_s),
                scale: None,
            },
            moving_share(&log, gap_s),
        )?;
        let mut pieces = vec![];
        for &length_s in &self.pieces_s {
            for piece in 0..(duration_s / length_s) as usize {
                let begin_s = start_s + piece as f64 * length_s;
                pieces.extend(
                    run_piece(&log, &radars, [begin_s, begin_s + length_s])?.into_iter().map(
                        |record| PieceRecord { length_s, start_s: begin_s - start_s, ..record },
                    ),
                );
            }
        }
        Ok(DriveRecord { drive: name.clone(), duration_s, whole, pieces })
    }

    fn report(&self, (): &(), records: impl Iterator<Item = DriveRecord>) -> DrivesReport {
        DrivesReport::new(&self.pieces_s, records)
    }
}

/// The radars whose mounting a log states, which is taken as the truth and as the nominal angle.
fn radars(log: &DriveLog) -> Vec<(u8, Mounting, CalibrationOptions)> {
    let stated = |sensor: &Sensor| {
        let mounting = sensor.mounting?;
        let options = CalibrationOptions {
            x_m: mounting.x_m,
            y_m: mounting.y_m,
            nominal_rad: Some(mounting.yaw_rad),
            ..CalibrationOptions::default()
        };
        Some((sensor.id, mounting, options))
    };
    log.sensors.iter().filter_map(stated).collect()
}

/// Labels of moving road users over all, of scans while driving; `None` without labels.
fn moving_share(log: &DriveLog, gap_s: f64) -> Option<f64> {
    let drives = |scan: &&Scan| {
        log.speed_at(scan.time_s, gap_s).is_some_and(|speed| speed.abs() > DRIVING_MPS)
    };
    let labels = || log.scans.iter().filter(drives).flat_map(|scan| &scan.labels);
    let all = labels().count();
    let moving = labels().filter(|label| **label != STATIC_LABEL).count();
    (all > 0).then(|| moving as f64 / all as f64)
}

/// All radars with a known mounting on a part of a log.
fn run_piece(
    log: &DriveLog,
    radars: &[(u8, Mounting, CalibrationOptions)],
    times_s: [f64; 2],
) -> Result<Vec<PieceRecord>, ValidateError> {
    let radars: Vec<Radar> = radars
        .iter()
        .map(|radar| Radar::new(log, *radar, times_s))
        .filter(|radar| !radar.frames.is_empty())
        .collect();
    let mut records: Vec<PieceRecord> = vec![];
    for radar in &radars {
        let mut answers = vec![];
        let mut start_sigmas = None;
        for candidate in &CANDIDATES {
            // The joint ones are filled in below.
            let answer = match candidate.joint {
                true => None,
                false => answer(candidate, radar, 0.0)?,
            };
            if candidate.method == Method::Recursive && candidate.speed && !candidate.joint {
                start_sigmas = change_with_start(candidate, radar, answer)?;
            }
            answers.push(answer);
        }
        records.push(PieceRecord {
            sensor: radar.sensor,
            true_deg: radar.truth.yaw_rad.to_degrees(),
            length_s: 0.0,
            start_s: 0.0,
            answers,
            start_sigmas,
        });
    }
    for (index, candidate) in CANDIDATES.iter().enumerate().filter(|(_, c)| c.joint) {
        let estimates = joint_estimates(candidate, &radars, log, times_s)?;
        for ((record, radar), estimate) in records.iter_mut().zip(&radars).zip(estimates) {
            record.answers[index] = Answer::of(radar.truth.yaw_rad, &estimate);
        }
    }
    Ok(records)
}

/// The answer of a method that begins so far off.
fn answer(
    candidate: &Candidate,
    radar: &Radar,
    off_deg: f64,
) -> Result<Option<Answer>, ValidateError> {
    let nominal_rad = radar.options.nominal_rad.map(|angle| angle + off_deg.to_radians());
    let begun = Radar {
        options: CalibrationOptions { nominal_rad, ..radar.options },
        frames: radar.frames.clone(),
        ..*radar
    };
    Ok(Answer::of(radar.truth.yaw_rad, &begun.calibrate(candidate, &begun.frames)?))
}

fn change_with_start(
    candidate: &Candidate,
    radar: &Radar,
    at_truth: Option<Answer>,
) -> Result<Option<f64>, ValidateError> {
    let Some(at_truth) = at_truth else { return Ok(None) };
    let mut most = 0.0_f64;
    for off_deg in STARTS_DEG {
        let change = answer(candidate, radar, off_deg)?.map_or(f64::MAX, |other| {
            (other.error_deg - at_truth.error_deg).abs() / at_truth.sigma_deg
        });
        most = most.max(change);
    }
    Ok(Some(most))
}
