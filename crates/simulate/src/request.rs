//! What users ask to be simulated: the options of a simulation, how often it runs, and what is wrong with the array.

use crate::cube::{CubeOptions, CubeTarget, Field, simulate_cube};
use crate::error::SimulateError;
use crate::snapshots::{Scene, SnapshotOptions, SnapshotSimulator, Snapshots};
use boresight_core::imperfections::ImperfectionOptions;
use boresight_core::{Array, Complex32, Waveform};
use boresight_options::{Described, Flat};
use ndarray::Array5;
use serde::{Deserialize, Serialize};

/// Snapshots of scenes, whose array and targets are given beside it.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct SnapshotRequest {
    /// What is the same for all scenes.
    pub options: Flat<SnapshotOptions>,
    /// Scenes.
    #[option(default = 1)]
    pub scenes: usize,
    /// Number of the first scene, to split a sweep.
    pub first_scene: usize,
    /// Errors of the array's elements.
    pub imperfections: ImperfectionOptions,
}

impl SnapshotRequest {
    /// Simulates the scenes.
    ///
    /// # Errors
    /// As [`SnapshotSimulator::new`] and [`SnapshotSimulator::scenes`].
    pub fn simulate(&self, array: &Array, scene: Scene) -> Result<Snapshots, SimulateError> {
        let imperfections = self.imperfections.draw(array, self.options.seed)?;
        let options = SnapshotOptions { scene, imperfections, ..self.options.0.clone() };
        SnapshotSimulator::new(array, &options)?.scenes(self.first_scene as u64, self.scenes)
    }
}

/// A data cube, whose waveform, array and targets are given beside it.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct CubeRequest {
    /// What is simulated.
    pub options: Flat<CubeOptions>,
    /// Spherical wavefronts instead of plane ones.
    pub near_field: bool,
    /// Errors of the array's elements.
    pub imperfections: ImperfectionOptions,
}

impl CubeRequest {
    /// Simulates frames x loops x chirps of a loop x receivers x samples.
    ///
    /// # Errors
    /// As [`simulate_cube`].
    pub fn simulate(
        &self,
        waveform: &Waveform,
        array: &Array,
        targets: &[CubeTarget],
    ) -> Result<Array5<Complex32>, SimulateError> {
        let field = if self.near_field { Field::Near } else { Field::Far };
        let imperfections = self.imperfections.draw(array, self.options.seed)?;
        let options = CubeOptions { field, imperfections, ..self.options.0.clone() };
        simulate_cube(waveform, array, targets, &options)
    }
}
