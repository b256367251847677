//! Errors of the readers and writers.

use boresight_core::{Details, Diagnose, InputError};
use thiserror::Error;

/// Why a file cannot be read or written.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FormatError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// A line of a radar configuration cannot be used.
    #[error("configuration line {line}: {command}: {what} is {given}; expected {expected}")]
    Config {
        /// Line, counted from 1.
        line: usize,
        /// The command on it.
        command: String,
        /// The argument or property that is wrong.
        what: String,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// A field of a radar configuration in JSON cannot be used.
    #[error("configuration: {field} is {given}; expected {expected}")]
    ConfigField {
        /// Path of the field.
        field: String,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// A radar configuration lacks a command it needs.
    #[error("the configuration has no {command} line, which gives {purpose}")]
    MissingCommand {
        /// The command.
        command: &'static str,
        /// What it says.
        purpose: &'static str,
    },
    /// A raw capture is shorter than one frame of its configuration.
    #[error(
        "the capture holds {given} bytes; expected at least {expected}, one frame of its \
         configuration ({layout})"
    )]
    NoWholeFrame {
        /// Bytes of one frame.
        expected: u64,
        /// Bytes given.
        given: u64,
        /// The factors of a frame, in words.
        layout: String,
    },
    /// A raw capture is laid out in a way that is not read.
    #[error("capture layout: {what} is {given}; expected {expected}")]
    Layout {
        /// The property of the layout.
        what: &'static str,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// Files are not the parts of one recording.
    #[error("{what}: {given}; expected {expected}")]
    Parts {
        /// What is wrong.
        what: String,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// Binary data breaks the rules of its format.
    #[error("{format} at byte {offset}: {what} is {given}; expected {expected}")]
    Binary {
        /// Name of the format.
        format: &'static str,
        /// Position in the file, bytes.
        offset: usize,
        /// The field that is wrong.
        what: String,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// A table breaks the rules of its format.
    #[error("CSV line {line}: {what} is {given}; expected {expected}")]
    Table {
        /// Line, counted from 1.
        line: u64,
        /// The column or property that is wrong.
        what: String,
        /// What would have been accepted.
        expected: String,
        /// What was given.
        given: String,
    },
    /// An HDF5 file, or what is stored in it, cannot be used.
    #[error("HDF5: {what}: {given}; expected {expected}")]
    Hdf5 {
        /// The file, dataset or field.
        what: String,
        /// What would have been accepted.
        expected: String,
        /// What was met.
        given: String,
    },
    /// What was to be written was not: a full disk, say.
    #[error("{what} cannot be written: {given}")]
    NotWritten {
        /// The file.
        what: &'static str,
        /// What was met.
        given: String,
    },
    /// A JSON file of a recording cannot be used.
    #[error("{file}: {given}; expected {expected}")]
    Json {
        /// The file.
        file: &'static str,
        /// What would have been accepted.
        expected: &'static str,
        /// What was met.
        given: String,
    },
    /// Compressed data cannot be unpacked.
    #[error("compressed data: {given}; expected a whole gzip file")]
    Compressed {
        /// What the decoder met.
        given: String,
    },
    /// Times of a log run backwards.
    #[error("{place}: time runs backwards: {given} s after {previous} s")]
    TimeBackwards {
        /// Where, as in `line 12`.
        place: String,
        /// The time before, s.
        previous: f64,
        /// The time given, s.
        given: f64,
    },
    /// A topic that was named cannot be used.
    #[error("topic {topic}: {given}; expected {expected}")]
    Topic {
        /// The topic.
        topic: String,
        /// What would have been accepted.
        expected: String,
        /// What it is.
        given: String,
    },
    /// What was given is no drive log.
    #[error("no drive log: {given}; expected {expected}")]
    NoDriveLog {
        /// What was looked for.
        expected: String,
        /// What is there.
        given: String,
    },
}

impl Diagnose for FormatError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Config { .. } | Self::ConfigField { .. } => "config-value",
            Self::MissingCommand { .. } => "config-incomplete",
            Self::NoWholeFrame { .. } => "capture-too-short",
            Self::Layout { .. } => "capture-layout",
            Self::Parts { .. } => "recording-parts",
            Self::Binary { .. } => "malformed-file",
            Self::Table { .. } => "malformed-table",
            Self::Hdf5 { .. } => "malformed-hdf5",
            Self::NotWritten { .. } => "not-written",
            Self::Json { .. } => "malformed-json",
            Self::Compressed { .. } => "malformed-gzip",
            Self::TimeBackwards { .. } => "time-backwards",
            Self::Topic { .. } => "unknown-topic",
            Self::NoDriveLog { .. } => "no-drive-log",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Config { line, command, what, expected, given } => {
                Details::new(format!("line {line}: {command}: {what}"), expected, given)
            }
            Self::ConfigField { field, expected, given } => Details::new(field, expected, given),
            Self::MissingCommand { command, purpose } => {
                Details::new("configuration", format!("a {command} line ({purpose})"), "none")
            }
            Self::NoWholeFrame { expected, given, layout } => Details::new(
                "capture",
                format!("at least {expected} bytes, one frame ({layout})"),
                format!("{given} bytes"),
            ),
            Self::Layout { what, expected, given } => Details::new(*what, expected, given),
            Self::Parts { what, expected, given } => Details::new(what, expected, given),
            Self::Binary { format, offset, what, expected, given } => {
                Details::new(format!("{format} at byte {offset}: {what}"), expected, given)
            }
            Self::Table { line, what, expected, given } => {
                Details::new(format!("line {line}: {what}"), expected, given)
            }
            Self::Hdf5 { what, expected, given } => Details::new(what, expected, given),
            Self::NotWritten { what, given } => {
                Details::new(*what, "a place that takes all of it", given)
            }
            Self::Json { file, expected, given } => Details::new(*file, *expected, given),
            Self::Compressed { given } => {
                Details::new("compressed data", "a whole gzip file", given)
            }
            Self::TimeBackwards { place, previous, given } => Details::new(
                format!("{place}: time"),
                format!("at least {previous} s"),
                format!("{given} s"),
            ),
            Self::Topic { topic, expected, given } => {
                Details::new(format!("topic {topic}"), expected, given)
            }
            Self::NoDriveLog { expected, given } => Details::new("drive log", expected, given),
        }
    }
}
