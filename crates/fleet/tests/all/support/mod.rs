//! Drives and fleets that tests make.

pub mod drive;
pub mod fleet;
