//! What the experiments take.

use boresight_cli::experiment::{ExperimentFormat, RunArguments};
use boresight_cli::flags::Flags;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_experiments::{aoa, images};
use boresight_pipeline::regions::RegionChainOptions;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// The experiments behind the published tables and figures, on simulated scenes: tables, figures, records.
#[derive(Debug, Parser)]
#[command(name = "boresight-experiments", version, max_term_width = 100)]
pub struct Program {
    /// Replace files that are there; never those an experiment reads.
    #[arg(long, global = true)]
    pub force: bool,
    /// What to run.
    #[command(subcommand)]
    pub what: ExperimentCommand,
}

/// Experiments.
#[derive(Debug, Subcommand)]
pub enum ExperimentCommand {
    /// Angles in single snapshots of 2 to 10 targets: detection and accuracy by method.
    Aoa(AoaArguments),
    /// The same on several arrays, for networks that take any.
    Arrays(ArraysArguments),
    /// Mounting angles on simulated drives of four radars: errors, trajectories, driving time.
    Calibration(CalibrationArguments),
    /// Counting and angles of up to two targets in the region of interest of a data cube.
    Doa(Box<DoaArguments>),
    /// Angles under conditions harder than those of `aoa`: noise, many targets, close pairs, short arrays, array errors.
    Hard(HardArguments),
    /// Bird's-eye images of simulated streets: how much of each is not target, by method.
    Images(ImagesArguments),
    /// Two sources far below the noise in many snapshots, by methods and networks on the covariance.
    LowSnr(LowSnrArguments),
    /// What the spherical waves of near targets do to methods that take waves for plane.
    NearField(NearFieldArguments),
    /// When two targets are resolved, by separation and signal-to-noise ratio.
    Resolution(ResolutionArguments),
    /// What gain, phase, position and coupling errors of the array do to detection and angles.
    Imperfections(ImperfectionsArguments),
    /// What targets between the points of a grid cost methods that search one, and what finer grids cost.
    Straddling(StraddlingArguments),
    /// Put together what was run in parts.
    Merge(MergeArguments),
}

/// Arguments of all experiments.
#[derive(Debug, Args)]
pub struct SharedArguments {
    /// Seed.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// How it runs.
    #[command(flatten)]
    pub run: RunArguments,
}

/// What was answered, for those who count again.
#[derive(Debug, Args)]
pub struct AnswersArguments {
    /// Write the truth and every answer of each trial as JSON lines; nothing is recorded then. It grows large: with
    /// `aoa` by about 1 KB a snapshot and method, of which 4000 snapshots a condition make 180 MB a method.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["out", "part"])]
    pub answers: Option<PathBuf>,
}

/// Arguments of `merge`.
#[derive(Debug, Args)]
pub struct MergeArguments {
    /// Files of records (.jsonl) or folders with such files, all of one run.
    #[arg(value_name = "DIR", required = true)]
    pub sources: Vec<PathBuf>,
    /// Folder for records, tables and figures of the whole.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How it is printed.
    #[command(flatten)]
    pub format: ExperimentFormat,
}

/// Trained networks of an experiment.
#[derive(Debug, Args)]
pub struct NetworkArguments {
    /// Trained network, an ONNX file with its card beside it (NAME.onnx, NAME.json); repeatable. Its records are a
    /// file of their own, so that methods are not run again with another network.
    #[arg(long = "model", value_name = "FILE")]
    pub models: Vec<PathBuf>,
}

/// Arguments of `aoa`.
#[derive(Debug, Args)]
pub struct AoaArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
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
    /// Methods, separated by commas; plain-iaa for IAA on whole degrees without interpolation, plain-iaa-half-degree on
    /// half degrees; NAME+refined for one refined on the matched model; iaa+hard and iaa+soft for IAA with
    /// thresholding. Those that need the number of targets are given it. Default: bartlett, capon, iaa, iaa+hard, iaa+soft, iaa+refined, nomp and, on uniform
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

/// Arguments of `doa`.
#[derive(Debug, Args)]
pub struct DoaArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
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

