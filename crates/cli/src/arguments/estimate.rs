//! What `estimate` takes.

use super::{OutputFormat, pair};
use boresight_aoa::Method;
use boresight_signal::Window;
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::path::PathBuf;

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

/// Names of all methods, networks too.
pub fn methods() -> Vec<&'static str> {
    Method::ALL.into_iter().chain(Method::NETWORKS).map(Method::name).collect()
}

/// The model that methods aaetr, dnn and cnn3d run.
#[derive(Debug, Args)]
pub struct ModelArguments {
    /// Model of a network, an ONNX file.
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Its card; without it the .json file of its name, if there is one.
    #[arg(long, value_name = "FILE", requires = "model")]
    pub card: Option<PathBuf>,
}

/// Options of angle estimation.
#[derive(Debug, Args)]
#[command(next_help_heading = "Angle estimation")]
pub struct AngleArguments {
    /// Method.
    #[arg(long, default_value = "bartlett", value_parser = PossibleValuesParser::new(methods()))]
    pub method: String,
    /// Model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Least confidence of a network's sources, from 0 to 1; without it that of the model's card.
    #[arg(long, value_name = "P")]
    pub confidence: Option<f64>,
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
    /// Refine the angles on the matched model by Gauss-Newton: drop what noise explains, add what was
    /// missed.
    #[arg(long)]
    pub refine: bool,
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
