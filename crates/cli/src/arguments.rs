//! What the command line takes.

use boresight_aoa::Method;
use boresight_calibrate::{Method as Calibration, MotionMethod};
use boresight_formats::DriveFormat;
use boresight_signal::Window;
use boresight_simulate::Scenario;
use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Args, Parser, Subcommand};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  Angles in a raw capture of a TI board, all frames together:
    boresight estimate capture.bin --config profile.cfg
  One frame, by IAA, as JSON:
    boresight estimate capture.bin --config profile.cfg --method iaa --frame 0 --json
  What the board itself detected:
    boresight estimate board.dat
  Two targets seen by an 8-element array, and their angles by MUSIC:
    boresight simulate snapshots --array ula8 --target azimuth=-5 --target azimuth=20,power=-3 \\
      --snapshots 50 --seed 1 --out two.npy
    boresight estimate two.npy --array ula8 --method music --sources 2

Angles are in degrees, positive to the left; range rates are positive when receding.";

/// Automotive radar: angles from captures and snapshots, and simulation.
#[derive(Debug, Parser)]
#[command(name = "boresight", version, after_help = EXAMPLES, max_term_width = 100)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Print the detections in a capture, or the angles in snapshots.
    Estimate(Box<EstimateArguments>),
    /// Simulate data of which the truth is known, as a .npy file.
    Simulate {
        /// What to simulate.
        #[command(subcommand)]
        what: SimulateCommand,
    },
    /// Estimate the angle a car's radars are mounted at from a drive log.
    Calibrate(CalibrateArguments),
    /// Tell what is in a drive log: radars, scans, the car's motion, and what was left out.
    Log(LogArguments),
    /// Run an experiment on simulated scenes: tables, figures, records.
    Evaluate {
        /// What to run.
        #[command(subcommand)]
        what: EvaluateCommand,
    },
    /// List the methods of angle estimation, and what each needs.
    Methods(ListFormat),
    /// List the arrays known by name.
    Arrays(ListFormat),
}

/// Arguments of `log`.
#[derive(Debug, Args)]
pub struct LogArguments {
    /// The log: its folder, its one file, or its files. Tables (.csv, also packed as .csv.gz) are
    /// recognised by their columns. Of RadarScenes also the folder of the data set.
    #[arg(required = true, value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Which sequence of a data set's folder, such as sequence_7 or 7.
    #[arg(long, value_name = "NAME")]
    pub sequence: Option<String>,
    /// Write the log as general tables, detections.csv and motion.csv, to this folder.
    #[arg(long, value_name = "DIR")]
    pub export: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `calibrate`.
#[derive(Debug, Args)]
pub struct CalibrateArguments {
    /// The log: its folder, its one file, or its files; of RadarScenes also the data set's folder.
    #[arg(required = true, value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Which sequence of a data set's folder, such as sequence_7 or 7.
    #[arg(long, value_name = "NAME")]
    pub sequence: Option<String>,
    /// Format of the log, where it is not to be found from the files.
    #[arg(long, value_parser = PossibleValuesParser::new(DriveFormat::ALL.map(DriveFormat::name)))]
    pub format: Option<String>,
    /// Only this radar of the log.
    #[arg(long, value_name = "N")]
    pub sensor: Option<u8>,
    /// How the angle is estimated.
    #[arg(long, default_value = "recursive",
          value_parser = PossibleValuesParser::new(Calibration::ALL.map(Calibration::name)))]
    pub method: String,
    /// Estimate all radars of the log together, by the recursive method with one scale and bias of
    /// the yaw rate for all; --sensor then says which is printed.
    #[arg(long, conflicts_with_all = ["method", "motion"])]
    pub joint: bool,
    /// How the radar's motion is estimated, instead of the way that belongs to the method.
    #[arg(long, value_parser = PossibleValuesParser::new(MotionMethod::ALL.map(MotionMethod::name)))]
    pub motion: Option<String>,
    /// The angle the radar should be mounted at, deg, positive to the left.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub nominal: Option<f64>,
    /// The radar's distance ahead of the rear axle, m, where the log does not state it.
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub x: Option<f64>,
    /// The radar's distance left of the centre line, m.
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub y: Option<f64>,
    /// Frames below this speed of the radar are left out, m/s.
    #[arg(long, value_name = "MPS", default_value_t = 1.0)]
    pub min_speed: f64,
    /// Write the car's trajectory by the radar's motion and the estimated angle: time_s, x_m, y_m,
    /// yaw_deg of the rear axle, from the origin along x, and where the log has poses
    /// logged_x_m, logged_y_m, logged_yaw_deg in the same frame.
    #[arg(long, value_name = "OUT.csv")]
    pub trajectory: Option<PathBuf>,
    /// Print JSON: an object, or an array of them where there are several radars.
    #[arg(long)]
    pub json: bool,
}

