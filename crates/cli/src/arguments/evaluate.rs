//! What `evaluate` takes.

use super::ImperfectionArguments;
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Experiments.
#[derive(Debug, Subcommand)]
pub enum EvaluateCommand {
    /// Angles in single snapshots of 2 to 10 targets: detection and accuracy by method.
    Aoa(EvaluateAoaArguments),
    /// Mounting angles on simulated drives of four radars: errors, trajectories, driving time.
    Calibration(EvaluateCalibrationArguments),
}

/// Arguments of all experiments.
#[derive(Debug, Args)]
pub struct EvaluateArguments {
    /// Seed.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Threads; without it one a processor core.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// JSON instead of Markdown tables.
    #[arg(long)]
    pub json: bool,
    /// Folder for records, tables and figures. A run that was stopped goes on from the records.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `evaluate aoa`.
#[derive(Debug, Args)]
pub struct EvaluateAoaArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Comma-separated values, a row a condition and method.
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// Snapshots a condition: 2 to 10 targets at 15 to 35 dB.
    #[arg(long, value_name = "N", default_value_t = 4000)]
    pub trials: u64,
    /// Array, by name.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// What is wrong with the array.
    #[command(flatten)]
    pub imperfections: ImperfectionArguments,
}

/// Arguments of `evaluate calibration`.
#[derive(Debug, Args)]
pub struct EvaluateCalibrationArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Drives of each kind: all roads with up to 30 % moving detections, and dense traffic.
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub scenes: u64,
    /// Length of a drive, s.
    #[arg(long, value_name = "S", default_value_t = 120.0)]
    pub duration: f64,
}
