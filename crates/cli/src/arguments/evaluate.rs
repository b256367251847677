//! What `evaluate` takes.

use crate::flags::{Flags, OnCommandLine};
use boresight_core::imperfections::ImperfectionSpread;
use boresight_evaluate::sweep::Part;
use boresight_evaluate::{aoa, images};
use boresight_pipeline::regions::RegionChainOptions;
use clap::{ArgGroup, Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Experiments.
#[derive(Debug, Subcommand)]
pub enum EvaluateCommand {
    /// Angles in single snapshots of 2 to 10 targets: detection and accuracy by method.
    Aoa(EvaluateAoaArguments),
    /// The same on several arrays, for networks that take any.
    Arrays(EvaluateArraysArguments),
    /// Mounting angles on simulated drives of four radars: errors, trajectories, driving time.
    Calibration(EvaluateCalibrationArguments),
    /// Counting and angles of up to two targets in the region of interest of a data cube.
    Doa(Box<EvaluateDoaArguments>),
    /// Bird's-eye images of simulated streets: how much of each is not target, by method.
    Images(EvaluateImagesArguments),
    /// Two sources far below the noise in many snapshots, by methods and networks on the covariance.
    LowSnr(EvaluateLowSnrArguments),
    /// What the spherical waves of near targets do to methods that take waves for plane.
    NearField(EvaluateNearFieldArguments),
    /// When two targets are resolved, by separation and signal-to-noise ratio.
    Resolution(EvaluateResolutionArguments),
    /// What gain, phase, position and coupling errors of the array do to detection and angles.
    Imperfections(EvaluateImperfectionsArguments),
    /// What targets between the points of a grid cost methods that search one, and what finer grids cost.
    Straddling(EvaluateStraddlingArguments),
    /// Put together what was run in parts.
    Merge(EvaluateMergeArguments),
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
    /// How it is printed.
    #[command(flatten)]
    pub format: EvaluateFormat,
    /// Folder for records, tables and figures. A run that was stopped goes on from the records.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Run the K-th of N parts only, and keep its records for `evaluate merge`.
    #[arg(long, value_name = "K/N", requires = "out")]
    pub part: Option<Part>,
}

/// What was answered, for those who count again.
#[derive(Debug, Args)]
pub struct AnswersArguments {
    /// Write the truth and every answer of each trial as JSON lines; nothing is recorded then. It grows large: with
    /// `aoa` by about 1 KB a snapshot and method, of which 4000 snapshots a condition make 180 MB a method.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["out", "part"])]
    pub answers: Option<PathBuf>,
}

/// How experiments print.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("evaluate-format").args(["json", "csv"]))]
pub struct EvaluateFormat {
    /// JSON instead of Markdown tables.
    #[arg(long)]
    pub json: bool,
    /// Comma-separated values with a header line.
    #[arg(long)]
    pub csv: bool,
}

/// Arguments of `evaluate merge`.
#[derive(Debug, Args)]
pub struct EvaluateMergeArguments {
    /// Files of records (.jsonl) or folders with such files, all of one run.
    #[arg(value_name = "DIR", required = true)]
    pub sources: Vec<PathBuf>,
    /// Folder for records, tables and figures of the whole.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How it is printed.
    #[command(flatten)]
    pub format: EvaluateFormat,
}

/// Trained networks of an experiment.
#[derive(Debug, Args)]
pub struct NetworkArguments {
    /// Trained network, an ONNX file with its card beside it (NAME.onnx, NAME.json); repeatable. Its records are a
    /// file of their own, so that methods are not run again with another network.
    #[arg(long = "model", value_name = "FILE")]
    pub models: Vec<PathBuf>,
}

/// Arguments of `evaluate aoa`.
#[derive(Debug, Args)]
pub struct EvaluateAoaArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Snapshots a condition, which is a number of targets at a signal-to-noise ratio.
    #[arg(long, value_name = "N", default_value_t = 4000)]
    pub trials: u64,
    /// Further snapshots a condition, on which one threshold for all conditions is found.
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub validation: u64,
    /// Numbers of targets, separated by commas.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = aoa::TARGETS)]
    pub targets: Vec<usize>,
    /// Signal-to-noise ratios, dB, separated by commas: the power of a target of 0 dB at one element over the noise.
    #[arg(long, value_name = "DB", value_delimiter = ',', allow_negative_numbers = true, default_values_t = aoa::SNRS_DB)]
    pub snr: Vec<f64>,
    /// Difference between the strongest and the weakest target, dB.
    #[arg(long, value_name = "DB", default_value_t = aoa::SPREAD_DB)]
    pub spread: f64,
    /// What was answered.
    #[command(flatten)]
    pub answers: AnswersArguments,
    /// Array, by name.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas; plain-iaa for IAA on whole degrees without interpolation; NAME+refined for one
    /// refined on the matched model; iaa+hard and iaa+soft for IAA with thresholding. Those that need the number of
    /// targets are given it. Default: bartlett, capon, iaa, iaa+hard, iaa+soft, iaa+refined, nomp and, on uniform
    /// arrays, single-snapshot-music.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, each run plain and refined.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Print the time of a snapshot by method, on one thread, in place of the experiment.
    #[arg(long, conflicts_with_all = ["out", "part", "json", "csv", "answers"])]
    pub times: bool,
    /// What is wrong with the array.
    #[command(flatten)]
    pub imperfections: Flags<ImperfectionSpread>,
}

