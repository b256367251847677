//! Point Cloud Data files, version 0.7: the Point Cloud Library's format, in which nuScenes and TruckScenes keep the
//! scans of their radars.
//!
//! A text header names the fields with their sizes and types; the points follow as text (`ascii`), as records
//! (`binary`), or column by column, packed by LZF (`binary_compressed`).

mod header;
mod lzf;
mod read;

pub use header::{PcdData, PcdField, PcdNumber};
pub use read::PointCloud;

#[cfg(test)]
mod tests;
