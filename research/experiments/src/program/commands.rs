//! Runs the experiments.

use super::arguments::{
    AnswersArguments, DoaArguments, DoaAxis, DoaRegions, DoaSetup, ExperimentCommand,
    MergeArguments, NetworkArguments,
};
use boresight_cli::error::CliError;
use boresight_cli::experiment::{self, RunArguments, keep_merged};
use boresight_cli::files::Files;
use boresight_cli::network;
use boresight_cli::run::Run;
use boresight_core::presets::preset;
use boresight_experiments::{
    Entrants, EvaluateError, Network, aoa, arrays, calibration, doa, hard, images, imperfections,
    low_snr, merge, near_field, resolution, straddling,
};
use boresight_neural::Kind;
use boresight_validate::experiment::{Answered, run_answered};
use std::path::PathBuf;

/// Runs the experiment and returns what it prints.
pub fn run(what: &ExperimentCommand, files: &Files) -> Result<String, CliError> {
    match what {
        ExperimentCommand::Aoa(arguments) => {
            let options = aoa::AoaExperiment {
                array: arguments.array.clone(),
                trials: arguments.trials,
                validation: arguments.validation,
                seed: arguments.shared.seed,
                targets: arguments.targets.clone(),
                snrs_db: arguments.snr.clone(),
                spread_db: arguments.spread,
                imperfections: arguments.imperfections.options,
                entrants: entrants(
                    &arguments.methods,
                    || Ok(aoa::default_methods(&preset(&arguments.array)?)),
                    &arguments.networks,
                    files,
                )?,
            };
            if arguments.times {
                return times(&options);
            }
            answered(&options, &arguments.shared.run, &arguments.answers, files)
        }
        ExperimentCommand::Calibration(arguments) => {
            let options = calibration::CalibrationExperiment {
                scenes: arguments.scenes,
                seed: arguments.shared.seed,
                duration_s: arguments.duration,
                standing: arguments.standing,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Doa(arguments) => {
            let setup = match arguments.setup {
                DoaSetup::Simulation => doa::Setup::Simulation,
                DoaSetup::Experiment => doa::Setup::Experiment,
            };
            let seed = arguments.shared.seed;
            let networks = networks(&arguments.networks, files)?;
            let end_to_end = (arguments.regions == DoaRegions::EndToEnd)
                .then(|| end_to_end(arguments, &networks))
                .transpose()?;
            let methods = match end_to_end {
                Some(_) => vec![],
                None => doa::default_methods(setup)?,
            };
            let (trials, entrants) = (arguments.trials, Entrants::new(methods, networks));
            let axis = match arguments.axis {
                DoaAxis::Snr => doa::Axis::Snr,
                DoaAxis::PowerDifference => doa::Axis::PowerDifference,
            };
            let options = doa::DoaExperiment { setup, axis, trials, seed, entrants, end_to_end };
            answered(&options, &arguments.shared.run, &arguments.answers, files)
        }
        ExperimentCommand::Hard(arguments) => {
            let usual = || Ok(hard::default_methods());
            let options = hard::HardExperiment {
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(&arguments.methods, usual, &arguments.networks, files)?,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Images(arguments) => {
            let networks = networks(&arguments.networks, files)?;
            let options = images::ImagesExperiment {
                streets: arguments.streets,
                seed: arguments.shared.seed,
                entrants: Entrants::new(arguments.methods.clone(), networks),
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Resolution(arguments) => {
            let options = resolution::ResolutionExperiment {
                array: arguments.array.clone(),
                snapshots: arguments.snapshots.clone(),
                trials: arguments.trials,
                seed: arguments.shared.seed,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Imperfections(arguments) => {
            let options = imperfections::ImperfectionsExperiment {
                array: arguments.array.clone(),
                snr_db: arguments.snr,
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(
                    &arguments.methods,
                    || Ok(aoa::default_methods(&preset(&arguments.array)?)),
                    &arguments.networks,
                    files,
                )?,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Arrays(arguments) => {
            let usual = || Ok(arrays::default_methods());
            let options = arrays::ArraysExperiment {
                snr_db: arguments.snr,
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(&arguments.methods, usual, &arguments.networks, files)?,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::LowSnr(arguments) => {
            let usual = || Ok(low_snr::default_methods());
            let named = &arguments.methods;
            let options = low_snr::LowSnrExperiment {
                array: arguments.array.clone(),
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(named, usual, &arguments.networks, files)?,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::NearField(arguments) => {
            let usual = || Ok(near_field::default_methods());
            let named = &arguments.methods;
            let options = near_field::NearFieldExperiment {
                array: arguments.array.clone(),
                snr_db: arguments.snr,
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(named, usual, &arguments.networks, files)?,
            };
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Straddling(arguments) => {
            let usual = || Ok(straddling::default_methods());
            let named = &arguments.methods;
            let options = straddling::StraddlingExperiment {
                array: arguments.array.clone(),
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(named, usual, &arguments.networks, files)?,
            };
            if arguments.times {
                return Ok(straddling::times(&options)?);
            }
            experiment::run(&options, &arguments.shared.run, files)
        }
        ExperimentCommand::Merge(arguments) => merged(arguments, files),
    }
}

/// The whole flow, its targets counted by the first network given that counts.
fn end_to_end(arguments: &DoaArguments, networks: &[Network]) -> Result<doa::EndToEnd, CliError> {
    let counting = networks.iter().find(|network| network.kind == Kind::Counting);
    let counting = counting.cloned().ok_or_else(|| CliError::Option {
        option: "--model",
        expected: "a counting network among others, since regions are counted".into(),
        given: "none that counts".into(),
    })?;
    let regions = arguments.chain.options;
    Ok(doa::EndToEnd { counting, centre_deg: arguments.centre, regions })
}

/// The methods named, or the usual ones, and the networks.
fn entrants(
    named: &[String],
    usual: impl FnOnce() -> Result<Vec<String>, CliError>,
    models: &NetworkArguments,
    files: &Files,
) -> Result<Entrants, CliError> {
    let methods = match named {
        [] => usual()?,
        _ => named.to_vec(),
    };
    Ok(Entrants::new(methods, networks(models, files)?))
}

fn networks(arguments: &NetworkArguments, files: &Files) -> Result<Vec<Network>, CliError> {
    let network = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Network::new(network::load(path, None, files)?, &name))
    };
    arguments.models.iter().map(network).collect()
}

/// Times of a snapshot, as a table.
fn times(options: &aoa::AoaExperiment) -> Result<String, CliError> {
    let mut text =
        "Time of a snapshot of 6 targets, us\n\n| method | time |\n|---|---|\n".to_owned();
    for (name, seconds) in aoa::times(options)? {
        text += &format!("| {name} | {:.0} |\n", 1e6 * seconds);
    }
    Ok(text)
}

/// Writes what was answered, where that is asked for.
fn answered<E: Answered<Error = EvaluateError>>(
    options: &E,
    run: &RunArguments,
    answers: &AnswersArguments,
    files: &Files,
) -> Result<String, CliError> {
    let Some(path) = &answers.answers else { return experiment::run(options, run, files) };
    let destination = files.destination(path)?;
    let bar = Run::start("scenes")?;
    let outcome = files.write_with(destination, |out| {
        let write = |line: &str| {
            out.write_all(line.as_bytes()).map_err(|error| CliError::File {
                action: "write",
                path: path.clone(),
                error,
            })
        };
        run_answered(options, run.threads(), write, |p| bar.report(p))
    })?;
    bar.finish();
    Ok(run.format.printed(outcome))
}

fn merged(arguments: &MergeArguments, files: &Files) -> Result<String, CliError> {
    arguments.sources.iter().try_for_each(|path| files.check_input(path))?;
    keep_merged(merge(&arguments.sources)?, &arguments.out, &arguments.format, files)
}