impl OnCommandLine for ImperfectionSpread {
    const HEADING: &'static str = "What is wrong with the array";
    const PREFIX: &'static str = "imperfections";
}

/// Arguments of `evaluate doa`.
#[derive(Debug, Args)]
pub struct EvaluateDoaArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Trials a condition: 0, 1 and 2 targets, these at two ranges, at one, or at one with one of them moving.
    #[arg(long, value_name = "N", default_value_t = 2100)]
    pub trials: u64,
    /// The paper's simulated radar (Table 3) or that of its experiments (Table 4), simulated.
    #[arg(long, value_enum, default_value_t = DoaSetup::Simulation)]
    pub setup: DoaSetup,
    /// What changes between conditions.
    #[arg(long, value_enum, default_value_t = DoaAxis::Snr)]
    pub axis: DoaAxis,
    /// What was answered.
    #[command(flatten)]
    pub answers: AnswersArguments,
    /// Networks: such that count, and such of a region or its covariance.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Where regions and numbers of targets come from.
    #[arg(long, value_enum, default_value_t = DoaRegions::Told)]
    pub regions: DoaRegions,
    /// From end to end: targets around this azimuth in place of boresight, -50 to 50 deg.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    pub centre: f64,
    /// From end to end: detection and regions.
    #[command(flatten)]
    pub chain: Flags<RegionChainOptions>,
}

/// What changes between conditions of `evaluate doa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DoaAxis {
    /// The signal-to-noise ratio, -10 to 15 dB; two targets have equal power.
    Snr,
    /// The power of the second target, 0 to 15 dB below the first, which has 15 dB.
    PowerDifference,
}

/// Regions of `evaluate doa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DoaRegions {
    /// The strongest bin, and methods are told the number of targets.
    Told,
    /// Detected, and counted by the first network given that counts; of networks only.
    EndToEnd,
}

/// Radar of `evaluate doa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DoaSetup {
    /// Range bins of 1 m, targets at 70 to 90 m.
    Simulation,
    /// Range bins of 43 mm, targets at 9.7 to 10.3 m.
    Experiment,
}

/// Arguments of `evaluate images`.
#[derive(Debug, Args)]
pub struct EvaluateImagesArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Streets, the first of the seed and each of the next one: a frame of all radars each.
    #[arg(long, value_name = "N", default_value_t = 4)]
    pub streets: u64,
    /// Methods, separated by commas; `chain` for the detections of the ordinary chain.
    #[arg(long, value_name = "NAMES", value_delimiter = ',',
          default_values_t = images::DEFAULT_METHODS.map(String::from))]
    pub methods: Vec<String>,
    /// Networks that find angles in a snapshot.
    #[command(flatten)]
    pub networks: NetworkArguments,
}