/// What changes between conditions of `doa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DoaAxis {
    /// The signal-to-noise ratio, -10 to 15 dB; two targets have equal power.
    Snr,
    /// The power of the second target, 0 to 15 dB below the first, which has 15 dB.
    PowerDifference,
}

/// Regions of `doa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DoaRegions {
    /// The strongest bin, and methods are told the number of targets.
    Told,
    /// Detected, and counted by the first network given that counts; of networks only.
    EndToEnd,
}

/// Radar of `doa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DoaSetup {
    /// Range bins of 1 m, targets at 70 to 90 m.
    Simulation,
    /// Range bins of 43 mm, targets at 9.7 to 10.3 m.
    Experiment,
}

/// Arguments of `hard`.
#[derive(Debug, Args)]
pub struct HardArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
    /// Snapshots a condition.
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub trials: u64,
    /// Methods, separated by commas, as for `aoa`; the first one is compared with all others.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, each run plain and refined; one for a single array is run on that alone.
    #[command(flatten)]
    pub networks: NetworkArguments,
}

/// Arguments of `images`.
#[derive(Debug, Args)]
pub struct ImagesArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
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

/// Arguments of `resolution`.
#[derive(Debug, Args)]
pub struct ResolutionArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
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

/// Arguments of `arrays`.
#[derive(Debug, Args)]
pub struct ArraysArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
    /// Snapshots a condition: two numbers of targets on each of six arrays.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Methods, separated by commas, as for `aoa`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks that take any array.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Signal-to-noise ratio, dB: 15, 20, 25, 30 or 35.
    #[arg(long, value_name = "DB", default_value_t = 25.0)]
    pub snr: f64,
}

/// Arguments of `low-snr`.
#[derive(Debug, Args)]
pub struct LowSnrArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
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

/// Arguments of `imperfections`.
#[derive(Debug, Args)]
pub struct ImperfectionsArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
    /// Snapshots a condition: 2, 5 and 10 targets under each of 25 settings of the errors.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Array, by name.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas, as for `aoa`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, as for `aoa`.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Signal-to-noise ratio, dB: 15, 20, 25, 30 or 35.
    #[arg(long, value_name = "DB", default_value_t = 25.0)]
    pub snr: f64,
}

/// Arguments of `near-field`.
#[derive(Debug, Args)]
pub struct NearFieldArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
    /// Snapshots a condition: one and two targets at ten ranges from 0.01 to 10 Fraunhofer distances, and infinitely
    /// far.
    #[arg(long, value_name = "N", default_value_t = 500)]
    pub trials: u64,
    /// Array, by name; ten half wavelengths long or longer.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas, as for `aoa`. Without it bartlett, iaa, iaa+refined and nomp.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, as for `aoa`.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Signal-to-noise ratio of the stronger target, dB.
    #[arg(long, value_name = "DB", default_value_t = 25.0, allow_hyphen_values = true)]
    pub snr: f64,
}

/// Arguments of `straddling`.
#[derive(Debug, Args)]
pub struct StraddlingArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
    /// Snapshots a condition: one target at 10 and at 30 dB, and a weak one beside a strong one.
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub trials: u64,
    /// Array, by name; its elements stand on a line.
    #[arg(long, value_name = "NAME", default_value = "lrr48")]
    pub array: String,
    /// Methods, separated by commas, as for `aoa`; those with a spectrum are run on grids of 64 to 8192
    /// points. Without it bartlett, capon, iaa, iaa+refined and nomp.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub methods: Vec<String>,
    /// Networks, as for `aoa`.
    #[command(flatten)]
    pub networks: NetworkArguments,
    /// Print the time of a snapshot by method and grid, on one thread, in place of the experiment.
    #[arg(long, conflicts_with_all = ["out", "part", "json", "csv"])]
    pub times: bool,
}

/// Arguments of `calibration`.
#[derive(Debug, Args)]
pub struct CalibrationArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SharedArguments,
    /// Drives of each kind: all roads with up to 30 % moving detections, and dense traffic.
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub scenes: u64,
    /// Length of a drive, s.
    #[arg(long, value_name = "S", default_value_t = 120.0)]
    pub duration: f64,
    /// Keep all that moves from the methods, by the truth: what it costs them.
    #[arg(long)]
    pub standing: bool,
}
