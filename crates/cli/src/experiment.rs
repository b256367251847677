//! Running experiments: validation on drives, and those of the research program.

use crate::destination::Destination;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::output::remark;
use crate::run::Run;
use crate::terminal::name;
use boresight_core::{InputError, Progress};
use boresight_fleet::Part;
use boresight_validate::Outcome;
use boresight_validate::experiment::{self, Experiment, How};
use boresight_validate::merge::Merged;
use clap::{ArgGroup, Args};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// How an experiment runs.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// Number of threads; by default one for each processor core.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// How it is printed.
    #[command(flatten)]
    pub format: ExperimentFormat,
    /// Folder for records, tables and figures. A run that was stopped continues from the records.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Run the K-th of N parts only, and keep its records to be merged with those of the others.
    #[arg(long, value_name = "K/N", requires = "out")]
    pub part: Option<Part>,
}

/// How experiments print.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("experiment-format").args(["json", "csv"]))]
pub struct ExperimentFormat {
    /// Print JSON instead of Markdown tables.
    #[arg(long)]
    pub json: bool,
    /// Print comma-separated values with a header line.
    #[arg(long)]
    pub csv: bool,
}

impl RunArguments {
    /// The number of threads to use.
    pub fn threads(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.unwrap_or_else(cores)
    }
}

impl ExperimentFormat {
    /// What of an outcome is printed.
    pub fn printed(&self, outcome: Outcome) -> String {
        match (self.json, self.csv) {
            (true, _) => outcome.json,
            (_, true) => outcome.csv,
            _ => outcome.tables,
        }
    }
}

/// Runs an experiment, keeps what it comes to where a folder is given, and returns what is printed.
///
/// # Errors
/// Those of the experiment and of the files.
pub fn run<E: Experiment>(
    options: &E,
    arguments: &RunArguments,
    files: &Files,
) -> Result<String, CliError>
where
    CliError: From<E::Error>,
{
    let folder = arguments.out.as_deref();
    let how = How { threads: arguments.threads(), folder };
    let run = Run::start("records")?;
    let started = Instant::now();
    let (mut done, mut new) = (0, 0);
    let progress = |progress: Progress| {
        // Those recorded before come all at once.
        new += usize::from(progress.done == done + 1);
        done = progress.done;
        run.report(progress)
    };
    let took = |new: usize| {
        let s = started.elapsed().as_secs_f64();
        remark([format!("{new} records in {s:.1} s on {} threads", how.threads)]);
    };
    if let Some(part) = arguments.part {
        let Some(folder) = folder else {
            return Err(InputError::Empty {
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
    Ok(arguments.format.printed(outcome))
}

/// Keeps what parts come to that were put together, and returns what is printed.
///
/// # Errors
/// Those of the files.
pub fn keep_merged(
    merged: Merged,
    out: &Path,
    format: &ExperimentFormat,
    files: &Files,
) -> Result<String, CliError> {
    let Merged { outcome, records, sources } = merged;
    sources.iter().for_each(|path| files.note_input(path));
    let mut all = outcome.files();
    all.extend(records.iter().map(|(name, text)| (name.clone(), &**text)));
    let names = all.iter().map(|(name, _)| name.clone());
    let places = places(names, out, false, files)?;
    keep(&all, places, out, files)?;
    Ok(format.printed(outcome))
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
