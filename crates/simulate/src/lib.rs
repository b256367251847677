//! Seeded simulation of what a radar's array receives: snapshots of scenes, and FMCW data cubes;
//! a street around a car with four radars, and drives as Doppler point clouds.
//! The same seed gives the same bits natively and in wasm.

pub mod cube;
pub mod digest;
pub mod drive;
pub mod error;
pub mod snapshots;
pub mod street;
pub mod waveforms;

pub use cube::{CubeOptions, CubeTarget, Field, simulate_cube};
pub use drive::{DriveOptions, Scenario, SimulatedDrive, simulate_drive, simulate_drive_reporting};
pub use error::SimulateError;
pub use snapshots::{
    Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator, Snapshots, Target,
};
pub use street::{Street, StreetOptions, StreetRadar, VisibleTarget};
pub use waveforms::{
    waveform_3dcnn_experiment, waveform_3dcnn_simulated, waveform_awr1642, waveform_corner,
};