/// Arguments of `evaluate resolution`.
#[derive(Debug, Args)]
pub struct EvaluateResolutionArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Trials a condition: 0.05 to 2 beam widths apart, at 0 to 40 dB.
    #[arg(long, value_name = "N", default_value_t = 600)]
    pub trials: u64,
    /// Array, by name.
    #[arg(long, value_name = "NAME", default_value = "ula8")]
    pub array: String,
    /// Numbers of snapshots.
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_values_t = [1, 16])]
    pub snapshots: Vec<usize>,
}

/// Arguments of `evaluate arrays`.
#[derive(Debug, Args)]
pub struct EvaluateArraysArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Snapshots a condition: two numbers of targets on each of six arrays.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Methods, separated by commas, as for `evaluate aoa`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks that take any array.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Signal-to-noise ratio, dB: 15, 20, 25, 30 or 35.
    #[arg(long, value_name = "DB", default_value_t = 25.0)]
    pub snr: f64,
}

/// Arguments of `evaluate low-snr`.
#[derive(Debug, Args)]
pub struct EvaluateLowSnrArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Trials a condition: -20 to 10 dB, each with 20, 200 and 2000 snapshots.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Array, by name.
    #[arg(long, value_name = "NAME", default_value = "ula16")]
    pub array: String,
    /// Methods that take a covariance, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks on the covariance of the array.
    #[command(flatten)]
    pub networks: NetworkArguments,
}

/// Arguments of `evaluate imperfections`.
#[derive(Debug, Args)]
pub struct EvaluateImperfectionsArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Snapshots a condition: 2, 5 and 10 targets under each of 25 settings of the errors.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Array, by name.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas, as for `evaluate aoa`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, as for `evaluate aoa`.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Signal-to-noise ratio, dB: 15, 20, 25, 30 or 35.
    #[arg(long, value_name = "DB", default_value_t = 25.0)]
    pub snr: f64,
}

/// Arguments of `evaluate near-field`.
#[derive(Debug, Args)]
pub struct EvaluateNearFieldArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Snapshots a condition: one and two targets at ten ranges from 0.01 to 10 Fraunhofer distances, and infinitely
    /// far.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Array, by name; ten half wavelengths long or longer.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas, as for `evaluate aoa`. Without it bartlett, iaa, iaa+refined and nomp.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, as for `evaluate aoa`.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Signal-to-noise ratio of the stronger target, dB.
    #[arg(long, value_name = "DB", default_value_t = 25.0, allow_hyphen_values = true)]
    pub snr: f64,
}

/// Arguments of `evaluate straddling`.
#[derive(Debug, Args)]
pub struct EvaluateStraddlingArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: EvaluateArguments,
    /// Snapshots a condition: one target at 10 and at 30 dB, and a weak one beside a strong one.
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub trials: u64,
    /// Array, by name; its elements stand on a line.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas, as for `evaluate aoa`; those with a spectrum are run on grids of 64 to 8192
    /// points. Without it bartlett, capon, iaa, iaa+refined and nomp.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, as for `evaluate aoa`.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Print the time of a snapshot by method and grid, on one thread, in place of the experiment.
    #[arg(long, conflicts_with_all = ["out", "part", "json", "csv"])]
    pub times: bool,
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
    /// Keep all that moves from the methods, by the truth: what it costs them.
    #[arg(long)]
    pub standing: bool,
    /// Take the drives in this folder instead: each folder in it that holds one, a data set of RadarScenes for example. The
    /// mounting angles that logs state are taken as true.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scenes", "duration", "seed", "standing"])]
    pub drives: Option<PathBuf>,
    /// Lengths of the pieces that these drives are cut into, s.
    #[arg(long, value_name = "S,...", value_delimiter = ',', default_values_t = [25.0, 60.0, 120.0], requires = "drives")]
    pub pieces: Vec<f64>,
}
