//! Drives recorded as MCAP, mostly by ROS 2: the topics with detections of radars, with the car's
//! motion, and with the radars' places. What each topic is used for, and why others are not, is told.
//!
//! Radars are numbered from 1 in the order of their topics' names. Times are those in the headers of
//! messages, or when they were recorded where these have none, or where the clocks of the topics differ;
//! the log begins with the first.

mod choice;
mod clock;
mod cloud;
mod drive;
mod frames;
mod list;
mod motion;
mod quantity;
mod reader;
#[cfg(test)]
mod tests;
mod topic;
mod topics;

use crate::mcap::MAGIC;
pub(super) use choice::no_radar;
pub use reader::{McapDriveReader, read};
pub use topics::{DriveTopic, TopicClock, TopicOptions, TopicUse};

/// Frame of the car where none is named.
pub const BASE_FRAME: &str = "base_link";

/// Whether a file is MCAP, by its beginning.
pub fn is_mcap(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Whether a file's name is that of an MCAP file.
pub fn is_mcap_name(name: &str) -> bool {
    name.to_ascii_lowercase().ends_with(".mcap")
}
