//! `boresight simulate`.

use crate::arguments::{CubeArguments, SimulateArguments, SimulateCommand, SnapshotArguments};
use crate::array;
use crate::destination::Destination;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::pairs;
use crate::terminal::name;
use boresight_core::Array;
use boresight_formats::json;
use boresight_formats::npy;
use boresight_options::Described;
use boresight_simulate::{CubeTarget, Scene};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Runs the command and returns what it prints.
pub fn run(what: &SimulateCommand, files: &Files) -> Result<String, CliError> {
    match what {
        SimulateCommand::Snapshots(arguments) => snapshots(arguments, files),
        SimulateCommand::Cube(arguments) => cube(arguments, files),
        SimulateCommand::Drive(arguments) => match (&arguments.dataset, &arguments.out) {
            (Some(folder), _) => super::simulated_dataset::run(arguments, folder, files),
            (None, Some(folder)) => super::simulated_drive::run(arguments, folder, files),
            // The parser asks for one of them.
            (None, None) => Ok(String::new()),
        },
    }
}

fn snapshots(arguments: &SnapshotArguments, files: &Files) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let array = array::array(&shared.array, files)?;
    let scene = match (arguments.random.is_given(), &arguments.targets[..]) {
        (true, []) => Scene::Sampled(arguments.random.options),
        (false, targets @ [_, ..]) => Scene::Given(read_targets(targets)?),
        (is_random, _) => {
            return Err(CliError::Option {
                option: "--target",
                expected: "at least one target, or --random-count, not both".into(),
                given: if is_random { "both" } else { "none" }.into(),
            });
        }
    };
    let request = &arguments.flags.options;
    let outputs = Outputs::of(shared, files)?;
    let result = request.simulate(&array, scene)?;
    let truth = json!({
        "array": positions(&array),
        "snrDb": request.options.snr_db,
        "wavelengthM": request.options.wavelength_m,
        "seed": request.options.seed,
        "firstScene": request.first_scene,
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
    let targets: Vec<CubeTarget> = read_targets(&arguments.targets)?;
    let request = &arguments.flags.options;
    let outputs = Outputs::of(shared, files)?;
    let result = request.simulate(&waveform, &array, &targets)?;
    let truth = json!({
        "waveform": waveform,
        "array": positions(&array),
        "snrDb": request.options.snr_db,
        "seed": request.options.seed,
        "targets": json::result(&targets),
    });
    let shape = result.shape().to_vec();
    let values: Vec<_> = result.into_iter().collect();
    outputs.write(files, &shape, &npy::write(&shape, &values)?, &truth)
}

fn read_targets<T: Described + DeserializeOwned>(targets: &[String]) -> Result<Vec<T>, CliError> {
    targets.iter().map(|text| pairs::read("--target", text)).collect()
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
        let mut said = format!("{}: complex numbers of shape {shape:?}\n", name(self.data.named()));
        files.write(self.data, data)?;
        if let Some(destination) = self.truth {
            said += &format!("{}: the truth\n", name(destination.named()));
            files.write(destination, format!("{truth:#}\n").as_bytes())?;
        }
        Ok(said)
    }
}

fn positions(array: &Array) -> Value {
    json!({ "positions": array.positions(), "tx": array.tx(), "rx": array.rx() })
}
