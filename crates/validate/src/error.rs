//! Errors of validation.

use boresight_core::{Details, Diagnose, InputError};
use boresight_mounting::MountingError;
use std::path::PathBuf;
use thiserror::Error;

/// What can stop a run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ValidateError {
    /// An option is wrong.
    #[error(transparent)]
    Core(#[from] InputError),
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
    Calibrate(#[from] MountingError),
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
    /// Stopped by the caller.
    #[error("stopped after {done} of {total} scenes")]
    Cancelled {
        /// Scenes done.
        done: usize,
        /// Scenes in all.
        total: usize,
    },
}

impl Diagnose for ValidateError {
    fn code(&self) -> &'static str {
        match self {
            Self::Core(error) => error.code(),
            Self::Drive { .. } => "unreadable-drive",
            Self::Calibrate(error) => error.code(),
            Self::File { .. } => "file",
            Self::OtherRun { .. } => "other-run",
            Self::Record { .. } | Self::Scene { .. } => "malformed-file",
            Self::Conflict { .. } => "conflict",
            Self::Incomplete { .. } => "incomplete",
            Self::Cancelled { .. } => "cancelled",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Core(error) => error.details(),
            Self::Drive { name, source } => {
                Details::new(name, "a drive that can be read", source.to_string())
            }
            Self::Calibrate(error) => error.details(),
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
            Self::Cancelled { done, total } => {
                Details::new("scenes", total.to_string(), done.to_string())
            }
        }
    }
}
