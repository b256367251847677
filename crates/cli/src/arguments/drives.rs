//! What `log`, `calibrate` and `odometry` take.

use crate::flags::{Flags, OnCommandLine};
use boresight_formats::{DriveFormat, TopicOptions};
use boresight_mounting::{CalibrationOptions, SignOptions};
use boresight_options::Named;
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::path::PathBuf;

/// Where a drive log is.
#[derive(Debug, Default, Args)]
pub struct LogPaths {
    /// The log: its folder, its one file, or its files. Tables (.csv, also packed as .csv.gz) are
    /// recognised by their columns. Of RadarScenes also the folder of the data set; of point clouds (.pcd) the folder of one radar
    /// or of several, with that of their tables (v1.0-mini, say) beside; of a recording in MCAP (.mcap) all its parts.
    #[arg(required = true, value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Which sequence of a data set's folder, such as sequence_7 or 7; of point clouds what their names begin with.
    #[arg(long, value_name = "NAME")]
    pub sequence: Option<String>,
    /// What the signs in it mean.
    #[command(flatten)]
    pub signs: Flags<SignOptions>,
    /// Which topics are read.
    #[command(flatten)]
    pub topics: Flags<TopicOptions>,
}

/// Names of the formats of logs.
pub(super) fn formats() -> PossibleValuesParser {
    PossibleValuesParser::new(DriveFormat::VARIANTS.iter().map(|format| format.name()))
}

/// Arguments of `log`.
#[derive(Debug, Args)]
pub struct LogArguments {
    /// The log.
    #[command(flatten)]
    pub log: LogPaths,
    /// Write the log as general tables, detections.csv and motion.csv, to this folder.
    #[arg(long, value_name = "DIR")]
    pub export: Option<PathBuf>,
    /// Write the log as messages for viewers: point clouds, the car's motion, transforms.
    #[arg(long, value_name = "OUT.mcap")]
    pub mcap: Option<PathBuf>,
    /// Print statistics of each radar in place of what the log holds: counts, outliers, noise, how
    /// its angle scatters and how long that lasts, slip, delay, speed.
    #[arg(long)]
    pub statistics: bool,
    /// Print the messages of this topic of an MCAP file, one a line as JSON, in place of what the log holds.
    #[arg(long, value_name = "TOPIC")]
    pub messages: Option<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `calibrate`.
#[derive(Debug, Args)]
pub struct CalibrateArguments {
    /// The log.
    #[command(flatten)]
    pub log: LogPaths,
    /// Format of the log, where it is not to be found from the files.
    #[arg(long, value_parser = formats())]
    pub format: Option<String>,
    /// Only this radar of the log.
    #[arg(long, value_name = "N")]
    pub sensor: Option<u8>,
    /// Estimate all radars of the log together, by the recursive method with one scale and bias of
    /// the yaw rate for all; --sensor then says which is printed.
    #[arg(long, conflicts_with_all = ["method", "motion"])]
    pub joint: bool,
    /// Weights of the network of motion, for --motion deepego and deepego-plus; those of models/motion/deepego-plus.bin if absent.
    #[arg(long, value_name = "F.bin")]
    pub network: Option<PathBuf>,
    /// How it is calibrated.
    #[command(flatten)]
    pub flags: Flags<CalibrationOptions>,
    /// Write the car's trajectory by the radar's motion and the estimated angle: time_s, x_m, y_m,
    /// yaw_deg of the rear axle, from the origin along x, and where the log has poses
    /// logged_x_m, logged_y_m, logged_yaw_deg in the same frame.
    #[arg(long, value_name = "OUT.csv")]
    pub trajectory: Option<PathBuf>,
    /// Write a report to print: verdict, angle, plots, conditions and the files it comes from, as one page of HTML.
    #[arg(long, value_name = "OUT.html")]
    pub report: Option<PathBuf>,
    /// Write the drive and the angle as it went as messages for viewers.
    #[arg(long, value_name = "OUT.mcap")]
    pub mcap: Option<PathBuf>,
    /// Print JSON: an object, or an array of them where there are several radars.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `odometry`.
#[derive(Debug, Args)]
pub struct OdometryArguments {
    /// The log.
    #[command(flatten)]
    pub log: LogPaths,
    /// Only these radars of the log.
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    pub sensors: Vec<u8>,
    /// Weights of the network of motion; those of models/motion/deepego-plus.bin if absent.
    #[arg(long, value_name = "F.bin")]
    pub network: Option<PathBuf>,
    /// Write the car's trajectory by its radars: time_s, x_m, y_m, yaw_deg of the rear axle, from the origin along x, and where
    /// the log has poses logged_x_m, logged_y_m, logged_yaw_deg in the same frame.
    #[arg(long, value_name = "OUT.csv")]
    pub trajectory: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

impl OnCommandLine for SignOptions {
    const HEADING: &'static str = "Signs of the log";
}

impl OnCommandLine for TopicOptions {
    const HEADING: &'static str = "Recordings in MCAP";
}

impl OnCommandLine for CalibrationOptions {
    const HEADING: &'static str = "Calibration";
}
