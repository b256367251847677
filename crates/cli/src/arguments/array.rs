//! What `array` takes.

use super::RadarArguments;
use crate::flags::{Flags, OnCommandLine};
use boresight_array_calibration::{CalibrationOptions, Reflector};
use clap::{Args, Subcommand};
use std::ops::Range;
use std::path::PathBuf;

/// What to do with an array.
#[derive(Debug, Subcommand)]
pub enum ArrayCommand {
    /// Find gain and phase of each channel, from reflectors or from ordinary captures.
    Calibrate(Box<CalibrateArrayArguments>),
    /// Tell what a calibration holds.
    Show(ShowCalibrationArguments),
}

/// Arguments of `array calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is, by its ending:
  .bin  raw samples of a DCA1000 capture card, with --config
  .npy  a data cube (frames x loops x transmitters x receivers x samples), with --config or --waveform
  .mat, .h5  the same in a file of MATLAB (-v7.3) or HDF5, --dataset naming one of several arrays
  .json  a table of measured steering vectors (azimuthDeg, elevationDeg, responses), with --array

Without --at all strong cells with one target serve. Their directions are not known then, and a phase that rises linearly
over the array, which turns all angles alike, stays that of the plan.

Examples:
  boresight array calibrate capture.bin --config profile.cfg --out calibration.json
  boresight array calibrate corner.bin --config profile.cfg --at 5.2,0 --range-bias --out calibration.json
  boresight estimate capture.bin --config profile.cfg --calibration calibration.json")]
pub struct CalibrateArrayArguments {
    /// The capture, the data cube, or the table.
    pub file: PathBuf,
    /// The radar.
    #[command(flatten)]
    pub radar: RadarArguments,
    /// A target to calibrate by: its range in m and, where they are known, its azimuth and elevation in degrees; may be given
    /// several times.
    #[arg(long, value_name = "RANGE[,AZIMUTH[,ELEVATION]]", value_parser = reflector, allow_hyphen_values = true)]
    pub at: Vec<Reflector>,
    /// Frames it is made from, A to B - 1; the first half without it.
    #[arg(long, value_name = "A..B", value_parser = frames)]
    pub frames: Option<Range<usize>>,
    /// Frames it is checked on; all after the others without it.
    #[arg(long, value_name = "A..B", value_parser = frames)]
    pub check_frames: Option<Range<usize>>,
    /// File to write the calibration to (JSON).
    #[arg(long, value_name = "OUT.json")]
    pub out: Option<PathBuf>,
    /// Print the line that makes the board of --config apply it, and nothing else.
    #[arg(long, conflicts_with = "json")]
    pub ti: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// How.
    #[command(flatten)]
    pub options: Flags<CalibrationOptions>,
}

/// Arguments of `array show`.
#[derive(Debug, Args)]
pub struct ShowCalibrationArguments {
    /// The calibration (JSON).
    pub file: PathBuf,
    /// The configuration (.cfg) of a TI board: print the line that makes it apply the calibration, and nothing else.
    #[arg(long, value_name = "CFG")]
    pub ti: Option<PathBuf>,
}

impl OnCommandLine for CalibrationOptions {
    const HEADING: &'static str = "Calibration";
    /// They are given by `--at`.
    const ELSEWHERE: &'static [&'static str] = &["reflectors"];
}

fn reflector(text: &str) -> Result<Reflector, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([range_m]) => Ok(Reflector { range_m: *range_m, ..Reflector::default() }),
        Some([range_m, azimuth]) => Ok(Reflector {
            range_m: *range_m,
            azimuth_rad: Some(azimuth.to_radians()),
            elevation_rad: 0.0,
        }),
        Some([range_m, azimuth, elevation]) => Ok(Reflector {
            range_m: *range_m,
            azimuth_rad: Some(azimuth.to_radians()),
            elevation_rad: elevation.to_radians(),
        }),
        _ => Err("expected one to three numbers with commas between".into()),
    }
}

fn frames(text: &str) -> Result<Range<usize>, String> {
    let bounds = text.split_once("..").and_then(|(first, end)| {
        Some((first.trim().parse::<usize>().ok()?, end.trim().parse::<usize>().ok()?))
    });
    match bounds {
        Some((first, end)) if first < end => Ok(first..end),
        _ => Err("expected two whole numbers, such as 0..4 for frames 0 to 3".into()),
    }
}
