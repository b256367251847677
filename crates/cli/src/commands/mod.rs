//! The commands.

mod board;
mod capture;
mod chain;
mod cube;
pub mod estimate;
pub mod lists;
pub mod simulate;
mod snapshots;
mod targets;
