//! `boresight fleet`: the mounting angles of many drives, on many machines.

mod log;
mod memory;
mod merge;
mod part;
mod plan;
mod run;
mod worker;

use crate::arguments::FleetCommand;
use crate::error::CliError;
use crate::files::Files;
use boresight_fleet::FleetError;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Plans, runs or merges.
pub fn run(what: &FleetCommand, files: &Files) -> Result<String, CliError> {
    match what {
        FleetCommand::Plan(arguments) => plan::run(arguments, files),
        FleetCommand::Run(arguments) => run::run(arguments, files),
        FleetCommand::Worker(arguments) => worker::run(arguments),
        FleetCommand::Merge(arguments) => merge::run(arguments, files),
    }
}

/// As many threads as asked for, or as there are cores.
fn threads(asked: Option<usize>) -> usize {
    asked.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into))
}

/// Lines of a file, or of the standard input for `-`.
fn lines_of(path: &Path, files: &Files) -> Result<Box<dyn BufRead + Send>, CliError> {
    if path == Path::new("-") {
        return Ok(Box::new(BufReader::new(std::io::stdin())));
    }
    files.check_input(path)?;
    let file = File::open(path).map_err(|error| FleetError::file("read", path, error))?;
    Ok(Box::new(BufReader::with_capacity(1 << 18, file)))
}
