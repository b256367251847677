//! What `augment` takes.

use crate::flags::{Flags, OnCommandLine};
use boresight_formats::ReadingOptions;
use boresight_signal::RangeAugmentation;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `augment`.
#[derive(Debug, Args)]
#[command(after_help = "\
Each new frame is a recorded one with all that it holds moved in range (equation 10 of Sang et al. 2021), to train networks on more \
ranges than were recorded. FILE is, by its ending:
  .bin  raw samples of a DCA1000 capture card, with --config; or a folder of the files of one recording
  .npy  a data cube (frames x loops x transmitters x receivers x samples), with --config or --waveform
  .mat, .h5  the same in a file of MATLAB (-v7.3) or HDF5, --dataset naming one of several arrays
The new frames are a data cube, for whose estimates the same --config or --waveform stands.")]
pub struct AugmentArguments {
    /// The capture or the data cube.
    pub file: PathBuf,
    /// Which array of a .mat or .h5 file that has several.
    #[arg(long, value_name = "NAME")]
    pub dataset: Option<String>,
    /// The board's configuration: a .cfg file, or .mmwave.json of mmWave Studio.
    #[arg(long, value_name = "CFG")]
    pub config: Option<PathBuf>,
    /// Waveform of a data cube: awr1642, corner, 3dcnn-simulated, 3dcnn-experiment, or a JSON file.
    #[arg(long, value_name = "NAME|JSON", conflicts_with = "config")]
    pub waveform: Option<String>,
    /// How the samples of a capture are read.
    #[command(flatten)]
    pub reading: Flags<ReadingOptions>,
    /// File to write, .npy.
    #[arg(long, value_name = "F.npy")]
    pub out: PathBuf,
    /// File for the frame and the shift of each new frame, JSON; without it beside the data, ending in .json.
    #[arg(long, value_name = "F.json")]
    pub shifts: Option<PathBuf>,
    /// What is made.
    #[command(flatten)]
    pub flags: Flags<RangeAugmentation>,
}

impl OnCommandLine for RangeAugmentation {
    const HEADING: &'static str = "New frames";
    const REQUIRED: &'static [&'static str] = &["count", "seed"];
}
