//! The commands.

pub mod array;
pub mod augment;
mod board;
pub mod bridge;
pub mod calibrate;
mod capture;
mod chain;
mod cube;
pub mod estimate;
pub mod evaluate;
mod explain;
mod frame;
pub mod image;
pub mod lists;
pub mod log;
pub mod log_statistics;
mod mcap;
mod messages;
pub mod network;
pub mod odometry;
pub mod regions;
pub mod serve;
pub mod simulate;
mod simulated_dataset;
mod simulated_drive;
mod snapshots;
mod track;
