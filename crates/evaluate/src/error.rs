//! Errors of the experiments.

use boresight_aoa::AoaError;
use boresight_calibrate::CalibrateError;
use boresight_core::{CoreError, Details, Diagnose};
use boresight_image::ImageError;
use boresight_neural::NeuralError;
use boresight_pipeline::PipelineError;
use boresight_signal::SignalError;
use boresight_simulate::SimulateError;
use std::path::PathBuf;
use thiserror::Error;

/// What can stop an experiment.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// An option is wrong.
    #[error(transparent)]
    Core(#[from] CoreError),
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
    /// A drive cannot be read.
    #[error("drive {name}: {source}")]
    Drive {
        /// Its name.
        name: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A calibration refused.
    #[error(transparent)]
    Calibrate(#[from] CalibrateError),
    /// Cells cannot be found in a frame.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// An image cannot be made.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The system refused a file of the output folder.
    #[error("cannot {action} {}: {error}", path.display())]
    File {
        /// What was tried.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// The folder holds records of another experiment, version or seed.
    #[error("{} holds records of another run: {given}", path.display())]
    OtherRun {
        /// The file.
        path: PathBuf,
        /// What this run's records are headed by.
        expected: String,
        /// What was found.
        given: String,
    },
    /// A line of the records cannot be read.
    #[error("{}, line {line}: {error}", path.display())]
    Record {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What the reader says.
        error: serde_json::Error,
    },
    /// A record is not one of this experiment.
    #[error("{}, scene {scene}: {error}", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// Number of the scene.
        scene: u64,
        /// What the reader says.
        error: serde_json::Error,
    },
    /// Two files hold different records of one scene.
    #[error("{} and {} hold different records of scene {scene}", path.display(), other.display())]
    Conflict {
        /// Number of the scene.
        scene: u64,
        /// A file.
        path: PathBuf,
        /// Another.
        other: PathBuf,
    },
    /// Not all scenes of a run are there.
    #[error("{missing} of {total} scenes are missing, the first of them number {first}")]
    Incomplete {
        /// Scenes missing.
        missing: usize,
        /// The first of them.
        first: u64,
        /// Scenes in all.
        total: u64,
    },
    /// A figure cannot be drawn.
    #[error("the figure cannot be drawn: {0}")]
    Figure(String),
    /// Stopped by the caller.
    #[error("stopped after {done} of {total} scenes")]
    Cancelled {
        /// Scenes done.
        done: usize,
        /// Scenes in all.
        total: usize,
    },
}

impl Diagnose for EvaluateError {
    fn code(&self) -> &'static str {
        match self {
            Self::Core(error) => error.code(),
            Self::Simulate(error) => error.code(),
            Self::Signal(error) => error.code(),
            Self::Angle(error) => error.code(),
            Self::Network(error) => error.code(),
            Self::NoModel { .. } => "needs-model",
            Self::Drive { .. } => "unreadable-drive",
            Self::Calibrate(error) => error.code(),
            Self::Pipeline(error) => error.code(),
            Self::Image(error) => error.code(),
            Self::File { .. } => "file",
            Self::OtherRun { .. } => "other-run",
            Self::Record { .. } | Self::Scene { .. } => "malformed-file",
            Self::Conflict { .. } => "conflict",
            Self::Incomplete { .. } => "incomplete",
            Self::Figure(_) => "figure",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Core(error) => error.details(),
            Self::Simulate(error) => error.details(),
            Self::Signal(error) => error.details(),
            Self::Angle(error) => error.details(),
            Self::Network(error) => error.details(),
            Self::Drive { name, source } => {
                Details::new(name, "a drive that can be read", source.to_string())
            }
            Self::NoModel { name } => Details::new(name, "a network's model", "its name only"),
            Self::Calibrate(error) => error.details(),
            Self::Pipeline(error) => error.details(),
            Self::Image(error) => error.details(),
            Self::File { action, path, error } => Details::new(
                path.display().to_string(),
                format!(
                    "a path that can be {}",
                    if *action == "read" { "read" } else { "written" }
                ),
                error.to_string(),
            ),
            Self::OtherRun { path, expected, given } => {
                Details::new(path.display().to_string(), expected.clone(), given.clone())
            }
            Self::Record { path, line, error } => Details::new(
                format!("{}, line {line}", path.display()),
                "a record of a scene",
                error.to_string(),
            ),
            Self::Scene { path, scene, error } => Details::new(
                format!("{}, scene {scene}", path.display()),
                "a record of this experiment",
                error.to_string(),
            ),
            Self::Conflict { scene, path, other } => Details::new(
                format!("scene {scene}"),
                format!("the record in {}", other.display()),
                format!("another one in {}", path.display()),
            ),
            Self::Incomplete { missing, total, .. } => {
                Details::new("scenes", total.to_string(), (total - *missing as u64).to_string())
            }
            Self::Figure(error) => Details::new("figure", "one that can be drawn", error.clone()),
            Self::Cancelled { done, total } => {
                Details::new("scenes", total.to_string(), done.to_string())
            }
        }
    }
}
