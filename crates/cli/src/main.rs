//! `boresight`: angles from radar captures and snapshots, and simulation, on the command line.
//!
//! Angles are in degrees here and in radians behind it.
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
mod destination;
mod drive;
mod error;
mod files;
mod flags;
mod network;
mod numbers;
mod output;
mod pairs;
mod picture;
mod run;
mod terminal;

use arguments::{Cli, Command};
use clap::Parser;
use error::CliError;
use files::Files;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) if error.use_stderr() => {
            terminal::report(&error.render().to_string());
            return ExitCode::from(2);
        }
        // Help and version.
        Err(error) => error.exit(),
    };
    let files = Files::new(cli.force);
    let result = match cli.command {
        Command::Estimate(arguments) => commands::estimate::run(&arguments, &files),
        Command::Simulate { what } => commands::simulate::run(&what, &files),
        Command::Augment(arguments) => commands::augment::run(&arguments, &files),
        Command::Calibrate(arguments) => commands::calibrate::run(&arguments, &files),
        Command::Fleet { what } => commands::fleet::run(&what, &files),
        Command::Evaluate { what } => commands::evaluate::run(&what, &files),
        Command::Image { what } => commands::image::run(&what, &files),
        Command::Log(arguments) => commands::log::run(&arguments, &files),
        Command::Serve(arguments) => commands::serve::run(&arguments, &files),
        Command::Odometry(arguments) => commands::odometry::run(&arguments, &files),
        Command::Bridge(arguments) => commands::bridge::run(&arguments, &files),
        Command::Methods(format) => commands::lists::methods(format.json),
        Command::Network(arguments) => commands::network::run(&arguments, &files),
        Command::Regions(arguments) => commands::regions::run(&arguments, &files),
        Command::Array { what } => commands::array::run(&what, &files),
        Command::Arrays(format) => commands::lists::arrays(format.json),
    };
    match result.and_then(|text| print(&text, &files)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::report(&error.report());
            error.exit_code()
        }
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
