//! `boresight evaluate`.

use crate::arguments::{
    AnswersArguments, DoaAxis, DoaRegions, DoaSetup, EvaluateArguments,
    EvaluateCalibrationArguments, EvaluateCommand, EvaluateDoaArguments, EvaluateMergeArguments,
    NetworkArguments,
};
use crate::destination::Destination;
use crate::drive;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::network;
use crate::output::remark;
use crate::run::Run;
use crate::terminal::name;
use boresight_core::CoreError;
use boresight_core::presets::preset;
use boresight_evaluate::experiment::{self, Answered, Experiment, How};
use boresight_evaluate::{
    Entrants, Merged, Network, Outcome, aoa, arrays, calibration, doa, images, imperfections,
    low_snr, merge, near_field, resolution, straddling,
};
use boresight_neural::Kind;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the experiment and returns what it prints.
pub fn run(what: &EvaluateCommand, files: &Files) -> Result<String, CliError> {
    match what {
        EvaluateCommand::Aoa(arguments) => {
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
            answered(&options, &arguments.shared, &arguments.answers, files)
        }
        EvaluateCommand::Calibration(EvaluateCalibrationArguments {
            shared,
            drives: Some(folder),
            pieces,
            ..
        }) => {
            let (drives, paths) = drive::drives_in(folder, files)?.into_iter().unzip();
            let options = calibration::DrivesExperiment {
                drives,
                pieces_s: pieces.clone(),
                paths,
                load: Some(drive::load),
            };
            evaluate(&options, shared, files)
        }
        EvaluateCommand::Calibration(arguments) => {
            let options = calibration::CalibrationExperiment {
                scenes: arguments.scenes,
                seed: arguments.shared.seed,
                duration_s: arguments.duration,
                standing: arguments.standing,
            };
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::Doa(arguments) => {
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
            answered(&options, &arguments.shared, &arguments.answers, files)
        }
        EvaluateCommand::Images(arguments) => {
            let networks = networks(&arguments.networks, files)?;
            let options = images::ImagesExperiment {
                streets: arguments.streets,
                seed: arguments.shared.seed,
                entrants: Entrants::new(arguments.methods.clone(), networks),
            };
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::Resolution(arguments) => {
            let options = resolution::ResolutionExperiment {
                array: arguments.array.clone(),
                snapshots: arguments.snapshots.clone(),
                trials: arguments.trials,
                seed: arguments.shared.seed,
            };
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::Imperfections(arguments) => {
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
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::Arrays(arguments) => {
            let usual = || Ok(arrays::default_methods());
            let options = arrays::ArraysExperiment {
                snr_db: arguments.snr,
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(&arguments.methods, usual, &arguments.networks, files)?,
            };
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::LowSnr(arguments) => {
            let usual = || Ok(low_snr::default_methods());
            let named = &arguments.methods;
            let options = low_snr::LowSnrExperiment {
                array: arguments.array.clone(),
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(named, usual, &arguments.networks, files)?,
            };
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::NearField(arguments) => {
            let usual = || Ok(near_field::default_methods());
            let named = &arguments.methods;
            let options = near_field::NearFieldExperiment {
                array: arguments.array.clone(),
                snr_db: arguments.snr,
                trials: arguments.trials,
                seed: arguments.shared.seed,
                entrants: entrants(named, usual, &arguments.networks, files)?,
            };
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::Straddling(arguments) => {
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
            evaluate(&options, &arguments.shared, files)
        }
        EvaluateCommand::Merge(arguments) => merged(arguments, files),
    }
}

/// The whole flow, its targets counted by the first network given that counts.
fn end_to_end(
    arguments: &EvaluateDoaArguments,
    networks: &[Network],
) -> Result<doa::EndToEnd, CliError> {
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
    let mut text = "| method | us a snapshot |\n|---|---|\n".to_owned();
    for (name, seconds) in aoa::times(options)? {
        text += &format!("| {name} | {:.0} |\n", 1e6 * seconds);
    }
    Ok(text)
}

fn threads(shared: &EvaluateArguments) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    shared.threads.unwrap_or_else(cores)
}

/// Writes what was answered, where that is asked for.
fn answered<E: Answered>(
    options: &E,
    shared: &EvaluateArguments,
    answers: &AnswersArguments,
    files: &Files,
) -> Result<String, CliError> {
    let Some(path) = &answers.answers else { return evaluate(options, shared, files) };
    let destination = files.destination(path)?;
    let run = Run::start("scenes")?;
    let outcome = files.write_with(destination, |out| {
        let write = |line: &str| {
            out.write_all(line.as_bytes()).map_err(|error| CliError::File {
                action: "write",
                path: path.clone(),
                error,
            })
        };
        experiment::run_answered(options, threads(shared), write, |p| run.report(p))
    })?;
    run.finish();
    Ok(printed(outcome, shared.format.json, shared.format.csv))
}

fn evaluate<E: Experiment>(
    options: &E,
    shared: &EvaluateArguments,
    files: &Files,
) -> Result<String, CliError> {
    let folder = shared.out.as_deref();
    let how = How { threads: threads(shared), folder };
    let run = Run::start("records")?;
    let started = Instant::now();
    let (mut done, mut new) = (0, 0);
    let progress = |progress: boresight_pipeline::Progress| {
        // Those recorded before come all at once.
        new += usize::from(progress.done == done + 1);
        done = progress.done;
        run.report(progress)
    };
    let took = |new: usize| {
        let s = started.elapsed().as_secs_f64();
        remark([format!("{new} records in {s:.1} s on {} threads", how.threads)]);
    };
    if let Some(part) = shared.part {
        let Some(folder) = folder else {
            return Err(CoreError::Empty {
                what: "--out".into(),
                expected: "a folder for the part's records".into(),
            }
            .into());
        };
        let records = experiment::run_part(options, how, part, progress)?;
        run.finish();
        took(new);
        let file = folder.join(part.file_name(E::NAME));
        return Ok(format!("Part {part}: {records} records in {}\n", name(&file)));
    }
    // What a run wrote before is replaced when it goes on; what only bears the same name is not.
    let mut results = BTreeMap::new();
    if let Some(folder) = folder {
        let own = experiment::is_recorded(options, folder);
        results = places(Outcome::names::<E>(), folder, own, files)?;
    }
    let outcome = experiment::run_outcome(options, how, progress)?;
    run.finish();
    took(new);
    if let Some(folder) = folder {
        keep(&outcome.files(), results, folder, files)?;
    }
    Ok(printed(outcome, shared.format.json, shared.format.csv))
}

fn merged(arguments: &EvaluateMergeArguments, files: &Files) -> Result<String, CliError> {
    arguments.sources.iter().try_for_each(|path| files.check_input(path))?;
    let Merged { outcome, records, sources } = merge(&arguments.sources)?;
    sources.iter().for_each(|path| files.note_input(path));
    let mut all = outcome.files();
    all.extend(records.iter().map(|(name, text)| (name.clone(), &**text)));
    let names = all.iter().map(|(name, _)| name.clone());
    let places = places(names, &arguments.out, false, files)?;
    keep(&all, places, &arguments.out, files)?;
    Ok(printed(outcome, arguments.format.json, arguments.format.csv))
}

/// Where files go, by name; `own` says that those there are of the same run.
fn places(
    names: impl IntoIterator<Item = String>,
    folder: &Path,
    own: bool,
    files: &Files,
) -> Result<BTreeMap<String, Destination>, CliError> {
    let place = |name: String| {
        let destination = files.destination_of(&folder.join(&name), own)?;
        Ok((name, destination))
    };
    names.into_iter().map(place).collect()
}

/// Writes tables, numbers and figures.
fn keep(
    all: &[(String, &str)],
    mut places: BTreeMap<String, Destination>,
    folder: &Path,
    files: &Files,
) -> Result<(), CliError> {
    files::make_folder(folder)?;
    for (name, text) in all {
        if let Some(destination) = places.remove(name) {
            files.write(destination, text.as_bytes())?;
        }
    }
    Ok(())
}

fn printed(outcome: Outcome, json: bool, csv: bool) -> String {
    match (json, csv) {
        (true, _) => outcome.json,
        (_, true) => outcome.csv,
        _ => outcome.tables,
    }
}