/// How lists are printed.
#[derive(Debug, Args)]
pub struct ListFormat {
    /// Print JSON instead of a table.
    #[arg(long)]
    pub json: bool,
}

/// How results are printed.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("format").args(["json", "csv"]))]
pub struct OutputFormat {
    /// Print a JSON array of objects (rangeM, rateMps, azimuthDeg, elevationDeg, powerDb, snrDb...).
    #[arg(long)]
    pub json: bool,
    /// Print comma-separated values with a header line.
    #[arg(long)]
    pub csv: bool,
}

/// Arguments of `estimate`.
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is, by its ending:
  .bin  raw samples of a DCA1000 capture card, with --config
  .npy  a data cube (frames x loops x transmitters x receivers x samples), with --config or
        --waveform; or snapshots (elements, elements x snapshots or scenes x elements x snapshots),
        with --array
  .csv  snapshots with the columns snapshot, element, re, im, with --array
  .dat  packets of a TI board's data port: the board's own detections are printed")]
pub struct EstimateArguments {
    /// The capture or the snapshots.
    pub file: PathBuf,
    /// The board's configuration (.cfg).
    #[arg(long, value_name = "CFG")]
    pub config: Option<PathBuf>,
    /// Waveform of a data cube: awr1642, 3dcnn-simulated, 3dcnn-experiment, or a JSON file, such as
    /// the truth that `simulate cube` writes.
    #[arg(long, value_name = "NAME|JSON", conflicts_with = "config")]
    pub waveform: Option<String>,
    /// Array: a name (see `boresight arrays`), ulaN for N elements, or a JSON file with `positions`
    /// or `tx` and `rx` in half wavelengths. A capture's is taken from --config where it says.
    #[arg(long, value_name = "NAME|JSON")]
    pub array: Option<String>,
    /// Only this frame (of snapshots: this scene), from 0.
    #[arg(long, value_name = "I", conflicts_with_all = ["each", "all"])]
    pub frame: Option<usize>,
    /// Every frame by itself.
    #[arg(long, conflicts_with = "all")]
    pub each: bool,
    /// All frames together, for scenes that stand still; this is the default where the method
    /// takes several snapshots.
    #[arg(long)]
    pub all: bool,
    /// Output.
    #[command(flatten)]
    pub output: OutputFormat,
    /// Angle estimation.
    #[command(flatten)]
    pub angle: AngleArguments,
    /// Detection.
    #[command(flatten)]
    pub chain: ChainArguments,
}

/// Options of angle estimation.
#[derive(Debug, Args)]
#[command(next_help_heading = "Angle estimation")]
pub struct AngleArguments {
    /// Method.
    #[arg(long, default_value = "bartlett",
          value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)))]
    pub method: String,
    /// Number of sources in a cell, or aic or mdl to count them (methods that need it).
    #[arg(long, value_name = "N|aic|mdl", default_value = "mdl")]
    pub sources: String,
    /// Half width of the field of view, deg.
    #[arg(long, value_name = "DEG", default_value_t = 90.0)]
    pub field_of_view: f64,
    /// Points of the azimuth grid.
    #[arg(long, value_name = "N", default_value_t = 1024)]
    pub grid_points: usize,
    /// Average the covariance with its reversal (evenly spaced arrays).
    #[arg(long)]
    pub forward_backward: bool,
    /// Length of the subarrays of spatial smoothing (evenly spaced arrays).
    #[arg(long, value_name = "N")]
    pub smoothing: Option<usize>,
    /// Diagonal loading, as a share of the mean element power.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    pub loading: f64,
    /// Peaks this far below the strongest of a cell are not reported, dB.
    #[arg(long, value_name = "DB", default_value_t = 20.0)]
    pub dynamic_range: f64,
    /// Most angles in a cell.
    #[arg(long, value_name = "N", default_value_t = 16)]
    pub max_peaks: usize,
}

