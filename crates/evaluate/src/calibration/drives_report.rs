//! From records of drives to tables.

use super::drives::{DriveRecord, PieceAnswer, PieceRecord};
use super::report::{percent, within};
use super::{CANDIDATES, Candidate};
use crate::EvaluateError;
use crate::experiment::Report;
use crate::statistics::Summary;
use crate::table::table;
use boresight_calibrate::Method;
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct DrivesReport {
    /// Drives.
    pub drives: usize,
    /// Length of all drives, h.
    pub duration_h: f64,
    /// Pieces by their length.
    pub lengths: Vec<Pieces>,
}

/// All pieces of one length.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Pieces {
    /// Their length, s.
    pub length_s: f64,
    /// Radars: number and true angle in the first drive that has it, deg.
    pub radars: Vec<(u8, f64)>,
    /// Methods in the order of [`CANDIDATES`].
    pub methods: Vec<PieceResult>,
    /// Largest change of a recursive answer in its standard deviations when it begins up to 8 deg off.
    pub start_sigmas: f64,
}

/// A method on all pieces of one length.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PieceResult {
    /// Name.
    pub name: &'static str,
    /// Errors by radar, deg.
    pub radars: Vec<Summary>,
    /// Errors of all radars, deg.
    pub all: Summary,
    /// Pieces that gave no angle.
    pub without: usize,
    /// Share of errors within one and two of the stated standard deviations.
    pub within: [f64; 2],
    /// Pieces called converged.
    pub converged: usize,
    /// Pieces called converged that are more than three standard deviations off.
    pub confidently_wrong: usize,
}

impl DrivesReport {
    /// From the records, in order.
    pub fn new(lengths_s: &[f64], records: impl Iterator<Item = DriveRecord>) -> Self {
        let records: Vec<DriveRecord> = records.collect();
        let pieces = |length_s: f64| -> Vec<&PieceRecord> {
            records
                .iter()
                .flat_map(|record| &record.pieces)
                .filter(|piece| piece.length_s == length_s)
                .collect()
        };
        Self {
            drives: records.len(),
            duration_h: records.iter().map(|record| record.duration_s).sum::<f64>() / 3600.0,
            lengths: lengths_s.iter().map(|&length| Pieces::new(length, &pieces(length))).collect(),
        }
    }
}

impl Pieces {
    fn new(length_s: f64, pieces: &[&PieceRecord]) -> Self {
        let mut radars: Vec<(u8, f64)> = vec![];
        for piece in pieces {
            if radars.iter().all(|(sensor, _)| *sensor != piece.sensor) {
                radars.push((piece.sensor, piece.true_deg));
            }
        }
        radars.sort_by_key(|(sensor, _)| *sensor);
        Self {
            length_s,
            methods: CANDIDATES
                .iter()
                .enumerate()
                .map(|(index, candidate)| PieceResult::new(index, candidate, &radars, pieces))
                .collect(),
            radars,
            start_sigmas: pieces.iter().filter_map(|piece| piece.start_sigmas).fold(0.0, f64::max),
        }
    }
}

impl PieceResult {
    fn new(
        index: usize,
        candidate: &Candidate,
        radars: &[(u8, f64)],
        pieces: &[&PieceRecord],
    ) -> Self {
        let answers = || pieces.iter().map(|piece| (piece.sensor, &piece.answers[index]));
        let errors = |wanted: &dyn Fn(u8) -> bool| {
            let errors: Vec<f64> = answers()
                .filter(|(sensor, _)| wanted(*sensor))
                .filter_map(|(_, answer)| answer.error_deg)
                .collect();
            Summary::of(&errors)
        };
        let told = |answer: &PieceAnswer| Some((answer.error_deg?, answer.sigma_deg?));
        let wrong = |answer: &PieceAnswer| {
            answer.converged && told(answer).is_some_and(|(error, sigma)| error.abs() > 3.0 * sigma)
        };
        Self {
            name: candidate.name,
            radars: radars.iter().map(|(radar, _)| errors(&|sensor| sensor == *radar)).collect(),
            all: errors(&|_| true),
            without: answers().filter(|(_, answer)| answer.error_deg.is_none()).count(),
            within: within(answers().filter_map(|(_, answer)| told(answer))),
            converged: answers().filter(|(_, answer)| answer.converged).count(),
            confidently_wrong: answers().filter(|(_, answer)| wrong(answer)).count(),
        }
    }
}

impl Report for DrivesReport {
    fn tables(&self) -> String {
        let mut text = format!(
            "## {} drives from files, {:.2} h\n\nTrue angles are those that the logs state.\n",
            self.drives, self.duration_h
        );
        for pieces in &self.lengths {
            text += &format!(
                "\n### Pieces of {} s\n\nErrors of the angle: mean in deg and variance in deg^2 by radar, mean absolute error in deg of all \
                 (pieces without an angle), the share within one and two stated standard deviations, and how many pieces are called \
                 converged and how many of these are more than three deviations off.\n\n",
                pieces.length_s
            );
            let mut heads: Vec<String> = pieces
                .radars
                .iter()
                .map(|(sensor, true_deg)| format!("radar {sensor} ({true_deg:.2} deg)"))
                .collect();
            heads.extend(["all", "within 1, 2 sigma", "converged, 3 sigma off"].map(String::from));
            let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
            let rows: Vec<_> = pieces.methods.iter().map(|m| (m.name, m.cells())).collect();
            text += &table("method", &heads, &rows);
            let recursive = CANDIDATES
                .iter()
                .find(|c| c.method == Method::Recursive && c.speed && !c.joint)
                .map_or("recursive", |c| c.name);
            text += &format!(
                "\nBegun 2, 5 and 8 deg off, the method \"{recursive}\" changes by at most {:.2} of its standard deviations.\n",
                pieces.start_sigmas
            );
        }
        text
    }

    fn csv(&self) -> String {
        let mut text = "length_s,method,radar,pieces,error_mean_deg,error_variance_deg2,error_mean_absolute_deg,\
                        error_largest_deg\n"
            .to_owned();
        for pieces in &self.lengths {
            for method in &pieces.methods {
                for ((sensor, _), e) in pieces.radars.iter().zip(&method.radars) {
                    text += &format!(
                        "{},\"{}\",{sensor},{},{},{},{},{}\n",
                        pieces.length_s,
                        method.name,
                        e.count,
                        e.mean,
                        e.variance,
                        e.mean_absolute,
                        e.largest
                    );
                }
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &[];

    fn figures(&self) -> Result<Vec<String>, EvaluateError> {
        Ok(vec![])
    }
}

impl PieceResult {
    fn cells(&self) -> Vec<String> {
        let mut cells: Vec<String> = self
            .radars
            .iter()
            .map(|error| format!("{:+.4}, {:.4}", error.mean, error.variance))
            .collect();
        let without = if self.without > 0 { format!(" ({})", self.without) } else { String::new() };
        cells.push(format!("{:.3}{without}", self.all.mean_absolute));
        cells.push(percent(self.within));
        cells.push(format!("{}, {}", self.converged, self.confidently_wrong));
        cells
    }
}
