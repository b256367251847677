//! Mounting angles of many drives.
//!
//! A plan is a list of [`Job`]s, a drive log each. Running one gives a [`Record`], which depends on the job alone, so that jobs may run
//! anywhere, in any order and more than once. The records of a fleet come to a [`Fleet`]: of each vehicle the angles of its radars over
//! time, and of all the vehicles those that are unlike the others.

pub mod error;
pub mod fleet;
pub mod gather;
pub mod history;
pub mod job;
pub mod lines;
pub mod merge;
pub mod options;
pub mod outlying;
pub mod parallel;
pub mod part;
pub mod pattern;
pub mod plan;
pub mod record;
pub mod report;
pub mod run;
pub mod schema;
pub mod store;
pub mod tables;
mod tails;
pub mod text;
mod vehicle;
pub mod worker;
pub mod written;

pub use error::FleetError;
pub use fleet::Fleet;
pub use history::{History, HistoryOptions, HistoryPoint};
pub use job::Job;
pub use options::FleetOptions;
pub use outlying::{Outlying, Standing, VehicleAngle};
pub use part::Part;
pub use pattern::Pattern;
pub use plan::Jobs;
pub use record::Record;
