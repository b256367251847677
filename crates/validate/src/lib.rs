//! How right mounting angles are: every method on drives whose true angles are known, on whole drives and on pieces of them,
//! with errors, the share within the stated standard deviations, tables and figures.
//!
//! A run is a numbered list of scenes. A scene depends on the options and its number only, so a run can be stopped and
//! continued, spread over threads, or split by scene numbers over machines. The experiments on simulated scenes in
//! `research/experiments` run on the same [`experiment`] machinery.

pub mod accepted;
pub mod candidates;
pub mod condition;
pub mod drives;
pub mod drives_report;
pub mod error;
pub mod experiment;
pub mod figures;
pub mod merge;
pub mod outcome;
pub mod plot;
pub mod statistics;
pub mod sweep;
pub mod table;
pub mod tables;
pub mod whole;

pub use drives::DrivesExperiment;
pub use drives_report::DrivesReport;
pub use error::ValidateError;
pub use experiment::Experiment;
pub use outcome::Outcome;
