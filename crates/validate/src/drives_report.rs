//! From records of drives to tables.

use crate::accepted::{Accepted, PRECISION_DEG, percent, within};
use crate::candidates::{CANDIDATES, Candidate};
use crate::condition::Condition;
use crate::drives::{DriveRecord, PieceRecord};
use crate::experiment::Report;
use crate::figures;
use crate::statistics::Summary;
use crate::table::{Best, Cell, Table, Tables};
use crate::tables::or_none;
use crate::whole::{Answer, WholeRecord};
use boresight_mounting::Method;
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct DrivesReport {
    /// Drives.
    pub drives: usize,
    /// Length of all drives, h.
    pub duration_h: f64,
    /// Every method on whole drives.
    pub whole: Condition,
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
    /// Pieces called converged beside the reference.
    pub accepted: Accepted,
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
        let whole: Vec<&WholeRecord> = records.iter().map(|record| &record.whole).collect();
        let reference = |sensor| reference_error_deg(&whole, sensor);
        Self {
            drives: records.len(),
            duration_h: records.iter().map(|record| record.duration_s).sum::<f64>() / 3600.0,
            lengths: lengths_s
                .iter()
                .map(|&length| Pieces::new(length, &pieces(length), &reference))
                .collect(),
            whole: Condition::new("whole drives", &whole),
        }
    }
}

/// Error of the angle that all whole drives together give for a radar, by the method that has all radars together, deg; 0 without any.
fn reference_error_deg(whole: &[&WholeRecord], sensor: u8) -> f64 {
    let (mut weights, mut sum) = (0.0, 0.0);
    for radar in whole.iter().flat_map(|record| &record.radars).filter(|r| r.sensor == sensor) {
        let joint = CANDIDATES.iter().zip(&radar.estimates).find(|(c, _)| c.joint);
        if let Some(answer) = joint.and_then(|(_, estimate)| estimate.answer()) {
            let weight = answer.sigma_deg.powi(-2);
            weights += weight;
            sum += weight * answer.error_deg;
        }
    }
    if weights > 0.0 { sum / weights } else { 0.0 }
}

impl Pieces {
    fn new(length_s: f64, pieces: &[&PieceRecord], reference: &dyn Fn(u8) -> f64) -> Self {
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
                .map(|(index, candidate)| {
                    PieceResult::new(index, candidate, &radars, pieces, reference)
                })
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
        reference: &dyn Fn(u8) -> f64,
    ) -> Self {
        let answers =
            || pieces.iter().filter_map(|piece| Some((piece.sensor, piece.answers[index]?)));
        let without = pieces.len() - answers().count();
        let errors = |wanted: &dyn Fn(u8) -> bool| {
            let wanted = answers().filter(|(sensor, _)| wanted(*sensor));
            Summary::of(&wanted.map(|(_, answer)| answer.error_deg).collect::<Vec<_>>())
        };
        let beside = |(sensor, answer): (u8, Answer)| Answer {
            error_deg: answer.error_deg - reference(sensor),
            ..answer
        };
        Self {
            name: candidate.name,
            radars: radars.iter().map(|(radar, _)| errors(&|sensor| sensor == *radar)).collect(),
            all: errors(&|_| true),
            without,
            within: within(answers().map(|(_, answer)| (answer.error_deg, answer.sigma_deg))),
            converged: answers().filter(|(_, answer)| answer.converged).count(),
            confidently_wrong: answers().filter(|(_, answer)| answer.confidently_wrong()).count(),
            accepted: Accepted::of(answers().map(beside), without),
        }
    }
}

impl Report for DrivesReport {
    fn tables(&self) -> Tables {
        let remark = format!(
            "# {} drives from files, {:.2} h\n\nTrue angles are those that the logs state.\n",
            self.drives, self.duration_h
        );
        let recursive = CANDIDATES
            .iter()
            .find(|c| c.method == Method::Recursive && c.speed && !c.joint)
            .map_or("recursive", |c| c.name);
        let of_length = |pieces: &Pieces| {
            let radars = pieces
                .radars
                .iter()
                .map(|(sensor, true_deg)| format!("radar {sensor} ({true_deg:.2} deg)"));
            let further =
                ["all", "within 1, 2 sigma", "converged, 3 sigma off", "precision, recall"];
            Table::new(
                format!(
                    "## Pieces of {} s\n\nBegun 2, 5 and 8 deg off, the method \"{recursive}\" changes by at most {:.2} of its \
                     standard deviations.\n\nErrors of the angle: mean in deg and variance in deg^2 by radar, mean absolute error in deg of all \
                     (pieces without an angle), the share within one and two stated standard deviations, how many pieces are called \
                     converged and how many of these are more than three deviations off, and precision and recall: of those called converged the share \
                     within {PRECISION_DEG} deg of what all whole drives give (recursive, four radars), and their share of all.",
                    pieces.length_s, pieces.start_sigmas
                ),
                Best::None,
                "method",
                radars.chain(further.map(String::from)),
                pieces
                    .methods
                    .iter()
                    .map(|m| (m.name, m.cells().into_iter().map(Cell::text).collect())),
            )
        };
        let mut tables = self.whole.tables();
        tables.extend(self.lengths.iter().map(of_length));
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text = "length_s,method,radar,pieces,error_mean_deg,error_variance_deg2,error_mean_absolute_deg,\
                        error_largest_deg\n"
            .to_owned();
        let mut add = |length: &str, method: &str, sensor: u8, e: &Summary| {
            text += &format!(
                "{length},\"{method}\",{sensor},{},{},{},{},{}\n",
                e.count, e.mean, e.variance, e.mean_absolute, e.largest
            );
        };
        for method in &self.whole.methods {
            for radar in &method.radars {
                add("whole", method.name, radar.sensor, &radar.error_deg);
            }
        }
        for pieces in &self.lengths {
            let length = pieces.length_s.to_string();
            for method in &pieces.methods {
                for ((sensor, _), error) in pieces.radars.iter().zip(&method.radars) {
                    add(&length, method.name, *sensor, error);
                }
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &["convergence.svg", "states.svg", "angles.svg"];

    fn figures(&self) -> Vec<String> {
        let whole = std::slice::from_ref(&self.whole);
        vec![figures::convergence(whole), figures::states(whole), figures::angles(&self.whole)]
    }
}

impl PieceResult {
    fn cells(&self) -> Vec<String> {
        let mut cells: Vec<String> = self
            .radars
            .iter()
            .map(|error| format!("{:+.4}, {:.4}", error.mean, error.variance))
            .collect();
        let without = or_none(self.without);
        cells.push(format!("{:.3}{without}", self.all.mean_absolute));
        cells.push(percent(self.within));
        cells.push(format!("{}, {}", self.converged, self.confidently_wrong));
        cells.push(self.accepted.cell());
        cells
    }
}
