//! What `simulate` takes.

use crate::flags::{Flags, OnCommandLine};
use boresight_core::imperfections::ImperfectionSpread;
use boresight_simulate::drive::dataset::DatasetOptions;
use boresight_simulate::{CubeRequest, DriveOptions, SceneSampling, SnapshotRequest};
use clap::{Args, Subcommand};
use std::path::PathBuf;

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
mountings: those of --sensor less the misalignment.

With --dataset, many short drives as compact columns to train networks on, in DIR/frames.bin, \
DIR/detections.bin and DIR/dataset.json; of the options of a drive it takes --seed and --scenario, the \
only kind of roads.")]
pub struct DriveArguments {
    /// Seed; the same one gives the same drive on every machine.
    #[arg(long, value_name = "S")]
    pub seed: u64,
    /// A radar: the number of one of the RadarScenes car's (1 to 4), or where it truly sits and
    /// looks, such as id=1,x=3.7,y=-0.6,yaw=-30: m from the rear axle, deg. Repeat for more;
    /// without it all four of the RadarScenes car.
    #[arg(long = "sensor", value_name = "N|KEY=VALUE,...")]
    pub sensors: Vec<String>,
    /// By how much a radar's true yaw exceeds the nominal one, such as 2=1.5: its number, deg.
    /// Repeat for more.
    #[arg(long = "misalign", value_name = "N=DEG")]
    pub misalignments: Vec<String>,
    /// What is simulated.
    #[command(flatten)]
    pub flags: Flags<DriveOptions>,
    /// Write radar_data.h5 in chunks packed by deflate.
    #[arg(long)]
    pub packed: bool,
    /// Folder to write.
    #[arg(long, value_name = "DIR", required_unless_present = "dataset")]
    pub out: Option<PathBuf>,
    /// Folder for a set of data in place of one drive.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "sensors", "misalignments", "packed"])]
    pub dataset: Option<PathBuf>,
    /// What the set of data holds.
    #[command(flatten)]
    pub of_dataset: Flags<DatasetOptions>,
}

impl OnCommandLine for DatasetOptions {
    const HEADING: &'static str = "Set of data, with --dataset";
    /// Seed and roads have the flags of a drive.
    const ELSEWHERE: &'static [&'static str] = &["seed", "scenario"];
}

impl OnCommandLine for DriveOptions {
    const HEADING: &'static str = "Drive";
    /// Seed, radars and their misalignments have flags of their own.
    const ELSEWHERE: &'static [&'static str] = &["seed", "sensors", "misalignment_rad"];
}

/// Arguments shared by the simulations of snapshots and data cubes.
#[derive(Debug, Args)]
pub struct SimulateArguments {
    /// Array: a name (see `boresight arrays`), ulaN, or a JSON file.
    #[arg(long, value_name = "NAME|JSON")]
    pub array: String,
    /// File to write, .npy.
    #[arg(long, value_name = "F.npy")]
    pub out: PathBuf,
    /// File for the truth, JSON; without it beside the data, ending in .json.
    #[arg(long, value_name = "F.json")]
    pub truth: Option<PathBuf>,
}

impl OnCommandLine for SnapshotRequest {
    const HEADING: &'static str = "Snapshots";
    const REQUIRED: &'static [&'static str] = &["seed"];
}

impl OnCommandLine for SceneSampling {
    const HEADING: &'static str = "Targets drawn anew for each scene, in place of --target";
    const PREFIX: &'static str = "random";
}

impl OnCommandLine for CubeRequest {
    const HEADING: &'static str = "Data cube";
    const REQUIRED: &'static [&'static str] = &["seed"];
}

/// Arguments of `simulate snapshots`.
#[derive(Debug, Args)]
pub struct SnapshotArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SimulateArguments,
    /// A target, such as azimuth=12,power=-3: azimuth and elevation in deg, power in dB, phase in
    /// deg, and range in m, with which its wave is spherical. Repeat for more.
    #[arg(long = "target", value_name = "KEY=VALUE,...", allow_hyphen_values = true)]
    pub targets: Vec<String>,
    /// What is simulated.
    #[command(flatten)]
    pub flags: Flags<SnapshotRequest>,
    /// How targets are drawn.
    #[command(flatten)]
    pub random: Flags<SceneSampling>,
}

/// Arguments of `simulate cube`.
#[derive(Debug, Args)]
pub struct CubeArguments {
    /// Shared arguments.
    #[command(flatten)]
    pub shared: SimulateArguments,
    /// Waveform: awr1642, corner, 3dcnn-simulated, 3dcnn-experiment, a JSON file or a board's .cfg.
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
    /// What is simulated.
    #[command(flatten)]
    pub flags: Flags<CubeRequest>,
}

impl OnCommandLine for ImperfectionSpread {
    const HEADING: &'static str = "What is wrong with the array";
    const PREFIX: &'static str = "imperfections";
}
