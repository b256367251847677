//! What `regions` takes.

use super::{OutputFormat, RadarArguments};
use crate::flags::{Flags, OnCommandLine};
use boresight_pipeline::regions::RegionChainOptions;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `regions`.
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is, by its ending:
  .bin  raw samples of a DCA1000 capture card, with --config; or a folder of the files of one recording
  .npy  a data cube (frames x loops x transmitters x receivers x samples), with --config or --waveform
  .mat, .h5  the same in a file of MATLAB (-v7.3) or HDF5, --dataset naming one of several arrays

Without networks, ranges and azimuths of each region are estimated jointly by maximum likelihood, for any linear
array. Networks are ONNX files with their cards beside them. Those of models/ take 8 elements half a wavelength apart
along y.
One line a target is printed; JSON has all regions, those without a target too.")]
pub struct RegionsArguments {
    /// The capture or the data cube.
    pub file: PathBuf,
    /// The radar.
    #[command(flatten)]
    pub radar: RadarArguments,
    /// Network that counts the targets of a region: models/counting-small.onnx.
    #[arg(long, value_name = "FILE", requires = "one", requires = "two")]
    pub counting: Option<PathBuf>,
    /// Network for one target, a 3D-CNN or a DNN: models/dnn-small-1.onnx.
    #[arg(long, value_name = "FILE", requires = "counting")]
    pub one: Option<PathBuf>,
    /// Network of the same kind for two targets: models/dnn-small-2.onnx.
    #[arg(long, value_name = "FILE", requires = "counting")]
    pub two: Option<PathBuf>,
    /// Only this frame, from 0; every frame by itself without it.
    #[arg(long, value_name = "I")]
    pub frame: Option<usize>,
    /// Output.
    #[command(flatten)]
    pub output: OutputFormat,
    /// Detection and regions.
    #[command(flatten)]
    pub chain: Flags<RegionChainOptions>,
}

impl OnCommandLine for RegionChainOptions {
    const HEADING: &'static str = "Detection and regions";
}
