//! `boresight evaluate`.

use crate::arguments::{
    EvaluateAoaArguments, EvaluateArguments, EvaluateCalibrationArguments, EvaluateCommand,
};
use crate::error::CliError;
use crate::files;
use crate::run::Run;
use boresight_evaluate::{aoa, calibration};
use serde_json::json;

/// Runs the experiment and returns what it prints.
pub fn run(what: &EvaluateCommand) -> Result<String, CliError> {
    match what {
        EvaluateCommand::Aoa(arguments) => aoa(arguments),
        EvaluateCommand::Calibration(arguments) => calibration(arguments),
    }
}

fn aoa(arguments: &EvaluateAoaArguments) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let options = aoa::Options {
        array: arguments.array.clone(),
        trials: arguments.trials,
        seed: shared.seed,
        imperfections: arguments.imperfections.spread(),
        threads: threads(shared),
    };
    let run = Run::start("parts")?;
    let report = aoa::run(&options, shared.out.as_deref(), |progress| run.report(progress))?;
    run.finish();
    let (tables, json, csv) = (report.tables(), format!("{:#}\n", json!(report)), report.csv());
    keep(
        shared,
        &[
            ("aoa.md", &tables),
            ("aoa.json", &json),
            ("aoa.csv", &csv),
            ("precision-recall.svg", &aoa::figures::precision_recall(&report)?),
            ("scores.svg", &aoa::figures::scores(&report)?),
        ],
    )?;
    Ok(match (shared.json, arguments.csv) {
        (true, _) => json,
        (_, true) => csv,
        _ => tables,
    })
}

fn calibration(arguments: &EvaluateCalibrationArguments) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let options = calibration::Options {
        scenes: arguments.scenes,
        seed: shared.seed,
        duration_s: arguments.duration,
        threads: threads(shared),
    };
    let run = Run::start("drives")?;
    let out = shared.out.as_deref();
    let report = calibration::run(&options, out, |progress| run.report(progress))?;
    run.finish();
    let (tables, json) = (report.tables(), format!("{:#}\n", json!(report)));
    let mut files = vec![
        ("calibration.md", tables.clone()),
        ("calibration.json", json.clone()),
        ("convergence.svg", calibration::figures::convergence(&report)?),
    ];
    for (condition, name) in report.conditions.iter().zip(["angles.svg", "angles-dense.svg"]) {
        files.push((name, calibration::figures::angles(condition)?));
    }
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, &**text)).collect();
    keep(shared, &files)?;
    Ok(if shared.json { json } else { tables })
}

fn threads(shared: &EvaluateArguments) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    shared.threads.unwrap_or_else(cores)
}

/// Writes the files into the output folder, if there is one.
fn keep(shared: &EvaluateArguments, contents: &[(&str, &str)]) -> Result<(), CliError> {
    let Some(folder) = &shared.out else { return Ok(()) };
    contents.iter().try_for_each(|(name, text)| files::write(&folder.join(name), text.as_bytes()))
}
