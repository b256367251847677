//! What `serve` takes.

use super::LogPaths;
use crate::flags::{Flags, OnCommandLine};
use boresight_live::foxglove::ServeOptions;
use boresight_mounting::CalibrationOptions;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `serve`.
#[derive(Debug, Args)]
pub struct ServeArguments {
    /// The log.
    #[command(flatten)]
    pub log: LogPaths,
    /// Only this radar of the log.
    #[arg(long, value_name = "N", conflicts_with = "joint")]
    pub sensor: Option<u8>,
    /// Calibrate all radars of the log together, as `calibrate --joint` does.
    #[arg(long, conflicts_with_all = ["method", "motion"])]
    pub joint: bool,
    /// Weights of the network of motion, for --motion deepego and deepego-plus; those of models/motion/deepego-plus.bin if absent.
    #[arg(long, value_name = "F.bin")]
    pub network: Option<PathBuf>,
    /// How it is served.
    #[command(flatten)]
    pub serve: Flags<ServeOptions>,
    /// How it is calibrated.
    #[command(flatten)]
    pub flags: Flags<CalibrationOptions>,
    /// Print the counts at the end as JSON.
    #[arg(long)]
    pub json: bool,
}

impl OnCommandLine for ServeOptions {
    const HEADING: &'static str = "Server";
}
