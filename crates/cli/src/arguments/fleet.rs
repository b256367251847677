//! What `fleet` takes.

use super::drives::formats;
use crate::flags::{Flags, OnCommandLine};
use boresight_fleet::FleetOptions;
use boresight_fleet::Part;
use boresight_formats::TopicOptions;
use boresight_mounting::{CalibrationOptions, SignOptions};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use std::str::FromStr;

/// What to do with a fleet of drives.
#[derive(Debug, Subcommand)]
pub enum FleetCommand {
    /// Make a plan: a line of JSON a log, with its digest and how it is calibrated.
    Plan(Box<FleetPlanArguments>),
    /// Run a plan or a part of it: a record a log, as a line of JSON.
    Run(FleetRunArguments),
    /// Calibrate the jobs on the standard input, one at a time, for `fleet run`.
    #[command(hide = true)]
    Worker(FleetWorkerArguments),
    /// Put the records of all parts together: each vehicle's angles over its drives, and vehicles unlike the others.
    Merge(Box<FleetMergeArguments>),
}

/// Arguments of `fleet plan`.
#[derive(Debug, Args)]
pub struct FleetPlanArguments {
    /// The logs, each a file or a folder; of a data set of RadarScenes each sequence is one.
    #[arg(value_name = "LOG", required_unless_present = "list")]
    pub logs: Vec<PathBuf>,
    /// More logs, one a line: a path, or JSON such as {"path": "a.mcap", "vehicle": "7", "drive": "3", "timeS": 1777629600}. - is the
    /// standard input.
    #[arg(long, value_name = "FILE")]
    pub list: Option<PathBuf>,
    /// Where in a log's path its vehicle, drive and time stand, such as {vehicle}/*/{time}_{drive}.mcap; the end of each path is held against
    /// it. Or the name of the one vehicle that all logs are of. The folder that holds the log names the vehicle if absent.
    #[arg(long, value_name = "PATTERN")]
    pub vehicle: Option<String>,
    /// Write the plan to this file.
    #[arg(long, value_name = "OUT.jsonl")]
    pub out: Option<PathBuf>,
    /// Threads; as many as there are cores if absent.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// Format of the logs, where it is not to be found from the files.
    #[arg(long, value_parser = formats())]
    pub format: Option<String>,
    /// Only this radar of each log.
    #[arg(long, value_name = "N")]
    pub sensor: Option<u8>,
    /// Estimate all radars of a log together, with one scale and bias of the yaw rate for all.
    #[arg(long, conflicts_with_all = ["method", "motion"])]
    pub joint: bool,
    /// What the signs in the logs mean.
    #[command(flatten)]
    pub signs: Flags<SignOptions>,
    /// Which topics are read.
    #[command(flatten)]
    pub topics: Flags<TopicOptions>,
    /// How they are calibrated.
    #[command(flatten)]
    pub flags: Flags<CalibrationOptions>,
}

/// Arguments of `fleet run`.
#[derive(Debug, Args)]
pub struct FleetRunArguments {
    /// The plan; - is the standard input, of which each record is printed as soon as it is there.
    #[arg(value_name = "JOBS.jsonl")]
    pub plan: PathBuf,
    /// Folder of the records; logs that have one there are not run again. Without it records are printed.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Run the K-th of N parts only; auto takes both from the variables of Slurm's array jobs, Kubernetes' indexed jobs or HTCondor.
    #[arg(long, value_name = "K/N|auto")]
    pub part: Option<WhichPart>,
    /// Threads; as many as there are cores if absent.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// Run logs again that failed, those that crashed or timed out included.
    #[arg(long, requires = "out")]
    pub retry: bool,
    /// Longest time for one log; a log that takes longer gets a record with the code timed-out.
    #[arg(long, value_name = "SECONDS", default_value_t = 3600.0, value_parser = seconds)]
    pub time_limit: f64,
    /// Most memory for one log (address space, Linux only); a log that needs more gets a record with the code crashed. Half of the memory of
    /// the machine or container if absent.
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..=1 << 40))]
    pub memory_limit: Option<u64>,
}

/// Arguments of `fleet worker`.
#[derive(Debug, Args)]
pub struct FleetWorkerArguments {
    /// Most memory, bytes.
    #[arg(long)]
    pub memory_limit: Option<u64>,
}

fn seconds(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|s| (1e-3..=1e9).contains(s));
    found.ok_or_else(|| "expected seconds from 0.001 to 1000000000".into())
}

/// A part, or where to find out which.
#[derive(Debug, Clone, Copy)]
pub enum WhichPart {
    /// What a scheduler's variables say.
    Auto,
    /// This one.
    Given(Part),
}

impl FromStr for WhichPart {
    type Err = boresight_core::InputError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == "auto" { Ok(Self::Auto) } else { text.parse().map(Self::Given) }
    }
}

/// Arguments of `fleet merge`.
#[derive(Debug, Args)]
pub struct FleetMergeArguments {
    /// Files of records, or folders of them.
    #[arg(required = true, value_name = "RECORDS")]
    pub records: Vec<PathBuf>,
    /// The plan: each of its logs must have a record, and others are left out.
    #[arg(long, value_name = "JOBS.jsonl")]
    pub plan: Option<PathBuf>,
    /// Take the records that are there, though logs of the plan have none.
    #[arg(long, requires = "plan")]
    pub partial: bool,
    /// Folder of the results: fleet.json, drives.parquet, radars.parquet and report.html.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the result as JSON in place of a summary.
    #[arg(long)]
    pub json: bool,
    /// Threads; as many as there are cores if absent.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// How records are put together.
    #[command(flatten)]
    pub flags: Flags<FleetOptions>,
}

impl OnCommandLine for FleetOptions {
    const HEADING: &'static str = "Fleet";
}
