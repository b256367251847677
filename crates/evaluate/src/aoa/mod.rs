//! Detection and accuracy on random scenes of a single snapshot: Figures 4 and 5 of the AAETR paper.

pub mod cell;
pub mod figures;
pub mod report;
pub mod score;

pub use report::Report;
pub use score::Score;

use crate::EvaluateError;
use crate::sweep::{self, Sweep};
use boresight_core::error::check_range;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_pipeline::Progress;
use serde_json::json;
use std::ops::ControlFlow;
use std::path::Path;

/// Numbers of targets of the conditions.
pub const TARGETS: [usize; 9] = [2, 3, 4, 5, 6, 7, 8, 9, 10];
/// Signal-to-noise ratios of the conditions, dB.
pub const SNRS_DB: [f64; 5] = [15.0, 20.0, 25.0, 30.0, 35.0];
/// Snapshots of one record.
const CHUNK: u64 = 250;

/// What to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Name of the array.
    pub array: String,
    /// Snapshots a condition.
    pub trials: u64,
    /// Everything random comes from it.
    pub seed: u64,
    /// Errors of the array that no method knows of.
    pub imperfections: ImperfectionSpread,
    /// Threads.
    pub threads: usize,
}

/// Number of targets and signal-to-noise ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Targets.
    pub targets: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
}

impl Condition {
    /// All conditions.
    pub fn all() -> Vec<Self> {
        let of = |&targets: &usize| SNRS_DB.map(|snr_db| Self { targets, snr_db });
        TARGETS.iter().flat_map(of).collect()
    }
}

/// Runs the experiment; with a folder, its records are kept there and a stopped run goes on.
///
/// # Errors
/// Options out of range; those of [`sweep::run`].
pub fn run(
    options: &Options,
    folder: Option<&Path>,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Report, EvaluateError> {
    check_range("trials", options.trials as f64, 1.0, 1e7)?;
    let plan = cell::Plan::new(options)?;
    let records = folder.map(|folder| folder.join("aoa.jsonl"));
    let setup = json!({
        "experiment": "aoa",
        "version": env!("CARGO_PKG_VERSION"),
        "seed": options.seed,
        "array": options.array,
        "trials": options.trials,
        "gainDb": options.imperfections.gain_db,
        "phaseRad": options.imperfections.phase_rad,
        "position": options.imperfections.position,
        "couplingDb": options.imperfections.coupling_db,
        "methods": plan.names(),
    });
    let chunks = options.trials.div_ceil(CHUNK);
    let conditions = Condition::all();
    let sweep = Sweep {
        setup,
        scenes: 0..chunks * conditions.len() as u64,
        threads: options.threads,
        records: records.as_deref(),
    };
    let work = |number: u64| {
        let (index, chunk) = ((number / chunks) as usize, number % chunks);
        let trials = CHUNK.min(options.trials - chunk * CHUNK);
        plan.run(index, conditions[index], chunk * CHUNK, trials)
    };
    let done = sweep::run(&sweep, work, progress)?;
    Ok(Report::new(options, &plan.names(), done.into_values()))
}
