//! Errors of the experiments.

use boresight_aoa::AoaError;
use boresight_cli::error::CliError;
use boresight_core::{Details, Diagnose, InputError};
use boresight_image::ImageError;
use boresight_mounting::MountingError;
use boresight_neural::NeuralError;
use boresight_pipeline::PipelineError;
use boresight_signal::SignalError;
use boresight_simulate::SimulateError;
use boresight_validate::ValidateError;
use thiserror::Error;

/// What can stop an experiment.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// A street cannot be simulated, or no image made of it.
    #[error(transparent)]
    Street(Box<CliError>),
    /// Records, figures, or a run that was stopped.
    #[error(transparent)]
    Run(#[from] ValidateError),
    /// An option is wrong.
    #[error(transparent)]
    Core(#[from] InputError),
    /// A scene cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// Signal processing refused.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// An estimator of angles refused.
    #[error(transparent)]
    Angle(#[from] AoaError),
    /// A network refused.
    #[error(transparent)]
    Network(#[from] NeuralError),
    /// A network that is to run is known by its name only.
    #[error("there is no model of the network {name}")]
    NoModel {
        /// Its name.
        name: String,
    },
    /// A calibration refused.
    #[error(transparent)]
    Calibrate(#[from] MountingError),
    /// Cells cannot be found in a frame.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// An image cannot be made.
    #[error(transparent)]
    Image(#[from] ImageError),
}

impl Diagnose for EvaluateError {
    fn code(&self) -> &'static str {
        match self {
            Self::Street(error) => error.code(),
            Self::Run(error) => error.code(),
            Self::Core(error) => error.code(),
            Self::Simulate(error) => error.code(),
            Self::Signal(error) => error.code(),
            Self::Angle(error) => error.code(),
            Self::Network(error) => error.code(),
            Self::NoModel { .. } => "needs-model",
            Self::Calibrate(error) => error.code(),
            Self::Pipeline(error) => error.code(),
            Self::Image(error) => error.code(),
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Street(error) => error.details(),
            Self::Run(error) => error.details(),
            Self::Core(error) => error.details(),
            Self::Simulate(error) => error.details(),
            Self::Signal(error) => error.details(),
            Self::Angle(error) => error.details(),
            Self::Network(error) => error.details(),
            Self::NoModel { name } => Details::new(name, "a network's model", "its name only"),
            Self::Calibrate(error) => error.details(),
            Self::Pipeline(error) => error.details(),
            Self::Image(error) => error.details(),
        }
    }
}

impl From<CliError> for EvaluateError {
    fn from(error: CliError) -> Self {
        Self::Street(Box::new(error))
    }
}

impl From<EvaluateError> for CliError {
    fn from(error: EvaluateError) -> Self {
        match error {
            EvaluateError::Street(error) => *error,
            EvaluateError::Run(error) => error.into(),
            EvaluateError::Core(error) => error.into(),
            EvaluateError::Simulate(error) => error.into(),
            EvaluateError::Signal(error) => error.into(),
            EvaluateError::Angle(error) => error.into(),
            EvaluateError::Network(error) => error.into(),
            EvaluateError::Calibrate(error) => error.into(),
            EvaluateError::Pipeline(error) => error.into(),
            EvaluateError::Image(error) => error.into(),
            EvaluateError::NoModel { name } => Self::Option {
                option: "--model",
                expected: format!("the model of the network {name}"),
                given: "its name only".into(),
            },
        }
    }
}
