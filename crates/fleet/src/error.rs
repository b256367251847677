//! Errors of fleets.

use crate::schema::SCHEMA;
use boresight_core::{Details, Diagnose, InputError};
use boresight_mounting::MountingError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// What can be wrong with plans, records and what they come to.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FleetError {
    /// An argument is wrong.
    #[error(transparent)]
    Core(#[from] InputError),
    /// The equations of drives do not go together.
    #[error(transparent)]
    Calibrate(#[from] MountingError),
    /// A pattern is none, or a path does not follow it.
    #[error("{what} is {given}; expected {expected}")]
    Name {
        /// What was wrong.
        what: &'static str,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
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
    /// The disk has no room for another record. Those written before are whole.
    #[error("no room to write {}", path.display())]
    DiskFull {
        /// The file.
        path: PathBuf,
    },
    /// Another run writes to the same file.
    #[error("another run writes to {}", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// A worker process does not start. This is no fault of a log.
    #[error("a worker process did not start: {given}")]
    Worker {
        /// Its answer or its end.
        given: String,
    },
    /// A file would be replaced that holds no records of a fleet.
    #[error("{} holds no records of a fleet", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// A line is of a newer release, in a format that this release cannot read.
    #[error("{}, line {line}: the format has version {found}; this release reads up to {SCHEMA}", path.display())]
    Newer {
        /// The plan or the file of records.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Version of the line.
        found: u32,
    },
    /// A line of a plan is none.
    #[error("{}, line {line}: {error}", path.display())]
    Plan {
        /// The plan.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What the reader says.
        error: serde_json::Error,
    },
    /// The key of a job is not that of its files and settings.
    #[error("{}, line {line}: the job's key is not that of its files and settings", path.display())]
    EditedPlan {
        /// The plan.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The key that they have.
        expected: String,
        /// The key in the line.
        given: String,
    },
    /// A line of records is none.
    #[error("{}, line {line}: {error}", path.display())]
    Record {
        /// The file of records.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What the reader says.
        error: String,
    },
    /// One log has two records that differ.
    #[error("two records of {path} differ: {what}")]
    Conflict {
        /// Where the log was.
        path: String,
        /// In what.
        what: &'static str,
        /// What one says.
        expected: String,
        /// What the other says.
        given: String,
    },
    /// Not all logs of the plan have a record.
    #[error("{missing} of {planned} logs have no record, {first} among them")]
    Incomplete {
        /// Logs without one.
        missing: u64,
        /// Logs of the plan.
        planned: u64,
        /// Where one of them is.
        first: String,
    },
    /// Stopped by the caller.
    #[error("stopped after {done} logs")]
    Cancelled {
        /// Logs with a record.
        done: u64,
    },
    /// A table cannot be written.
    #[error("the table cannot be written: {0}")]
    Table(String),
}

impl FleetError {
    /// Of what the system says of a file.
    pub fn file(action: &'static str, path: &Path, error: std::io::Error) -> Self {
        let path = path.to_owned();
        match error.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
                Self::DiskFull { path }
            }
            ErrorKind::WouldBlock => Self::Busy { path },
            _ => Self::File { action, path, error },
        }
    }
}

impl Diagnose for FleetError {
    fn code(&self) -> &'static str {
        match self {
            Self::Core(error) => error.code(),
            Self::Calibrate(error) => error.code(),
            Self::Name { .. } => "name",
            Self::File { .. } => "file",
            Self::DiskFull { .. } => "disk-full",
            Self::Busy { .. } => "busy",
            Self::Worker { .. } => "worker",
            Self::Foreign { .. } => "exists",
            Self::Newer { .. } => "unsupported-version",
            Self::Plan { .. } => "malformed-plan",
            Self::EditedPlan { .. } => "edited-plan",
            Self::Record { .. } => "malformed-record",
            Self::Conflict { .. } => "conflict",
            Self::Incomplete { .. } => "incomplete",
            Self::Cancelled { .. } => "cancelled",
            Self::Table(_) => "table",
        }
    }

    fn details(&self) -> Details {
        let line = |path: &Path, line: &u64| format!("{}, line {line}", path.display());
        match self {
            Self::Core(error) => error.details(),
            Self::Calibrate(error) => error.details(),
            Self::Name { what, expected, given } => {
                Details::new(*what, expected.clone(), given.clone())
            }
            Self::File { action, path, error } => Details::new(
                path.display().to_string(),
                format!(
                    "a file that can be {}",
                    if *action == "read" { "read" } else { "written" }
                ),
                error.to_string(),
            ),
            Self::DiskFull { path } => Details::new(
                path.display().to_string(),
                "room for one more record; the same command then goes on",
                "a full disk, or a quota used up",
            ),
            Self::Busy { path } => Details::new(
                path.display().to_string(),
                "one run a part and folder at a time",
                "a file that another run has open",
            ),
            Self::Worker { given } => Details::new(
                "a worker process",
                "a process that accepts jobs, and a memory limit that lets it start",
                given.clone(),
            ),
            Self::Foreign { path } => Details::new(
                path.display().to_string(),
                "a file of records, an empty file, no file, or --force",
                "a file with other content",
            ),
            Self::Newer { path, line: at, found } => Details::new(
                line(path, at),
                format!("format version {SCHEMA} or earlier, or a newer release of Boresight"),
                format!("format version {found}"),
            ),
            Self::Plan { path, line: at, error } => {
                Details::new(line(path, at), "a job of `fleet plan`", error.to_string())
            }
            Self::EditedPlan { path, line: at, expected, given } => {
                Details::new(line(path, at), format!("key {expected}"), given.clone())
            }
            Self::Record { path, line: at, error } => {
                Details::new(line(path, at), "a record of `fleet run`", error.clone())
            }
            Self::Conflict { path, expected, given, .. } => {
                Details::new(path.clone(), expected.clone(), given.clone())
            }
            Self::Incomplete { missing, planned, first } => Details::new(
                first.clone(),
                format!("records of all {planned} logs, or --partial"),
                format!("{} records", planned - missing),
            ),
            Self::Cancelled { done } => {
                Details::new("run", "a run that is not stopped", format!("{done} logs done"))
            }
            Self::Table(message) => Details::new("table", "one that can be written", message),
        }
    }
}
