//! The program `boresight-experiments`.

mod program;

use program::arguments::Program;
use program::commands;
use std::process::ExitCode;

fn main() -> ExitCode {
    boresight_cli::main(|program: Program, files| commands::run(&program.what, files), |p| p.force)
}
