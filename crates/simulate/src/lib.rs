//! Seeded simulation of what a radar's array receives: snapshots of scenes, and FMCW data cubes;
//! and of drives, as Doppler point clouds.
//! The same seed gives the same bits natively and in wasm.

pub mod cube;
pub mod digest;
pub mod drive;
pub mod error;
pub mod snapshots;
pub mod waveforms;

pub use cube::{CubeOptions, CubeTarget, Field, simulate_cube};
pub use drive::{DriveOptions, Scenario, SimulatedDrive, simulate_drive, simulate_drive_reporting};
pub use error::SimulateError;
pub use snapshots::{
    Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator, Snapshots, Target,
};
pub use waveforms::{waveform_3dcnn_experiment, waveform_3dcnn_simulated, waveform_awr1642};
