//! What `image` takes.

use super::estimate::{ModelArguments, methods};
use crate::flags::{Flags, OnCommandLine, names};
use boresight_formats::ReadingOptions;
use boresight_image::ViewGridOptions;
use boresight_pipeline::image::Content;
use boresight_simulate::StreetOptions;
use boresight_simulate::street::STREET_RADARS;
use clap::builder::PossibleValuesParser;
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// What to make an image of.
#[derive(Debug, Subcommand)]
pub enum ImageCommand {
    /// A simulated street seen by five radars, with how much of the image is not target.
    Street(ImageStreetArguments),
    /// A frame of a raw capture.
    Capture(ImageCaptureArguments),
}

/// Arguments of all images.
#[derive(Debug, Args)]
pub struct ImageArguments {
    /// Method of angle estimation; several, with commas between, make an image each.
    #[arg(long, default_value = "iaa", value_delimiter = ',',
          value_parser = PossibleValuesParser::new(methods()))]
    pub method: Vec<String>,
    /// Model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// What goes into the image: the angles found in each cell, or the spectrum of each cell;
    /// without it spectra if all methods have them, so that like stands beside like.
    #[arg(long, value_name = "WHAT", value_parser = names::<Content>())]
    pub from: Option<String>,
    /// Picture to write; of several methods, each has the method's name before the ending.
    #[arg(long, value_name = "OUT.png")]
    pub out: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `image street`.
#[derive(Debug, Args)]
pub struct ImageStreetArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: ImageArguments,
    /// The street.
    #[command(flatten)]
    pub street: Flags<StreetOptions>,
    /// Radars, with commas between; without it all five.
    #[arg(long, value_name = "NAMES", value_delimiter = ',',
          value_parser = PossibleValuesParser::new(STREET_RADARS))]
    pub radars: Vec<String>,
    /// Beside the methods an image of the detections of the ordinary chain, one a peak.
    #[arg(long)]
    pub chain: bool,
    /// Mark the true targets and walls in the picture.
    #[arg(long)]
    pub truth: bool,
    /// What is shown.
    #[command(flatten)]
    pub grid: Flags<ViewGridOptions>,
}

impl OnCommandLine for StreetOptions {
    const HEADING: &'static str = "The street";
}

impl OnCommandLine for ViewGridOptions {
    const HEADING: &'static str = "What is shown";
}

/// Arguments of `image capture`.
#[derive(Debug, Args)]
pub struct ImageCaptureArguments {
    /// Raw samples of a DCA1000 capture card (.bin); or a folder of the files of one recording.
    pub file: PathBuf,
    /// The board's configuration: a .cfg file, or .mmwave.json of mmWave Studio.
    #[arg(long, value_name = "CFG")]
    pub config: PathBuf,
    /// Shared arguments.
    #[command(flatten)]
    pub shared: ImageArguments,
    /// Only this frame, from 0; without it all together, for scenes that stand still.
    #[arg(long, value_name = "I")]
    pub frame: Option<usize>,
    /// Array, where the configuration names no board with a known one.
    #[arg(long, value_name = "NAME|JSON")]
    pub array: Option<String>,
    /// How the samples are read.
    #[command(flatten)]
    pub reading: Flags<ReadingOptions>,
    /// Calibration of the array, a JSON file of `boresight array calibrate`; `none` leaves out that of --config.
    #[arg(long, value_name = "JSON|none")]
    pub calibration: Option<String>,
}
