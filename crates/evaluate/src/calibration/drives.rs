//! Mounting angles on drives from files, whose true angles their logs state: every method on pieces of each drive.

use super::drives_report::DrivesReport;
use super::scene::{error_deg, joint_estimates};
use super::{CANDIDATES, Candidate};
use crate::EvaluateError;
use crate::experiment::Experiment;
use boresight_calibrate::{CalibrationOptions, Calibrator, FrameInput, Frames, Method};
use boresight_core::error::check_range;
use boresight_core::{CoreError, DriveLog};
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
    /// Answers in the order of [`CANDIDATES`].
    pub answers: Vec<PieceAnswer>,
    /// Largest change of the recursive answer in its standard deviations when it begins up to 8 deg off.
    pub start_sigmas: Option<f64>,
}

/// A method's answer to a piece.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PieceAnswer {
    /// Estimated less true angle, deg; `None` where the method gave no angle.
    pub error_deg: Option<f64>,
    /// Its standard deviation as the method states it, deg.
    pub sigma_deg: Option<f64>,
    /// Whether it called itself converged.
    pub converged: bool,
}

impl Experiment for DrivesExperiment {
    const NAME: &'static str = "calibration-drives";
    type Plan = ();
    type Record = DriveRecord;
    type Report = DrivesReport;

    fn plan(&self) -> Result<(), EvaluateError> {
        if self.drives.is_empty() {
            let expected = "at least one folder with a drive".into();
            return Err(CoreError::Empty { what: "drives".into(), expected }.into());
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

    fn scene(&self, (): &(), number: u64) -> Result<DriveRecord, EvaluateError> {
        let index = number as usize;
        let name = &self.drives[index];
        let unreadable = |source| EvaluateError::Drive { name: name.clone(), source };
        let (Some(load), Some(path)) = (self.load, self.paths.get(index)) else {
            return Err(unreadable("its place is not known".into()));
        };
        let log = load(path).map_err(unreadable)?;
        let (Some(first), Some(last)) = (log.scans.first(), log.scans.last()) else {
            return Err(unreadable("it has no scans".into()));
        };
        let (start_s, duration_s) = (first.time_s, last.time_s - first.time_s);
        let mut pieces = vec![];
        for &length_s in &self.pieces_s {
            for piece in 0..(duration_s / length_s) as usize {
                let begin_s = start_s + piece as f64 * length_s;
                pieces.extend(
                    run_piece(&log, [begin_s, begin_s + length_s])?.into_iter().map(|record| {
                        PieceRecord { length_s, start_s: begin_s - start_s, ..record }
                    }),
                );
            }
        }
        Ok(DriveRecord { drive: name.clone(), duration_s, pieces })
    }

    fn report(&self, (): &(), records: impl Iterator<Item = DriveRecord>) -> DrivesReport {
        DrivesReport::new(&self.pieces_s, records)
    }
}

/// A radar whose true angle is known.
struct Radar<'a> {
    sensor: u8,
    true_rad: f64,
    options: CalibrationOptions,
    frames: Vec<FrameInput<'a>>,
}

/// All radars with a known mounting on a part of a log.
fn run_piece(
    log: &DriveLog,
    [begin_s, end_s]: [f64; 2],
) -> Result<Vec<PieceRecord>, EvaluateError> {
    let defaults = CalibrationOptions::default();
    let radars: Vec<Radar> = log
        .sensors
        .iter()
        .filter_map(|sensor| {
            let mounting = sensor.mounting?;
            let frames: Vec<FrameInput> = Frames::of(log, |id| id == sensor.id, defaults.max_gap_s)
                .map(|(_, frame)| frame)
                .filter(|frame| (begin_s..end_s).contains(&frame.time_s))
                .collect();
            let options = CalibrationOptions {
                x_m: mounting.x_m,
                y_m: mounting.y_m,
                nominal_rad: Some(mounting.yaw_rad),
                ..defaults
            };
            (!frames.is_empty()).then_some(Radar {
                sensor: sensor.id,
                true_rad: mounting.yaw_rad,
                options,
                frames,
            })
        })
        .collect();
    let mut records: Vec<PieceRecord> = vec![];
    for radar in &radars {
        let mut answers = vec![];
        let mut start_sigmas = None;
        for candidate in &CANDIDATES {
            // The joint ones are filled in below.
            let answer = match candidate.joint {
                true => PieceAnswer { error_deg: None, sigma_deg: None, converged: false },
                false => answer(candidate, radar, 0.0)?,
            };
            if candidate.method == Method::Recursive && candidate.speed && !candidate.joint {
                start_sigmas = change_with_start(candidate, radar, &answer)?;
            }
            answers.push(answer);
        }
        records.push(PieceRecord {
            sensor: radar.sensor,
            true_deg: radar.true_rad.to_degrees(),
            length_s: 0.0,
            start_s: 0.0,
            answers,
            start_sigmas,
        });
    }
    for (index, candidate) in CANDIDATES.iter().enumerate().filter(|(_, c)| c.joint) {
        let named: Vec<_> =
            radars.iter().map(|r| (r.sensor, candidate.options(&r.options))).collect();
        let frames = Frames::of(log, |_| true, defaults.max_gap_s)
            .filter(|(_, frame)| (begin_s..end_s).contains(&frame.time_s));
        for ((record, radar), estimate) in
            records.iter_mut().zip(&radars).zip(joint_estimates(candidate, &named, frames)?)
        {
            record.answers[index] = told(radar, &estimate);
        }
    }
    Ok(records)
}

fn answer(
    candidate: &Candidate,
    radar: &Radar,
    off_deg: f64,
) -> Result<PieceAnswer, EvaluateError> {
    let nominal_rad = radar.options.nominal_rad.map(|angle| angle + off_deg.to_radians());
    let options = CalibrationOptions { nominal_rad, ..candidate.options(&radar.options) };
    let mut calibrator = Calibrator::new(options)?;
    for frame in &radar.frames {
        calibrator.add(candidate.told(frame))?;
    }
    Ok(told(radar, &calibrator.estimate()))
}

fn told(radar: &Radar, estimate: &boresight_calibrate::AngleEstimate) -> PieceAnswer {
    let error_deg = error_deg(radar.true_rad, estimate);
    PieceAnswer {
        error_deg,
        sigma_deg: error_deg.map(|_| estimate.sigma_rad.to_degrees()),
        converged: estimate.converged,
    }
}

fn change_with_start(
    candidate: &Candidate,
    radar: &Radar,
    at_truth: &PieceAnswer,
) -> Result<Option<f64>, EvaluateError> {
    let (Some(error), Some(sigma)) = (at_truth.error_deg, at_truth.sigma_deg) else {
        return Ok(None);
    };
    let mut most = 0.0_f64;
    for off_deg in STARTS_DEG {
        let other = answer(candidate, radar, off_deg)?;
        most = most.max(other.error_deg.map_or(f64::MAX, |other| (other - error).abs() / sigma));
    }
    Ok(Some(most))
}
