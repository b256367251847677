//! What `estimate` takes.

use super::OutputFormat;
use crate::flags::{Flags, OnCommandLine};
use boresight_aoa::Method;
use boresight_formats::ReadingOptions;
use boresight_pipeline::{AngleOptions, ChainOptions};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `estimate`.
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is, by its ending:
  .bin  raw samples of a DCA1000 capture card, with --config; or a folder of the files of one recording
  .npy  a data cube (frames x loops x chirps of a loop x receivers x samples), with --config or
        --waveform; or snapshots (elements, elements x snapshots or scenes x elements x snapshots),
        with --array
  .mat, .h5  the same in a file of MATLAB (-v7.3) or HDF5, --dataset naming one of several arrays
  .csv  snapshots with the columns snapshot, element, re, im, with --array
  .dat  packets of a TI board's data port: the board's own detections are printed")]
pub struct EstimateArguments {
    /// The capture or the snapshots.
    pub file: PathBuf,
    /// The radar.
    #[command(flatten)]
    pub radar: RadarArguments,
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
    /// Why a cell of a capture or a data cube is a detection or none, in place of the detections: of one frame or of all
    /// together.
    #[arg(long, value_name = "RANGE_BIN,DOPPLER_BIN", value_delimiter = ',', num_args = 1, conflicts_with_all = ["each", "csv"])]
    pub explain: Option<Vec<usize>>,
    /// Output.
    #[command(flatten)]
    pub output: OutputFormat,
    /// Angle estimation.
    #[command(flatten)]
    pub angle: AngleArguments,
    /// Detection.
    #[command(flatten)]
    pub chain: Flags<ChainOptions>,
}

/// The radar that a capture or a data cube is of.
#[derive(Debug, Args)]
pub struct RadarArguments {
    /// Which array of a .mat or .h5 file that has several.
    #[arg(long, value_name = "NAME")]
    pub dataset: Option<String>,
    /// The board's configuration: a .cfg file, or .mmwave.json of mmWave Studio.
    #[arg(long, value_name = "CFG")]
    pub config: Option<PathBuf>,
    /// Which sub-frame of an advanced frame is read, from 0.
    #[arg(long, value_name = "I", requires = "config")]
    pub subframe: Option<usize>,
    /// Waveform of a data cube: awr1642, corner, 3dcnn-simulated, 3dcnn-experiment, or a JSON file, such as
    /// the truth that `simulate cube` writes.
    #[arg(long, value_name = "NAME|JSON", conflicts_with = "config")]
    pub waveform: Option<String>,
    /// Array: a name (see `boresight arrays`), ulaN for N elements, or a JSON file with `positions`
    /// or `tx` and `rx` in half wavelengths. A capture's is taken from --config where it says.
    #[arg(long, value_name = "NAME|JSON")]
    pub array: Option<String>,
    /// How the samples of a capture are read.
    #[command(flatten)]
    pub reading: Flags<ReadingOptions>,
    /// Calibration of the array, a JSON file of `boresight array calibrate`; `none` leaves out that of --config.
    #[arg(long, value_name = "JSON|none")]
    pub calibration: Option<String>,
}

impl OnCommandLine for ReadingOptions {
    const HEADING: &'static str = "Samples of captures";
}

/// Names of all methods, networks too.
pub fn methods() -> Vec<&'static str> {
    Method::ALL.into_iter().chain(Method::NETWORKS).map(Method::name).collect()
}

/// The model that methods aaetr, learned-pursuit, dnn and cnn3d run.
#[derive(Debug, Args)]
pub struct ModelArguments {
    /// Model of a network, an ONNX file.
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Its card; without it the .json file of its name, if there is one.
    #[arg(long, value_name = "FILE", requires = "model")]
    pub card: Option<PathBuf>,
    /// Model of a counting network, for `--sources network`; its card is the .json file of its name.
    #[arg(long, value_name = "FILE")]
    pub counting_model: Option<PathBuf>,
}

/// Options of angle estimation.
#[derive(Debug, Args)]
#[command(next_help_heading = "Angle estimation")]
pub struct AngleArguments {
    /// Model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Method and options.
    #[command(flatten)]
    pub flags: Flags<AngleOptions>,
}

impl OnCommandLine for AngleOptions {
    const HEADING: &'static str = "Angle estimation";
    /// A network is named by its file, `--model`.
    const ELSEWHERE: &'static [&'static str] = &["network"];
}

impl OnCommandLine for ChainOptions {
    const HEADING: &'static str = "Detection (captures and data cubes)";
    /// Angle estimation stands beside, since snapshots need it too.
    const ELSEWHERE: &'static [&'static str] = &["angle"];
}
