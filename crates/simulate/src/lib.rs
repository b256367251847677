//! Seeded simulation of what a radar's array receives: snapshots of scenes, and FMCW data cubes;
//! a street around a car with five radars, and drives as Doppler point clouds.
//! The same seed gives the same bits natively and in wasm.
//!
//! # Example
//!
//! ```
//! use boresight_core::{Array, Direction};
//! use boresight_simulate::{Fluctuation, Scene, SnapshotOptions, SnapshotSimulator, Target};
//!
//! let direction = Direction::azimuth(10_f64.to_radians());
//! let options = SnapshotOptions {
//!     scene: Scene::Given(vec![Target { direction: direction.into(), ..Target::default() }]),
//!     snr_db: 20.0,
//!     snapshots: 4,
//!     fluctuation: Fluctuation::ComplexNormal,
//!     seed: 7,
//!     ..SnapshotOptions::default()
//! };
//! let simulator = SnapshotSimulator::new(&Array::ula(8)?, &options)?;
//! let (snapshots, truth) = simulator.scene(3)?;
//! assert_eq!(snapshots.dim(), (8, 4));
//! assert_eq!(*truth[0].direction, direction);
//!
//! // A scene is told by the seed and its number, whatever was drawn before.
//! assert_eq!(simulator.scenes(2, 3)?.values.index_axis(ndarray::Axis(0), 1), snapshots);
//! # Ok::<(), boresight_simulate::SimulateError>(())
//! ```

mod cost;
pub mod cube;
pub mod digest;
pub mod drive;
pub mod error;
pub mod fluctuation;
pub mod ground;
pub mod interference;
mod paths;
mod phase_noise;
pub mod request;
pub mod snapshots;
pub mod street;
pub mod waveforms;

pub use cube::{CubeColumns, CubeOptions, CubeTarget, Field, simulate_cube};
pub use drive::{DriveOptions, Scenario, SimulatedDrive, simulate_drive, simulate_drive_reporting};
pub use error::SimulateError;
pub use fluctuation::SwerlingModel;
pub use ground::Ground;
pub use interference::Interferer;
pub use request::{CubeRequest, SnapshotRequest};
pub use snapshots::{
    Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator, Snapshots, Target,
};
pub use street::{Street, StreetOptions, StreetRadar, VisibleTarget};
pub use waveforms::{
    waveform_3dcnn_experiment, waveform_3dcnn_simulated, waveform_awr1642, waveform_corner,
    waveform_preset, waveform_presets,
};
