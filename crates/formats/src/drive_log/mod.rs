//! Drives as car makers, data sets and simulators store them, read into one
//! [`DriveLog`](boresight_core::DriveLog): which format it is is found from the
//! files' contents, and every row that is left out is counted.

pub mod clouds;
pub mod delphi;
pub mod mcap;
pub(crate) mod motion;
mod open;
mod report;
pub(crate) mod scans;
pub mod table;
mod text;

pub use mcap::{DriveTopic, McapDriveReader, TopicOptions, is_mcap, is_mcap_name};
pub use open::{
    DriveFormat, DriveRead, in_file, is_hdf5, is_table, no_drive_log, open, open_owned,
};
pub use report::{DropReason, MountingSource, ReadReport};

#[cfg(test)]
mod tests;
