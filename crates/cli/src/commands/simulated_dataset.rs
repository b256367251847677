//! `boresight simulate drive --dataset`.

use crate::arguments::DriveArguments;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::run::Run;
use crate::terminal::name;
use boresight_core::Progress;
use boresight_options::{Named, naming};
use boresight_simulate::SimulateError;
use boresight_simulate::drive::dataset::{Condition, Dataset, DatasetOptions, WINDOW, file};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// What was written.
#[derive(Default)]
struct Counts {
    frames: usize,
    detections: usize,
    moving: usize,
    nothing_static: usize,
    drives: u64,
}

/// Simulates drives until there are enough frames, writes them as they come and says what there is.
pub fn run(arguments: &DriveArguments, folder: &Path, files: &Files) -> Result<String, CliError> {
    let options = options(arguments)?;
    let mut data = Dataset::new(&options)?;
    let paths = ["frames.bin", "detections.bin", "dataset.json"].map(|name| folder.join(name));
    let destination = |path: &Path| files.destination(path);
    let (frames, detections, card) =
        (destination(&paths[0])?, destination(&paths[1])?, destination(&paths[2])?);
    let run = Run::start("frames")?;
    files::make_folder(folder)?;
    let counts = files.write_with(frames, |frames| {
        files.write_with(detections, |detections| {
            write(&mut data, options.frames, &run, [(&paths[0], frames), (&paths[1], detections)])
        })
    })?;
    run.finish();
    files.write(card, format!("{:#}\n", told(&options, &counts)).as_bytes())?;
    Ok(format!(
        "{}: {} drives, {} frames, {} detections, {:.1} % of them moving, {:.1} % of the frames without \
         anything static\n",
        name(folder),
        counts.drives,
        counts.frames,
        counts.detections,
        100.0 * counts.moving as f64 / counts.detections.max(1) as f64,
        100.0 * counts.nothing_static as f64 / counts.frames.max(1) as f64,
    ))
}

fn write(
    data: &mut Dataset,
    wanted: usize,
    run: &Run,
    [(frames_path, frames_out), (detections_path, detections_out)]: [(&Path, &mut dyn Write); 2],
) -> Result<Counts, CliError> {
    let mut counts = Counts::default();
    let (mut frames, mut detections) = (vec![], vec![]);
    while counts.frames < wanted {
        if run.report(Progress { done: counts.frames, total: wanted }).is_break() {
            return Err(SimulateError::Cancelled { done: counts.frames, total: wanted }.into());
        }
        frames.clear();
        detections.clear();
        counts.drives += 1;
        for window in data.next_drive()? {
            if counts.frames >= wanted {
                break;
            }
            counts.frames += WINDOW;
            counts.nothing_static +=
                if window.condition == Condition::NothingStatic { WINDOW } else { 0 };
            for (_, moving) in window.frames.iter().flat_map(|frame| &frame.detections) {
                counts.detections += 1;
                counts.moving += usize::from(*moving);
            }
            file::append(&window, &mut frames, &mut detections);
        }
        put(frames_path, frames_out, &frames)?;
        put(detections_path, detections_out, &detections)?;
    }
    Ok(counts)
}

fn put(path: &Path, out: &mut dyn Write, bytes: &[u8]) -> Result<(), CliError> {
    out.write_all(bytes).map_err(|error| CliError::File {
        action: "write",
        path: path.into(),
        error,
    })
}

fn options(arguments: &DriveArguments) -> Result<DatasetOptions, CliError> {
    let drive = &arguments.flags;
    if let Some(field) = drive.all_given().iter().find(|field| **field != "scenario") {
        return Err(CliError::Option {
            option: "--dataset",
            expected: "of the options of a drive --seed and --scenario alone".into(),
            given: format!("--{}", naming::flag(field)),
        });
    }
    let options = DatasetOptions {
        seed: arguments.seed,
        scenario: drive.given("scenario").then_some(drive.options.scenario),
        ..arguments.of_dataset.options.clone()
    };
    Ok(options)
}

fn told(options: &DatasetOptions, counts: &Counts) -> Value {
    json!({
        "format": file::FORMAT,
        "version": file::VERSION,
        "window": WINDOW,
        "frames": counts.frames,
        "detections": counts.detections,
        "drives": counts.drives,
        "seed": options.seed,
        "scenario": options.scenario.map(Named::name),
        "scenarioLeftOut": options.scenario_left_out.map(Named::name),
        "noise": options.dataset_noise.name(),
    })
}
