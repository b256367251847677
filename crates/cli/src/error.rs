//! Errors of the command line, and the one place that prints them.

use crate::terminal::one_line;
use boresight_aoa::AoaError;
use boresight_array_calibration::ArrayCalibrationError;
use boresight_core::{Details, Diagnose, InputError};
use boresight_fleet::FleetError;
use boresight_formats::FormatError;
use boresight_image::ImageError;
use boresight_live::LiveError;
use boresight_mounting::MountingError;
use boresight_mounting::network::NetworkError;
use boresight_neural::NeuralError;
use boresight_pipeline::PipelineError;
use boresight_signal::SignalError;
use boresight_simulate::SimulateError;
use boresight_validate::ValidateError;
use std::path::PathBuf;
use std::process::ExitCode;
use thiserror::Error;

/// Exit code of a run stopped by Ctrl-C: 128 and the signal's number.
const INTERRUPTED: u8 = 130;

/// What can go wrong.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CliError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// A file breaks the rules of its format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// Signal processing refused.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// Angle estimation refused.
    #[error(transparent)]
    Angle(#[from] AoaError),
    /// An array cannot be calibrated.
    #[error(transparent)]
    ArrayCalibration(#[from] ArrayCalibrationError),
    /// Calibration refused.
    #[error(transparent)]
    Calibrate(#[from] MountingError),
    /// A server cannot run.
    #[error(transparent)]
    Live(#[from] LiveError),
    /// A plan or the records of a fleet refused, or a run was stopped.
    #[error(transparent)]
    Fleet(#[from] FleetError),
    /// A log's files are not those that were planned.
    #[error("{} is not as it was planned", path.display())]
    Changed {
        /// The log.
        path: PathBuf,
        /// What was planned.
        expected: String,
    },
    /// An image cannot be made.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The chain refused, or was stopped.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// Simulation refused.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// Validation or an experiment refused, or was stopped.
    #[error(transparent)]
    Validate(#[from] ValidateError),
    /// A network refused.
    #[error(transparent)]
    Neural(#[from] NeuralError),
    /// A model cannot be loaded, or not for this use.
    #[error("{}: {error}", path.display())]
    Model {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: Box<NeuralError>,
    },
    /// A network of motion cannot be loaded.
    #[error("{}: {error}", path.display())]
    Network {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: NetworkError,
    },
    /// The system refused a file.
    #[error("cannot {action} {}: {error}", path.display())]
    File {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// A file that would be replaced.
    #[error("{} is there already", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A file would be written that was read.
    #[error("{} is read by this command", path.display())]
    OwnInput {
        /// The file.
        path: PathBuf,
    },
    /// Two outputs would go to one file.
    #[error("{} would be written twice", path.display())]
    SameOutput {
        /// The file.
        path: PathBuf,
    },
    /// A JSON file breaks its rules.
    #[error("{}: {error}; expected {expected}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What would have been accepted.
        expected: &'static str,
        /// What the reader says.
        error: serde_json::Error,
    },
    /// An option that the file needs is not there, or does not go with it.
    #[error("{option} is {given}; expected {expected}")]
    Option {
        /// The option.
        option: &'static str,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// The handler of Ctrl-C cannot be set.
    #[error("cannot watch for Ctrl-C: {0}")]
    Interrupts(#[from] ctrlc::Error),
}

impl CliError {
    /// The code the process ends with: 2 for a wrong use of options, as for errors of the option
    /// parser; 130 for Ctrl-C; 1 otherwise.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Pipeline(PipelineError::Cancelled { .. })
            | Self::Validate(ValidateError::Cancelled { .. })
            | Self::Fleet(FleetError::Cancelled { .. })
            | Self::Simulate(SimulateError::Cancelled { .. }) => ExitCode::from(INTERRUPTED),
            Self::Option { .. } | Self::OwnInput { .. } | Self::SameOutput { .. } => {
                ExitCode::from(2)
            }
            _ => ExitCode::FAILURE,
        }
    }

    /// Message, and what was expected and given, in lines.
    pub fn report(&self) -> String {
        let details = self.details();
        format!(
            "error: {}\n  what:     {}\n  expected: {}\n  given:    {}\n  code:     {}\n",
            one_line(&self.to_string()),
            one_line(&details.what),
            one_line(&details.expected),
            one_line(&details.given),
            self.code()
        )
    }

    fn inner(&self) -> Option<&dyn Diagnose> {
        Some(match self {
            Self::Argument(error) => error,
            Self::Format(error) => error,
            Self::Signal(error) => error,
            Self::Angle(error) => error,
            Self::ArrayCalibration(error) => error,
            Self::Calibrate(error) => error,
            Self::Live(error) => error,
            Self::Fleet(error) => error,
            Self::Image(error) => error,
            Self::Pipeline(error) => error,
            Self::Simulate(error) => error,
            Self::Validate(error) => error,
            Self::Neural(error) => error,
            Self::Model { error, .. } => error.as_ref(),
            Self::Network { error, .. } => error,
            _ => return None,
        })
    }
}

impl Diagnose for CliError {
    fn code(&self) -> &'static str {
        match self {
            Self::File { .. } => "file",
            Self::Exists { .. } => "exists",
            Self::Changed { .. } => "changed",
            Self::OwnInput { .. } => "own-input",
            Self::SameOutput { .. } => "same-output",
            Self::Json { .. } => "malformed-file",
            Self::Option { .. } => "option",
            Self::Interrupts(_) => "interrupts",
            _ => self.inner().map_or("unknown", Diagnose::code),
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::File { action, path, error } => Details::new(
                path.display().to_string(),
                format!(
                    "a file that can be {}",
                    if *action == "read" { "read" } else { "written" }
                ),
                error.to_string(),
            ),
            Self::Exists { path } => Details::new(
                path.display().to_string(),
                "a file that is not there yet, or --force",
                "a file that is there",
            ),
            Self::Changed { path, expected } => Details::new(
                path.display().to_string(),
                expected,
                "other files, or other bytes in them",
            ),
            Self::OwnInput { path } => Details::new(
                path.display().to_string(),
                "another file than those that are read",
                "a file that is read",
            ),
            Self::SameOutput { path } => Details::new(
                path.display().to_string(),
                "a file for each output",
                "the file of another output",
            ),
            Self::Json { path, expected, error } => {
                Details::new(path.display().to_string(), *expected, error.to_string())
            }
            Self::Option { option, expected, given } => Details::new(*option, expected, given),
            Self::Interrupts(error) => {
                Details::new("Ctrl-C", "a handler that can be set", error.to_string())
            }
            _ => self.inner().map_or_else(|| Details::new("", "", ""), Diagnose::details),
        }
    }
}