/// Options of the chain.
#[derive(Debug, Args)]
#[command(next_help_heading = "Detection (captures and data cubes)")]
pub struct ChainArguments {
    /// Window over the samples of a chirp.
    #[arg(long, default_value = "hann", value_parser = PossibleValuesParser::new(Window::NAMES))]
    pub range_window: String,
    /// Window over the chirps of a frame.
    #[arg(long, default_value = "hann", value_parser = PossibleValuesParser::new(Window::NAMES))]
    pub doppler_window: String,
    /// Range bins as a multiple of the samples.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub range_padding: usize,
    /// Doppler bins as a multiple of the loops.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub doppler_padding: usize,
    /// Remove what does not move.
    #[arg(long)]
    pub remove_static: bool,
    /// How noise is estimated.
    #[arg(long, default_value = "cell-averaging",
          value_parser = ["cell-averaging", "greatest-of", "smallest-of", "ordered-statistic"])]
    pub cfar: String,
    /// Along which axes.
    #[arg(long, default_value = "range", value_parser = ["range", "doppler", "both"])]
    pub cfar_axes: String,
    /// Probability that a cell of noise is detected.
    #[arg(long, value_name = "P", default_value_t = 1e-6)]
    pub false_alarm: f64,
    /// Guard cells on each side, along range and Doppler.
    #[arg(long, value_name = "R,D", default_value = "4,2", value_parser = pair::<usize>)]
    pub guard: [usize; 2],
    /// Training cells on each side, along range and Doppler.
    #[arg(long, value_name = "R,D", default_value = "8,4", value_parser = pair::<usize>)]
    pub training: [usize; 2],
    /// Rank of the ordered statistic, as a share of the training cells.
    #[arg(long, value_name = "SHARE", default_value_t = 0.75)]
    pub rank: f64,
    /// Keep every cell over the threshold instead of one a peak.
    #[arg(long)]
    pub no_grouping: bool,
    /// Report ranges within these, m; without it from 4 bins to 0.9 of the unambiguous range.
    #[arg(long, value_name = "LOW,HIGH", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub range_limits: Option<[f64; 2]>,
    /// Report range rates within these, m/s.
    #[arg(long, value_name = "LOW,HIGH", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub rate_limits: Option<[f64; 2]>,
    /// Report azimuths within these, deg.
    #[arg(long, value_name = "LOW,HIGH", value_parser = pair::<f64>, allow_hyphen_values = true)]
    pub azimuth_limits: Option<[f64; 2]>,
    /// Most detections a frame; the strongest are kept.
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub max_detections: usize,
}

/// What to simulate.
#[derive(Debug, Subcommand)]
pub enum SimulateCommand {
    /// Snapshots of an array (scenes x elements x snapshots, complex).
    Snapshots(Box<SnapshotArguments>),
    /// FMCW data cubes (frames x loops x transmitters x receivers x samples, complex).
    Cube(Box<CubeArguments>),
    /// A drive in the layout of RadarScenes: Doppler point clouds of a car's radars, its yaw rate
    /// and speed, and the truth behind them.
    Drive(Box<DriveArguments>),
}

/// Arguments of `simulate drive`.
#[derive(Debug, Args)]
#[command(after_help = "\
Writes DIR/data/sequence_1/radar_data.h5 and scenes.json, DIR/data/sensors.json and sequences.json, \
and the truth, DIR/truth.json, which calibrate does not read. sensors.json has the nominal \
mountings: those of --sensor less the misalignment.")]
pub struct DriveArguments {
    /// Roads and traffic.
    #[arg(long, default_value = "city",
          value_parser = PossibleValuesParser::new(Scenario::ALL.map(Scenario::name)))]
    pub scenario: String,
    /// Seed; the same one gives the same drive on every machine.
    #[arg(long, value_name = "S")]
    pub seed: u64,
    /// Length of the drive, s.
    #[arg(long, value_name = "S", default_value_t = 60.0)]
    pub duration: f64,
    /// Share of moving detections, 0 to 0.8; without it what the scenario's traffic gives.
    #[arg(long, value_name = "SHARE")]
    pub moving_share: Option<f64>,
    /// A radar: the number of one of the RadarScenes car's (1 to 4), or where it truly sits and
    /// looks, such as id=1,x=3.7,y=-0.6,yaw=-30: m from the rear axle, deg. Repeat for more;
    /// without it all four of the RadarScenes car.
    #[arg(long = "sensor", value_name = "N|KEY=VALUE,...")]
    pub sensors: Vec<String>,
    /// By how much a radar's true yaw exceeds the nominal one, such as 2=1.5: its number, deg.
    /// Repeat for more.
    #[arg(long = "misalign", value_name = "N=DEG")]
    pub misalignments: Vec<String>,
    /// Measured over true yaw rate; without it drawn from 0.98 to 1.02.
    #[arg(long, value_name = "RATIO")]
    pub yaw_rate_scale: Option<f64>,
    /// Yaw rate measured at standstill, deg/s; without it drawn from -0.2 to 0.2.
    #[arg(long, value_name = "DEG/S", allow_negative_numbers = true)]
    pub yaw_rate_bias: Option<f64>,
    /// Slip angle of the rear axle over lateral acceleration, deg/(m/s^2).
    #[arg(long, value_name = "DEG/(M/S2)", default_value_t = 0.0, allow_negative_numbers = true)]
    pub slip: f64,
    /// Write radar_data.h5 in chunks packed by deflate.
    #[arg(long)]
    pub packed: bool,
    /// Folder to write.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments shared by the simulations of snapshots and data cubes.
