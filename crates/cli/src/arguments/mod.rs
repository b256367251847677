//! What the command line takes: a file a command, and what several share.

mod array;
mod augment;
mod bridge;
mod drives;
mod estimate;
mod fleet;
mod image;
mod regions;
mod serve;
mod simulate;
mod validate;

pub use array::{ArrayCommand, CalibrateArrayArguments, ShowCalibrationArguments};
pub use augment::AugmentArguments;
pub use bridge::BridgeArguments;
pub use drives::{CalibrateArguments, LogArguments, LogPaths, OdometryArguments};
pub use estimate::{EstimateArguments, ModelArguments, RadarArguments};
pub use fleet::{
    FleetCommand, FleetMergeArguments, FleetPlanArguments, FleetRunArguments, FleetWorkerArguments,
    WhichPart,
};
pub use image::{ImageArguments, ImageCaptureArguments, ImageCommand, ImageStreetArguments};
pub use regions::RegionsArguments;
pub use serve::ServeArguments;
pub use simulate::{
    CubeArguments, DriveArguments, SimulateArguments, SimulateCommand, SnapshotArguments,
};
pub use validate::ValidateArguments;

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
  The same of a long-range array by a trained network:
    boresight estimate cell.npy --array lrr48 --method learned-pursuit --model models/learned-pursuit.onnx

Angles are in degrees, positive to the left; range rates are positive when receding.";

/// Automotive radar: angles from captures and snapshots, and simulation.
#[derive(Debug, Parser)]
#[command(name = "boresight", version, after_help = EXAMPLES, max_term_width = 100)]
pub struct Cli {
    /// Replace files that are there; never those a command reads.
    #[arg(long, global = true)]
    pub force: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Print the detections in a capture, or the angles in snapshots.
    Estimate(Box<EstimateArguments>),
    /// Print regions of the range spectrum and the targets in each, counted and told apart by networks.
    Regions(Box<RegionsArguments>),
    /// Simulate data of which the truth is known, as a .npy file.
    Simulate {
        /// What to simulate.
        #[command(subcommand)]
        what: SimulateCommand,
    },
    /// Make more frames of a recording by moving all that it holds in range, to train networks on.
    Augment(Box<AugmentArguments>),
    /// Estimate the angle a car's radars are mounted at from a drive log.
    Calibrate(Box<CalibrateArguments>),
    /// Calibrate many drives, on many machines, and put the results of a fleet together.
    Fleet {
        /// What to do.
        #[command(subcommand)]
        what: FleetCommand,
    },
    /// Estimate the car's motion from all of its radars, once they are calibrated on the same drive.
    Odometry(OdometryArguments),
    /// Tell what is in a drive log: radars, scans, the car's motion, and what was left out.
    Log(LogArguments),
    /// Play a drive and its calibration to viewers such as Foxglove and Lichtblick, over a socket of this machine.
    Serve(Box<ServeArguments>),
    /// Compare the mounting angles of every method with the true ones on your own drives, whole and in pieces.
    Validate(ValidateArguments),
    /// Make a bird's-eye image of a simulated street or of a capture, as a PNG file.
    Image {
        /// What to make it of.
        #[command(subcommand)]
        what: ImageCommand,
    },
    /// Hand raw samples of a DCA1000 capture card to pages, from its UDP packets over a WebSocket.
    Bridge(BridgeArguments),
    /// List the methods of angle estimation, and what each needs.
    Methods(ListFormat),
    /// Tell what a trained network is: inputs, outputs, what its card says of it.
    Network(TellArguments),
    /// List the arrays known by name.
    Arrays(ListFormat),
    /// Calibrate the channels of an array, and tell what a calibration holds.
    Array {
        /// What to do.
        #[command(subcommand)]
        what: ArrayCommand,
    },
}

/// Arguments of `network`.
#[derive(Debug, Args)]
pub struct TellArguments {
    /// The model (.onnx).
    pub model: PathBuf,
    /// Its card; without it the .json file of its name, if there is one.
    #[arg(long, value_name = "FILE")]
    pub card: Option<PathBuf>,
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
