//! `boresight evaluate`.

use crate::arguments::{EvaluateCalibrationArguments, EvaluateCommand};
use crate::error::CliError;
use crate::files;
use crate::run::Run;
use boresight_evaluate::calibration::{self, figures};

/// Runs the experiment and returns what it prints.
pub fn run(what: &EvaluateCommand) -> Result<String, CliError> {
    match what {
        EvaluateCommand::Calibration(arguments) => calibration(arguments),
    }
}

fn calibration(arguments: &EvaluateCalibrationArguments) -> Result<String, CliError> {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let options = calibration::Options {
        scenes: arguments.scenes,
        seed: arguments.seed,
        duration_s: arguments.duration,
        threads: arguments.threads.unwrap_or_else(cores),
    };
    let run = Run::start("drives")?;
    let out = arguments.out.as_deref();
    let report = calibration::run(&options, out, |progress| run.report(progress))?;
    run.finish();
    let tables = report.tables();
    let json = format!("{:#}\n", serde_json::json!(report));
    if let Some(folder) = out {
        files::write(&folder.join("calibration.md"), tables.as_bytes())?;
        files::write(&folder.join("calibration.json"), json.as_bytes())?;
        files::write(&folder.join("convergence.svg"), figures::convergence(&report)?.as_bytes())?;
        for (condition, name) in report.conditions.iter().zip(["angles", "angles-dense"]) {
            let svg = figures::angles(condition)?;
            files::write(&folder.join(name).with_extension("svg"), svg.as_bytes())?;
        }
    }
    Ok(if arguments.json { json } else { tables })
}
