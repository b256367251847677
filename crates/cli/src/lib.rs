//! The command line: angles from radar captures and snapshots, mounting angles, and simulation.
//!
//! Angles are in degrees here and in radians behind it. The program is [`run()`]; the modules that are public are what
//! another program with the same rules for files, flags and errors needs.
//!
//! # Example
//!
//! ```text
//! boresight estimate cell.npy --array lrr48 --method iaa
//! boresight calibrate recordings/delphi --min-speed 3
//! ```

mod arguments;
mod array;
mod commands;
pub mod destination;
mod drive;
pub mod error;
pub mod experiment;
pub mod files;
pub mod flags;
pub mod network;
mod numbers;
pub mod output;
mod pairs;
mod picture;
pub mod run;
pub mod street;
pub mod terminal;

use crate::arguments::{Cli, Command};
use crate::error::CliError;
use crate::files::Files;
use clap::Parser;
use std::process::ExitCode;

/// The program `boresight`.
pub fn run() -> ExitCode {
    main(|cli: Cli, files| dispatch(cli.command, files), |cli| cli.force)
}

/// Parses the command line, runs the command and prints what it returns or its error. `force` says whether files that are
/// there may be replaced.
pub fn main<P: Parser>(
    run: impl FnOnce(P, &Files) -> Result<String, CliError>,
    force: impl FnOnce(&P) -> bool,
) -> ExitCode {
    let arguments = match P::try_parse() {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() => {
            terminal::report(&error.render().to_string());
            return ExitCode::from(2);
        }
        // Help and version.
        Err(error) => error.exit(),
    };
    let files = Files::new(force(&arguments));
    match run(arguments, &files).and_then(|text| print(&text, &files)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::report(&error.report());
            error.exit_code()
        }
    }
}

fn dispatch(command: Command, files: &Files) -> Result<String, CliError> {
    match command {
        Command::Estimate(arguments) => commands::estimate::run(&arguments, files),
        Command::Simulate { what } => commands::simulate::run(&what, files),
        Command::Augment(arguments) => commands::augment::run(&arguments, files),
        Command::Calibrate(arguments) => commands::calibrate::run(&arguments, files),
        Command::Fleet { what } => commands::fleet::run(&what, files),
        Command::Validate(arguments) => commands::validate::run(&arguments, files),
        Command::Image { what } => commands::image::run(&what, files),
        Command::Log(arguments) => commands::log::run(&arguments, files),
        Command::Serve(arguments) => commands::serve::run(&arguments, files),
        Command::Odometry(arguments) => commands::odometry::run(&arguments, files),
        Command::Bridge(arguments) => commands::bridge::run(&arguments, files),
        Command::Methods(format) => commands::lists::methods(format.json),
        Command::Network(arguments) => commands::network::run(&arguments, files),
        Command::Regions(arguments) => commands::regions::run(&arguments, files),
        Command::Array { what } => commands::array::run(&what, files),
        Command::Arrays(format) => commands::lists::arrays(format.json),
    }
}

/// Writes to the standard output, or where data went there to the standard error. A reader that has seen enough is no
/// error.
fn print(text: &str, files: &Files) -> Result<(), CliError> {
    if files.standard_output_taken() {
        // The data is what was asked for.
        terminal::report(text);
        return Ok(());
    }
    match terminal::print(text) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(CliError::File { action: "write", path: "the standard output".into(), error })
        }
        _ => Ok(()),
    }
}
