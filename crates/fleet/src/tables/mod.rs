//! A fleet as tables in Parquet: one of drives, one of radars. The same fleet gives the same bytes.

mod column;
mod drives;
mod radars;

pub use column::Column;
pub use drives::{DriveRow, drive_columns, write_drives};
pub use radars::{RadarRow, radar_columns, write_radars};