#[derive(Debug, Args)]
pub struct SimulateArguments {
    /// Array: a name (see `boresight arrays`), ulaN, or a JSON file.
    #[arg(long, value_name = "NAME|JSON")]
    pub array: String,
    /// Power of a 0 dB target at one element over the noise power there, dB.
    #[arg(long, value_name = "DB", default_value_t = 20.0, allow_hyphen_values = true)]
    pub snr: f64,
    /// Seed; the same one gives the same numbers on every machine.
    #[arg(long, value_name = "S")]
    pub seed: u64,
    /// File to write, .npy.
    #[arg(long, value_name = "F.npy")]
    pub out: PathBuf,
    /// File for the truth, JSON; without it beside the data, ending in .json.
    #[arg(long, value_name = "F.json")]
    pub truth: Option<PathBuf>,
    /// Standard deviation of the elements' gain, dB.
    #[arg(long, value_name = "DB", default_value_t = 0.0)]
    pub gain_error: f64,
    /// Standard deviation of the elements' phase, deg.
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub phase_error: f64,
    /// Standard deviation of the elements' position, half wavelengths.
    #[arg(long, value_name = "HALF-WAVELENGTHS", default_value_t = 0.0)]
    pub position_error: f64,
    /// Coupling of elements half a wavelength apart, dB.
    #[arg(long, value_name = "DB", allow_hyphen_values = true)]
    pub coupling: Option<f64>,
}

/// Arguments of `simulate snapshots`.
#[derive(Debug, Args)]
pub struct SnapshotArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SimulateArguments,
    /// A target, such as azimuth=12,power=-3: azimuth and elevation in deg, power in dB, phase in
    /// deg. Repeat for more.
    #[arg(long = "target", value_name = "KEY=VALUE,...", allow_hyphen_values = true)]
    pub targets: Vec<String>,
    /// Draw the number of targets between these, and their angles and powers, for each scene.
    #[arg(long, value_name = "FEWEST,MOST", value_parser = pair::<usize>, conflicts_with = "targets")]
    pub random_targets: Option<[usize; 2]>,
    /// Half width of the sector random targets are drawn from, deg.
    #[arg(long, value_name = "DEG", default_value_t = 60.0)]
    pub field_of_view: f64,
    /// Snapshots a scene.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub snapshots: usize,
    /// Scenes.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub scenes: usize,
    /// Number of the first scene, to split a sweep.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub first_scene: u64,
    /// How targets change from snapshot to snapshot.
    #[arg(long, default_value = "random-phase",
          value_parser = ["random-phase", "complex-normal", "coherent"])]
    pub fluctuation: String,
}

/// Arguments of `simulate cube`.
#[derive(Debug, Args)]
pub struct CubeArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SimulateArguments,
    /// Waveform: awr1642, 3dcnn-simulated, 3dcnn-experiment, a JSON file or a board's .cfg.
    #[arg(long, value_name = "NAME|FILE", default_value = "awr1642")]
    pub waveform: String,
    /// A target, such as range=5,rate=-1.5,azimuth=10,power=-3: range in m, rate in m/s, azimuth,
    /// elevation and phase in deg, power of one raw sample in dB. Repeat for more.
    #[arg(
        long = "target",
        value_name = "KEY=VALUE,...",
        required = true,
        allow_hyphen_values = true
    )]
    pub targets: Vec<String>,
    /// Frames.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub frames: usize,
    /// Spherical wavefronts instead of plane ones.
    #[arg(long)]
    pub near_field: bool,
}

/// Two numbers with a comma between.
fn pair<T: std::str::FromStr>(text: &str) -> Result<[T; 2], String> {
    let number = |part: &str| part.trim().parse::<T>().ok();
    text.split_once(',')
        .and_then(|(a, b)| Some([number(a)?, number(b)?]))
        .ok_or_else(|| "expected two numbers with a comma between, such as 4,2".into())
}

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
    /// Standard deviation of the elements' gain, dB.
    #[arg(long, value_name = "DB", default_value_t = 0.0)]
    pub gain_error: f64,
    /// Standard deviation of the elements' phase, deg.
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    pub phase_error: f64,
    /// Standard deviation of the elements' position, half wavelengths.
    #[arg(long, value_name = "HALF-WAVELENGTHS", default_value_t = 0.0)]
    pub position_error: f64,
    /// Coupling of elements half a wavelength apart, dB.
    #[arg(long, value_name = "DB", allow_hyphen_values = true)]
    pub coupling: Option<f64>,
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
