//! `boresight simulate`.

use super::targets::TargetText;
use crate::arguments::{CubeArguments, SimulateArguments, SimulateCommand, SnapshotArguments};
use crate::array;
use crate::destination::Destination;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::json;
use boresight_core::error::check_range;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::{Array, Direction, Imperfections};
use boresight_formats::npy;
use boresight_simulate::{
    CubeOptions, CubeTarget, Field, Fluctuation, Scene, SceneSampling, SnapshotOptions,
    SnapshotSimulator, Target, simulate_cube,
};
use serde_json::{Value, json};

/// Runs the command and returns what it prints.
pub fn run(what: &SimulateCommand, files: &Files) -> Result<String, CliError> {
    match what {
        SimulateCommand::Snapshots(arguments) => snapshots(arguments, files),
        SimulateCommand::Cube(arguments) => cube(arguments, files),
        SimulateCommand::Drive(arguments) => super::simulated_drive::run(arguments, files),
    }
}

fn snapshots(arguments: &SnapshotArguments, files: &Files) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let array = array::array(&shared.array, files)?;
    let scene = match arguments.random_targets {
        Some(targets) => {
            check_range("--field-of-view (deg)", arguments.field_of_view, 0.1, 90.0)?;
            let field_of_view_rad = arguments.field_of_view.to_radians();
            Scene::Sampled(SceneSampling {
                count: targets,
                field_of_view_rad,
                ..Default::default()
            })
        }
        None if arguments.targets.is_empty() => {
            return Err(CliError::Option {
                option: "--target",
                expected: "at least one target, or --random-targets".into(),
                given: "none".into(),
            });
        }
        None => {
            Scene::Given(arguments.targets.iter().map(|t| target(t)).collect::<Result<_, _>>()?)
        }
    };
    let options = SnapshotOptions {
        scene,
        snr_db: shared.snr,
        snapshots: arguments.snapshots,
        fluctuation: match arguments.fluctuation.as_str() {
            "complex-normal" => Fluctuation::ComplexNormal,
            "coherent" => Fluctuation::Coherent,
            _ => Fluctuation::RandomPhase,
        },
        imperfections: imperfections(shared, &array)?,
        seed: shared.seed,
    };
    let outputs = Outputs::of(shared, files)?;
    let result = SnapshotSimulator::new(&array, &options)?
        .scenes(arguments.first_scene, arguments.scenes)?;
    let truth = json!({
        "array": positions(&array),
        "snrDb": shared.snr,
        "seed": shared.seed,
        "firstScene": arguments.first_scene,
        "scenes": json::result(&result.truth),
    });
    let shape = result.values.shape().to_vec();
    let values: Vec<_> = result.values.into_iter().collect();
    outputs.write(files, &shape, &npy::write(&shape, &values)?, &truth)
}

fn cube(arguments: &CubeArguments, files: &Files) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let array = array::array(&shared.array, files)?;
    let waveform = files::waveform(&arguments.waveform, files)?;
    let targets: Vec<CubeTarget> =
        arguments.targets.iter().map(|t| cube_target(t)).collect::<Result<_, _>>()?;
    let options = CubeOptions {
        snr_db: shared.snr,
        frames: arguments.frames,
        field: if arguments.near_field { Field::Near } else { Field::Far },
        imperfections: imperfections(shared, &array)?,
        seed: shared.seed,
    };
    let outputs = Outputs::of(shared, files)?;
    let result = simulate_cube(&waveform, &array, &targets, &options)?;
    let truth = json!({
        "waveform": waveform,
        "array": positions(&array),
        "snrDb": shared.snr,
        "seed": shared.seed,
        "targets": json::result(&targets),
    });
    let shape = result.shape().to_vec();
    let values: Vec<_> = result.into_iter().collect();
    outputs.write(files, &shape, &npy::write(&shape, &values)?, &truth)
}

/// Where data and truth go.
struct Outputs {
    data: Destination,
    /// Beside data that go to no file it is written only where it is asked for.
    truth: Option<Destination>,
}

impl Outputs {
    fn of(shared: &SimulateArguments, files: &Files) -> Result<Self, CliError> {
        let data = files.destination(&shared.out)?;
        let beside = || data.file().map(|_| shared.out.with_extension("json"));
        let truth = shared.truth.clone().or_else(beside);
        let truth = truth.map(|path| files.destination(&path)).transpose()?;
        Ok(Self { data, truth })
    }

    /// Writes data and truth, and says so.
    fn write(
        self,
        files: &Files,
        shape: &[usize],
        data: &[u8],
        truth: &Value,
    ) -> Result<String, CliError> {
        let mut said =
            format!("{}: complex numbers of shape {shape:?}\n", self.data.named().display());
        files.write(self.data, data)?;
        if let Some(destination) = self.truth {
            said += &format!("{}: the truth\n", destination.named().display());
            files.write(destination, format!("{truth:#}\n").as_bytes())?;
        }
        Ok(said)
    }
}

fn imperfections(
    shared: &SimulateArguments,
    array: &Array,
) -> Result<Option<Imperfections>, CliError> {
    let spread = shared.imperfections.spread();
    if spread == ImperfectionSpread::default() {
        return Ok(None);
    }
    Ok(Some(Imperfections::random(array, spread, shared.seed)?))
}

fn direction(text: &TargetText<'_>) -> Result<Direction, CliError> {
    let (azimuth_deg, elevation_deg) =
        (text.get("azimuth").unwrap_or(0.0), text.get("elevation").unwrap_or(0.0));
    check_range("azimuth (deg)", azimuth_deg, -90.0, 90.0)?;
    check_range("elevation (deg)", elevation_deg, -90.0, 90.0)?;
    Ok(Direction::new(azimuth_deg.to_radians(), elevation_deg.to_radians()))
}

fn target(text: &str) -> Result<Target, CliError> {
    let text = TargetText::parse("--target", text, &["azimuth", "elevation", "power", "phase"])?;
    text.need("azimuth")?;
    Ok(Target {
        direction: direction(&text)?,
        power_db: text.get("power").unwrap_or(0.0),
        phase_rad: text.get("phase").map(f64::to_radians),
    })
}

fn cube_target(text: &str) -> Result<CubeTarget, CliError> {
    let keys = ["range", "rate", "azimuth", "elevation", "power", "phase"];
    let text = TargetText::parse("--target", text, &keys)?;
    Ok(CubeTarget {
        range_m: text.need("range")?,
        rate_mps: text.get("rate").unwrap_or(0.0),
        direction: direction(&text)?,
        power_db: text.get("power").unwrap_or(0.0),
        phase_rad: text.get("phase").map(f64::to_radians),
    })
}

fn positions(array: &Array) -> Value {
    json!({ "positions": array.positions(), "tx": array.tx(), "rx": array.rx() })
}
