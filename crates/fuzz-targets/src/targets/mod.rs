//! One module per target, each with a function that panics if an input breaks what the target promises.

pub mod cfg;
pub mod clouds;
pub mod csv;
pub mod dca1000;
pub mod drive_csv;
pub mod drive_h5;
pub mod drive_json;
#[cfg(feature = "fleet")]
pub mod fleet_plan;
#[cfg(feature = "fleet")]
pub mod fleet_records;
pub mod hdf5;
pub mod mcap;
pub mod motion_weights;
#[cfg(feature = "network")]
pub mod network;
pub mod npy;
pub mod options;
pub mod pcd;
pub mod snapshot;
pub mod uart;

/// Name and body of a target.
pub type Target = (&'static str, fn(&[u8]));

/// Every target.
pub const TARGETS: &[Target] = &[
    ("cfg", cfg::check),
    ("clouds", clouds::check),
    ("csv", csv::check),
    ("dca1000", dca1000::check),
    ("drive_csv", drive_csv::check),
    ("drive_h5", drive_h5::check),
    ("drive_json", drive_json::check),
    #[cfg(feature = "fleet")]
    ("fleet_plan", fleet_plan::check),
    #[cfg(feature = "fleet")]
    ("fleet_records", fleet_records::check),
    ("hdf5", hdf5::check),
    ("mcap", mcap::check),
    ("motion_weights", motion_weights::check),
    #[cfg(feature = "network")]
    ("network", network::check),
    ("npy", npy::check),
    ("options", options::check),
    ("pcd", pcd::check),
    ("snapshot", snapshot::check),
    ("uart", uart::check),
];
