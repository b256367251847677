//! The program `boresight`.

use std::process::ExitCode;

fn main() -> ExitCode {
    boresight_cli::run()
}
